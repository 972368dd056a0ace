// Russian roulette: with which chance paths go on (Arvo and Kirk, "Particle Transport and Image Synthesis", SIGGRAPH
// 1990).
#pragma once

#include "world/world.h"

#include <algorithm>
#include <cmath>

namespace etendue {

/// Rays after which a path counts as long.
inline constexpr int kLongPath = 64;

/// Says how fast the largest share of living paths falls: to the power of 1/2 where a path is a walk, to the first
/// power where it is a subpath, all of whose vertices are kept and connected.
enum class LongPaths { Walk, Subpath };

/// Returns the largest share of paths of `rays` rays that Russian roulette lets live, however much light is left.
/// The number n of scatterings after which light leaves a dense body that absorbs nothing has a density that falls as
/// n^(-3/2) (Feller, "An Introduction to Probability Theory and Its Applications", vol. 1, III.4). Shares of
/// 1 - 1 / (2n) let the weight of what lives grow as the root of n, so that its variance grows as a logarithm; with one
/// constant share, the variance has no bound. Subpaths pay for each vertex: with shares of 1 - 1 / n the mean number of
/// vertices does not grow, and the variance grows as the root of the longest walk. Paths that find no way out are ended
/// soon after kLongestFair rays.
[[nodiscard]] inline float most_survival(LongPaths paths, int rays) {
    constexpr int kLongestFair = 1024 * kLongPath;
    if (rays < kLongPath) return 1.0f;
    if (rays >= kLongestFair) return 0.95f;
    return 1.0f - (paths == LongPaths::Walk ? 0.5f : 1.0f) / static_cast<float>(rays);
}

/// Returns the chance with which Russian roulette lets a path live that may go on with the chance `most`, of whose
/// light the share `throughput` arrives at the eye. The root spares where all light has come a long way, and little of
/// it arrives, what a chance in proportion would add to the noise; docs/integrators.md has the figures.
template <typename T>
[[nodiscard]] inline T eye_path_survival(const T& throughput, float most) {
    return min(T(most), sqrt(throughput));
}

/// Returns the chance with which Russian roulette lets a path from a light live that may go on with the chance `most`,
/// of whose light the share `throughput` is left. The root is worse for these paths on as many scenes as it is better
/// (docs/integrators.md).
template <typename T>
[[nodiscard]] inline T light_path_survival(const T& throughput, float most) {
    return min(T(most), throughput);
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
    return std::min(most_survival(LongPaths::Walk, rays), contribution / kSmallestContribution);
}

}  // namespace etendue
