// glTF animations at one moment.
#pragma once

#include "loader/gltf/gltf_accessor.h"
#include "scene/render_settings.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// What an animation says of a node at one moment; what it leaves unsaid stays as the node has it.
struct NodePose {
    std::optional<std::array<double, 3>> translation;
    std::optional<std::array<double, 4>> rotation;  ///< x, y, z, w; not normalised
    std::optional<std::array<double, 3>> scale;
    std::vector<double> weights;  ///< of morph targets; empty if not said
};

/// Poses by node index.
using NodePoses = std::map<int, NodePose>;

/// The animation that `settings` name, or the first. Null if there is none of that name (an error) or none at all (an
/// error if a frame of a sequence is asked for, which would be like all the others, else a warning).
[[nodiscard]] const GltfAnimation* find_animation(const GltfDocument& document, const RenderSettings& settings,
                                                  ProblemList& problems);

/// The poses at `seconds`: before the first key as at the first, after the last as at the last, between by the
/// sampler's interpolation (glTF 2.0 specification, appendix C). Channels that cannot be read are errors.
[[nodiscard]] NodePoses sample_animation(const GltfDocument& document, const GltfAnimation& animation, double seconds,
                                         AccessorReader& accessors, ProblemList& problems);

}  // namespace etendue
