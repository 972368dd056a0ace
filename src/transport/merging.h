// Merging: where both subpaths arrive at nearly one point, a light subpath's photon takes the place of a connection.
//
// A vertex x_i merges if nothing but deltas, one at least, lies between it and the lens, and the light has come by a
// delta, too. "Merge at x_i" finds a path with Q_i eta_i times the density of the strategy s = i + 1, where
// eta_i = alpha(x_i) pi r(x_i)² N, with the radius r, N light subpaths and the opacity alpha. Its weight is
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
#include "sampling/hash.h"
#include "transport/mis.h"
#include "world/scattering.h"

#include <algorithm>
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

/// Says whether a vertex merges, and what of its surface decides with which photons, and how much.
struct MergePlace {
    float opacity = 1.0f;      ///< share of subpaths that stop at the point, (0, 1]
    std::uint16_t sheet = 0;   ///< names a surface that may be partly transparent, among those nearby; 0: an opaque one
    bool bounds_body = false;  ///< the surface bounds a body, so that its front is known
    bool merges = false;       ///< subpaths from the other end may merge with this one here; the rest is known then
};

/// Returns the place of a vertex that merges at `hit` (valid), on a surface of `material`.
[[nodiscard]] inline MergePlace merge_place(const World& world, const Hit& hit, const Material& material) {
    MergePlace place{.bounds_body = material.filling != kNone, .merges = true};
    if (material.alpha_test != AlphaTest::Blend) return place;
    // What stops a ray is opaque by more than that, but for rounding.
    constexpr float kLeastOpacity = 1e-6f;
    place.opacity = std::max(world.geometry().opacity(hit), kLeastOpacity);
    place.sheet = static_cast<std::uint16_t>(hash_combine(hash_u32(hit.instance), hit.geometry) >> 16 | 1u);
    return place;
}

/// Holds a light subpath as it arrives at a vertex that merges.
struct Photon {
    Vec3f position{0.0f};   ///< metres
    Vec3f direction{0.0f};  ///< unit, back to the vertex before
    /// Holds the subpath's throughput over the cosine and the opacity, without the weight of its wavelength.
    Rgb throughput{};
    float a = 0.0f;                ///< see SubpathDensities
    float b = 0.0f;                ///< see SubpathDensities
    std::uint32_t first_word = 0;  ///< see WordRange
    std::uint32_t word_count = 0;  ///< see WordRange
    std::int32_t edges = 1;        ///< edges of the subpath
    std::uint16_t sheet = 0;       ///< see MergePlace
    CoarseDirection normal{};      ///< geometric, on the surface's front
    bool is_dispersed = false;     ///< light of other wavelengths would not be here
    bool bounds_body = false;      ///< see MergePlace
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
    // The eye's subpath stops at a partly transparent surface by chance already; the photon must not have it twice.
    const float per_light = cosine * vertex.merging.opacity;
    return {.position = vertex.position,
            .direction = vertex.wo,
            .throughput = per_light > 0.0f ? vertex.throughput * (1.0f / per_light) : Rgb(),
            .a = static_cast<float>(vertex.densities.a),
            .b = static_cast<float>(vertex.densities.b),
            .edges = vertex.next_edges - 1,
            .sheet = vertex.merging.sheet,
            .normal = CoarseDirection(geometric_normal),
            .is_dispersed = vertex.is_dispersed,
            .bounds_body = vertex.merging.bounds_body};
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
    MergePlace surface{};    ///< the vertex's

    [[nodiscard]] bool contains(const Photon& photon) const {
        const Vec3f apart = photon.position - position;
        return length_squared(apart) < radius * radius && photon.sheet == surface.sheet &&
               cosine_to(photon) >= kLeastCosine &&
               std::abs(dot(apart, normal)) <= kThickness * radius + 2.0f * clearance;
    }

  private:
    /// Returns the cosine between the normals of both surfaces, of sheets on the side that the light comes from: which
    /// side of these is the front may differ from triangle to triangle.
    [[nodiscard]] float cosine_to(const Photon& photon) const {
        const float cosine = photon.normal.cosine(normal);
        if (surface.bounds_body || photon.bounds_body) return cosine;
        const bool agree = (photon.normal.cosine(photon.direction) > 0.0f) == (dot(normal, photon.direction) > 0.0f);
        return agree ? cosine : -cosine;
    }
};

/// Returns the kernel of a vertex that merges, on a surface with the normal `geometric_normal`.
template <typename AnyVertex>
[[nodiscard]] inline MergeKernel merge_kernel(const Merging& merging, const AnyVertex& vertex,
                                              const Vec3f& geometric_normal, float clearance) {
    return {vertex.position, geometric_normal, merging.radius(vertex.position), clearance, vertex.merging};
}

/// Returns the density of all other ways to the path that merges `vertex` with `photon` over that of the merge, raised.
/// `within` is Merging::expected_within the kernel's radius.
template <typename AnyVertex>
[[nodiscard]] inline double others_of_merge(const MisContext& mis, const AnyVertex& vertex, const Photon& photon,
                                            const Scattering::TwoWayValue& scattered, double within) {
    const double expected = within * static_cast<double>(vertex.merging.opacity);
    const SubpathDensities of_photon{.a = static_cast<double>(photon.a), .b = static_cast<double>(photon.b)};
    const auto forward = static_cast<double>(scattered.pdf_solid_angle);
    const auto backward = static_cast<double>(scattered.reverse_pdf_solid_angle);
    const double fewer =
        of_photon.fewer(mis.raised, forward) + vertex.densities.fewer_without_own_merge(mis.raised, backward);
    return fewer / mis.raised(expected);
}

/// Returns the light that an eye subpath takes from `photon` at `vertex`, which scatters it towards the photon by
/// `scattered`, times `weight`. `within` is Merging::expected_within the kernel's radius.
template <typename AnyVertex>
[[nodiscard]] inline Rgb merged_light(const AnyVertex& vertex, const Photon& photon,
                                      const Scattering::TwoWayValue& scattered, double weight, double within) {
    return vertex.throughput * scattered.f_cos * photon.throughput * static_cast<float>(weight / within);
}

}  // namespace etendue
