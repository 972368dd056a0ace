#include "core/error.h"
#include "image/image_functions.h"
#include "oiio/functions.h"
#include "oiio/library_setup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace etendue::oiio {

namespace {

constexpr float kLargestHalf = 65504.0f;

OIIO::TypeDesc stored_type(PixelDepth depth) {
    switch (depth) {
        case PixelDepth::UInt8:
            return OIIO::TypeDesc::UINT8;
        case PixelDepth::UInt16:
            return OIIO::TypeDesc::UINT16;
        case PixelDepth::Half:
            return OIIO::TypeDesc::HALF;
        case PixelDepth::Float:
            break;
    }
    return OIIO::TypeDesc::FLOAT;
}

std::vector<std::string> default_channel_names(int channels) {
    if (channels <= 2) return channels == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"Y", "A"};
    std::vector<std::string> names{"R", "G", "B", "A"};
    names.resize(static_cast<std::size_t>(std::min(channels, 4)));
    for (int i = 4; i < channels; ++i) names.push_back(fmt::format("channel{}", i));
    return names;
}

void add_attribute(OIIO::ImageSpec& spec, const ImageAttribute& attribute) {
    struct Visitor {
        OIIO::ImageSpec& spec;
        const std::string& name;
        void operator()(int value) const { spec.attribute(name, value); }
        void operator()(float value) const { spec.attribute(name, value); }
        void operator()(const std::string& value) const { spec.attribute(name, value); }
        void operator()(const std::vector<float>& value) const {
            spec.attribute(name, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, static_cast<int>(value.size())), value.data());
        }
        void operator()(const Mat4f& value) const { spec.attribute(name, OIIO::TypeMatrix, value.getValue()); }
        void operator()(const ImageRational& value) const {
            const std::array<int, 2> numbers{value.numerator, value.denominator};
            spec.attribute(name, OIIO::TypeRational, numbers.data());
        }
        void operator()(const ImageTimeCode& value) const {
            const std::array<std::uint32_t, 2> words{value.digits, 0};
            spec.attribute(name, OIIO::TypeTimeCode, words.data());
        }
    };
    std::visit(Visitor{spec, attribute.name}, attribute.value);
}

OIIO::ImageSpec make_spec(const ImagePart& part, const ImageWriteOptions& options) {
    const ImageF& image = *part.image;
    OIIO::ImageSpec spec(image.width, image.height, image.channels, stored_type(options.depth));
    for (const PixelDepth depth : part.channel_depths) spec.channelformats.push_back(stored_type(depth));
    const std::vector<std::string>& names = part.channel_names.empty() ? options.channel_names : part.channel_names;
    spec.channelnames = names.empty() ? default_channel_names(image.channels) : names;
    spec.full_x = options.full_x;
    spec.full_y = options.full_y;
    spec.x = options.full_x + options.offset_x;
    spec.y = options.full_y + options.offset_y;
    if (options.full_width > 0 && options.full_height > 0) {
        spec.full_width = options.full_width;
        spec.full_height = options.full_height;
    }
    const auto alpha = std::find(spec.channelnames.begin(), spec.channelnames.end(), "A");
    if (alpha != spec.channelnames.end()) spec.alpha_channel = static_cast<int>(alpha - spec.channelnames.begin());
    if (is_integer(options.depth)) {
        spec.attribute("oiio:UnassociatedAlpha", 1);  // else the pixels would be divided by alpha
    } else {
        spec.attribute("compression", options.compression == ExrCompression::Zip ? "zip" : "none");
    }
    for (const ImageAttribute& attribute : options.attributes) add_attribute(spec, attribute);
    for (const ImageAttribute& attribute : part.attributes) add_attribute(spec, attribute);
    return spec;
}

template <typename T>
std::vector<T> to_integers(std::span<const float> pixels) {
    std::vector<T> integers(pixels.size());
    std::transform(pixels.begin(), pixels.end(), integers.begin(), [](float value) {
        const float clamped = value > 0.0f ? std::min(value, 1.0f) : 0.0f;  // a NaN becomes 0
        return static_cast<T>(std::lround(clamped * static_cast<float>(std::numeric_limits<T>::max())));
    });
    return integers;
}

bool is_beyond_half(float value) {
    return std::isfinite(value) && std::abs(value) > kLargestHalf;
}

// A finite value stays finite: an infinity in a file poisons every filter that touches it.
// `depths` are those of the channels.
std::vector<float> to_half_range(std::span<const float> pixels, std::span<const PixelDepth> depths) {
    std::vector<float> clamped(pixels.begin(), pixels.end());
    for (std::size_t i = 0; i < clamped.size(); ++i)
        if (depths[i % depths.size()] == PixelDepth::Half && is_beyond_half(clamped[i]))
            clamped[i] = std::clamp(clamped[i], -kLargestHalf, kLargestHalf);
    return clamped;
}

bool write_pixels(OIIO::ImageOutput& output, const ImagePart& part, PixelDepth depth) {
    const ImageF& image = *part.image;
    if (depth == PixelDepth::UInt8)
        return output.write_image(OIIO::TypeDesc::UINT8, to_integers<std::uint8_t>(image.pixels).data());
    if (depth == PixelDepth::UInt16)
        return output.write_image(OIIO::TypeDesc::UINT16, to_integers<std::uint16_t>(image.pixels).data());
    const std::vector<PixelDepth> depths = part.channel_depths.empty() ? std::vector{depth} : part.channel_depths;
    const bool has_halves = std::ranges::find(depths, PixelDepth::Half) != depths.end();
    if (!has_halves || std::ranges::none_of(image.pixels, is_beyond_half))
        return output.write_image(OIIO::TypeDesc::FLOAT, image.pixels.data());
    return output.write_image(OIIO::TypeDesc::FLOAT, to_half_range(image.pixels, depths).data());
}

// The specifications of all parts; one image has no name.
std::vector<OIIO::ImageSpec> make_specs(std::span<const ImagePart> parts, const ImageWriteOptions& options) {
    std::vector<OIIO::ImageSpec> specs;
    for (const ImagePart& part : parts) {
        specs.push_back(make_spec(part, options));
        if (!part.name.empty()) specs.back().attribute("oiio:subimagename", part.name);
    }
    return specs;
}

bool write_parts(OIIO::ImageOutput& output, const std::string& name, std::span<const ImagePart> parts,
                 const ImageWriteOptions& options) {
    const std::vector<OIIO::ImageSpec> specs = make_specs(parts, options);
    const bool opened = specs.size() == 1 ? output.open(name, specs.front())
                                          : output.open(name, static_cast<int>(specs.size()), specs.data());
    if (!opened) return false;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i > 0 && !output.open(name, specs[i], OIIO::ImageOutput::AppendSubimage)) return false;
        if (!write_pixels(output, parts[i], options.depth)) return false;
    }
    return output.close();
}

// A file in memory that is opened by a name: OpenImageIO 2.4 writes EXR files of several parts to nothing else.
class MemoryFile {
  public:
    MemoryFile() : fd_(memfd_create("etendue", MFD_CLOEXEC)) {}
    ~MemoryFile() {
        if (fd_ >= 0) close(fd_);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    [[nodiscard]] std::string name() const { return fmt::format("/proc/self/fd/{}", fd_); }
    /// Throws IoError.
    [[nodiscard]] std::vector<unsigned char> bytes() const {
        std::vector<unsigned char> bytes(fd_ < 0 ? 0 : static_cast<std::size_t>(lseek(fd_, 0, SEEK_END)));
        std::size_t done = 0;
        while (done < bytes.size()) {
            const ssize_t got = pread(fd_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
            if (got <= 0) throw IoError("what was encoded cannot be read from memory");
            done += static_cast<std::size_t>(got);
        }
        return bytes;
    }

  private:
    int fd_;
};

/// The samples of all pixels, as OpenImageIO takes them.
OIIO::DeepData deep_data(const DeepImageView& image, const OIIO::ImageSpec& spec) {
    OIIO::DeepData data(spec);
    data.set_all_samples(
        OIIO::cspan<unsigned int>(image.counts.data(), static_cast<std::int64_t>(image.counts.size())));
    std::size_t sample = 0;
    for (std::size_t p = 0; p < image.counts.size(); ++p)
        for (std::uint32_t s = 0; s < image.counts[p]; ++s, ++sample) {
            const auto pixel = static_cast<std::int64_t>(p);
            for (std::size_t c = 0; c < 4; ++c)
                data.set_deep_value(pixel, static_cast<int>(c), static_cast<int>(s), image.colors[4 * sample + c]);
            for (std::size_t c = 0; c < 2; ++c)
                data.set_deep_value(pixel, static_cast<int>(4 + c), static_cast<int>(s), image.depths[2 * sample + c]);
        }
    return data;
}

}  // namespace

std::vector<unsigned char> encode(const std::filesystem::path& path, const std::string& format,
                                  std::span<const ImagePart> parts, const ImageWriteOptions& options) {
    configure_image_library();
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput memory(encoded);
    const MemoryFile file;
    const bool multi_part = parts.size() > 1;
    const std::string name = multi_part ? file.name() : "memory." + path.extension().string();
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    if (!output) throw IoError(fmt::format("cannot write {}: {}", path.string(), OIIO::geterror()));
    output->threads(1);
    if (!(multi_part || output->set_ioproxy(&memory)) || !write_parts(*output, name, parts, options))
        throw IoError(fmt::format("cannot write {}: {}", path.string(), output->geterror()));
    if (multi_part) encoded = file.bytes();
    return encoded;
}

std::vector<unsigned char> encode_deep(const std::filesystem::path& path, const DeepImageView& image,
                                       const ImageWriteOptions& options) {
    ImageF shape;
    shape.width = image.width;
    shape.height = image.height;
    shape.channels = 6;
    const ImagePart part{.image = &shape, .channel_names = {"R", "G", "B", "A", "Z", "ZBack"}};
    ImageWriteOptions as_floats = options;
    as_floats.depth = PixelDepth::Float;
    configure_image_library();
    OIIO::ImageSpec spec = make_spec(part, as_floats);
    spec.deep = true;
    spec.z_channel = 4;
    if (options.compression == ExrCompression::Zip) spec.attribute("compression", "zips");  // what deep files may have
    const MemoryFile file;
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("openexr");
    if (!output) throw IoError(fmt::format("cannot write {}: {}", path.string(), OIIO::geterror()));
    output->threads(1);
    if (!output->open(file.name(), spec) || !output->write_deep_image(deep_data(image, spec)) || !output->close())
        throw IoError(fmt::format("cannot write {}: {}", path.string(), output->geterror()));
    return file.bytes();
}

}  // namespace etendue::oiio
