#include "process/child_process.h"

#include "core/error.h"
#include "core/system_error_text.h"
#include "process/memory_left.h"
#include "process/pipe.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <sys/poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace etendue {

namespace {

[[noreturn]] void throw_start_error(const std::filesystem::path& program, int error) {
    throw IoError(fmt::format("cannot start {}: {}", program.string(), system_error_text(error)));
}

Pipe pipe_for(const std::filesystem::path& program) {
    Pipe pipe = make_pipe();
    if (!pipe.reader.is_open()) throw_start_error(program, errno);
    return pipe;
}

/// Holds what the child needs on its way from fork to exec.
struct Start {
    const char* program;
    char* const* arguments;
    int output;
    int messages;
    int progress;
    int failure;  ///< takes the error number if there is no exec
    pid_t parent;
    std::optional<rlimit> memory;
};

/// Puts `from` in the place of the descriptor `to`.
bool place(int from, int to) {
    return ::dup2(from, to) == to;
}

/// Everything but the exec itself. Here and in `become`, other threads are gone while what they locked stays locked:
/// only system calls may be made.
bool prepare(const Start& start, int& failure) {
    // Out of the way of the descriptors that are about to be given out.
    constexpr int kFirstFree = ChildProcess::kProgressDescriptor + 1;
    failure = ::fcntl(start.failure, F_DUPFD_CLOEXEC, kFirstFree);
    const int output = ::fcntl(start.output, F_DUPFD_CLOEXEC, kFirstFree);
    const int messages = ::fcntl(start.messages, F_DUPFD_CLOEXEC, kFirstFree);
    const int progress = ::fcntl(start.progress, F_DUPFD_CLOEXEC, kFirstFree);
    const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (failure < 0 || output < 0 || messages < 0 || progress < 0 || nothing < 0) return false;
    if (!place(nothing, STDIN_FILENO) || !place(output, STDOUT_FILENO) || !place(messages, STDERR_FILENO) ||
        !place(progress, ChildProcess::kProgressDescriptor))
        return false;
    // If stdin was closed here, /dev/null has its number already, and would be closed by exec.
    if (nothing == STDIN_FILENO && ::fcntl(STDIN_FILENO, F_SETFD, 0) != 0) return false;
    // Sockets that a library has accepted are open for children, too; a kernel that cannot close them leaves them so.
    (void)::close_range(kFirstFree, ~0u, CLOSE_RANGE_CLOEXEC);
    // The child would go on ignoring the signals that this process and its libraries ignore.
    for (const int number : {SIGPIPE, SIGXFSZ})
        if (::signal(number, SIG_DFL) == SIG_ERR) return false;
    if (start.memory && ::setrlimit(RLIMIT_DATA, &*start.memory) != 0) return false;
    return ::setpgid(0, 0) == 0 && ::prctl(PR_SET_PDEATHSIG, SIGKILL) == 0;
}

[[noreturn]] void become(const Start& start) {
    int failure = start.failure;
    if (prepare(start, failure)) {
        // The parent may have ended before its end was to be told.
        if (::getppid() != start.parent) ::_exit(0);
        ::execv(start.program, start.arguments);
    }
    const int error = errno;
    const ssize_t ignored = ::write(failure, &error, sizeof error);
    ::_exit(ignored == sizeof error ? 126 : 127);
}

/// 0 if exec has succeeded, which closes the pipe.
int exec_error(const FileDescriptor& failure) {
    int error = 0;
    ssize_t got = 0;
    do got = ::read(failure.get(), &error, sizeof error);
    while (got < 0 && errno == EINTR);
    return got == sizeof error ? error : 0;
}

/// Hands what can be read now to `take`; closes the pipe at its end.
template <typename Take>
void read_available(FileDescriptor& pipe, const Take& take) {
    std::array<char, 65536> buffer{};
    while (pipe.is_open()) {
        const ssize_t got = ::read(pipe.get(), buffer.data(), buffer.size());
        if (got > 0) {
            take(std::string_view(buffer.data(), static_cast<std::size_t>(got)));
            continue;
        }
        if (got < 0 && errno == EINTR) continue;
        if (got < 0 && errno == EAGAIN) return;
        pipe.close();
    }
}

}  // namespace

std::string signal_name(int signal) {
    const char* const name = ::sigabbrev_np(signal);
    return name != nullptr ? fmt::format("SIG{}", name) : fmt::format("signal {}", signal);
}

ChildProcess::ChildProcess(const ChildOptions& options) : most_output_(options.most_output) {
    std::vector<std::string> words{options.name};
    words.insert(words.end(), options.arguments.begin(), options.arguments.end());
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    Pipe output = pipe_for(options.program);
    Pipe messages = pipe_for(options.program);
    Pipe progress = pipe_for(options.program);
    Pipe failure = pipe_for(options.program);
    // Nobody waits for progress to be read.
    for (const FileDescriptor* end : {&output.reader, &messages.reader, &progress.reader, &progress.writer})
        if (::fcntl(end->get(), F_SETFL, O_NONBLOCK) != 0) throw_start_error(options.program, errno);

    Start start{.program = options.program.c_str(),
                .arguments = argv.data(),
                .output = output.writer.get(),
                .messages = messages.writer.get(),
                .progress = progress.writer.get(),
                .failure = failure.writer.get(),
                .parent = ::getpid(),
                .memory = std::nullopt};
    if (options.memory_limit) start.memory = rlimit{*options.memory_limit, *options.memory_limit};
    pid_ = ::fork();
    if (pid_ < 0) throw_start_error(options.program, errno);
    if (pid_ == 0) become(start);

    failure.writer.close();
    if (const int error = exec_error(failure.reader); error != 0) {
        reap();
        throw_start_error(options.program, error);
    }
    output_stream_.pipe = std::move(output.reader);
    messages_.pipe = std::move(messages.reader);
    progress_.pipe = std::move(progress.reader);
}

ChildProcess::~ChildProcess() {
    send(SIGKILL);
    if (pid_ > 0) reap();
}

void ChildProcess::send(int signal) {
    if (pid_ > 0) ::kill(pid_, signal);
}

void ChildProcess::reap() {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    end_ = {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0,
            .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0};
}

void ChildProcess::drain(const LineCallback& on_message, const LineCallback& on_progress) {
    const LineCallback keep = [&](const std::string& line) {
        last_messages_.push_back(line);
        if (last_messages_.size() > kKeptLines) last_messages_.pop_front();
        on_message(line);
    };
    read_available(output_stream_.pipe, [&](std::string_view text) {
        const std::size_t kept = std::min(text.size(), most_output_ - output_.size());
        output_was_cut_ = output_was_cut_ || kept < text.size();
        output_.append(text.substr(0, kept));
    });
    read_available(messages_.pipe, [&](std::string_view text) { messages_.lines.add(text, keep); });
    read_available(progress_.pipe, [&](std::string_view text) { progress_.lines.add(text, on_progress); });
    if (pid_ > 0) return;
    messages_.lines.finish(keep);
    progress_.lines.finish(on_progress);
}

void ChildProcess::wait_for_any(std::span<const ChildProcess* const> children, std::chrono::milliseconds timeout) {
    // Nothing tells when a child ends that has closed its pipes; it mostly does so by ending.
    constexpr std::chrono::milliseconds kBetweenLooks(10);
    std::vector<pollfd> pipes;
    for (const ChildProcess* const child : children) {
        const std::size_t before = pipes.size();
        for (const Stream* stream : {&child->output_stream_, &child->messages_, &child->progress_})
            if (stream->pipe.is_open()) pipes.push_back({stream->pipe.get(), POLLIN, 0});
        if (pipes.size() == before) timeout = std::min(timeout, kBetweenLooks);
    }
    ::poll(pipes.data(), pipes.size(), static_cast<int>(timeout.count()));
}

std::uint64_t ChildProcess::own_memory_bytes() const {
    return pid_ > 0 ? process_memory_bytes(pid_) : 0;
}

bool ChildProcess::wait(std::chrono::milliseconds timeout, const LineCallback& on_message,
                        const LineCallback& on_progress) {
    if (pid_ < 0) return false;
    const ChildProcess* const self = this;
    wait_for_any({&self, 1}, timeout);
    siginfo_t ended{};
    const bool is_over =
        ::waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOWAIT | WNOHANG) == 0 && ended.si_pid == pid_;
    if (is_over) reap();
    drain(on_message, on_progress);
    return !is_over;
}

}  // namespace etendue
