#include "oiio/open_image.h"

#include "core/error.h"
#include "core/refused_input.h"
#include "oiio/library_setup.h"
#include "oiio/shown_bytes.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace etendue::oiio {

namespace {

void refuse_large_tiles(const OIIO::ImageSpec& spec) {
    constexpr int kMaxTileBeyondImage = 4096;
    if (spec.tile_width > std::max(spec.width, kMaxTileBeyondImage) ||
        spec.tile_height > std::max(spec.height, kMaxTileBeyondImage))
        throw IoError(
            fmt::format("its tiles of {} x {} pixels are larger than the image", spec.tile_width, spec.tile_height));
}

void refuse_absurd(const OIIO::ImageSpec& spec, const EncodedFormat& format, std::int64_t encoded_size) {
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) throw IoError("the image has no pixels");
    if (spec.deep || spec.depth > 1) throw IoError("deep and volume images are not supported");
    const std::int64_t pixels = std::int64_t{spec.width} * spec.height;
    if (spec.width > kMaxImageSide || spec.height > kMaxImageSide || pixels > kMaxImagePixels) {
        throw RefusedInput(fmt::format("{} x {} pixels are more than are allowed ({} in all, {} on a side)", spec.width,
                                       spec.height, kMaxImagePixels, kMaxImageSide));
    }
    refuse_large_tiles(spec);
    const auto decoded_bits = 8 * static_cast<std::int64_t>(spec.pixel_bytes(true));
    const std::int64_t bits = format.bits_per_pixel > 0 ? format.bits_per_pixel : decoded_bits;
    if (pixels * bits / 8 / format.max_expansion > encoded_size) {
        throw IoError(fmt::format("the header claims {} x {} pixels, which {} bytes cannot hold", spec.width,
                                  spec.height, encoded_size));
    }
}

std::vector<int> select_channels(const OIIO::ImageSpec& spec) {
    std::vector<int> selected;
    for (const char* name : {"R", "G", "B"}) {
        if (const int index = spec.channelindex(name); index >= 0) selected.push_back(index);
    }
    if (selected.size() == 3) {
        if (const int alpha = spec.channelindex("A"); alpha >= 0) selected.push_back(alpha);
        return selected;
    }
    selected.clear();
    for (int i = 0; i < std::min(spec.nchannels, 4); ++i) selected.push_back(i);
    return selected;
}

TexelDepth depth_of(const OIIO::ImageSpec& spec) {
    switch (spec.format.basetype) {
        case OIIO::TypeDesc::UINT8:
            return TexelDepth::UInt8;
        case OIIO::TypeDesc::UINT16:
            return TexelDepth::UInt16;
        case OIIO::TypeDesc::HALF:
            return TexelDepth::Half;
        default:
            return TexelDepth::Float;
    }
}

/// Windows are any integers in the file, so that their far corner may lie beyond what an int holds.
PixelRect window(int x, int y, int width, int height) {
    constexpr std::int64_t kMost = std::numeric_limits<int>::max();
    return {x, y, static_cast<int>(std::min(kMost, std::int64_t{x} + width)),
            static_cast<int>(std::min(kMost, std::int64_t{y} + height))};
}

std::optional<std::array<float, 8>> chromaticities_of(const OIIO::ImageSpec& spec) {
    constexpr OIIO::TypeDesc kEightFloats(OIIO::TypeDesc::FLOAT, 8);
    std::array<float, 8> values{};
    if (!spec.getattribute("chromaticities", kEightFloats, values.data())) return std::nullopt;
    return values;
}

bool is_tiff(const OIIO::ImageInput& input) {
    return input.format_name() == std::string_view("tiff");
}

/// True if the library has kept an error of a TIFF that it did not return. A JPEG that ends early leaves an error, too,
/// but the library makes its rest up.
bool has_broken_strips(const OIIO::ImageInput& input) {
    return is_tiff(input) && input.has_error();
}

/// True if the library, or one behind it, has got no memory: OpenEXR, libjpeg, or libpng and libtiff.
bool tells_of_memory(std::string_view reason) {
    constexpr std::array<std::string_view, 3> kWords{"std::bad_alloc", "nsufficient memory", "ut of memory"};
    return std::ranges::any_of(kWords, [&](auto words) { return reason.find(words) != std::string_view::npos; });
}

/// Returns what the library reads `encoded` through, of which `name` is the file; null if that is all of a file.
std::unique_ptr<OIIO::Filesystem::IOProxy> bytes_to_show(const EncodedImage& encoded, const std::string& name) {
    using namespace OIIO::Filesystem;
    std::unique_ptr<IOProxy> bytes;
    if (const auto* memory = std::get_if<std::span<const std::byte>>(&encoded.source))
        bytes = std::make_unique<IOMemReader>(memory->data(), memory->size());
    if (encoded.pieces.empty()) return bytes;
    if (!bytes) bytes = std::make_unique<IOFile>(name, IOProxy::Read);
    return std::make_unique<ShownBytes>(std::move(bytes), encoded.pieces);
}

}  // namespace

bool read_rows(OIIO::ImageInput& input, int begin, int end, const PixelTarget& target) {
    const auto& [part, level, channels, type, pixels, stride] = target;
    // Where it inflates several rows of a TIFF, the library does not look whether their strips are broken.
    const int step = is_tiff(input) ? 1 : end - begin;
    const std::size_t pixel_bytes =
        stride == OIIO::AutoStride ? channels.size() * type.size() : static_cast<std::size_t>(stride);
    const std::size_t row_bytes = pixel_bytes * static_cast<std::size_t>(input.spec_dimensions(part, level).width);
    auto* row = static_cast<std::byte*>(pixels);
    for (int y = begin; y < end; y += step, row += row_bytes * static_cast<std::size_t>(step))
        if (!input.read_scanlines(part, level, y, y + step, 0, channels.first, channels.last, type, row, stride))
            return false;
    return !has_broken_strips(input);
}

bool read_tiles(OIIO::ImageInput& input, int x, int y, const ImageLevel& size, const PixelTarget& target) {
    const auto& [part, level, channels, type, pixels, stride] = target;
    return input.read_tiles(part, level, x, x + size.width, y, y + size.height, 0, 1, channels.first, channels.last,
                            type, pixels, stride) &&
           !has_broken_strips(input);
}

bool read_pixels(OIIO::ImageInput& input, const PixelTarget& target) {
    const auto& [part, level, channels, type, pixels, stride] = target;
    const OIIO::ImageSpec spec = input.spec_dimensions(part, level);
    if (is_tiff(input) && spec.tile_width == 0) return read_rows(input, spec.y, spec.y + spec.height, target);
    return input.read_image(part, level, channels.first, channels.last, type, pixels, stride) &&
           !has_broken_strips(input);
}

void throw_library_error(const OIIO::ImageInput& input, std::string_view what) {
    std::string reason = input.geterror();
    if (reason.empty()) reason = OIIO::geterror();
    if (tells_of_memory(reason)) throw std::bad_alloc();
    throw IoError(reason.empty() ? std::string(what) : fmt::format("{}: {}", what, reason));
}

OpenImage open_unchecked(const EncodedImage& encoded) {
    configure_image_library();
    OpenImage image;
    image.format = encoded.format;
    image.encoded_size = encoded.size;
    image.input = OIIO::ImageInput::create(std::string(image.format.name));
    if (!image.input) throw IoError(OIIO::geterror());
    image.input->threads(1);

    const auto* const path = std::get_if<std::filesystem::path>(&encoded.source);
    const std::string name = path != nullptr ? path->string() : "memory." + std::string(image.format.name);
    image.bytes = bytes_to_show(encoded, name);
    if (image.bytes && !image.input->set_ioproxy(image.bytes.get()))
        throw_library_error(*image.input, "cannot read from memory");
    OIIO::ImageSpec request;
    request.attribute("oiio:UnassociatedAlpha", 1);
    if (!image.input->open(name, image.spec, request)) throw_library_error(*image.input, "the header is broken");
    image.channels = select_channels(image.spec);
    return image;
}

bool seek_part(OpenImage& image, int part) {
    if (part >= kMostParts) return false;
    if (!image.input->seek_subimage(part, 0)) return false;
    image.part = part;
    image.spec = image.input->spec();
    image.channels = select_channels(image.spec);
    return true;
}

void require_all_parts(const OpenImage& image) {
    if (image.format.name == "openexr" && image.input->has_error())
        throw_library_error(*image.input, fmt::format("part {} is broken", image.part + 1));
}

void require_acceptable(const OpenImage& image) {
    refuse_absurd(image.spec, image.format, image.encoded_size);
}

OpenImage open_image(const EncodedImage& encoded, int part) {
    OpenImage image = open_unchecked(encoded);
    if (part != 0 && !seek_part(image, part)) throw_library_error(*image.input, fmt::format("it has no part {}", part));
    require_acceptable(image);
    return image;
}

ImageInfo describe(const OpenImage& image) {
    ImageInfo info;
    info.width = image.spec.width;
    info.height = image.spec.height;
    info.channels = image.spec.nchannels;
    info.decoded_channels = static_cast<int>(image.channels.size());
    info.is_float = image.spec.format.is_floating_point();
    info.bits_per_channel = image.spec.get_int_attribute("oiio:BitsPerSample", 8 * int(image.spec.format.basesize()));
    info.depth = depth_of(image.spec);
    info.format = image.format.name;
    info.color_space = image.spec.get_string_attribute("oiio:ColorSpace");
    info.chromaticities = chromaticities_of(image.spec);
    if (float stops = 0.0f; image.spec.getattribute("etendue:exposure", OIIO::TypeDesc::FLOAT, &stops))
        info.exposure = stops;
    info.is_aces_container = image.spec.get_int_attribute("acesImageContainerFlag") == 1;
    info.data_window = window(image.spec.x, image.spec.y, image.spec.width, image.spec.height);
    info.display_window = window(image.spec.full_x, image.spec.full_y, image.spec.full_width, image.spec.full_height);
    return info;
}

std::vector<ImageLevel> levels_of(OpenImage& image) {
    std::vector<ImageLevel> levels{{image.spec.width, image.spec.height}};
    for (int i = 1; levels.back().width > 1 || levels.back().height > 1; ++i) {
        const OIIO::ImageSpec level = image.input->spec_dimensions(image.part, i);
        const ImageLevel half{std::max(1, levels.back().width / 2), std::max(1, levels.back().height / 2)};
        const bool is_half = level.width == half.width && level.height == half.height;
        if (!is_half || level.nchannels != image.spec.nchannels) break;
        levels.push_back(half);
    }
    return levels;
}

void seek_level(OpenImage& image, const ImageLevel& size, int level) {
    if (!image.input->seek_subimage(image.part, level)) throw_library_error(*image.input, "a mip level is broken");
    const OIIO::ImageSpec live = image.input->spec();
    const bool is_as_stated = live.width == size.width && live.height == size.height && live.depth <= 1 &&
                              live.nchannels == image.spec.nchannels;
    if (!is_as_stated) throw IoError(fmt::format("level {} is not what the header says", level));
    refuse_large_tiles(live);
}

ChannelRange channel_range(const OpenImage& image) {
    const auto [first, last] = std::minmax_element(image.channels.begin(), image.channels.end());
    return {*first, *last + 1};
}

bool channels_in_order(const OpenImage& image) {
    return std::is_sorted(image.channels.begin(), image.channels.end()) &&
           channel_range(image).size() == image.channels.size();
}

}  // namespace etendue::oiio
