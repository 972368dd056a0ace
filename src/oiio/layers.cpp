#include "core/error.h"
#include "oiio/functions.h"
#include "oiio/open_image.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace etendue::oiio {

namespace {

constexpr std::size_t kMostLayers = 65536;

struct Channel {
    std::string name;    ///< whole
    std::string suffix;  ///< behind the last dot, in capitals
    int index = 0;
};

std::string in_capitals(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

/// Channels by what stands before their last dot, each in the order of the file.
struct Group {
    std::string name;
    std::vector<Channel> channels;
};

std::vector<Group> group_channels(const OIIO::ImageSpec& spec) {
    std::vector<Group> groups;
    std::map<std::string, std::size_t> places;
    for (int i = 0; i < spec.nchannels; ++i) {
        const std::string name = spec.channel_name(i);
        const std::size_t dot = name.rfind('.');
        const std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
        const auto [place, is_new] = places.try_emplace(layer, groups.size());
        if (is_new) groups.push_back({layer, {}});
        groups[place->second].channels.push_back(
            {name, in_capitals(dot == std::string::npos ? name : name.substr(dot + 1)), i});
    }
    return groups;
}

/// Takes the channels called so out of `channels`; none if one of `required` is missing.
std::vector<Channel> take(std::vector<Channel>& channels, const std::vector<std::string>& required,
                          const std::string& optional = {}) {
    const auto find = [&](const std::string& suffix) { return std::ranges::find(channels, suffix, &Channel::suffix); };
    for (const std::string& suffix : required)
        if (find(suffix) == channels.end()) return {};
    std::vector<std::string> wanted = required;
    if (!optional.empty()) wanted.push_back(optional);
    std::vector<Channel> taken;
    for (const std::string& suffix : wanted) {
        const auto found = find(suffix);
        if (found == channels.end()) continue;
        taken.push_back(*found);
        channels.erase(found);
    }
    return taken;
}

ImageLayer make_layer(std::string name, LayerKind kind, const std::vector<Channel>& channels, const OpenImage& image) {
    ImageLayer layer{.name = std::move(name), .kind = kind, .part = image.part};
    for (const Channel& channel : channels) {
        layer.channels.push_back(channel.name);
        layer.indices.push_back(channel.index);
    }
    layer.is_integer = !image.spec.channelformat(layer.indices.front()).is_floating_point();
    return layer;
}

std::vector<ImageLayer> layers_of(Group group, const OpenImage& image) {
    std::vector<ImageLayer> layers;
    const auto add = [&](LayerKind kind, const std::vector<Channel>& channels) {
        if (channels.empty()) return false;
        layers.push_back(make_layer(group.name, kind, channels, image));
        return true;
    };
    const bool is_single = group.channels.size() == 1 && group.channels.front().suffix != "Y";
    if (!is_single && !add(LayerKind::Color, take(group.channels, {"R", "G", "B"}, "A")) &&
        !add(LayerKind::Vector, take(group.channels, {"X", "Y", "Z"})) &&
        !add(LayerKind::Vector, take(group.channels, {"X", "Y"})) &&
        !add(LayerKind::Luminance, take(group.channels, {"Y"}, "A")))
        add(LayerKind::Vector, take(group.channels, {"U", "V"}));
    for (const Channel& channel : group.channels)
        layers.push_back(make_layer(is_single && !group.name.empty() ? group.name : channel.name, LayerKind::Single,
                                    {channel}, image));
    return layers;
}

/// The layer's name in a file of several parts.
std::string with_part(const std::string& layer, const std::string& part) {
    if (layer.empty() || layer == part) return part;
    return layer.starts_with(part + ".") ? layer : part + "." + layer;
}

std::string problem_of(const OpenImage& image) {
    try {
        require_acceptable(image);
        return {};
    } catch (const IoError& error) {
        return error.what();
    }
}

/// Adds what is read of one part to `result`: its header, its layers and the names of its Cryptomattes.
void add_part(const OpenImage& image, LayeredImage& result) {
    result.parts.push_back(describe(image));
    for (const OIIO::ParamValue& attribute : image.spec.extra_attribs) {
        const std::string_view key = attribute.name().c_str();
        if (key.starts_with("cryptomatte/") && key.ends_with("/name")) result.mattes.push_back(attribute.get_string());
    }
    const std::string problem = problem_of(image);
    for (Group& group : group_channels(image.spec))
        for (ImageLayer& layer : layers_of(std::move(group), image)) {
            layer.problem = problem;
            result.layers.push_back(std::move(layer));
            if (result.layers.size() > kMostLayers)
                throw IoError(fmt::format("it has more than {} layers", kMostLayers));
        }
}

void make_names_unique(std::vector<ImageLayer>& layers) {
    std::set<std::string> taken;
    for (ImageLayer& layer : layers) {
        const std::string name = layer.name;
        for (int i = 2; !taken.insert(layer.name).second; ++i) layer.name = fmt::format("{}#{}", name, i);
    }
}

bool read_channels(OpenImage& image, const std::vector<int>& indices, ImageF& pixels) {
    const auto read = [&](int first, int last, float* target, OIIO::stride_t stride) {
        return read_pixels(*image.input, {image.part, 0, {first, last}, OIIO::TypeDesc::FLOAT, target, stride});
    };
    const int count = static_cast<int>(indices.size());
    bool is_run = true;
    for (int i = 0; i < count; ++i) is_run = is_run && indices[static_cast<std::size_t>(i)] == indices.front() + i;
    if (is_run) return read(indices.front(), indices.front() + count, pixels.pixels.data(), OIIO::AutoStride);
    // One by one: others may stand between them, and a file may have more of those than there is memory for.
    const auto stride = static_cast<OIIO::stride_t>(indices.size() * sizeof(float));
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (!read(indices[i], indices[i] + 1, pixels.pixels.data() + i, stride)) return false;
    return true;
}

}  // namespace

LayeredImage read_layers(const EncodedImage& encoded) {
    OpenImage image = open_unchecked(encoded);
    LayeredImage result;
    std::vector<std::string> names;
    do {
        const std::string name = image.spec.get_string_attribute("oiio:subimagename");
        names.push_back(name.empty() ? fmt::format("part{}", image.part) : name);
        add_part(image, result);
    } while (seek_part(image, image.part + 1));
    try {
        require_all_parts(image);
    } catch (const IoError& error) {
        // Parts after the first unreadable one cannot be reached.
        result.layers.push_back({.name = "rest", .part = image.part, .problem = error.what()});
    }
    if (names.size() > 1)
        for (ImageLayer& layer : result.layers)
            layer.name = with_part(layer.name, names[static_cast<std::size_t>(layer.part)]);
    make_names_unique(result.layers);
    return result;
}

ImageF read_layer(const EncodedImage& encoded, const ImageLayer& layer) {
    OpenImage image = open_image(encoded, layer.part);
    for (std::size_t i = 0; i < layer.channels.size(); ++i)
        if (layer.indices[i] >= image.spec.nchannels || image.spec.channel_name(layer.indices[i]) != layer.channels[i])
            throw IoError(fmt::format("it has no channel '{}' any more", layer.channels[i]));
    seek_level(image, {image.spec.width, image.spec.height}, 0);
    ImageF pixels(image.spec.width, image.spec.height, static_cast<int>(layer.channels.size()));
    if (!read_channels(image, layer.indices, pixels)) throw_library_error(*image.input, "the pixels are broken");
    return pixels;
}

}  // namespace etendue::oiio
