// Headers of Radiance pictures: what the image library does not heed. For this room only.
#pragma once

#include "core/rgb.h"
#include "image/image.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace etendue {

/// How the pixels of a picture lie and what they stand for (Radiance, "File Formats", section "Picture").
struct RadianceHeader {
    int width = 0;             ///< as the picture is seen, pixels
    int height = 0;            ///< as the picture is seen, pixels
    bool by_columns = false;   ///< each scanline is a column of the picture
    bool from_bottom = false;  ///< y grows with the order of the pixels
    bool from_right = false;   ///< x falls with the order of the pixels
    bool is_xyz = false;       ///< colours are CIE XYZ, Y in cd/m²
    Rgb exposure{1.0f};        ///< factor that radiance was multiplied with
    std::size_t size = 0;      ///< bytes before the first scanline
    bool is_plain = false;     ///< the image library reads it as it is meant

    friend bool operator==(const RadianceHeader&, const RadianceHeader&) = default;
};

/// Most bytes that a header may have.
inline constexpr std::size_t kMostRadianceHeader = std::size_t{1} << 16;

/// Reads the header that `file` begins with, of which `file` has at least its first kMostRadianceHeader bytes or all.
/// Throws IoError if it has no end, an unknown format, broken values or no size.
[[nodiscard]] RadianceHeader parse_radiance_header(std::span<const std::byte> file);

/// A header that the image library reads as it is meant, for scanlines that lie as those of `header` do.
[[nodiscard]] std::string plain_radiance_header(const RadianceHeader& header);

/// The picture that `scanlines`, decoded behind `plain_radiance_header`, stand for: upright, and radiance
/// in Rec.709 if it has all three channels.
[[nodiscard]] ImageF developed(ImageF scanlines, const RadianceHeader& header);

}  // namespace etendue
