// Subpaths from the eye and from the lights, whose vertices bidirectional path tracing and light tracing connect.
#pragma once

#include "core/ray.h"
#include "core/rgb.h"
#include "scene/integrator_settings.h"
#include "transport/dimensions.h"
#include "transport/merging.h"
#include "transport/mis.h"
#include "transport/vertex.h"
#include "transport/walk.h"

#include <functional>
#include <optional>
#include <vector>

namespace etendue {

/// Returns what subpaths from `end` carry.
[[nodiscard]] inline TransportMode mode_of(SubpathEnd end) {
    return end == SubpathEnd::AtEye ? TransportMode::Radiance : TransportMode::Importance;
}

/// Returns the fewest edges of a path that leads from a light, or on from a surface, by one more vertex to the camera:
/// 2, or 1 if that vertex may lie in a medium.
[[nodiscard]] inline int edges_to_connect(const World& world) {
    return world.traits().has_scattering_bodies ? 1 : 2;
}

/// Holds what both subpaths of a sample share.
struct SubpathSample {
    MisContext mis;
    const PathLengths& lengths;
    const EyeSample& eye;
    /// Holds the key of the numbers that samples share if they merge, in place of the sample's own.
    std::optional<SampleKey> shared{};
    /// Has the densities of light subpaths count the strategies s = 0 and s = 1 alone, those of path tracing.
    bool counts_path_tracing_alone = false;

    [[nodiscard]] const World& world() const { return mis.world; }
    /// Returns a pair of numbers for `bounce` of a subpath, 0 where it begins.
    [[nodiscard]] Vec2f pair(SubpathEnd end, int bounce, SubpathDimension which) const {
        return eye.numbers.pair(subpath_dimension(end, bounce, which));
    }
    /// Returns the key of rays that connect the vertex of this index.
    [[nodiscard]] std::uint32_t connection_key(SubpathEnd end, int index) const {
        return ~eye.numbers.bits(subpath_dimension(end, index, SubpathDimension::Alpha));
    }
    /// Returns the number in [0, 1) that chooses the sample's wavelength.
    [[nodiscard]] float wavelength_number() const {
        const SampleNumbers numbers{eye.numbers.sequence, shared.value_or(eye.numbers.key)};
        return numbers.pair(kSubpathWavelengthDimension).x;
    }
    /// Returns the wavelength that the sample's path takes where a body disperses light.
    [[nodiscard]] Wavelength wavelength() const { return world().spectral_response().sample(wavelength_number()); }
    [[nodiscard]] Rgb wavelength_weight(bool is_dispersed) const {
        return is_dispersed ? wavelength().weight : Rgb(1.0f);
    }
};

/// Holds a subpath under way.
struct Subpath : SubpathProgress {
    SubpathEnd end = SubpathEnd::AtEye;
    std::optional<Emission> emission;  ///< with which a subpath from a light begins
    Ray ray;
    Interior interior;  ///< the bodies that the ray is in

    [[nodiscard]] TransportMode mode() const { return mode_of(end); }
};

/// Describes a vertex of a subpath that can be connected to others.
struct SubpathVertex : Vertex {
    Rgb throughput;              ///< throughput of the subpath as it arrives
    SubpathDensities densities;  ///< densities with which the subpath arrives
    int index = 1;               ///< vertices before it
    int next_edges = 1;          ///< edges of the path when a ray from here has hit
    bool is_dispersed = false;
    bool is_after_delta = false;  ///< the subpath has scattered by a delta, or passed a hidden boundary
    MergePlace merging{};
};

/// Hears where the ray of a subpath has led, and with which densities if that is a surface.
using Arrival = std::function<void(const Subpath&, const Vertex&, const SubpathDensities&)>;

/// Returns the subpath of the sample's camera ray.
[[nodiscard]] Subpath begin_subpath_at_eye(const SubpathSample& sample);
/// Returns a subpath from a light that was chosen by its power; nothing if that emits nothing.
[[nodiscard]] std::optional<Subpath> begin_subpath_at_light(const SubpathSample& sample);

/// Returns true if a subpath that has just begun at a light may light anything that the camera sees.
[[nodiscard]] inline bool leads_to_camera(const SubpathSample& sample, const Subpath& from_light) {
    return sample.lengths.max_depth >= edges_to_connect(sample.world()) && !is_black(from_light.emission->weight);
}

/// Follows a subpath to its end. Russian roulette begins after `roulette_depth` rays. Returns its vertices that can be
/// connected, the first one first.
[[nodiscard]] std::vector<SubpathVertex> follow_subpath(const SubpathSample& sample, Subpath subpath,
                                                        int roulette_depth, const Arrival& arrive = {});

}  // namespace etendue
