#include "program/run_program.h"

#include "program/program_server.h"
#include "program/small_files.h"
#include "support/sanitizers.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace etendue::test {

namespace {

/// After fork other threads are gone while what they locked stays locked: only system calls may be made.
[[noreturn]] void become_etendue(char* const* argv, const std::filesystem::path& directory,
                                 const std::filesystem::path& out, const std::filesystem::path& err) {
    const int out_file = open(out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    const int err_file = open(err.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    const bool ready = out_file >= 0 && err_file >= 0 && dup2(out_file, STDOUT_FILENO) >= 0 &&
                       dup2(err_file, STDERR_FILENO) >= 0 && chdir(directory.c_str()) == 0;
    if (ready) execv(ETENDUE_PROGRAM, argv);
    _exit(127);
}

}  // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& arguments, const std::filesystem::path& directory,
                               Start start)
    : start_(kHasSanitizers ? Start::Executed : start) {
    // Beside the directory, not in it: tests look at what the program leaves there.
    // Several may run there at once.
    const std::string name = fmt::format("{}.{}", directory.string(), static_cast<const void*>(this));
    out_ = name + ".out";
    err_ = name + ".err";
    std::vector<std::string> words{"etendue"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    if (start_ == Start::Copied) {
        pid_ = program_server().start(words, directory, out_, err_);
        return;
    }
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) become_etendue(argv.data(), directory, out_, err_);
}

RunningProgram::~RunningProgram() {
    if (pid_ <= 0) return;
    send(SIGKILL);
    (void)wait();
}

void RunningProgram::send(int signal) const {
    if (pid_ > 0) kill(pid_, signal);
}

bool RunningProgram::has_ended() const {
    if (start_ == Start::Copied) return program_server().has_ended(pid_);
    siginfo_t ended{};
    return waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid == pid_;
}

std::string RunningProgram::messages() const {
    // The program makes it when it starts.
    return std::filesystem::exists(err_) ? read_file(err_) : "";
}

ProgramResult RunningProgram::wait() {
    // Far longer than any test's program takes: a test that hangs has to say which it is.
    constexpr int kPatience = 5;
    bool ended = false;
    for (int i = 0; i < kPatience && !ended; ++i) ended = wait_until([this] { return has_ended(); });
    if (!ended) {
        ADD_FAILURE() << "process " << pid_ << " has not ended in " << kPatience << " minutes: " << messages();
        send(SIGKILL);
    }
    int status = 0;
    const int pid = std::exchange(pid_, -1);
    if (start_ == Start::Copied) {
        status = program_server().wait(pid);
    } else {
        waitpid(pid, &status, 0);
    }
    ProgramResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    result.out = read_file(out_);
    result.err = read_file(err_);
    std::filesystem::remove(out_);
    std::filesystem::remove(err_);
    return result;
}

std::filesystem::path program_file() {
    return kHasSanitizers ? ETENDUE_PROGRAM : ETENDUE_SERVED_PROGRAM;
}

bool handles_interrupt(int pid) {
    std::ifstream status(fmt::format("/proc/{}/status", pid));
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("State:\tZ")) return false;  // it has ended
        if (line.starts_with("SigCgt:"))
            return (std::stoull(line.substr(7), nullptr, 16) & (1ull << (SIGINT - 1))) != 0;
    }
    return false;
}

std::string command_of(int pid) {
    std::ifstream file(fmt::format("/proc/{}/cmdline", pid));
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<int> children_of(int pid) {
    std::vector<int> children;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        const std::string name = entry.path().filename().string();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        std::string text;
        std::getline(std::ifstream(entry.path() / "stat"), text);
        int parent = 0;
        const std::size_t name_end = text.rfind(')');
        if (name_end == std::string::npos) continue;
        if (std::sscanf(text.c_str() + name_end, ") %*c %d", &parent) == 1 && parent == pid)
            children.push_back(std::stoi(name));
    }
    return children;
}

bool wait_until(const std::function<bool()>& is_true, std::chrono::microseconds interval) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!is_true()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(interval);
    }
    return true;
}

ProgramResult run_etendue(const std::vector<std::string>& arguments, const std::filesystem::path& directory,
                          const std::function<void(int pid)>& while_running, Start start) {
    RunningProgram program(arguments, directory, start);
    if (while_running) {
        const bool is_ready =
            wait_until([&program] { return program.has_ended() || handles_interrupt(program.pid()); });
        if (is_ready && !program.has_ended()) while_running(program.pid());
    }
    return program.wait();
}

}  // namespace etendue::test
