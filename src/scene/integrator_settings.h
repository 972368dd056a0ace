// What is asked of integrators: the only home of their settings. Transport and integrators take them from here.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace etendue {

/// Bounds the lengths of paths. An edge leads from vertex to vertex, so that one edge is a light seen directly and two
/// are direct light on a surface; media, clear surfaces and hidden boundaries add rays and no edges.
struct PathLengths {
    int max_depth = 32;      ///< most edges of a path from camera to light, >= 1
    int min_depth = 1;       ///< least edges of a path that is kept, >= 1
    int roulette_depth = 3;  ///< rays, whatever they lead to, after which Russian roulette may end a path, >= 1

    /// Returns true if a path of `edges` edges is not too short to be kept.
    [[nodiscard]] bool is_long_enough(int edges) const { return edges >= min_depth; }
    /// Returns true if a path of `edges` edges is kept.
    [[nodiscard]] bool keeps(int edges) const { return is_long_enough(edges) && edges <= max_depth; }
};

/// Says how multiple importance sampling weighs strategies against each other.
enum class Heuristic {
    Power,    ///< exponent 2 (Veach 1997, section 9.2.4)
    Balance,  ///< exponent 1
};

/// Names one way in which bidirectional path tracing makes paths: `s` vertices from the light, `t` from the eye, those
/// on the light and on the lens included. Vertices in media count, though they add no edge to a path's length.
struct Strategy {
    int s = 0;
    int t = 0;

    /// Returns true if there is such a strategy: no light hits the lens (t = 0).
    [[nodiscard]] bool exists() const { return s >= 0 && t >= 1 && s + t >= 2; }
    [[nodiscard]] int edges() const { return s + t - 1; }
    friend bool operator==(const Strategy&, const Strategy&) = default;
};

/// Stands for all merges (transport/merging.h), which are no strategies of bidirectional path tracing.
inline constexpr Strategy kMerges{0, 0};
inline constexpr std::string_view kMergesName = "merging";

/// Says which vertices of both subpaths merge.
enum class MergeAt : std::uint8_t {
    Nothing,       ///< none: bidirectional path tracing without merging
    SeenByDeltas,  ///< those that the eye sees by deltas alone, for light that has come by a delta, too
    Everywhere,    ///< all that scatter by more than deltas: the algorithm as it was published
};

/// Says how subpaths merge.
struct MergeSettings {
    MergeAt at = MergeAt::SeenByDeltas;
    double radius = 1.5;  ///< radius of the first sample, in widths of a pixel, [0.01, 100]
    double alpha = 0.75;  ///< [0.1, 1]: the radius shrinks with the power (alpha - 1) / 2 of the number of samples
};

/// Names no integrator: a pilot is to choose one for the scene.
inline constexpr std::string_view kAutoIntegrator = "auto";

struct IntegratorSettings {
    std::string type = "path";  ///< a name from the integrator registry, or kAutoIntegrator
    PathLengths lengths{};
    /// Counts the lights, 1 to 64, that `path` and `direct` sample at each first vertex behind the eye and its mirrors.
    /// With 0, which no user asks for, paths find lights by chance only.
    std::uint32_t light_samples = 1;
    /// Says whether directions are sampled uniformly, not by the BSDF, at surfaces that only reflect and have no delta
    /// lobes. The integrator `hemisphere` sets it.
    bool even_directions = false;
    /// Says how bidirectional path tracing weighs its strategies against each other.
    Heuristic heuristic = Heuristic::Balance;
    /// Names the one strategy of bidirectional path tracing that makes the image, or kMerges; none for all strategies.
    std::optional<Strategy> strategy{};
    /// Says whether bidirectional path tracing weighs `strategy` against the other strategies; if not, `strategy` is
    /// all there is.
    bool weighted = true;
    /// Counts the light vertices of all samples that bidirectional path tracing connects an eye vertex to; 0 for all
    /// light vertices of the eye vertex's own sample.
    int cached_connections = 0;
    /// Says whether images of small lamps in mirrors and glass get samples of their own, which only renders of `path`,
    /// `direct`, `bdpt` and `vcm` take.
    bool lamp_images = true;
    /// Says whether a share of light subpaths is aimed at mirrors and smooth glass.
    bool aimed_emission = true;
    MergeSettings merging{};  ///< says how `vcm` merges
};

}  // namespace etendue
