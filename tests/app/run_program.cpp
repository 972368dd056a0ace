#include "app/run_program.h"

#include "app/small_files.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace etendue::test {

namespace {

/// True once the process catches SIGINT, by the mask of caught signals in /proc.
bool handles_interrupt(pid_t pid) {
    std::ifstream status(fmt::format("/proc/{}/status", pid));
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("SigCgt:"))
            return (std::stoull(line.substr(7), nullptr, 16) & (1ull << (SIGINT - 1))) != 0;
    return false;
}

[[noreturn]] void become_etendue(const std::vector<std::string>& arguments, const std::filesystem::path& directory,
                                 const std::filesystem::path& out, const std::filesystem::path& err) {
    std::vector<char*> argv{const_cast<char*>("etendue")};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const int out_file = open(out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    const int err_file = open(err.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
    const bool ready = out_file >= 0 && err_file >= 0 && dup2(out_file, STDOUT_FILENO) >= 0 &&
                       dup2(err_file, STDERR_FILENO) >= 0 && chdir(directory.c_str()) == 0;
    if (ready) execv(ETENDUE_PROGRAM, argv.data());
    _exit(127);
}

}  // namespace

ProgramResult run_etendue(const std::vector<std::string>& arguments, const std::filesystem::path& directory,
                          const std::function<void(int pid)>& while_running) {
    // Beside the directory, not in it: tests look at what the program leaves there.
    const std::filesystem::path out = directory.string() + ".out";
    const std::filesystem::path err = directory.string() + ".err";
    const pid_t pid = fork();
    if (pid == 0) become_etendue(arguments, directory, out, err);
    int status = 0;
    bool ended = false;
    if (while_running) {
        for (int i = 0; i < 3000 && !ended && !handles_interrupt(pid); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            ended = waitpid(pid, &status, WNOHANG) == pid;
        }
        if (!ended) while_running(pid);
    }
    if (!ended) waitpid(pid, &status, 0);
    ProgramResult result;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    result.out = read_file(out);
    result.err = read_file(err);
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return result;
}

}  // namespace etendue::test
