// Scene-linear OpenEXR files.
#pragma once

#include "color/color_config.h"
#include "image/write.h"
#include "output/output_frame.h"

#include <filesystem>
#include <span>

namespace etendue {

/// Pixels as they are, in the frame's output space or else its working space, with all metadata: chromaticities,
/// oiio:ColorSpace, worldToCamera and worldToNDC by OpenEXR's conventions, and etendue:* for how the image was made.
/// docs/colour.md lists them.
class ExrDriver final {
  public:
    /// `depth` is Half or Float.
    ExrDriver(std::filesystem::path path, ColorConfig config, PixelDepth depth = PixelDepth::Half);

    /// The image and its layers as the channels of one part: R, G, B, A, NAME.R …
    void write(const OutputFrame& frame);
    /// Writes the image and the layers of `frame` as parts of their own, "rgba", NAME …, from pixels that are in the
    /// space in which the file holds them.
    void write_layers_as_parts(const OutputFrame& frame);
    /// One layer of the frame, in the space that it is written in, in place of its pixels.
    void write_layer(const OutputFrame& frame, const OutputLayer& layer);
    /// The frame's depths, in the space that it is written in: a deep file of R, G, B, A, Z and ZBack, all of them
    /// 32-bit floats.
    void write_deep(const OutputFrame& frame);
    /// `parts`, of the frame's size and in the space that it is written in, in place of its pixels: a multi-part file,
    /// unless it is one.
    void write_parts(const OutputFrame& frame, std::span<const ImagePart> parts);

  private:
    [[nodiscard]] ImageWriteOptions options_of(const OutputFrame& frame) const;
    [[nodiscard]] ImagePart part_of(const OutputLayer& layer, bool with_name) const;

    std::filesystem::path path_;
    ColorConfig config_;
    PixelDepth depth_;
};

}  // namespace etendue
