// Merging: where both subpaths arrive at nearly one point, a light subpath's photon takes the place of a connection.
//
// A vertex x_i merges if both ways to it were deltas: no strategy of bidirectional path tracing can make such a path
// but by chance. "Merge at x_i" finds a path with Q_i eta_i times the density of the strategy s = i + 1, where
//
//   eta_i = pi r(x_i, k)² N
//
// and N is the number of light subpaths (Georgiev, Křivánek, Davidovič and Slusallek, "Light Transport Simulation with
// Vertex Connection and Merging", 2012, equation 36). In the recursion of mis.h that is one more term of D_i, counted
// if the next vertex is a delta, too; the weight of a merge is
//
//   1 / (1 + (a_L + b_L q_L) / eta + (a_E + b_E q_E) / eta)
//
// with all three raised to the power of the heuristic. Its bias, light taken from as far as r away, goes to zero with
// the radius (Knaus and Zwicker, "Progressive Photon Mapping: A Probabilistic Approach", 2011):
//
//   r(x, k) = c rho(x) (k + 1)^((alpha - 1) / 2)
//
// where rho is the width of a pixel at the distance of x from the camera and k the index of the sample. A radius
// depends on nothing that other samples have found, so that parts of a render add up to the whole.
#pragma once

#include "core/ray_cone.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "sampling/warp.h"
#include "transport/mis.h"
#include "world/scattering.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace etendue {

/// Holds a light subpath as it arrives at a vertex that merges.
struct Photon {
    Vec3f position{0.0f};   ///< metres
    Vec3f direction{0.0f};  ///< unit, back to the vertex before
    Vec3f normal{0.0f};     ///< unit, geometric, on the surface's front
    Rgb throughput{};       ///< throughput of the subpath, without the weight of its wavelength
    SubpathDensities densities{};
    std::uint32_t first_word = 0;    ///< see WordRange
    std::uint32_t word_count = 0;    ///< see WordRange
    std::int32_t edges = 1;          ///< edges of the subpath
    std::uint32_t is_dispersed = 0;  ///< 1 if light of other wavelengths would not be here
};

/// Decides which photons a vertex takes light from.
struct MergeKernel {
    /// Least cosine between the normals of the photon's surface and the vertex's.
    static constexpr float kLeastCosine = 0.7f;
    /// Share of the radius that a photon may lie above or below the vertex's surface.
    static constexpr float kThickness = 0.1f;

    Vec3f position{0.0f};
    Vec3f normal{0.0f};
    float radius = 0.0f;

    [[nodiscard]] bool contains(const Photon& photon) const {
        const Vec3f apart = photon.position - position;
        return length_squared(apart) < radius * radius && dot(photon.normal, normal) >= kLeastCosine &&
               std::abs(dot(apart, normal)) <= kThickness * radius;
    }
};

/// Returns the light that an eye subpath takes from `photon` at `vertex`, at which it arrives with `throughput` and
/// which scatters it towards the photon by `scattered`.
template <typename AnyVertex>
[[nodiscard]] inline Rgb merged_light(const MisContext& mis, const AnyVertex& vertex, const Rgb& throughput,
                                      const Photon& photon, const Scattering::TwoWayValue& scattered) {
    const double expected = mis.merging.expected(vertex.position);
    const double raised = mis.raised(expected);
    const double fewer = photon.densities.fewer(mis.raised, static_cast<double>(scattered.pdf_solid_angle)) +
                         vertex.densities.fewer(mis.raised, static_cast<double>(scattered.reverse_pdf_solid_angle));
    const double weight = mis.merging.weight(fewer / raised);
    // The density of photons is one per area of the surface, that of directions one per area across the ray.
    const float cosine = vertex.cosine(photon.direction);
    if (!(cosine > 0.0f)) return {};
    return throughput * scattered.f_cos * photon.throughput *
           static_cast<float>(weight / (expected * static_cast<double>(cosine)));
}

}  // namespace etendue
