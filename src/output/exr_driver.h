// Scene-linear OpenEXR files.
#pragma once

#include "color/color_config.h"
#include "image/write.h"
#include "output/output_driver.h"

#include <filesystem>
#include <span>

namespace etendue {

/// Pixels as they are, in the frame's output space or else its working space, with all metadata: chromaticities,
/// oiio:ColorSpace, worldToCamera and worldToNDC by OpenEXR's conventions, and etendue:* for how the image was made.
/// docs/colour.md lists them.
class ExrDriver final : public OutputDriver {
  public:
    /// `depth` is Half or Float.
    ExrDriver(std::filesystem::path path, ColorConfig config, PixelDepth depth = PixelDepth::Half);

    void write(const OutputFrame& frame) override;
    /// `parts`, of the frame's size and in the space that it is written in, in place of its pixels: a multi-part file,
    /// unless it is one.
    void write_parts(const OutputFrame& frame, std::span<const ImagePart> parts);

  private:
    std::filesystem::path path_;
    ColorConfig config_;
    PixelDepth depth_;
};

}  // namespace etendue
