// What walks from the eye and from the light share.
#pragma once

#include "world/world.h"

namespace etendue {

/// Rays after which a path counts as long.
inline constexpr int kLongPath = 64;

/// Most of the paths of `depth` edges that Russian roulette lets live. Lossless ones live on as long as paths usually
/// get; between perfect mirrors they would do so until the longest path allowed.
[[nodiscard]] inline float most_survival(int depth) {
    return depth < kLongPath ? 1.0f : 0.95f;
}

/// Share of light that arrives from `distance` metres away.
[[nodiscard]] inline Rgb transmittance(const World& world, const Interior& interior, float distance) {
    const HomogeneousMedium* medium = world.medium(interior);
    return medium != nullptr ? medium->transmittance(distance) : Rgb(1.0f);
}

/// Where a direction leads from a boundary.
[[nodiscard]] inline const Interior& beyond(const Crossing& crossing, const SurfacePoint& point,
                                            const Vec3f& direction) {
    return dot(direction, point.geometric_normal) > 0.0f ? crossing.outside : crossing.inside;
}

}  // namespace etendue
