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

/// Holds what an animation says of a node at one moment; a part that the animation leaves unsaid stays as the node has
/// it.
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

/// The keys of one sampler.
struct AnimationKeys {
    std::vector<float> times;   ///< seconds, strictly increasing
    std::vector<float> values;  ///< `width` numbers a key; three times as many for cubic splines
    std::size_t width = 0;
    Interpolation interpolation = Interpolation::Linear;

    [[nodiscard]] bool is_cubic() const { return interpolation == Interpolation::CubicSpline; }
    /// Part 0 is a cubic key's in-tangent, 1 the value, 2 the out-tangent.
    [[nodiscard]] double number(std::size_t key, std::size_t part, std::size_t component) const {
        const std::size_t row = is_cubic() ? 3 * key + part : key;
        return static_cast<double>(values[row * width + component]);
    }
};

/// Holds what an animation says at one moment of a place in the document that is no node.
struct PointerValue {
    std::string pointer;  ///< JSON pointer to it
    std::vector<double> numbers;
    SourceLocation where;  ///< the channel
};

/// An animation, read once and posed at any moment.
class AnimationSampler {
  public:
    /// Channels that cannot be read are errors, those whose target is not known warnings.
    AnimationSampler(const GltfDocument& document, const GltfAnimation& animation, AccessorReader& accessors,
                     ProblemList& problems);

    /// The poses at `seconds`: before the first key as at the first, after the last as at the last, between by the
    /// sampler's interpolation (glTF 2.0 specification, appendix C).
    [[nodiscard]] NodePoses poses(double seconds) const;
    /// Returns the values at `seconds` of what the animation moves besides nodes (KHR_animation_pointer), interpolated
    /// as by `poses`.
    [[nodiscard]] std::vector<PointerValue> pointer_values(double seconds) const;

  private:
    enum class Target { Translation, Rotation, Scale, Weights };
    struct Channel {
        int node;
        Target target;
        AnimationKeys keys;
    };
    struct PointerChannel {
        std::string pointer;
        bool is_rotation;  ///< a quaternion
        SourceLocation where;
        AnimationKeys keys;
    };
    std::vector<Channel> channels_;
    std::vector<PointerChannel> pointer_channels_;
};

}  // namespace etendue
