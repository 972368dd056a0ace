// What the channels of a rendered file are to a denoiser: layers of light, features, their halves, and the rest.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Returns the name of the channel that holds what the channel `whole` does, of about half of the samples: "half.R" of
/// "R", "half_albedo.R" of "albedo.R".
[[nodiscard]] std::string half_channel(std::string_view whole);

/// Says whether a method needs the halves of an image, to know its noise.
enum class HalvesUse { Needed, None };

/// Channels of one layer, as indices among those of the file, and those of its half in the same order, if it is needed.
struct LayerChannels {
    std::string name;  ///< empty for plain channels, R, G and B
    std::vector<int> whole;
    std::vector<int> half;
};

struct LayerPlan {
    std::vector<LayerChannels> lights;  ///< R, G, B each; the beauty first
    std::vector<LayerChannels> features;
    std::vector<int> kept;  ///< channels that are written, in the file's order: all but halves
};

/// The layers that are features where a file has them, unless others are named.
[[nodiscard]] std::vector<std::string> default_features();

/// Finds the layers among the channels `names` of a file. A layer of light is one that has NAME.R, NAME.G and NAME.B,
/// and their `half_channel` if halves are needed, and is one of `lights` if these are known (if neither
/// halves nor lights say what is light, only the beauty is). The beauty is plain R, G and B, or the first layer that
/// has these, such as Blender's "ViewLayer.Combined". A feature is one of `features`, of up to four channels, with
/// their halves if needed. What lacks a half that is needed is kept as it is. Throws std::invalid_argument, with what
/// to do about it, if there is no beauty with its half, a feature of `required` (a subset of `features`) is not there
/// or not whole, or there are too many features.
[[nodiscard]] LayerPlan plan_layers(std::span<const std::string> names,
                                    const std::optional<std::vector<std::string>>& lights,
                                    std::span<const std::string> features, std::span<const std::string> required,
                                    HalvesUse halves = HalvesUse::Needed);

}  // namespace etendue
