// The weights of bidirectional path tracing, in a constant number of steps per vertex and connection.
//
// A subpath keeps two numbers, a and b, of its last vertex x_i. The ratios of all strategies with fewer vertices on its
// side to the one that connects x_i (Veach 1997, equation 10.9) sum up to Q_i D_i, where
//
//   D_i = a_i + b_i q_i
//   a_{i+1} = 1 / P_{i+1}                                     if x_i and x_{i+1} can be connected, otherwise 0
//   b_{i+1} = |cos theta_i| / |x_i - x_{i+1}|² D_i / P_{i+1}
//
// P_i and Q_i are the densities per area with which this side and the other one make x_i, q_i the one per solid angle
// of turning back there, and theta_i lies between the geometric normal and the edge to x_{i+1}. (Georgiev,
// "Implementing Vertex Connection and Merging", 2012, calls a and b dVCM and dVC.) All factors are raised to the power
// of the heuristic. docs/derivations.md, equations 1 to 10, has why, the ends of subpaths, deltas and what is left out.
#pragma once

#include "camera/camera.h"
#include "scene/integrator_settings.h"
#include "transport/dimensions.h"
#include "transport/merge_radius.h"
#include "world/world.h"

namespace etendue {

/// Raises a density, or a ratio of densities, to the exponent of the heuristic.
struct Raised {
    Heuristic heuristic = Heuristic::Balance;

    /// Returns `ratio` raised to the heuristic's exponent; a template of its lane type, see core/lane.h, or of double.
    template <typename T>
    [[nodiscard]] T operator()(T ratio) const {
        return heuristic == Heuristic::Power ? ratio * ratio : ratio;
    }
};

/// Numbers the vertex of a subpath at which a camera ray ends; the lens is 0.
inline constexpr int kDirectlySeen = 1;

/// Holds what the weights of all paths of a render depend on.
struct MisContext {
    const World& world;
    Raised raised{};
    /// Multiplies the density of the eye's first vertex: camera samples per area of the film over light paths.
    double samples_per_light_path = 1.0;
    Merging merging{};
    bool aims = false;  ///< light subpaths are aimed, see LightEmitter::sample
};

/// Holds a and b of a vertex, raised, and two such numbers for a merge, which counts as soon as the path reaches a
/// delta (docs/derivations.md, equation 12).
struct SubpathDensities {
    double a = 0.0;
    double b = 0.0;
    float merge_a = 0.0f;    ///< eta at the vertex that merges, otherwise 0
    float own_merge = 0.0f;  ///< eta at the vertex where all vertices merge, otherwise 0
    double merge_b = 0.0;    ///< b of the merge at vertices after that one

    /// Returns the sum over the strategies with fewer vertices on this side, but for the raised density per area with
    /// which the other side makes this vertex. `turning_back` is q.
    [[nodiscard]] double fewer(const Raised& raised, double turning_back) const {
        return static_cast<double>(own_merge) + fewer_without_own_merge(raised, turning_back);
    }
    /// Returns `fewer` without the merge at the vertex itself.
    [[nodiscard]] double fewer_without_own_merge(const Raised& raised, double turning_back) const {
        return a + b * raised(turning_back);
    }
    /// Returns what the merge adds to `fewer` on paths whose light has come by a delta.
    [[nodiscard]] double merged(const Raised& raised, double turning_back) const {
        return static_cast<double>(merge_a) + merge_b * raised(turning_back);
    }
};

/// Holds the densities of a subpath on its way from a vertex towards the next one.
struct DepartingDensities {
    double d = 0.0;              ///< D_i
    double merged = 0.0;         ///< SubpathDensities::merged of the vertex
    double pdf_forward = 1.0;    ///< 1/sr, of the direction; 1/m², of the point across it, from infinity
    double cosine = 1.0;         ///< |cos theta_i|
    bool is_connectible = true;  ///< the edge can be that of a connection, as far as this vertex is concerned
    bool is_in_dense = false;    ///< the vertex lies in a dense medium, within which nothing is connected

    /// Goes on through the boundary of a body that another hides: no connection passes it, so that merges count from
    /// there on as after a delta.
    void pass_hidden() {
        is_connectible = false;
        d += merged;
        merged = 0.0;
    }
    /// Returns the densities at a vertex `squared_distance` m² away, >= 0, or 1 where `pdf_forward` is per area, and
    /// where the direction has the cosine `cos_arriving`; `in_dense` if it lies in a dense medium. The distance cancels
    /// in b, and divides nothing in a: media scatter light again after no distance at all.
    [[nodiscard]] SubpathDensities arrive(const Raised& raised, double squared_distance, double cos_arriving,
                                          bool in_dense = false) const {
        const double across = pdf_forward * cos_arriving;
        const bool arrives = across > 0.0;
        const bool connects = is_connectible && !(is_in_dense && in_dense);
        const double inverse = 1.0 / raised(across);
        const double back = raised(cosine);
        return {.a = arrives && connects ? raised(squared_distance) * inverse : 0.0,
                .b = arrives ? back * d * inverse : 0.0,
                .merge_b = arrives ? back * merged * inverse : 0.0};
    }
};

/// Holds how far a subpath is, between two of its vertices.
struct SubpathProgress {
    Rgb throughput{1.0f};  ///< without the weight of the wavelength
    /// Multiplies the throughput for Russian roulette: eta² over the refractions of radiance, or one over what a
    /// light began with.
    float roulette_scale = 1.0f;
    Vec3f from{0.0f};  ///< the vertex before
    DepartingDensities departing;
    int index = 1;  ///< index of the vertex to come
    int edges = 1;  ///< edges of the path when its ray has hit; media, clear surfaces and hidden boundaries add none
    bool is_dispersed = false;
    bool only_deltas = true;
    bool is_after_delta = false;  ///< a delta or a hidden boundary lies behind it
    bool is_direct = true;        ///< no boundary that another body hides lies between `from` and where the ray is

    /// Goes past the boundary of a body that another hides, which no connection passes.
    void pass_hidden() {
        departing.pass_hidden();
        is_after_delta = true;
        is_direct = false;
    }
};

/// Returns the densities along the ray of `emission`.
[[nodiscard]] inline DepartingDensities leave_light(const MisContext& mis, const Emission& emission) {
    const EmissionSample& sample = emission.sample;
    const bool at_infinity = mis.world.lights().is_at_infinity(emission.light);
    const auto position = static_cast<double>(sample.pdf_position_area);
    const auto direction = static_cast<double>(sample.pdf_direction_solid_angle);
    const auto choice = static_cast<double>(emission.probability);
    return {.d = mis.world.lights().can_be_hit(emission.light)
                     ? 1.0 / mis.raised(choice * (at_infinity ? direction : position))
                     : 0.0,
            .pdf_forward = at_infinity ? position : direction,
            .cosine = static_cast<double>(sample.cos_theta)};
}

/// Returns a and b at the first vertex of a light subpath, at `position`, where its ray has the cosine `cos_arriving`.
[[nodiscard]] inline SubpathDensities arrive_from_light(const MisContext& mis, const Emission& emission,
                                                        const DepartingDensities& departing, const Vec3f& position,
                                                        double cos_arriving) {
    const EmissionSample& sample = emission.sample;
    const double squared_distance = mis.world.lights().is_at_infinity(emission.light)
                                        ? 1.0
                                        : static_cast<double>(length_squared(position - sample.position));
    SubpathDensities arrived = departing.arrive(mis.raised, squared_distance, cos_arriving);
    // A light that is sampled for this vertex is chosen in another way than this one was, and so are its triangles.
    auto for_vertex = static_cast<double>(
        mis.world.lights().probability(position, emission.light) *
        mis.world.lights().gain(emission.light, sample.triangle, sample.position, position, emission.ray.time));
    auto for_emission = static_cast<double>(emission.probability);
    if (emission.light == mis.world.environment().light()) {
        for_vertex *= static_cast<double>(mis.world.environment().pdf_solid_angle(emission.light, -sample.direction));
        for_emission *= static_cast<double>(sample.pdf_direction_solid_angle);
    }
    arrived.a *= mis.raised(for_vertex / for_emission);
    return arrived;
}

/// Returns a and b at the first vertex of an eye subpath; the lens and the film, by `camera`, say how densely camera
/// rays fall there.
[[nodiscard]] inline SubpathDensities arrive_from_lens(const MisContext& mis, DepartingDensities departing,
                                                       const CameraConnection& camera, double cos_arriving) {
    departing.pdf_forward = mis.samples_per_light_path * static_cast<double>(camera.importance_area);
    return departing.arrive(mis.raised, 1.0, cos_arriving);
}

/// Returns the densities on the way from a vertex to the next one. `pdf` is that of the direction, `reverse_pdf` that
/// of turning back, both 1/sr; `cosine` is the direction's, absolute, to the geometric normal.
[[nodiscard]] inline DepartingDensities depart(const Raised& raised, const SubpathDensities& arrived, float pdf,
                                               float reverse_pdf, float cosine) {
    return {.d = arrived.fewer(raised, static_cast<double>(reverse_pdf)),
            .merged = arrived.merged(raised, static_cast<double>(reverse_pdf)),
            .pdf_forward = static_cast<double>(pdf),
            .cosine = static_cast<double>(cosine)};
}

/// Says how a subpath has come to a vertex, for merges: by deltas, or through boundaries of bodies that others hide,
/// which no connection passes either.
struct ArrivalForMerging {
    SubpathEnd end = SubpathEnd::AtEye;
    int index = 1;                ///< of the vertex
    bool only_deltas = true;      ///< nothing but deltas lies before it
    bool is_after_delta = false;  ///< a delta or a hidden boundary lies before it
    bool is_direct = true;        ///< no hidden boundary lies between it and the vertex before

    /// Returns true if the eye sees the vertex in mirrors, through smooth refractions or through hidden boundaries.
    [[nodiscard]] bool is_seen_by_deltas() const {
        return end == SubpathEnd::AtEye && only_deltas && (index > kDirectlySeen || !is_direct);
    }
};

/// Returns true if the subpath merges at the vertex, which lies on a surface that scatters by more than deltas.
[[nodiscard]] inline bool merges_at(MergeAt at, const ArrivalForMerging& arrival) {
    switch (at) {
        case MergeAt::Nothing:
            return false;
        case MergeAt::SeenByDeltas:
            return arrival.end == SubpathEnd::AtLight ? arrival.is_after_delta : arrival.is_seen_by_deltas();
        case MergeAt::Everywhere:
            return true;
    }
    return false;
}

/// Adds to `arrived` what the weights need of a vertex at `position` at which a subpath from `end` merges, on a surface
/// that stops the share `opacity`.
inline void count_merge(const MisContext& mis, SubpathEnd end, const Vec3f& position, float opacity,
                        SubpathDensities& arrived) {
    const auto expected = static_cast<float>(mis.raised(mis.merging.expected(position, opacity)));
    if (mis.merging.at == MergeAt::Everywhere)
        arrived.own_merge = expected;
    else if (end == SubpathEnd::AtEye)
        arrived.merge_a = expected;
}

/// Departs from a vertex by a delta, where one density is `reverse_ratio` times the other.
[[nodiscard]] inline DepartingDensities depart_by_delta(const Raised& raised, const SubpathDensities& arrived,
                                                        float reverse_ratio, float cosine) {
    return {.d = (arrived.b + arrived.merge_b) * raised(static_cast<double>(reverse_ratio)),
            .cosine = static_cast<double>(cosine),
            .is_connectible = false};
}

}  // namespace etendue
