// Merging: where both subpaths arrive at nearly one point, a light subpath's photon takes the place of a connection.
//
// A vertex x_i merges if nothing but deltas, one at least, lies between it and the lens, and the light has come by a
// delta, too. "Merge at x_i" finds a path with Q_i eta_i times the density of the strategy s = i + 1, where
// eta_i = pi r(x_i)² N, with the radius r and N light subpaths. Its weight is
//
//   1 / (1 + (a_L + b_L q_L) / eta + (a_E + b_E q_E) / eta)
//
// with a, b and q of mis.h at the photon (L) and at the eye's vertex (E) (Georgiev, Křivánek, Davidovič and Slusallek,
// "Light Transport Simulation with Vertex Connection and Merging", 2012). The bias goes to zero with r, which shrinks
// from sample to sample (Knaus and Zwicker, "Progressive Photon Mapping: A Probabilistic Approach", 2011).
// docs/derivations.md, equations 11 to 14, has the rest.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "transport/mis.h"
#include "world/scattering.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace etendue {

/// Holds a unit vector within one degree.
class CoarseDirection {
  public:
    CoarseDirection() = default;
    explicit CoarseDirection(const Vec3f& unit) : parts_{part(unit.x), part(unit.y), part(unit.z)} {}

    /// Returns the cosine between the vector and `unit`, within 0.01.
    [[nodiscard]] float cosine(const Vec3f& unit) const {
        return (static_cast<float>(parts_[0]) * unit.x + static_cast<float>(parts_[1]) * unit.y +
                static_cast<float>(parts_[2]) * unit.z) *
               (1.0f / kScale);
    }

  private:
    static constexpr float kScale = 127.0f;

    [[nodiscard]] static std::int8_t part(float of_unit) {
        return static_cast<std::int8_t>(std::lround(kScale * of_unit));
    }

    std::array<std::int8_t, 3> parts_{};
};

/// Holds a light subpath as it arrives at a vertex that merges.
struct Photon {
    Vec3f position{0.0f};          ///< metres
    Vec3f direction{0.0f};         ///< unit, back to the vertex before
    Rgb throughput{};              ///< throughput of the subpath, over the cosine, without the weight of its wavelength
    float a = 0.0f;                ///< see SubpathDensities
    float b = 0.0f;                ///< see SubpathDensities
    std::uint32_t first_word = 0;  ///< see WordRange
    std::uint32_t word_count = 0;  ///< see WordRange
    std::int32_t edges = 1;        ///< edges of the subpath
    CoarseDirection normal{};      ///< geometric, on the surface's front
    bool is_dispersed = false;     ///< light of other wavelengths would not be here
};

/// Bounds the memory that a photon takes.
inline constexpr std::size_t kMostPhotonBytes = 64;
static_assert(sizeof(Photon) <= kMostPhotonBytes);

/// Returns the photon of a light subpath that arrives at `vertex`, which merges, on a surface with the normal
/// `geometric_normal`; without words.
template <typename AnyVertex>
[[nodiscard]] inline Photon make_photon(const AnyVertex& vertex, const Vec3f& geometric_normal) {
    // The density of photons is one per area of the surface they lie on, that of directions one per area across the
    // ray. The normal of the eye's vertex, on another facet, may be square to a ray that lights this one.
    const float cosine = abs_dot(vertex.wo, geometric_normal);
    return {.position = vertex.position,
            .direction = vertex.wo,
            .throughput = cosine > 0.0f ? vertex.throughput * (1.0f / cosine) : Rgb(),
            .a = static_cast<float>(vertex.densities.a),
            .b = static_cast<float>(vertex.densities.b),
            .edges = vertex.next_edges - 1,
            .normal = CoarseDirection(geometric_normal),
            .is_dispersed = vertex.is_dispersed};
}

/// Decides which photons a vertex takes light from.
struct MergeKernel {
    /// Bounds the cosine between the normals of the photon's surface and the vertex's from below.
    static constexpr float kLeastCosine = 0.7f;
    /// Bounds how far a photon may lie above or below the vertex's surface, in radii.
    static constexpr float kThickness = 0.1f;

    Vec3f position{0.0f};
    Vec3f normal{0.0f};
    float radius = 0.0f;
    float clearance = 0.0f;  ///< metres that rounding may have moved the vertex, as in SurfacePoint

    [[nodiscard]] bool contains(const Photon& photon) const {
        const Vec3f apart = photon.position - position;
        return length_squared(apart) < radius * radius && photon.normal.cosine(normal) >= kLeastCosine &&
               std::abs(dot(apart, normal)) <= kThickness * radius + 2.0f * clearance;
    }
};

/// Returns the density of all other ways to the path that merges `vertex` with `photon` over that of the merge, raised.
/// `expected` is Merging::expected at the vertex.
template <typename AnyVertex>
[[nodiscard]] inline double others_of_merge(const MisContext& mis, const AnyVertex& vertex, const Photon& photon,
                                            const Scattering::TwoWayValue& scattered, double expected) {
    const SubpathDensities of_photon{.a = static_cast<double>(photon.a), .b = static_cast<double>(photon.b)};
    const double fewer = of_photon.fewer(mis.raised, static_cast<double>(scattered.pdf_solid_angle)) +
                         vertex.densities.fewer(mis.raised, static_cast<double>(scattered.reverse_pdf_solid_angle));
    return mis.merging.others(fewer / mis.raised(expected));
}

/// Returns the light that an eye subpath takes from `photon` at `vertex`, which scatters it towards the photon by
/// `scattered`, times `weight`. `expected` is Merging::expected at the vertex.
template <typename AnyVertex>
[[nodiscard]] inline Rgb merged_light(const AnyVertex& vertex, const Photon& photon,
                                      const Scattering::TwoWayValue& scattered, double weight, double expected) {
    return vertex.throughput * scattered.f_cos * photon.throughput * static_cast<float>(weight / expected);
}

}  // namespace etendue
