// The strategies of bidirectional path tracing (Veach 1997, chapter 10), one function each: the light that a pair of
// subpaths finds by it, and how the other strategies compare.
#pragma once

#include "core/rgb.h"
#include "transport/light.h"
#include "transport/photon_map.h"
#include "transport/strategy_sums.h"
#include "transport/subpath.h"

#include <functional>
#include <optional>

namespace etendue {

/// Holds the light that one strategy finds, as if no other did.
struct StrategyLight {
    Rgb light{};  ///< W/(m² sr), or as FilmLight::value for t = 1
    StrategySums sums{};

    /// Returns the light times the strategy's weight.
    [[nodiscard]] Rgb weighted() const {
        const auto weight = static_cast<float>(sums.weight());
        return weight > 0.0f ? light * weight : Rgb();
    }
};

/// Holds what t = 1 shows on the film.
struct StrategyOnFilm : StrategyLight {
    Vec2f film{0.0f, 0.0f};  ///< as FilmLight::film
};

/// Calls `add` with the light of s = 0: that of each thing that shines where an eye subpath meets `vertex`, at which it
/// arrives with `arrived`.
void light_met(const SubpathSample& sample, const Subpath& eye, const Vertex& vertex, const SubpathDensities& arrived,
               const std::function<void(const StrategyLight&)>& add);

/// Returns the light of s = 1: `eye` is connected to a light that is sampled for it.
[[nodiscard]] StrategyLight light_sampled(const SubpathSample& sample, const SubpathVertex& eye);

/// Returns the light of s > 1 and t > 1: `eye` is connected to `light`.
[[nodiscard]] StrategyLight light_connected(const SubpathSample& sample, const SubpathVertex& eye,
                                            const SubpathVertex& light);

/// Returns the light of s = 1 and t = 1: the lamp of `emission` is seen; nothing if the film does not show it.
[[nodiscard]] std::optional<StrategyOnFilm> lamp_at_lens(const SubpathSample& sample, const Emission& emission);

/// Returns the light of s > 1 and t = 1: `light` is connected to the lens; nothing if the film does not show it.
[[nodiscard]] std::optional<StrategyOnFilm> light_at_lens(const SubpathSample& sample, const SubpathVertex& light);

/// Calls `add` with each photon that `eye`, where subpaths merge, takes light from, and with that light; its sums are
/// those of all other strategies together.
void light_merged(const SubpathSample& sample, const SubpathVertex& eye, const PhotonMap& photons,
                  const std::function<void(const Photon&, const StrategyLight&)>& add);

}  // namespace etendue
