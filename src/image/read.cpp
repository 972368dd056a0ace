#include "image/read.h"

#include "core/error.h"
#include "image/encoded_format.h"
#include "image/library_setup.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

namespace etendue {

namespace {

struct Encoded {
    std::array<std::byte, kMagicBytes> head{};
    std::size_t head_size = 0;
    std::int64_t size = 0;
};

Encoded look_at(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) throw IoError("the file does not exist");
    if (error) throw IoError(error.message());
    // Reading a pipe or a device could block for ever.
    if (!std::filesystem::is_regular_file(status)) throw IoError("not a regular file");

    Encoded encoded;
    encoded.size = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream) throw IoError("the file cannot be opened");
    stream.read(reinterpret_cast<char*>(encoded.head.data()), static_cast<std::streamsize>(encoded.head.size()));
    encoded.head_size = static_cast<std::size_t>(stream.gcount());
    return encoded;
}

Encoded look_at(std::span<const std::byte> bytes) {
    Encoded encoded;
    encoded.size = static_cast<std::int64_t>(bytes.size());
    encoded.head_size = std::min(bytes.size(), encoded.head.size());
    std::copy_n(bytes.begin(), encoded.head_size, encoded.head.begin());
    return encoded;
}

[[noreturn]] void throw_library_error(const OIIO::ImageInput& input, std::string_view what) {
    std::string reason = input.geterror();
    if (reason.empty()) reason = OIIO::geterror();
    throw IoError(reason.empty() ? std::string(what) : fmt::format("{}: {}", what, reason));
}

void refuse_absurd(const OIIO::ImageSpec& spec, const EncodedFormat& format, std::int64_t encoded_size) {
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0) throw IoError("the image has no pixels");
    if (spec.deep || spec.depth > 1) throw IoError("deep and volume images are not supported");
    const std::int64_t pixels = std::int64_t{spec.width} * spec.height;
    if (spec.width > kMaxImageSide || spec.height > kMaxImageSide || pixels > kMaxImagePixels) {
        throw IoError(fmt::format("{} x {} pixels are more than are allowed ({} in all, {} on a side)", spec.width,
                                  spec.height, kMaxImagePixels, kMaxImageSide));
    }
    const auto bytes_per_pixel = static_cast<std::int64_t>(spec.pixel_bytes(true));
    if (pixels * bytes_per_pixel / format.max_expansion > encoded_size) {
        throw IoError(fmt::format("the header claims {} x {} pixels, which {} bytes cannot hold", spec.width,
                                  spec.height, encoded_size));
    }
}

// An image whose header has been read and found acceptable.
struct OpenImage {
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;  // outlives `input`, which reads through it
    std::unique_ptr<OIIO::ImageInput> input;
    OIIO::ImageSpec spec;
    EncodedFormat format;
};

OpenImage open_image(const ImageSource& source) {
    configure_image_library();
    const Encoded encoded = std::visit([](const auto& place) { return look_at(place); }, source);
    if (encoded.size == 0) throw IoError("the file is empty");
    const auto format = detect_format(std::span(encoded.head).first(encoded.head_size));
    if (!format) throw IoError("not an image of a known format (PNG, JPEG, WebP, OpenEXR, Radiance HDR, TIFF)");

    OpenImage image;
    image.format = *format;
    image.input = OIIO::ImageInput::create(std::string(format->name));
    if (!image.input) throw IoError(OIIO::geterror());
    image.input->threads(1);

    std::string name = "memory." + std::string(format->name);
    if (const auto* bytes = std::get_if<std::span<const std::byte>>(&source)) {
        image.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes->data(), bytes->size());
        if (!image.input->set_ioproxy(image.memory.get())) throw_library_error(*image.input, "cannot read from memory");
    } else {
        name = std::get<std::filesystem::path>(source).string();
    }
    OIIO::ImageSpec request;
    request.attribute("oiio:UnassociatedAlpha", 1);
    if (!image.input->open(name, image.spec, request)) throw_library_error(*image.input, "the header is broken");
    refuse_absurd(image.spec, *format, encoded.size);
    return image;
}

// The channels to read, in order: R, G, B and A by name where the file has them (EXR stores channels alphabetically,
// and other layers may stand between), else the first four.
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

template <typename T>
std::vector<T> read_pixels(OpenImage& image, const std::vector<int>& channels, OIIO::TypeDesc type) {
    const auto [first, last] = std::minmax_element(channels.begin(), channels.end());
    const auto stored = static_cast<std::size_t>(*last - *first) + 1;
    const std::size_t pixel_count =
        static_cast<std::size_t>(image.spec.width) * static_cast<std::size_t>(image.spec.height);
    std::vector<T> pixels(pixel_count * stored);
    if (!image.input->read_image(0, 0, *first, *last + 1, type, pixels.data())) {
        throw_library_error(*image.input, "the pixels are broken");
    }
    const bool in_order = std::is_sorted(channels.begin(), channels.end()) && stored == channels.size();
    if (in_order) return pixels;

    std::vector<T> ordered(pixel_count * channels.size());
    for (std::size_t i = 0; i < pixel_count; ++i) {
        for (std::size_t c = 0; c < channels.size(); ++c) {
            ordered[i * channels.size() + c] = pixels[i * stored + static_cast<std::size_t>(channels[c] - *first)];
        }
    }
    return ordered;
}

// Image is ImageF or Image8, whose pixels OpenImageIO calls `type`.
template <typename Image>
Image read_image(const ImageSource& source, OIIO::TypeDesc type) {
    try {
        OpenImage open = open_image(source);
        const std::vector<int> channels = select_channels(open.spec);
        Image image;
        image.width = open.spec.width;
        image.height = open.spec.height;
        image.channels = static_cast<int>(channels.size());
        image.pixels = read_pixels<typename decltype(image.pixels)::value_type>(open, channels, type);
        return image;
    } catch (const std::bad_alloc&) {
        throw IoError("not enough memory to decode the image");
    }
}

}  // namespace

ImageInfo read_image_info(const ImageSource& source) {
    const OpenImage image = open_image(source);
    ImageInfo info;
    info.width = image.spec.width;
    info.height = image.spec.height;
    info.channels = image.spec.nchannels;
    info.is_float = image.spec.format.is_floating_point();
    info.bits_per_channel = image.spec.get_int_attribute("oiio:BitsPerSample", 8 * int(image.spec.format.basesize()));
    info.format = image.format.name;
    return info;
}

ImageF read_image_float(const ImageSource& source) {
    return read_image<ImageF>(source, OIIO::TypeDesc::FLOAT);
}

Image8 read_image_8bit(const ImageSource& source) {
    return read_image<Image8>(source, OIIO::TypeDesc::UINT8);
}

std::string image_library_version() {
    return OIIO_VERSION_STRING;
}

}  // namespace etendue
