#include "process/run_command.h"

#include "core/error.h"
#include "core/system_error_text.h"
#include "process/pipe.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace etendue {

namespace {

[[noreturn]] void throw_error(const std::string& program, int error) {
    throw IoError(fmt::format("cannot run {}: {}", program, system_error_text(error)));
}

Pipe pipe_to(const std::string& program) {
    Pipe pipe = make_pipe();
    if (!pipe.reader.is_open()) throw_error(program, errno);
    return pipe;
}

pid_t start(const std::vector<std::string>& words, const Pipe& out, const Pipe& err) {
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    // posix_spawn takes words that it does not write to.
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    if (const int error = ::posix_spawn_file_actions_init(&actions)) throw_error(words.front(), error);
    pid_t pid = -1;
    int error = ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (error == 0) error = ::posix_spawn_file_actions_adddup2(&actions, out.writer.get(), STDOUT_FILENO);
    if (error == 0) error = ::posix_spawn_file_actions_adddup2(&actions, err.writer.get(), STDERR_FILENO);
    // Commands expect that these signals, which this process ignores, end them.
    posix_spawnattr_t attributes;
    if (const int failure = ::posix_spawnattr_init(&attributes)) throw_error(words.front(), failure);
    sigset_t default_signals;
    ::sigemptyset(&default_signals);
    for (const int signal : {SIGPIPE, SIGXFSZ}) ::sigaddset(&default_signals, signal);
    if (error == 0) error = ::posix_spawnattr_setsigdefault(&attributes, &default_signals);
    if (error == 0) error = ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    if (error == 0) error = ::posix_spawnp(&pid, words.front().c_str(), &actions, &attributes, argv.data(), environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw_error(words.front(), error);
    return pid;
}

/// Returns whether `pid` has ended, and what it ended with.
bool has_ended(pid_t pid, int& status) {
    return ::waitpid(pid, &status, WNOHANG) == pid;
}

/// Reads both at once, so that the program never waits for one while we wait for the other, until both or the program
/// `pid` have ended: what it has started may keep them open. Returns what the program ended with.
int read_all(const Pipe& out, const Pipe& err, pid_t pid, CommandResult& result) {
    constexpr int kMillisecondsBetweenLooks = 100;
    int status = 0;
    bool is_over = false;
    std::array<pollfd, 2> open{pollfd{out.reader.get(), POLLIN, 0}, pollfd{err.reader.get(), POLLIN, 0}};
    const std::array<std::string*, 2> texts{&result.out, &result.err};
    std::array<char, 4096> buffer{};
    while (open[0].fd >= 0 || open[1].fd >= 0) {
        is_over = is_over || has_ended(pid, status);
        const int ready = ::poll(open.data(), open.size(), is_over ? 0 : kMillisecondsBetweenLooks);
        if ((ready < 0 && errno != EINTR) || (ready == 0 && is_over)) break;
        for (std::size_t i = 0; i < open.size(); ++i) {
            if (open[i].fd < 0 || open[i].revents == 0) continue;
            const ssize_t count = ::read(open[i].fd, buffer.data(), buffer.size());
            if (count > 0) texts[i]->append(buffer.data(), static_cast<std::size_t>(count));
            // poll passes over what is negative.
            if (count == 0 || (count < 0 && errno != EINTR)) open[i].fd = -1;
        }
    }
    while (!is_over && ::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

}  // namespace

CommandResult run_command(const std::vector<std::string>& words) {
    Pipe out = pipe_to(words.front());
    Pipe err = pipe_to(words.front());
    const pid_t pid = start(words, out, err);
    out.writer.close();
    err.writer.close();
    CommandResult result;
    const int status = read_all(out, err, pid, result);
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

}  // namespace etendue
