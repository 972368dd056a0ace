// What plain metallic-roughness surfaces make of the paths of a block: those stand here side by side, since what is
// computed for them is dear.
#pragma once

#include "bsdf/metallic_roughness.h"
#include "core/columns.h"

#include <cstddef>

namespace etendue {

/// About 10 KiB.
struct GlossyLanes {
    RgbColumns base, f0;
    Column metallic, alpha, f90;

    // The surface, as in SurfacePoint.
    Vec3Columns tangent, bitangent, normal, geometric_normal;
    Vec3Columns wo;

    Column u_lobe;
    Vec2Columns u;
    Vec3Columns light_wi;  ///< of the sampled light

    // Towards it.
    RgbColumns f_cos;
    Column pdf;

    // Where the path goes on.
    Vec3Columns next_direction;
    RgbColumns next_weight;
    Column next_pdf;

    /// `lobe` is_plain.
    void set_lobe(std::size_t lane, const MetallicRoughness& lobe) {
        base.set(lane, lobe.base);
        f0.set(lane, lobe.f0);
        metallic.set(lane, lobe.metallic);
        alpha.set(lane, lobe.alpha_x);
        f90.set(lane, lobe.f90);
    }

    /// Lanes [0, count), rounded up.
    void evaluate(std::size_t count);
};

}  // namespace etendue
