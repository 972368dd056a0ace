// Russian roulette: with which chance paths go on (Arvo and Kirk, "Particle Transport and Image Synthesis", SIGGRAPH
// 1990).
#pragma once

#include "world/world.h"

#include <algorithm>
#include <cmath>

namespace etendue {

/// Rays after which a path counts as long.
inline constexpr int kLongPath = 64;

/// Tells walks from subpaths, all of whose vertices are kept and connected. The share of long paths that Russian
/// roulette lets go on to ray n falls at least as n^(-1/2) for walks, and at least as 1/n for subpaths.
enum class PathKind { Walk, Subpath };

/// Returns the largest probability with which Russian roulette lets a path of `rays` rays go on, whatever its
/// throughput. The number n of scatterings after which light leaves a dense body that absorbs nothing has a density
/// that falls as n^(-3/2) (Feller, "An Introduction to Probability Theory and Its Applications", vol. 1, III.4). With
/// the probability 1 - 1 / (2n), the weight of a walk grows as the root of n, and its variance as the logarithm of n;
/// with a constant probability, the variance has no bound. Each vertex of a subpath takes time: with 1 - 1 / n, the
/// mean number of vertices has a bound, and the variance grows as the root of the longest path. From kTrappedPath rays
/// on, the probability is constant, so that paths that find no way out end.
[[nodiscard]] inline float most_survival(PathKind kind, int rays) {
    constexpr int kTrappedPath = 1024 * kLongPath;
    if (rays < kLongPath) return 1.0f;
    if (rays >= kTrappedPath) return 0.95f;
    return 1.0f - (kind == PathKind::Walk ? 0.5f : 1.0f) / static_cast<float>(rays);
}

/// Returns the probability with which Russian roulette lets a path from the eye with this `throughput` go on: at most
/// `most`, which `most_survival` returns. The root adds less noise than the throughput itself where all light has come
/// a long way, so that little of it arrives; docs/integrators.md has the figures.
template <typename T>
[[nodiscard]] inline T eye_path_survival(const T& throughput, float most) {
    return min(T(most), sqrt(throughput));
}

/// Returns the probability with which Russian roulette lets a path from a light with this `throughput` go on: at most
/// `most`, which `most_survival` returns. With the root of the throughput, more scenes have more noise than less
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
    return std::min(most_survival(PathKind::Walk, rays), contribution / kSmallestContribution);
}

}  // namespace etendue
