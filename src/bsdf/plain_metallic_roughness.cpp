#include "bsdf/plain_metallic_roughness.h"

#include "bsdf/metallic_roughness_layers.h"
#include "core/wide.h"
#include "sampling/warp.h"

namespace etendue {

namespace {

template <typename T>
MetallicRoughnessLayers<T> plain_layers_of(const PlainMetallicRoughness<T>& lobe, const Imath::Vec3<T>& wo) {
    return {BasicGgx<T>::isotropic(lobe.alpha),
            false,
            {lobe.f0, lobe.f90, {}},
            {lobe.base, T(1.0f), {}},
            lobe.metallic,
            {lobe.base * (1.0f - lobe.metallic), {}, {}},
            wo};
}

template <typename T>
BasicBsdfValue<T> evaluate_lanes(const MetallicRoughnessLayers<T>& layers, const LeaningNormal<T>& leaning,
                                 const Imath::Vec3<T>& wo, const Imath::Vec3<T>& wi) {
    const BasicBsdfValue<T> value =
        leaning.evaluate_for_eye(wi, [&](const Imath::Vec3<T>& w) { return layers.evaluate_above(wo, w); }).sum();
    const auto scatters = wo.z > T(0.0f) && leaning.side(wi) > T(0.0f);
    return {select<T>(scatters, value.f_cos, BasicRgb<T>()), select(scatters, value.pdf_solid_angle, T(0.0f))};
}

template <typename T>
BasicBsdfSample<T> sample_lanes(const MetallicRoughnessLayers<T>& layers, const LeaningNormal<T>& leaning,
                                const Imath::Vec3<T>& wo, T u_lobe, const Imath::Vec2<T>& u) {
    const Imath::Vec3<T> chosen = choose(
        u_lobe < layers.p_diffuse, [&] { return square_to_cosine_hemisphere(u); },
        [&] { return layers.sample_around(wo, u_lobe, layers.p_diffuse, layers.p_specular, u); });
    const Imath::Vec3<T> wi = leaning.kept_on_side(chosen);
    const BasicBsdfValue<T> value = evaluate_lanes(layers, leaning, wo, wi);
    const auto scatters = chosen.z > T(0.0f) && value.pdf_solid_angle > T(0.0f);
    return {.wi = wi,
            .weight = select<T>(scatters, value.f_cos / value.pdf_solid_angle, BasicRgb<T>()),
            .pdf_solid_angle = value.pdf_solid_angle};
}

}  // namespace

template <typename T>
BasicBsdfValue<T> PlainMetallicRoughness<T>::evaluate(const LeaningNormal<T>& leaning, const Vec& wo,
                                                      const Vec& wi) const {
    return evaluate_lanes(plain_layers_of(*this, wo), leaning, wo, wi);
}

template <typename T>
auto PlainMetallicRoughness<T>::evaluate_and_sample(const LeaningNormal<T>& leaning, const Vec& wo, const Vec& wi,
                                                    T u_lobe, const Imath::Vec2<T>& u) const -> ValueAndSample {
    const MetallicRoughnessLayers<T> layers = plain_layers_of(*this, wo);
    return {evaluate_lanes(layers, leaning, wo, wi), sample_lanes(layers, leaning, wo, u_lobe, u)};
}

template struct PlainMetallicRoughness<float>;
template struct PlainMetallicRoughness<Wide>;

}  // namespace etendue
