#include "session/progress_pipe.h"

#include "session/usage_error.h"

#include <csignal>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/types.h>
#include <unistd.h>

namespace etendue {

namespace {

/// True if a line can be written without waiting: what is shorter than PIPE_BUF then is taken as a whole.
bool is_ready(int descriptor) {
    pollfd reader{.fd = descriptor, .events = POLLOUT, .revents = 0};
    return ::poll(&reader, 1, 0) == 1 && (reader.revents & POLLOUT) != 0;
}

}  // namespace

void require_progress_reader(int descriptor) {
    const int flags = ::fcntl(descriptor, F_GETFL);
    if (flags == -1 || (flags & O_ACCMODE) == O_RDONLY)
        throw UsageError(
            fmt::format("--progress-fd {}: no file is open there to be written to; in a shell, {}>FILE "
                        "behind the command opens one",
                        descriptor, descriptor));
}

ProgressPipe::ProgressPipe(int descriptor) : descriptor_(descriptor) {
    // A reader that is gone would end the process, with all that was rendered.
    if (descriptor_ >= 0) std::signal(SIGPIPE, SIG_IGN);
}

void ProgressPipe::update(const RenderProgress& progress) const {
    write_line("render", progress);
}

void ProgressPipe::enter(std::string_view phase) const {
    write_line(phase, {});
}

void ProgressPipe::write_line(std::string_view phase, const RenderProgress& p) const {
    if (descriptor_ < 0 || !is_ready(descriptor_)) return;
    const std::string line =
        fmt::format("{{\"phase\":\"{}\",\"fraction\":{:.6f},\"seconds\":{:.3f},\"samples\":{},\"rays\":{}}}\n", phase,
                    p.fraction, p.seconds, p.samples, p.rays);
    [[maybe_unused]] const ssize_t written = ::write(descriptor_, line.data(), line.size());
}

}  // namespace etendue
