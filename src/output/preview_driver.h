// Images to look at.
#pragma once

#include "color/color_config.h"
#include "output/output_frame.h"

#include <filesystem>

namespace etendue {

/// An 8-bit RGB PNG of the frame over black, through its exposure, display and view. Only the crop window is written,
/// and of one that goes beyond the image, what lies within.
class PreviewDriver final {
  public:
    PreviewDriver(std::filesystem::path path, ColorConfig config);

    /// Without an exposure the frame is shown as it is.
    void write(const OutputFrame& frame);

    /// Returns the share of the pixels that was last written that have a channel as bright as a PNG can show.
    [[nodiscard]] double clipped_share() const { return clipped_share_; }

  private:
    std::filesystem::path path_;
    ColorConfig config_;
    double clipped_share_ = 0.0;
};

}  // namespace etendue
