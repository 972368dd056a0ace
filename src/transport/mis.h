// The weights of bidirectional path tracing, in a constant number of steps per vertex and connection.
//
// A path x_0 ... x_k (x_0 on the light, x_k on the lens) can be made by every strategy (s, t) with s + t = k + 1: s
// vertices from the light, t from the eye, the edge between x_{s-1} and x_s being the connection. With P_i the density
// per area with which a subpath from the light makes x_i from x_{i-1}, and Q_i that with which one from the eye makes
// it from x_{i+1}, strategies compare as
//
//   p_{s'} / p_s = prod_{i = s'}^{s-1} Q_i / P_i        (s' < s)
//
// wherever x_{s'-1} and x_{s'} can be connected (Veach 1997, equation 10.9), and the weight of s is one over the sum of
// all those ratios, each raised to the power of the heuristic. That sum over s' < s, once only Q_{s-1} and Q_{s-2} are
// still unknown, because they depend on where the path goes on, is
//
//   Q_{s-1} (a + b q)     with Q_{s-2} = q |cos theta_{s-2}| / |x_{s-2} - x_{s-1}|²
//
// where q is the density, per solid angle, of turning back at x_{s-1}. A subpath keeps a and b of its last vertex; with
// D_i = a_i + b_i q_i the next vertex has
//
//   a_{i+1} = 1 / P_{i+1}                                     if x_i and x_{i+1} can be connected, otherwise 0
//   b_{i+1} = |cos theta_i| / |x_i - x_{i+1}|² D_i / P_{i+1}
//
// (the recursion of Georgiev, "Implementing Vertex Connection and Merging", 2012, where they are called dVCM and dVC).
// By symmetry the same serves the subpath from the eye. Where it starts:
//
//   light: D_0 = 1 / P_0, or 0 if nothing can hit the light. For s = 1 the light is sampled anew, for x_1: with
//     c' P_0 / c in place of P_0, where c is the density with which it was chosen to emit and c' that with which it is
//     chosen for x_1: the probabilities of the choice (light/light_tree.h), of a mesh what triangles gain that face x_1
//     (light/mesh_light.h), and of an environment the densities of the direction besides (light/environment_light.h).
//     So a_1 is multiplied by c' / c, the sum that (1, t) compares itself with, P_1 (a + b q) of the eye's, by c / c',
//     and where an eye subpath ends on the light, P_0 (a + b q) has c' P_0 / c with a, but P_0 with b. a_1 depends on
//     x_0 and x_1 alone: at a light that reaches x_1 by a delta or through something hidden it is zero as ever.
//     Where an eye subpath has no vertex between the lens and the light, and for s = 1 and t = 1, P_0 is that of
//     emission: what is connected to the lens is where a light subpath begins.
//   eye: D = 0, as no light hits the lens. For t = 1 the lens is sampled anew. Each pixel of the window has one camera
//     sample and one light path that may fall anywhere: P_1, per area of the film, is multiplied by the film's pixels
//     over the window's.
//
// Lights at infinity have a density per solid angle in place of P_0, and P_1 is that of a point on the disk across the
// direction, times |cos theta_1|.
//
// At a delta D_i = b_i r_i: neither of its edges can be connected, and in r_i, the density of the way back over that of
// this way, the deltas cancel; P_{i+1} then has a density of 1 per solid angle. r_i is the ratio of the two choices of
// the event, times n² |cos| on the side of x_{i-1} over that on the side of x_{i+1} where it refracts, which is what
// the densities of a rough interface tend to. (Probabilities of choosing the delta cancel where they are the same both
// ways.)
//
// Left out of the densities of all strategies alike: Russian roulette, how far light gets in media, whether it passes
// what is partly transparent, and which wavelength a dispersed path has. That keeps the sum of the weights at one, but
// not the variance as low as it could be in dense media. Directions' densities are those of the lobes; cosines here
// belong to the geometric normals, and are 1 in media.
#pragma once

#include "camera/camera.h"
#include "transport/dimensions.h"
#include "transport/heuristic.h"
#include "transport/merge_radius.h"
#include "world/world.h"

namespace etendue {

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

/// Holds a and b of a vertex, raised.
struct SubpathDensities {
    double a = 0.0;
    double b = 0.0;

    /// Returns the sum over the strategies with fewer vertices on this side, but for the raised density per area with
    /// which the other side makes this vertex. `turning_back` is q.
    [[nodiscard]] double fewer(const Raised& raised, double turning_back) const { return a + b * raised(turning_back); }
};

/// Holds the densities of a subpath on its way from a vertex towards the next one.
struct DepartingDensities {
    double d = 0.0;              ///< D_i
    double pdf_forward = 1.0;    ///< 1/sr, of the direction; 1/m², of the point across it, from infinity
    double cosine = 1.0;         ///< |cos theta_i|
    bool is_connectible = true;  ///< the edge can be that of a connection, as far as this vertex is concerned
    bool is_from_infinity = false;

    /// Returns the densities at a vertex `squared_distance` m² away, >= 0, where the direction has the cosine
    /// `cos_arriving`. The distance cancels in b, and divides nothing in a: media scatter light again after no distance
    /// at all.
    [[nodiscard]] SubpathDensities arrive(const Raised& raised, double squared_distance, double cos_arriving) const {
        const double across = pdf_forward * cos_arriving;
        // Without a branch, so that compilers do it for many at once.
        const bool arrives = across > 0.0;
        const double inverse = 1.0 / raised(across);
        const double back = is_from_infinity ? 1.0 : raised(cosine);
        const double area = is_from_infinity ? 1.0 : raised(squared_distance);
        return {.a = arrives && is_connectible ? area * inverse : 0.0, .b = arrives ? back * d * inverse : 0.0};
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
            .cosine = static_cast<double>(sample.cos_theta),
            .is_from_infinity = at_infinity};
}

/// Returns a and b at the first vertex of a light subpath, at `position`, where its ray has the cosine `cos_arriving`.
[[nodiscard]] inline SubpathDensities arrive_from_light(const MisContext& mis, const Emission& emission,
                                                        const DepartingDensities& departing, const Vec3f& position,
                                                        double cos_arriving) {
    const EmissionSample& sample = emission.sample;
    const auto squared_distance = static_cast<double>(length_squared(position - sample.position));
    SubpathDensities arrived = departing.arrive(mis.raised, squared_distance, cos_arriving);
    // A light that is sampled for this vertex is chosen in another way than this one was, and so are its triangles.
    auto for_vertex =
        static_cast<double>(mis.world.lights().probability(position, emission.light) *
                            mis.world.lights().gain(emission.light, sample.triangle, sample.position, position));
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
    departing.is_from_infinity = true;  // per area already
    return departing.arrive(mis.raised, 1.0, cos_arriving);
}

/// Returns the densities on the way from a vertex to the next one. `pdf` is that of the direction, `reverse_pdf` that
/// of turning back, both 1/sr; `cosine` is the direction's, absolute, to the geometric normal.
[[nodiscard]] inline DepartingDensities depart(const Raised& raised, const SubpathDensities& arrived, float pdf,
                                               float reverse_pdf, float cosine) {
    return {.d = arrived.fewer(raised, static_cast<double>(reverse_pdf)),
            .pdf_forward = static_cast<double>(pdf),
            .cosine = static_cast<double>(cosine)};
}

/// Returns true if vertex `index` of a subpath from `end`, which has come by deltas alone if `only_deltas`, is what the
/// eye sees in mirrors or through smooth refractions.
[[nodiscard]] inline bool is_seen_by_deltas(SubpathEnd end, bool only_deltas, int index) {
    return end == SubpathEnd::AtEye && only_deltas && index > kDirectlySeen;
}

/// Adds to `arrived` what merging at a vertex at `position` has for the weights; the vertex lies on a surface that
/// scatters by more than deltas. Returns true if subpaths from `end` merge there.
[[nodiscard]] inline bool merge_at(const MisContext& mis, SubpathEnd end, bool is_seen, const Vec3f& position,
                                   SubpathDensities& arrived) {
    if (!mis.merging.merges()) return false;
    // Where a light subpath goes on from such a vertex, by a delta, no vertex follows that could be connected.
    if (mis.merging.at == MergeAt::SeenByDeltas && !is_seen) return end == SubpathEnd::AtLight;
    arrived.a += mis.raised(mis.merging.expected(position));
    return true;
}

/// Departs from a vertex by a delta, where one density is `reverse_ratio` times the other.
[[nodiscard]] inline DepartingDensities depart_by_delta(const Raised& raised, const SubpathDensities& arrived,
                                                        float reverse_ratio, float cosine) {
    return {.d = arrived.b * raised(static_cast<double>(reverse_ratio)),
            .cosine = static_cast<double>(cosine),
            .is_connectible = false};
}

}  // namespace etendue
