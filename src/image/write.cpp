#include "image/write.h"

#include "core/error.h"
#include "core/source_date.h"
#include "core/write_file.h"
#include "image/exr_header.h"
#include "image/image_functions.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace etendue {

namespace {

// OpenImageIO's EXR writer leaves out every attribute whose name begins with "oiio:" (2.4; its reader knows this one),
// so it is written under a name of the same length and renamed in the encoded header.
constexpr std::string_view kColorSpace = "oiio:ColorSpace";
constexpr std::string_view kColorSpaceStandIn = "etnd:ColorSpace";

/// OpenImageIO calls EXR's capDate by this name.
constexpr std::string_view kDate = "DateTime";

// OpenImageIO's name of the format that the extension asks for; throws if that format cannot hold the pixels.
std::string output_format(const std::filesystem::path& path, PixelDepth depth) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool exr = extension == ".exr";
    if (!exr && extension != ".png") throw IoError(fmt::format("cannot write {}: not .exr or .png", path.string()));
    if (exr == is_integer(depth)) {
        throw IoError(fmt::format("cannot write {}: {}", path.string(),
                                  exr ? "EXR holds floats only" : "PNG holds 8 or 16-bit integers only"));
    }
    return exr ? "openexr" : "png";
}

void check_shape(const std::filesystem::path& path, const ImagePart& part, const ImageWriteOptions& options) {
    const ImageF& image = *part.image;
    const std::vector<std::string>& names = part.channel_names.empty() ? options.channel_names : part.channel_names;
    const auto expected = static_cast<std::size_t>(std::max(image.width, 0)) *
                          static_cast<std::size_t>(std::max(image.height, 0)) *
                          static_cast<std::size_t>(std::max(image.channels, 0));
    const auto channels = static_cast<std::size_t>(std::max(image.channels, 0));
    const bool named = (names.empty() || names.size() == channels) &&
                       (part.channel_depths.empty() || part.channel_depths.size() == channels);
    if (expected == 0 || image.pixels.size() != expected || !named) {
        throw IoError(fmt::format("cannot write {}: {} x {} pixels of {} channels with {} values and {} channel names",
                                  path.string(), image.width, image.height, image.channels, image.pixels.size(),
                                  names.size()));
    }
}

/// Returns the options that the library gets for an EXR.
ImageWriteOptions for_library(ImageWriteOptions options) {
    for (ImageAttribute& attribute : options.attributes)
        if (attribute.name == kColorSpace) attribute.name = kColorSpaceStandIn;
    // Else the library writes what time it is.
    if (const auto date = source_date()) {
        std::erase_if(options.attributes, [](const ImageAttribute& attribute) { return attribute.name == kDate; });
        options.attributes.push_back({std::string(kDate), fmt::format("{:%Y:%m:%d %H:%M:%S}", fmt::gmtime(*date))});
    }
    return options;
}

// Encoded in memory first, so that every byte that reaches the disk is written and checked in one place.
std::vector<unsigned char> encode(const std::filesystem::path& path, std::span<const ImagePart> parts,
                                  const ImageWriteOptions& options) {
    for (const ImagePart& part : parts) check_shape(path, part, options);
    const std::string format = output_format(path, options.depth);
    if (is_integer(options.depth)) return image_functions().encode(path, format, parts, options);
    std::vector<unsigned char> encoded = image_functions().encode(path, format, parts, for_library(options));
    rename_exr_attribute(encoded, kColorSpaceStandIn, kColorSpace);
    return encoded;
}

}  // namespace

void write_deep_image(const std::filesystem::path& path, const DeepImageView& image, const ImageWriteOptions& options) {
    std::vector<unsigned char> encoded = image_functions().encode_deep(path, image, for_library(options));
    rename_exr_attribute(encoded, kColorSpaceStandIn, kColorSpace);
    write_bytes(path, std::as_bytes(std::span<const unsigned char>(encoded)));
}

void write_image_parts(const std::filesystem::path& path, std::span<const ImagePart> parts,
                       const ImageWriteOptions& options) {
    write_bytes(path, std::as_bytes(std::span<const unsigned char>(encode(path, parts, options))));
}

void write_image(const std::filesystem::path& path, const ImageF& image, const ImageWriteOptions& options) {
    write_image_parts(path, std::array{ImagePart{.image = &image}}, options);
}

std::vector<unsigned char> encode_png(const ImageF& image) {
    ImageWriteOptions options;
    options.depth = PixelDepth::UInt8;
    return encode("image.png", std::array{ImagePart{.image = &image}}, options);
}

}  // namespace etendue
