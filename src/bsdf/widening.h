// Lobes made rougher by the spread of the normals that they stand for.
//
// Where slopes vary by sigma² about those of a surface with Beckmann's alpha, whose own vary by alpha² / 2, theirs vary
// by alpha² / 2 + sigma²: alpha'² = alpha² + 2 sigma² (Olano and Baker, "LEAN Mapping", I3D 2010; Dupuy et al., "Linear
// Efficient Antialiased Displacement and Reflectance Mapping", SIGGRAPH Asia 2013). Slopes of GGX have no variance; the
// same is done to its alpha (Tokuyoshi and Kaplanyan, "Improved Geometric Specular Antialiasing", I3D 2019).
#pragma once

#include "bsdf/bsdf.h"
#include "core/vec.h"

#include <algorithm>
#include <cmath>

namespace etendue {

/// `alpha` along a direction in which slopes vary by `variance`, >= 0; [0, 1].
[[nodiscard]] inline float widened_alpha(float alpha, float variance) {
    return std::min(1.0f, std::sqrt(alpha * alpha + 2.0f * variance));
}

/// `bsdf`, a lobe that render.json names, where slopes vary by `variance` along x and y. Metals, which have one alpha,
/// get the mean of both; diffuse lobes stay as they are.
[[nodiscard]] Bsdf widened(const Bsdf& bsdf, Vec2f variance);

}  // namespace etendue
