// Progress for another program: a JSON object a line.
#pragma once

#include "render/render.h"

#include <string_view>

namespace etendue {

/// Throws UsageError unless `descriptor` is open for writing. What is not would become that of some other file.
void require_progress_reader(int descriptor);

class ProgressPipe {
  public:
    /// Writes to the open `descriptor`; nothing if that is negative. A reader that is gone or slow is no reason to
    /// stop: what cannot be written at once is left out, and SIGPIPE is ignored from now on.
    explicit ProgressPipe(int descriptor);

    /// {"phase": "render", "fraction": 0 to 1, "seconds": of rendering, "samples": n, "rays": n}
    void update(const RenderProgress& progress) const;
    /// Writes a line like that of `update` for a `phase` whose progress is not known: "load", "resume" (what was kept
    /// is read), "build" or "write".
    void enter(std::string_view phase) const;

  private:
    void write_line(std::string_view phase, const RenderProgress& progress) const;

    int descriptor_;
};

}  // namespace etendue
