// What most metallic-roughness surfaces are (metallic_roughness.h): rough, the same along x and y, opaque, without a
// film. For lanes of any width.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/leaning_normal.h"

namespace etendue {

/// A template of its lane type, see core/lane.h. Members as in MetallicRoughness.
template <typename T>
struct PlainMetallicRoughness {
    using Vec = Imath::Vec3<T>;

    BasicRgb<T> base;
    T metallic;
    T alpha;  ///< [kSmoothAlpha, 1]
    BasicRgb<T> f0;
    T f90;

    /// Evaluates towards `wi` for a walk from the eye. Zero where wo or the direction is not above the surface. Of
    /// float and Wide.
    [[nodiscard]] BasicBsdfValue<T> evaluate(const LeaningNormal<T>& leaning, const Vec& wo, const Vec& wi) const;

    struct ValueAndSample {
        BasicBsdfValue<T> value;
        BasicBsdfSample<T> sample;
    };
    /// Evaluates as `evaluate` does and samples by `u_lobe` and `u`, which share what depends on wo alone.
    [[nodiscard]] ValueAndSample evaluate_and_sample(const LeaningNormal<T>& leaning, const Vec& wo, const Vec& wi,
                                                     T u_lobe, const Imath::Vec2<T>& u) const;
};

}  // namespace etendue
