// Connections of plain diffuse surfaces, each with its weight among the strategies and its ray.
//
// The weights are those of strategy_sums.h in single precision: SubpathWave makes a DiffuseEnd only where floats hold
// the densities. Diffuse surfaces let all but the connection itself be computed beforehand.
#pragma once

#include "light/mesh_light.h"
#include "transport/connecting_ray.h"
#include "transport/strategy_sums.h"
#include "wave/subpath/diffuse_end.h"

namespace etendue {

/// How a render weighs strategies.
struct WeightRule {
    Raised raised;
    bool weighted = true;  ///< if not, each counts in full

    /// Returns the weight of a path among all strategies that could have made it, [0, 1].
    [[nodiscard]] float weight(const StrategySums& sums) const {
        return weighted ? static_cast<float>(sums.weight()) : 1.0f;
    }
    /// Returns the weight of a connection, [0, 1], from the densities, or ratios of them, that `sums_of_connection`
    /// takes.
    template <typename T>
    [[nodiscard]] T weight(T from_eye, T fewer_of_light, T from_light, T fewer_of_eye) const {
        if (!weighted) return T(1.0f);
        // What floats hold when raised: at 10⁻¹⁰ m a connection is lost in any case.
        constexpr float kLargest = 1e19f;
        return sums_of_connection(raised, min(from_eye, T(kLargest)), fewer_of_light, min(from_light, T(kLargest)),
                                  fewer_of_eye)
            .weight();
    }
};

/// Holds a connection with its weight and ray; a template of its lane type, see core/lane.h.
template <typename T>
struct DiffuseConnection {
    BasicRgb<T> contribution;  ///< if nothing is in the way; black where nothing would be scattered
    T weight;                  ///< that it includes
    ConnectingRay<T> ray;      ///< from the origin of the end on the eye's side, otherwise from that of the light's
};

/// Returns the connection of the ends of both subpaths, which stands for `scale` connections; `merged` is what
/// SubpathDensities::merged says of the eye's end, or 0 if the light has come by no delta.
template <typename T>
[[nodiscard]] inline DiffuseConnection<T> connect_ends(const WeightRule& rule, const BasicDiffuseEnd<T>& eye,
                                                       const BasicDiffuseEnd<T>& light, T merged, T scale) {
    const Imath::Vec3<T> to_light = light.position - eye.position;
    const T squared = length_squared(to_light);
    const Imath::Vec3<T> w = to_light * (1.0f / sqrt(squared));
    const T inverse = 1.0f / squared;
    const T weight = rule.weight(eye.radiance_pdf(w) * light.cosine(-w) * inverse, light.fewer,
                                 light.importance_pdf(-w) * eye.cosine(w) * inverse, eye.fewer + merged);
    const BasicRgb<T> contribution = eye.radiance(w) * light.importance(-w) * (scale * weight * inverse);
    return {select(eye.cosine(w) > T(0.0f) && light.cosine(-w) > T(0.0f), contribution, BasicRgb<T>()), weight,
            ConnectingRay<T>(eye.origin, light.origin)};
}

/// Returns the connection of `eye` to a sample of an evenly shining mesh light; `probability` is that of the choice of
/// the light for `eye`, `choice_ratio` that of both light and triangle for an emission over that for `eye`; emission is
/// aimed by `aim`.
template <typename T>
[[nodiscard]] inline DiffuseConnection<T> connect_to_triangle(const WeightRule& rule, const BasicDiffuseEnd<T>& eye,
                                                              const LightTriangleFront<T>& front,
                                                              const LightTriangleSample<T>& light,
                                                              const BasicRgb<T>& radiance, T probability,
                                                              T choice_ratio, const LightAim& aim) {
    const T pdf = light.pdf_solid_angle * probability;
    T emission_pdf = front.emission_pdf_solid_angle(light.cos_light);
    if (!aim.empty())
        emission_pdf =
            aim.pdf_solid_angle(eye.position + light.wi * light.distance, front.cone(), -light.wi, emission_pdf);
    const T from_light = emission_pdf * eye.cosine(light.wi) / (light.distance * light.distance);
    const T weight = rule.weight(eye.radiance_pdf(light.wi) / pdf, T(1.0f), choice_ratio * from_light, eye.fewer);
    const BasicRgb<T> contribution = eye.radiance(light.wi) * radiance * (weight / pdf);
    return {select(light.pdf_solid_angle > T(0.0f) && eye.cosine(light.wi) > T(0.0f), contribution, BasicRgb<T>()),
            weight, ConnectingRay<T>(eye.origin, light.end)};
}

/// Returns the connection of `light` to the point `lens`, which lies along `w` and sees this end of a light subpath
/// with `importance` per area, 1/m²; `samples_per_path` is MisContext::samples_per_light_path.
template <typename T>
[[nodiscard]] inline DiffuseConnection<T> connect_to_lens(const WeightRule& rule, const BasicDiffuseEnd<T>& light,
                                                          const Imath::Vec3<T>& lens, const Imath::Vec3<T>& w,
                                                          T importance, float samples_per_path) {
    const T from_eye = samples_per_path * importance * light.cosine(w);
    const T weight = rule.weight(from_eye, light.fewer, T(0.0f), T(0.0f));
    return {select(light.cosine(w) > T(0.0f), light.importance(w) * (importance * weight), BasicRgb<T>()), weight,
            ConnectingRay<T>(light.origin, lens)};
}

}  // namespace etendue
