// glTF animations at one moment.
#pragma once

#include "loader/gltf/gltf_accessor.h"
#include "scene/render_settings.h"

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Holds what an animation says of a node at one moment; a part that the animation leaves unsaid stays as the node has
/// it.
struct NodePose {
    std::optional<std::array<double, 3>> translation;
    std::optional<std::array<double, 4>> rotation;  ///< x, y, z, w; not normalised
    std::optional<std::array<double, 3>> scale;
    std::vector<double> weights;  ///< weights of morph targets; empty if not said
};

/// Poses by node index.
using NodePoses = std::map<int, NodePose>;

/// Chooses the animations that play: those that `settings` name, in that order, or all of the file. An animation that
/// moves what one before it does is left out, with a warning. Errors for names that the file does not have; if none is
/// left, an error if a frame of a sequence is asked for, which would be like all the others.
[[nodiscard]] std::vector<const GltfAnimation*> choose_animations(const GltfDocument& document,
                                                                  const RenderSettings& settings,
                                                                  ProblemList& problems);

/// The keys of one sampler.
struct AnimationKeys {
    std::vector<float> times;   ///< seconds, in order; of equal ones the last counts
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

/// Poses animations that play together at any moment; they are read once.
class AnimationSampler {
  public:
    /// Reads `animations`. Channels that cannot be read are errors, those whose target is not known warnings.
    AnimationSampler(const GltfDocument& document, std::span<const GltfAnimation* const> animations,
                     AccessorReader& accessors, ProblemList& problems);

    /// The poses at `seconds`: before the first key as at the first, after the last as at the last, between by the
    /// sampler's interpolation (glTF 2.0 specification, appendix C).
    [[nodiscard]] NodePoses poses(double seconds) const;
    /// Returns the times of the first key and of the last of all that moves nodes; twice 0 if nothing does.
    [[nodiscard]] std::array<double, 2> time_span() const;
    /// Returns the values at `seconds` of what the animations move besides nodes (KHR_animation_pointer), interpolated
    /// as by `poses`.
    [[nodiscard]] std::vector<PointerValue> pointer_values(double seconds) const;

  private:
    void read(const GltfDocument& document, const GltfAnimation& animation, AccessorReader& accessors,
              ProblemList& problems);

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
