// Lambertian reflection.
//
// f = albedo / pi. Sampled by the cosine; every sample has weight `albedo`. Example: chalk, matte paint.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/delta_list.h"
#include "sampling/warp.h"

namespace etendue {

/// A template of its lane type, see core/lane.h.
template <typename T>
struct BasicDiffuse {
    BasicRgb<T> albedo{T(0.5f)};  ///< reflected share per channel, [0, 1]

    [[nodiscard]] BasicBsdfValue<T> evaluate(const Imath::Vec3<T>& wo, const Imath::Vec3<T>& wi, TransportMode) const {
        const T pdf = select(wo.z > T(0.0f), cosine_hemisphere_pdf_solid_angle(wi), T(0.0f));
        return {albedo * pdf, pdf};
    }
    [[nodiscard]] BasicBsdfSample<T> sample(const Imath::Vec3<T>& wo, float /*u_lobe*/, const Imath::Vec2<T>& u,
                                            TransportMode) const {
        const Imath::Vec3<T> wi = square_to_cosine_hemisphere(u);
        const T scatters = select(wo.z > T(0.0f) && wi.z > T(0.0f), T(1.0f), T(0.0f));
        return {.wi = wi, .weight = albedo * scatters, .pdf_solid_angle = cosine_hemisphere_pdf_solid_angle(wi)};
    }
    /// Adds nothing: none of its samples are deltas.
    void add_deltas(const Vec3f&, DeltaList&) const {}
    [[nodiscard]] bool has_non_delta() const { return true; }
    [[nodiscard]] static constexpr bool is_diffuse() { return true; }
    [[nodiscard]] static constexpr bool is_two_sided() { return false; }
    [[nodiscard]] static constexpr bool only_reflects() { return true; }
};

using Diffuse = BasicDiffuse<float>;

}  // namespace etendue
