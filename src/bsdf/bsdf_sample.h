// What every lobe speaks in. All directions are unit vectors in the local frame (z along the shading normal) and point
// away from the surface: wo to where the walk comes from, wi to where it goes on.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"

namespace etendue {

/// Names what a walk carries. Refraction scales radiance by the squared ratio of the indices but leaves particles that
/// carry importance alone (Veach 1997, section 5.2).
enum class TransportMode {
    Radiance,    ///< walks from the eye: the weight is f(wi -> wo)
    Importance,  ///< walks from a light: the weight is f(wo -> wi)
};

/// A lobe's value for a pair of directions. Delta parts of a lobe are not in it.
/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicBsdfValue {
    BasicRgb<T> f_cos;        ///< BSDF times |cos theta_i|, 1/sr
    T pdf_solid_angle{0.0f};  ///< density with which `sample` picks wi given wo, non-delta parts only
};
using BsdfValue = BasicBsdfValue<float>;

/// A value in two parts: what scatters like a diffuse surface, and what does so around a direction.
/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicBsdfParts {
    BasicRgb<T> diffuse;
    BasicRgb<T> specular;
    T pdf_solid_angle{0.0f};

    [[nodiscard]] BasicBsdfValue<T> sum() const { return {diffuse + specular, pdf_solid_angle}; }
};
using BsdfParts = BasicBsdfParts<float>;

/// A sampled direction. An all-zero `weight` means that nothing was scattered.
/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicBsdfSample {
    Imath::Vec3<T> wi{T(0.0f)};
    BasicRgb<T> weight;       ///< f |cos theta_i| / pdf; for a delta part, its albedo over its probability
    T pdf_solid_angle{0.0f};  ///< density of all non-delta parts together, 1/sr; not meaningful if `is_delta`
    bool is_delta = false;    ///< true of all lanes or of none
    bool is_transmission = false;
    T eta{1.0f};  ///< index on wi's side over the index on wo's side, for Russian roulette
    /// The density of a delta's way back, from wi, over that of this way. Lobes count the probabilities of choosing it;
    /// `Scattering` also counts how solid angles change.
    T reverse_ratio{1.0f};
};
using BsdfSample = BasicBsdfSample<float>;

/// Where `w` points in the frame of the surface's other side, which is turned about y.
[[nodiscard]] inline Vec3f turned_about_y(const Vec3f& w) {
    return {-w.x, w.y, -w.z};
}

[[nodiscard]] inline Vec3f mirror_direction(const Vec3f& wo) {
    return {-wo.x, -wo.y, wo.z};
}

}  // namespace etendue
