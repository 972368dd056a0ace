// glTF's material with its upper layers: a clear coat over a sheen over the base. The layers pass a share t(w) along w,
// t_avg on average. The base's diffuse part is scaled by t(o) t(i) / t_avg from the outside of a body to its outside,
// and by t(o) t(i) otherwise. A mirror is scaled by min(t(o), t(i)); a rough base lies between the two, by
// `diffuseness` (docs/derivations.md, equation 21).
//
// A white surface in a white furnace reflects between 0.99 and 1 under one layer if its base is a dielectric, 0.975
// under both; metals lose up to 3.6% under a coat, 4.6% under a white sheen, 7% under both, panes 5%. On refracting
// bodies the layers lie outside, and send what they keep of leaving light back inside, where a mirror in place of the
// interface would. Smooth glass loses nothing, rough glass (alpha near 1) up to 4% under a coat, 4.5% under a white
// sheen, 6% under both: the smaller of the shares kept at the two ends of such a path comes back. All other surfaces
// have the layers on both sides.
//
// A coat with a normal of its own over anything but a body is placed by itself (world/coated_scattering.h). White
// dielectrics reflect between 0.95 and 1.01 under it if the normals are less than 90 degrees apart; metals lose
// 10% on average, up to 70% in places, where normal maps of both have slopes of up to 1. The code in this file, with
// which albedos are estimated, loses light below the base's horizon.
#pragma once

#include "bsdf/bsdf_sample.h"
#include "bsdf/clear_coat.h"
#include "bsdf/delta_list.h"
#include "bsdf/dielectric_body.h"
#include "bsdf/metallic_roughness.h"
#include "bsdf/sheen.h"

#include <variant>

namespace etendue {

struct LayeredSurface {
    std::variant<MetallicRoughness, DielectricBody> base;
    Sheen sheen{};
    ClearCoat coat{};
    float passed_average = 1.0f;        ///< t_avg, of what the base's own specular layer lets through too
    float passed_average_plain = 1.0f;  ///< t_avg of the layers alone
    float diffuseness = 0.0f;           ///< how far the base scatters around a direction: its alpha, [0, 1]

    /// Prepares the averages above. `geometric` is the geometric normal in the frame of the base; it matters where the
    /// coat leans.
    [[nodiscard]] static LayeredSurface make(const std::variant<MetallicRoughness, DielectricBody>& base,
                                             const Sheen& sheen, const ClearCoat& coat,
                                             const Vec3f& geometric = {0.0f, 0.0f, 1.0f});

    /// A sheen counts as diffuse.
    [[nodiscard]] BsdfParts evaluate_parts(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    [[nodiscard]] BsdfValue evaluate(const Vec3f& wo, const Vec3f& wi, TransportMode mode) const;
    [[nodiscard]] BsdfSample sample(const Vec3f& wo, float u_lobe, Vec2f u, TransportMode mode) const;
    /// Adds the deltas that light seen along `wo` may have taken, weighted as radiance.
    void add_deltas(const Vec3f& wo, DeltaList& deltas) const;
    [[nodiscard]] bool has_non_delta() const;
    [[nodiscard]] static constexpr bool is_diffuse() { return false; }
    /// Returns false without looking at the base, which may transmit light.
    [[nodiscard]] static constexpr bool only_reflects() { return false; }
    /// Returns the surface of a thin sheet as it is seen from its other side, in the frame turned about y: the coat's
    /// normal is the opposite one there.
    [[nodiscard]] LayeredSurface from_behind() const {
        LayeredSurface turned = *this;
        turned.coat.normal.y = -coat.normal.y;
        return turned;
    }
    /// Returns whether `Scattering` places the coat by itself, since it leans; not over bodies, whose inside gets back
    /// what the coat keeps.
    [[nodiscard]] bool has_leaning_coat() const { return coat.leans() && !is_two_sided(); }
    [[nodiscard]] bool is_two_sided() const { return std::holds_alternative<DielectricBody>(base); }
};

}  // namespace etendue
