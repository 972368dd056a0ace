// Russian roulette: with which chance paths go on (Arvo and Kirk, "Particle Transport and Image Synthesis", SIGGRAPH
// 1990).
#pragma once

#include "world/world.h"

#include <algorithm>
#include <cmath>

namespace etendue {

/// Rays after which a path counts as long.
inline constexpr int kLongPath = 64;

/// Returns the largest share of paths of `rays` rays that Russian roulette lets live. Lossless ones live on as long as
/// paths usually get; between perfect mirrors they would do so until the longest path allowed.
[[nodiscard]] inline float most_survival(int rays) {
    return rays < kLongPath ? 1.0f : 0.95f;
}

/// Returns the chance with which Russian roulette lets a path of `rays` rays from the eye live, of whose light the
/// share `throughput` arrives. The root spares where all light has come a long way, and little of it arrives, what a
/// chance in proportion would add to the noise; docs/integrators.md has the figures.
template <typename T>
[[nodiscard]] inline T eye_path_survival(const T& throughput, int rays) {
    return min(T(most_survival(rays)), sqrt(throughput));
}

/// Returns the chance with which Russian roulette lets a path of `rays` rays from a light live, of whose light the
/// share `throughput` is left. The root is worse for these paths on as many scenes as it is better
/// (docs/integrators.md).
template <typename T>
[[nodiscard]] inline T light_path_survival(const T& throughput, int rays) {
    return min(T(most_survival(rays)), throughput);
}

/// Holds how many rays of each subpath of a sample Russian roulette spares.
struct SparedRays {
    int of_eye;
    int of_light;
};

/// Shares the rays that Russian roulette spares between both subpaths. There are as many light subpaths as samples, few
/// of which bring much: the smaller half is enough for them.
[[nodiscard]] constexpr SparedRays spared_rays(int roulette_depth) {
    const int of_light = roulette_depth / 2;
    return {roulette_depth - of_light, of_light};
}

/// Returns the rays after which Russian roulette begins where `roulette_depth` is asked for. In bodies nothing else
/// bounds a walk: neither media nor hidden boundaries add edges. Without them, it begins late at most: a path between
/// mirrors would end nowhere.
[[nodiscard]] inline int first_roulette(const World& world, int roulette_depth) {
    constexpr int kLatest = 64 * kLongPath;
    return std::min(roulette_depth, world.traits().has_bodies ? kLongPath : kLatest);
}

/// Bounds the throughput of the branches of trees that are followed in any case from below.
inline constexpr float kSmallestContribution = 1.0f / 1024.0f;

/// Returns the chance with which a branch of Whitted's trees is followed that ends with ray number `rays` and
/// contributes `contribution`. Small ones live on as rarely as they are small, with one and the same contribution:
/// trees stay small, and what they show on average is what they would show in full.
[[nodiscard]] inline float branch_survival(float contribution, int rays) {
    return std::min(most_survival(rays), contribution / kSmallestContribution);
}

}  // namespace etendue
