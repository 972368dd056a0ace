// What walks from the eye and from the light share.
#pragma once

#include "world/world.h"

#include <algorithm>
#include <cmath>

namespace etendue {

/// Rays after which a path counts as long.
inline constexpr int kLongPath = 64;

/// Most of the paths of `depth` rays that Russian roulette lets live. Lossless ones live on as long as paths usually
/// get; between perfect mirrors they would do so until the longest path allowed.
[[nodiscard]] inline float most_survival(int depth) {
    return depth < kLongPath ? 1.0f : 0.95f;
}

/// Chance with which Russian roulette lets a path of `depth` edges from the eye live, of whose light the share
/// `throughput` arrives. The root spares where all light has come a long way, and little of it arrives, what a chance
/// in proportion would add to the noise; docs/integrators.md has the figures.
template <typename T>
[[nodiscard]] inline T eye_path_survival(const T& throughput, int depth) {
    return min(T(most_survival(depth)), sqrt(throughput));
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
