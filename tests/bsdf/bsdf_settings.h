// The table of lobes and directions over which the tests of this room run. A new lobe adds its rows in
// bsdf_settings.cpp.
#pragma once

#include "bsdf/bsdf.h"

#include <string>
#include <vector>

namespace etendue::test {

struct BsdfSetting {
    std::string name;
    Bsdf bsdf;
    TransportMode mode = TransportMode::Importance;
    /// Cosines to a normal that is not the surface's are in the value, so that importance has a factor of them over
    /// those to the surface's normal, which nothing bounds (Veach 1997, section 5.3.2).
    bool has_tilted_normal = false;
};

/// Every lobe over its parameters. Lobes that tell radiance from importance appear once for each.
[[nodiscard]] std::vector<BsdfSetting> all_bsdf_settings();

/// Those of them that scatter other than by deltas.
[[nodiscard]] std::vector<BsdfSetting> non_delta_bsdf_settings();

/// Directions to look from, at the normal, between and near grazing; from below too if the lobe has two sides.
[[nodiscard]] std::vector<Vec3f> outgoing_directions(const Bsdf& bsdf);

/// Reflects everything.
[[nodiscard]] inline FresnelMetal lossless_mirror() {
    return {.f0 = Rgb(1.0f), .dip = Rgb(0.0f)};
}

/// The unit vector in the x-z plane with cosine `cos_theta` in [-1, 1].
[[nodiscard]] Vec3f direction_at(float cos_theta);

}  // namespace etendue::test
