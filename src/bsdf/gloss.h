// What part of a surface's reflection is gathered around the direction of a mirror: a rough answer, for choosing
// lights.
#pragma once

#include "bsdf/bsdf.h"

namespace etendue {

struct Gloss {
    float share = 0.0f;  ///< share of all that is reflected, [0, 1]; the rest is taken to be diffuse
    float alpha = 1.0f;  ///< roughness²
};

/// Returns the gloss of `lobe` for light that is scattered to a direction with cosine `cos_o`, [0, 1]. The rougher a
/// lobe is, the more of it counts as diffuse.
[[nodiscard]] Gloss gloss_of(const MetallicRoughness& lobe, float cos_o);
/// Returns the gloss of metallic-roughness and rough metal lobes; all others count as diffuse.
[[nodiscard]] Gloss gloss_of(const Bsdf& bsdf, float cos_o);

}  // namespace etendue
