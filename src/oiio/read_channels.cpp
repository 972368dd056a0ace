#include "core/error.h"
#include "oiio/functions.h"
#include "oiio/open_image.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace etendue::oiio {

namespace {

/// Said by the writer, not by whoever made the image.
bool is_about_storage(std::string_view name) {
    constexpr std::array kNames{"compression", "name", "type", "chunkCount", "version", "tiles", "lineOrder"};
    return std::ranges::find(kNames, name) != kNames.end() || name.starts_with("openexr:") ||
           (name.starts_with("oiio:") && name != "oiio:ColorSpace");
}

std::optional<ImageAttribute> to_attribute(const OIIO::ParamValue& parameter) {
    const OIIO::TypeDesc type = parameter.type();
    ImageAttribute attribute{parameter.name().string(), {}};
    if (type == OIIO::TypeDesc::INT) {
        attribute.value = parameter.get_int();
    } else if (type == OIIO::TypeDesc::FLOAT) {
        attribute.value = parameter.get_float();
    } else if (type == OIIO::TypeDesc::STRING) {
        attribute.value = parameter.get_string();
    } else if (type == OIIO::TypeMatrix) {
        Mat4f matrix;
        std::copy_n(static_cast<const float*>(parameter.data()), 16, matrix.getValue());
        attribute.value = matrix;
    } else if (type == OIIO::TypeRational) {
        const auto* numbers = static_cast<const int*>(parameter.data());
        attribute.value = ImageRational{numbers[0], numbers[1]};
    } else if (type == OIIO::TypeTimeCode) {
        attribute.value = ImageTimeCode{static_cast<const std::uint32_t*>(parameter.data())[0]};
    } else if (attribute.name == "chromaticities" && type == OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8)) {
        const auto* values = static_cast<const float*>(parameter.data());
        attribute.value = std::vector<float>(values, values + 8);
    } else {
        return std::nullopt;
    }
    return attribute;
}

void require_floats(const OIIO::ImageSpec& spec) {
    for (int channel = 0; channel < spec.nchannels; ++channel)
        if (!spec.channelformat(channel).is_floating_point())
            throw IoError(fmt::format("channel '{}' holds integers, not floats", spec.channel_name(channel)));
}

void require_different(const std::vector<std::string>& names) {
    std::set<std::string_view> known;
    for (const std::string& name : names)
        if (!known.insert(name).second) throw IoError(fmt::format("there are two channels '{}'", name));
}

void require_same_window(const OpenImage& open, const ImageInfo& first) {
    require_acceptable(open);
    if (describe(open).data_window != first.data_window)
        throw IoError(fmt::format("its part '{}' has other pixels than the first: the data windows differ",
                                  open.spec.get_string_attribute("oiio:subimagename", fmt::format("{}", open.part))));
}

/// Adds the channels of a part, without pixels, and what its header says but for what is `known`.
void add_channels(const OIIO::ImageSpec& part, std::set<std::string>& known, ChannelImage& image) {
    for (int channel = 0; channel < part.nchannels; ++channel) {
        image.channel_names.push_back(part.channel_name(channel));
        const bool is_half = part.channelformat(channel) == OIIO::TypeDesc::HALF;
        image.depths.push_back(is_half ? PixelDepth::Half : PixelDepth::Float);
    }
    for (const OIIO::ParamValue& parameter : part.extra_attribs) {
        const std::string name = parameter.name().string();
        if (is_about_storage(name) || known.contains(name)) continue;
        if (auto attribute = to_attribute(parameter)) {
            known.insert(name);
            image.attributes.push_back(std::move(*attribute));
        }
    }
}

/// Puts the channels of all parts side by side.
void read_parts(OIIO::ImageInput& input, std::span<const int> channels_of_part, ImageF& pixels) {
    const auto stride = static_cast<OIIO::stride_t>(sizeof(float)) * pixels.channels;
    float* place = pixels.pixels.data();
    for (std::size_t part = 0; part < channels_of_part.size(); ++part) {
        const int channels = channels_of_part[part];
        if (!read_pixels(input, {static_cast<int>(part), 0, {0, channels}, OIIO::TypeDesc::FLOAT, place, stride}))
            throw_library_error(input, "the pixels are broken");
        place += channels;
    }
}

}  // namespace

ChannelImage read_channels(const EncodedImage& encoded) {
    OpenImage open = open_image(encoded);
    const ImageInfo info = describe(open);
    ChannelImage image;
    std::vector<int> channels_of_part;
    std::set<std::string> attributes;
    do {
        require_same_window(open, info);
        require_floats(open.spec);
        add_channels(open.spec, attributes, image);
        channels_of_part.push_back(open.spec.nchannels);
        if (image.channel_names.size() > kMostChannels)
            throw IoError(fmt::format("it has more than {} channels", kMostChannels));
    } while (seek_part(open, open.part + 1));
    require_all_parts(open);
    require_different(image.channel_names);
    // All parts together may not claim more than the file can hold, either.
    open.spec.nchannels = static_cast<int>(image.channel_names.size());
    open.spec.channelformats.assign(image.channel_names.size(), OIIO::TypeDesc::HALF);
    require_acceptable(open);
    image.data_window = info.data_window;
    image.display_window = info.display_window;
    image.pixels = ImageF(info.width, info.height, open.spec.nchannels);
    read_parts(*open.input, channels_of_part, image.pixels);
    return image;
}

}  // namespace etendue::oiio
