#include "app/progress_pipe.h"

#include <string>

#include <fmt/format.h>
#include <sys/types.h>
#include <unistd.h>

namespace etendue {

void ProgressPipe::update(const RenderProgress& progress) const {
    write_line("render", progress);
}

void ProgressPipe::enter(std::string_view phase) const {
    write_line(phase, {});
}

void ProgressPipe::write_line(std::string_view phase, const RenderProgress& p) const {
    if (descriptor_ < 0) return;
    const std::string line =
        fmt::format("{{\"phase\":\"{}\",\"fraction\":{:.6f},\"seconds\":{:.3f},\"samples\":{},\"rays\":{}}}\n", phase,
                    p.fraction, p.seconds, p.samples, p.rays);
    // Shorter than what a pipe takes as a whole (PIPE_BUF).
    [[maybe_unused]] const ssize_t written = ::write(descriptor_, line.data(), line.size());
}

}  // namespace etendue
