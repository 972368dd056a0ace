// Progress on stderr: a bar that redraws itself on a terminal, a plain line every few seconds elsewhere.
#pragma once

#include "render/render.h"

#include <string>

namespace etendue {

class ProgressDisplay {
  public:
    /// `title` stands before the bar. Nothing is written if `quiet`.
    ProgressDisplay(const std::string& title, bool quiet);
    /// Ends the bar's line, so that what follows starts on its own.
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void update(const RenderProgress& progress);

  private:
    std::string title_;
    bool quiet_;
    bool terminal_;
    bool drawn_ = false;  ///< terminal: a bar stands there; elsewhere: the last line has been written
    double last_line_seconds_ = 0.0;
};

/// Characters of the terminal that stderr is; 80 if it is none.
[[nodiscard]] int terminal_width();
/// `1:02:03`, `2:03` or `3.4 s`.
[[nodiscard]] std::string format_duration(double seconds);
/// The line that the display shows, `width` characters at most; for tests.
[[nodiscard]] std::string format_progress(const std::string& title, const RenderProgress& progress, int width);

}  // namespace etendue
