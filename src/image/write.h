// Writing image files: to a temporary name in the same directory, then renamed, so that no reader ever sees half a file.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "core/vec.h"
#include "image/image.h"

namespace etendue {

/// One entry of an image's metadata. A vector of eight floats under the name "chromaticities" is written as the EXR
/// attribute of that name.
struct ImageAttribute {
    std::string name;
    std::variant<int, float, std::string, std::vector<float>, Mat4f> value;
};

enum class PixelDepth { UInt8, Half, Float };

struct ImageWriteOptions {
    PixelDepth depth = PixelDepth::Half;
    std::vector<std::string> channel_names;  ///< one per channel; empty for R, G, B, A
    std::vector<ImageAttribute> attributes;
    /// Position of the pixels in a larger image (a crop window): x, y of the first pixel, and the full size; all zero
    /// when the image is whole.
    int offset_x = 0;
    int offset_y = 0;
    int full_width = 0;
    int full_height = 0;
};

/// Writes `image` to `path`; the extension chooses the format. UInt8 expects values in [0, 1] that are already encoded
/// for display, and clamps and rounds them. Throws IoError with the path and the reason; no partial file is left.
void write_image(const std::filesystem::path& path, const ImageF& image, const ImageWriteOptions& options);

/// Writes `text` the same careful way. Throws IoError.
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace etendue
