// What each kind of strategy compares itself with, from the recursion of mis.h.
#pragma once

#include "transport/mis.h"
#include "world/scattering.h"

#include <cmath>
#include <limits>

namespace etendue {

/// Sums ratios of a path over the strategies with fewer vertices from one end than the one that has made it.
/// A template of its lane type, see core/lane.h, double besides.
template <typename T>
struct BasicStrategySums {
    T fewer_from_light{0.0f};
    T fewer_from_eye{0.0f};

    /// Returns the sums of a strategy that all others together make `ratio` times as densely, whichever they are.
    [[nodiscard]] static BasicStrategySums of_all_others(T ratio) { return {.fewer_from_light = ratio}; }
    [[nodiscard]] T weight() const { return T(1.0f) / (T(1.0f) + fewer_from_light + fewer_from_eye); }
};

using StrategySums = BasicStrategySums<double>;

/// Returns the sums of a strategy that connects two vertices. `from_eye` is the density per area, 1/m², with which the
/// eye's vertex makes the light's, `from_light` that of the way back; `fewer_of_light` and `fewer_of_eye` are what
/// SubpathDensities::fewer says of each.
template <typename T>
[[nodiscard]] inline BasicStrategySums<T> sums_of_connection(const Raised& raised, T from_eye, T fewer_of_light,
                                                             T from_light, T fewer_of_eye) {
    return {.fewer_from_light = raised(from_eye) * fewer_of_light, .fewer_from_eye = raised(from_light) * fewer_of_eye};
}

/// Holds densities of a point of a light, 1/m², or at infinity of a direction, 1/sr, without the choice of the light.
struct LightPointPdfs {
    float sampled;  ///< for the next vertex
    float emitted;  ///< for a light subpath
};

/// Returns the sums of s = 0: an eye subpath has met a point of `light`, or at infinity a direction, coming from
/// `from`. `pdfs` are of that point or direction, `emission_pdf` of the ray from there.
[[nodiscard]] inline StrategySums sums_at_light(const MisContext& mis, const Vec3f& from, std::uint32_t light,
                                                const LightPointPdfs& pdfs, float emission_pdf,
                                                const SubpathDensities& arrived) {
    const World& world = mis.world;
    const Raised& raised = mis.raised;
    const double sampled = raised(static_cast<double>(pdfs.sampled * world.lights().probability(from, light)));
    const double emitted = raised(static_cast<double>(pdfs.emitted * world.emitters().probability(light)));
    return {.fewer_from_eye = sampled * arrived.a + emitted * arrived.b * raised(static_cast<double>(emission_pdf))};
}

/// Returns `sums_at_light` for a lamp that an eye subpath has met: `emitted` goes back along its ray to `from`.
[[nodiscard]] inline StrategySums sums_at_emitter(const MisContext& mis, const Vec3f& from, const EmittedRay& emitted,
                                                  const SubpathDensities& arrived) {
    const float pdf_area = mis.world.emitters().pdf_area(emitted.light, emitted.point, emitted.time);
    const float gain = mis.world.lights().gain(emitted.light, emitted.triangle, emitted.point, from, emitted.time);
    return sums_at_light(mis, from, emitted.light, {.sampled = pdf_area * gain, .emitted = pdf_area},
                         mis.world.emitters().pdf(emitted, mis.aims), arrived);
}

/// Returns the sums for a lamp that a camera ray of `time`, in [0, 1], has met at `on_light`. The strategy (1, 1) finds
/// the lamp, too.
[[nodiscard]] inline StrategySums sums_at_seen_emitter(const MisContext& mis, std::uint32_t light,
                                                       const Vec3f& on_light, float time,
                                                       const SubpathDensities& arrived) {
    return {.fewer_from_eye = mis.raised(static_cast<double>(mis.world.emitters().pdf_area(light, on_light, time) *
                                                             mis.world.emitters().probability(light))) *
                              arrived.a};
}

/// Returns the sums for the emission along `wo` of a lamp that `eye` has met at `point`, with the densities `arrived`;
/// `time`, in [0, 1], is the time of the path.
[[nodiscard]] inline StrategySums sums_of_met_lamp(const MisContext& mis, const SubpathProgress& eye,
                                                   const SurfacePoint& point, const Vec3f& wo, float time,
                                                   const SubpathDensities& arrived) {
    const std::uint32_t light = mis.world.lights().at(point);
    if (light == kNone) return {};
    if (eye.index == kDirectlySeen)
        return eye.is_direct ? sums_at_seen_emitter(mis, light, point.position, time, arrived) : StrategySums{};
    return sums_at_emitter(mis, eye.from,
                           {.light = light,
                            .triangle = point.triangle,
                            .point = point.position,
                            .direction = wo,
                            .cos_light = dot(wo, point.geometric_normal),
                            .time = time},
                           arrived);
}

/// Returns `sums_at_light` for a light that the ray has met infinitely far away. The vertex is a direction: its density
/// is per solid angle on both sides, and so is that of the light.
[[nodiscard]] inline StrategySums sums_from_afar(const MisContext& mis, const Vec3f& from, std::uint32_t light,
                                                 const Vec3f& direction, const DepartingDensities& departing) {
    const World& world = mis.world;
    return sums_at_light(mis, from, light,
                         {.sampled = world.environment().pdf_solid_angle(light, direction),
                          .emitted = world.environment().emission_pdf_solid_angle(light, direction)},
                         world.emitters().pdf({.light = light, .point = from, .direction = -direction}, mis.aims),
                         departing.arrive(mis.raised, 1.0, 1.0));
}

/// Returns the sums of s = 1: `chosen` was sampled for the last vertex of an eye subpath, which scatters it by `value`.
template <typename AnyVertex>
[[nodiscard]] inline StrategySums sums_of_light_sample(const MisContext& mis, const AnyVertex& vertex,
                                                       const ChosenLight& chosen,
                                                       const Scattering::TwoWayValue& value) {
    const World& world = mis.world;
    const Raised& raised = mis.raised;
    const LightSample& light = chosen.sample;
    const bool is_afar = std::isinf(light.distance);
    const EmittedRay emitted{.light = chosen.light,
                             .triangle = light.triangle,
                             .point = is_afar ? vertex.position : vertex.position + light.wi * light.distance,
                             .direction = -light.wi,
                             .cos_light = light.cos_light,
                             .time = chosen.time};
    const float arriving = world.emitters().pdf(emitted, mis.aims) * vertex.cosine(light.wi);
    const double from_light = static_cast<double>(is_afar ? arriving : arriving / (light.distance * light.distance));
    // The strategies with more vertices from the light have chosen it for its emission, not for this vertex, and so its
    // triangle, and the direction of an environment: its densities jump from cell to cell, and both must be of the one
    // that other strategies find the direction in.
    auto for_emission = static_cast<double>(world.emitters().probability(chosen.light));
    auto for_vertex =
        static_cast<double>(chosen.expected_samples * world.lights().gain(chosen.light, light.triangle, emitted.point,
                                                                          vertex.position, chosen.time));
    float pdf_solid_angle = light.pdf_solid_angle;
    if (chosen.light == world.environment().light()) {
        for_emission *= static_cast<double>(world.environment().emission_pdf_solid_angle(chosen.light, light.wi));
        pdf_solid_angle = chosen.expected_samples * world.environment().pdf_solid_angle(chosen.light, light.wi);
        for_vertex = static_cast<double>(pdf_solid_angle);
        if (!(pdf_solid_angle > 0.0f)) return {.fewer_from_light = std::numeric_limits<double>::infinity()};
    }
    const double from_eye = light.is_delta ? 0.0 : static_cast<double>(value.pdf_solid_angle / pdf_solid_angle);
    return sums_of_connection(raised, from_eye, 1.0, for_emission / for_vertex * from_light,
                              vertex.densities.fewer(raised, static_cast<double>(value.reverse_pdf_solid_angle)));
}

/// Returns the sums of t = 1: the last vertex of a light subpath scatters along `direction`, by `value`, to the lens.
template <typename AnyVertex>
[[nodiscard]] inline StrategySums sums_at_lens(const MisContext& mis, const AnyVertex& vertex, const Vec3f& direction,
                                               const CameraConnection& camera, const Scattering::TwoWayValue& value) {
    const double from_eye =
        mis.samples_per_light_path * static_cast<double>(camera.importance_area * vertex.cosine(direction));
    return {.fewer_from_light = mis.raised(from_eye) *
                                vertex.densities.fewer(mis.raised, static_cast<double>(value.reverse_pdf_solid_angle))};
}

/// Returns the sums of s = 1, t = 1: the point of a lamp at which `emission` begins is seen by `camera` with this
/// cosine.
[[nodiscard]] inline StrategySums sums_of_seen_light(const MisContext& mis, const Emission& emission,
                                                     const CameraConnection& camera, float cosine) {
    const double from_eye = mis.samples_per_light_path * static_cast<double>(camera.importance_area * cosine);
    const auto from_light = static_cast<double>(emission.sample.pdf_position_area * emission.probability);
    return {.fewer_from_light = mis.raised(from_eye / from_light)};
}

/// Returns the sums of s > 1, t > 1: the last vertices of both subpaths are `squared` m² apart, and `w` leads from that
/// of the eye to the other.
template <typename AnyVertex>
[[nodiscard]] inline StrategySums sums_between(const Raised& raised, const AnyVertex& eye, const AnyVertex& light,
                                               const Vec3f& w, float squared, const Scattering::TwoWayValue& at_eye,
                                               const Scattering::TwoWayValue& at_light) {
    const double from_eye = static_cast<double>(at_eye.pdf_solid_angle * light.cosine(w) / squared);
    const double from_light = static_cast<double>(at_light.pdf_solid_angle * eye.cosine(w) / squared);
    const auto eye_turning_back = static_cast<double>(at_eye.reverse_pdf_solid_angle);
    const double merged = light.is_after_delta ? eye.densities.merged(raised, eye_turning_back) : 0.0;
    return sums_of_connection(raised, from_eye,
                              light.densities.fewer(raised, static_cast<double>(at_light.reverse_pdf_solid_angle)),
                              from_light, eye.densities.fewer(raised, eye_turning_back) + merged);
}

}  // namespace etendue
