// Light at a point: the choice of a light for it, and samples of that light.
#pragma once

#include "light/light_receiver.h"
#include "light/light_sample.h"
#include "light/light_tree.h"
#include "light/mesh_light.h"
#include "world/light_pose.h"
#include "world/surface_point.h"
#include "world/world_data.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

namespace etendue {

class Materials;

/// Holds a light chosen for a point, with the choice in its density.
struct ChosenLight {
    LightSample sample;  ///< pdf_solid_angle includes the choice
    /// Counts the samples of this light that are expected: the chance of choosing it, times the light samples that are
    /// taken.
    float expected_samples = 0;
    std::uint32_t light = kNone;
    float time = 0.0f;  ///< time of the sample, from 0 at the shutter's opening to 1 at its closing

    /// Returns what the light of the sample is divided by: its density, 1/sr, or of a delta light the samples expected.
    [[nodiscard]] float density() const { return sample.is_delta ? expected_samples : sample.pdf_solid_angle; }
};

/// Holds the random numbers that a light sample is made from, each in [0, 1)².
struct LightNumbers {
    Vec2f light;      ///< which light
    Vec2f triangle;   ///< numbers that choose the triangle of a mesh light
    Vec2f direction;  ///< where on it, or from where
};

/// Samples the light that arrives at points, from lights that the light tree chooses for them, and tells how densely it
/// does. Functions that choose must not be called unless the scene `has_sampled_lights`.
class LightSampler {
  public:
    /// Builds the light tree; `data` and `materials` have to stay where they are.
    LightSampler(const WorldData& data, const Materials& materials);

    /// Samples light that arrives at `receiver` from a light chosen for it. Of an environment it finds only what is
    /// brighter than its mean: to be combined with samples of the BSDF, by `Environment::pdf_solid_angle`.
    [[nodiscard]] ChosenLight sample(const LightReceiver& receiver, const LightNumbers& u, float time) const {
        return sample(choose(receiver, u.light), receiver.position, u, time);
    }
    /// Samples light that arrives at `point` from the light that `choose` has chosen, at `time`, in [0, 1].
    [[nodiscard]] ChosenLight sample(const LightTree::Choice& choice, const Vec3f& point, const LightNumbers& u,
                                     float time) const;
    /// Chooses a light for `receiver`, with `u` in [0, 1)².
    [[nodiscard]] LightTree::Choice choose(const LightReceiver& receiver, Vec2f u) const {
        return tree_.sample(receiver, u);
    }
    /// Chooses a light for each of many receivers, and fetches these lights from memory besides.
    void choose(std::span<const LightReceiver> receivers, std::span<const Vec2f> u,
                std::span<LightTree::Choice> choices) const;
    /// Returns the probability with which the light of this index is chosen for `receiver`.
    [[nodiscard]] float probability(const LightReceiver& receiver, std::uint32_t light) const {
        return tree_.probability(receiver, light);
    }
    /// Returns the density, choice included, with which `sample` for `from` would have picked the direction that hit
    /// the emitter `point` at `distance` and `time`; 0 if it is no sampled light. `from` means nothing unless the scene
    /// `chooses_lights_by_receiver`.
    [[nodiscard]] float pdf_solid_angle(const LightReceiver& from, const SurfacePoint& point, const Vec3f& direction,
                                        float distance, float time) const;
    /// Returns how many times as densely `sample` at `point` picks the place `on_light`, of this triangle of the light
    /// of this index, as `LightEmitter::sample` does, both without the choice; 1 for lights without a surface.
    [[nodiscard]] float gain(std::uint32_t light, std::uint32_t triangle, const Vec3f& on_light, const Vec3f& point,
                             float time) const;

    /// Returns the light that the surface at `point` belongs to; kNone if it is not sampled.
    [[nodiscard]] std::uint32_t at(const SurfacePoint& point) const;
    /// Returns how many lights there are, the environment included.
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(data_.lights.size()); }
    /// Returns where the light of this index is while the shutter is open, and where it shines; none at infinity.
    [[nodiscard]] std::optional<LightBounds> bounds(std::uint32_t light) const { return swept_bounds(data_, light); }
    /// Returns the mesh light of this index if it shines evenly and stands still, else null.
    [[nodiscard]] const MeshLight* even_mesh(std::uint32_t light) const {
        const MeshLight* mesh = std::get_if<MeshLight>(&data_.lights[light]);
        return mesh != nullptr && mesh->is_uniform() && data_.motion_of(light) == nullptr ? mesh : nullptr;
    }
    /// Says what the light of this index is.
    [[nodiscard]] const Emitter& emitter(std::uint32_t light) const { return data_.emitter_of_light[light]; }
    /// Returns whether rays can meet the light of this index by chance.
    [[nodiscard]] bool can_be_hit(std::uint32_t light) const { return !is_delta_light(data_.lights[light]); }
    /// Returns whether the light of this index shines from infinitely far away.
    [[nodiscard]] bool is_at_infinity(std::uint32_t light) const {
        return etendue::is_at_infinity(data_.lights[light]);
    }

    /// Returns the tree that chooses.
    [[nodiscard]] const LightTree& tree() const { return tree_; }

  private:
    const WorldData& data_;
    const Materials& materials_;
    LightTree tree_;
};

}  // namespace etendue
