#include "denoise/layers.h"

#include "denoise/least_squares.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::size_t kMostFeatureChannels = kMostUnknowns - 3;
constexpr std::size_t kMostChannelsOfFeature = 4;

/// Where each name stands among the channels.
using Places = std::map<std::string, int, std::less<>>;

/// "diffuse.direct.R" is channel R of the layer "diffuse.direct".
std::pair<std::string, std::string> split(const std::string& name) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) return {"", name};
    return {name.substr(0, dot), name.substr(dot + 1)};
}

/// The channels `names` of a layer and, if needed, their halves; nothing unless all are there.
std::optional<LayerChannels> find_layer(const Places& places, const std::string& layer,
                                        std::span<const std::string> names, HalvesUse halves) {
    LayerChannels found{layer, {}, {}};
    for (const std::string& name : names) {
        const std::string whole = layer.empty() ? name : fmt::format("{}.{}", layer, name);
        const auto place = places.find(whole);
        if (place == places.end()) return std::nullopt;
        found.whole.push_back(place->second);
        if (halves == HalvesUse::None) continue;
        const auto half = places.find(half_channel(whole));
        if (half == places.end()) return std::nullopt;
        found.half.push_back(half->second);
    }
    return found;
}

bool contains(std::span<const std::string> names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

/// Returns the layer that is the image: plain channels, or else the first that has R, G and B, as Blender names them.
std::string layer_of_image(std::span<const std::string> names) {
    const auto has = [&](const std::string& layer, const char* channel) {
        return contains(names, layer.empty() ? channel : fmt::format("{}.{}", layer, channel));
    };
    const auto has_any = [&](const std::string& layer) {
        return has(layer, "R") || has(layer, "G") || has(layer, "B");
    };
    if (has_any("")) return "";
    for (const std::string& name : names)
        if (std::string layer = split(name).first; has(layer, "R") && has(layer, "G") && has(layer, "B")) return layer;
    return "";
}

void add_features(const Places& places, const std::map<std::string, std::vector<std::string>>& layers,
                  std::span<const std::string> features, std::span<const std::string> required, HalvesUse halves,
                  LayerPlan& plan) {
    std::size_t count = 0;
    for (const std::string& feature : features) {
        const auto layer = layers.find(feature);
        const bool fits = layer != layers.end() && layer->second.size() <= kMostChannelsOfFeature;
        auto found = fits ? find_layer(places, feature, layer->second, halves) : std::nullopt;
        if (!found && contains(required, feature))
            throw std::invalid_argument(
                layer == layers.end() ? fmt::format("there is no layer '{}' to be a feature", feature)
                : fits                ? fmt::format("the feature '{0}' has no 'half_{0}' beside it", feature)
                       : fmt::format("the feature '{}' has more than {} channels", feature, kMostChannelsOfFeature));
        if (!found) continue;
        count += found->whole.size();
        plan.features.push_back(std::move(*found));
    }
    if (count > kMostFeatureChannels)
        throw std::invalid_argument(
            fmt::format("the features have {} channels; {} are the most", count, kMostFeatureChannels));
}

}  // namespace

std::string half_channel(std::string_view whole) {
    return fmt::format("half{}{}", whole.find('.') == std::string_view::npos ? "." : "_", whole);
}

std::vector<std::string> default_features() {
    return {"albedo", "N", "depth"};
}

LayerPlan plan_layers(std::span<const std::string> names, const std::optional<std::vector<std::string>>& lights,
                      std::span<const std::string> features, std::span<const std::string> required, HalvesUse halves) {
    const std::array<std::string, 3> rgb{"R", "G", "B"};
    Places places;
    std::map<std::string, std::vector<std::string>> layers;
    LayerPlan plan;
    std::set<std::string> half_names;
    for (const std::string& name : names) half_names.insert(half_channel(name));
    for (std::size_t i = 0; i < names.size(); ++i) {
        places.emplace(names[i], static_cast<int>(i));
        if (half_names.contains(names[i])) continue;
        plan.kept.push_back(static_cast<int>(i));
        const auto [layer, channel] = split(names[i]);
        layers[layer].push_back(channel);
    }
    const std::string image = layer_of_image(names);
    const auto named = [&](const char* channel) {
        return image.empty() ? channel : fmt::format("{}.{}", image, channel);
    };
    for (const char* channel : {"R", "G", "B"})
        if (!places.contains(named(channel)))
            throw std::invalid_argument(fmt::format("there is no channel {}", named(channel)));
    if (auto found = find_layer(places, image, rgb, halves))
        plan.lights.push_back(std::move(*found));
    else
        throw std::invalid_argument(fmt::format(
            "there are no channels {}, {} and {}, the image from half of the samples, which say how noisy it is; "
            "render with '--aov denoising' and more than one sample to have them, and without '--aov-layout files'",
            half_channel(named("R")), half_channel(named("G")), half_channel(named("B"))));
    for (const auto& [layer, channels] : layers) {
        if (layer == image || contains(features, layer) || (lights && !contains(*lights, layer))) continue;
        if (halves == HalvesUse::None && !lights) continue;
        if (auto found = find_layer(places, layer, rgb, halves)) plan.lights.push_back(std::move(*found));
    }
    add_features(places, layers, features, required, halves, plan);
    return plan;
}

}  // namespace etendue
