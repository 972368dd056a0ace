// The surface of a closed body of glTF's material whose transmission is less than one, or that is partly metal: a share
// of it is the interface of a dielectric, the rest is opaque and scatters on both of its sides.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/delta_list.h"
#include "bsdf/metallic_roughness.h"
#include "bsdf/rough_dielectric.h"
#include "bsdf/smooth_dielectric.h"

#include <cmath>
#include <variant>

namespace etendue {

/// Returns false if an interface of this index inside over outside neither bends nor mirrors light.
[[nodiscard]] inline bool bends_light(float relative_ior) {
    constexpr float kSameIor = 1e-4f;
    return !(std::abs(relative_ior - 1.0f) < kSameIor);
}

/// The interface of this index inside over outside and of these alphas along x and y, without roughness where both are
/// below kSmoothAlpha. Where the indices are the same there is nothing that could refract, however rough it is.
[[nodiscard]] std::variant<SmoothDielectric, RoughDielectric> make_interface(float ior, Vec2f alpha, const Rgb& tint,
                                                                             const InterfaceFresnel& fresnel);

struct DielectricBody {
    std::variant<SmoothDielectric, RoughDielectric> interface;
    MetallicRoughness opaque{};
    float interface_share = 1.0f;   ///< [0, 1]
    float passed_by_layers = 1.0f;  ///< share of diffuse light from inside that layers on the outside let through

    [[nodiscard]] BsdfParts evaluate_parts(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    /// Adds the deltas that light seen along `wo` may have taken, weighted as radiance.
    void add_deltas(const Vec3f& wo, DeltaList& deltas) const;
    [[nodiscard]] bool has_non_delta() const;
    [[nodiscard]] static constexpr bool is_diffuse() { return false; }
    [[nodiscard]] static constexpr bool is_two_sided() { return true; }
    [[nodiscard]] static constexpr bool only_reflects() { return false; }
};

}  // namespace etendue
