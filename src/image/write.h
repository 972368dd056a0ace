// Writing image files: to a temporary name in the same directory, then renamed, so that no reader ever sees half a
// file.
#pragma once

#include "core/vec.h"
#include "image/image.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace etendue {

struct ImageRational {
    int numerator = 0;
    int denominator = 1;  ///< > 0

    friend bool operator==(const ImageRational&, const ImageRational&) = default;
};

/// Holds a SMPTE time code, hours, minutes, seconds and frames from the highest byte, two decimal digits in each.
struct ImageTimeCode {
    std::uint32_t digits = 0;

    friend bool operator==(const ImageTimeCode&, const ImageTimeCode&) = default;
};

/// One entry of an image's metadata. A vector of eight floats under the name "chromaticities" is written as the EXR
/// attribute of that name.
struct ImageAttribute {
    std::string name;
    std::variant<int, float, std::string, std::vector<float>, Mat4f, ImageRational, ImageTimeCode> value;
};

enum class PixelDepth { UInt8, UInt16, Half, Float };

enum class ExrCompression { Zip, None };

struct ImageWriteOptions {
    PixelDepth depth = PixelDepth::Half;
    ExrCompression compression = ExrCompression::Zip;
    std::vector<std::string> channel_names{};  ///< one per channel; empty for R, G, B, A (Y, A for one or two)
    std::vector<ImageAttribute> attributes{};
    /// Position of the pixels in a larger image (a crop window): x, y of the first pixel, and the full size; all zero
    /// when the image is whole.
    int offset_x = 0;
    int offset_y = 0;
    /// First pixel of that larger image, which `offset_x` and `offset_y` are counted from.
    int full_x = 0;
    int full_y = 0;
    int full_width = 0;
    int full_height = 0;
};

/// Writes `image` to `path`; the extension chooses the format: .exr (Half or Float) or .png (UInt8 or UInt16). Those of
/// PNG expect values in [0, 1] that are already encoded for display, and clamp and round them; Half clamps finite
/// values to ±65504. Creates no directory; a path that exists and is no regular file (/dev/stdout) is written in place.
/// Throws IoError with the path and the reason; no partial file is left.
void write_image(const std::filesystem::path& path, const ImageF& image, const ImageWriteOptions& options);

/// One image of a file that may hold several.
struct ImagePart {
    std::string name{};  ///< unlike all others
    const ImageF* image = nullptr;
    std::vector<std::string> channel_names{};  ///< in place of those of the options; empty for these
    std::vector<PixelDepth> channel_depths{};  ///< Half or Float of each channel; empty for that of the options
    std::vector<ImageAttribute> attributes{};  ///< besides those of the options
};

/// Writes `parts`, at least one, as a multi-part EXR in the same way; `options` are those of all.
void write_image_parts(const std::filesystem::path& path, std::span<const ImagePart> parts,
                       const ImageWriteOptions& options);

/// An image of any number of depths in each pixel.
struct DeepImageView {
    int width = 0;
    int height = 0;
    std::span<const std::uint32_t> counts{};  ///< number of depths of each pixel, row by row
    std::span<const float> colors{};          ///< R, G, B and A of each depth, from front to back
    std::span<const float> depths{};          ///< Z and ZBack of each depth
};

/// Writes a deep EXR of scanlines in the same way, whatever the options' depth in 32-bit floats.
void write_deep_image(const std::filesystem::path& path, const DeepImageView& image, const ImageWriteOptions& options);

/// The bytes of a PNG file of `image`, whose values lie in [0, 1] and are encoded for display. Throws IoError.
[[nodiscard]] std::vector<unsigned char> encode_png(const ImageF& image);

}  // namespace etendue
