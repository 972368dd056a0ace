#include "image/read_channels.h"

#include "core/error.h"
#include "image/open_image.h"

#include <algorithm>
#include <array>
#include <new>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace etendue {

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

}  // namespace

const ImageAttribute* ChannelImage::find(std::string_view name) const {
    const auto found = std::ranges::find(attributes, name, &ImageAttribute::name);
    return found == attributes.end() ? nullptr : &*found;
}

ChannelImage read_channels(const ImageSource& source) {
    try {
        OpenImage open = open_image(source);
        require_floats(open.spec);
        require_different(open.spec.channelnames);
        const ImageInfo info = describe(open);
        ChannelImage image;
        image.pixels = ImageF(open.spec.width, open.spec.height, open.spec.nchannels);
        image.channel_names = open.spec.channelnames;
        // The library's format of an image is that of its deepest channel.
        image.depth = info.depth == TexelDepth::Half ? PixelDepth::Half : PixelDepth::Float;
        image.data_window = info.data_window;
        image.display_window = info.display_window;
        for (const OIIO::ParamValue& parameter : open.spec.extra_attribs) {
            if (is_about_storage(parameter.name().string())) continue;
            if (auto attribute = to_attribute(parameter)) image.attributes.push_back(std::move(*attribute));
        }
        if (!open.input->read_image(0, 0, 0, open.spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.pixels.data()))
            throw_library_error(*open.input, "the pixels are broken");
        return image;
    } catch (const std::bad_alloc&) {
        throw IoError("not enough memory to decode the image");
    }
}

}  // namespace etendue
