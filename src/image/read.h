// Reading image files and encoded images in memory.
#pragma once

#include "core/pixel_rect.h"
#include "image/image.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace etendue {

/// How many bits a channel takes once it is decoded without loss.
enum class TexelDepth { UInt8, UInt16, Half, Float };

/// Bytes of one channel of one pixel.
[[nodiscard]] std::size_t bytes_of(TexelDepth depth);

/// Size in pixels of an image or of one of its mip levels.
struct ImageLevel {
    int width = 0;
    int height = 0;
};

/// Holds what an image's header says; nothing is decoded.
struct ImageInfo {
    int width = 0;
    int height = 0;
    int channels = 0;          ///< channels in the file
    int decoded_channels = 0;  ///< channels that decoding gives, 1 to 4
    int bits_per_channel = 0;
    bool is_float = false;
    TexelDepth depth = TexelDepth::UInt8;
    std::string format;  ///< "png", "jpeg", "openexr", …

    /// Names the colour space as the file, or the library for its format, calls it ("ACEScg", "sRGB"; "Linear" where an
    /// EXR does not say). Nothing is converted by it.
    std::string color_space;
    /// CIE xy of red, green, blue and white, if the file has EXR's attribute of that name.
    std::optional<std::array<float, 8>> chromaticities;
    /// Stops for which the file says that it is to be shown brighter (`etendue:exposure`), if it does.
    std::optional<float> exposure;
    /// It says that it follows SMPTE ST 2065-4, and so is in ACES2065-1.
    bool is_aces_container = false;
    /// Where the pixels lie, and the full image that they are a part of, both in the file's coordinates with y down:
    /// EXR's data and display window. The same for formats without.
    PixelRect data_window;
    PixelRect display_window;
};

/// Largest image that is decoded: 2^28 pixels (16384²), and no side above 65536. A header that claims more is refused
/// before any memory is taken.
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 28;
inline constexpr int kMaxImageSide = 65536;
/// Is the most parts of an EXR, or pages of a TIFF: more than any program writes. An EXR with more is refused; further
/// pages of a TIFF are not read.
inline constexpr int kMostParts = 4096;

/// Where encoded pixels come from: a file, or bytes in memory. PNG, JPEG, WebP, OpenEXR, Radiance HDR and TIFF are
/// known, by their first bytes; of a multi-part file the first part is read, of an EXR layer set R, G, B and A.
using ImageSource = std::variant<std::filesystem::path, std::span<const std::byte>>;

/// Reads the header only. Throws IoError if it cannot be read, is no known image or claims an absurd size; the message
/// says which, without the file's name (the caller knows where it came from).
[[nodiscard]] ImageInfo read_image_info(const ImageSource& source);

/// Decodes to floats, 1 to 4 channels as in the file (more are dropped). Integer channels are scaled to [0, 1] and not
/// linearised; alpha is left as in the file (PNG: unassociated, EXR: associated). Throws IoError as `read_image_info`
/// does.
[[nodiscard]] ImageF read_image_float(const ImageSource& source);

/// Decodes to 8 bits a channel, 1 to 4 channels; deeper files are rounded. Throws IoError as `read_image_info` does.
[[nodiscard]] Image8 read_image_8bit(const ImageSource& source);

/// Decodes in the file's own depth: the image, then those of the file's mip levels that each halve the one before
/// (rounded down). Channels as `read_image_float`. Throws IoError as `read_image_info` does.
[[nodiscard]] std::vector<NativeImage> read_image_levels(const ImageSource& source);

/// Version of the image library.
[[nodiscard]] std::string image_library_version();

}  // namespace etendue
