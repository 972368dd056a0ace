// The parts of a wave's work that a profile tells apart.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace etendue {

/// Names the stages of a wave, in their order.
enum class Stage : std::uint8_t {
    Generate,       ///< camera rays, and where light paths begin
    Numbers,        ///< random numbers of a bounce
    Intersect,      ///< nearest surfaces
    HitSetup,       ///< points on surfaces with their frames, normal maps included; what the first hits show; media
    Emission,       ///< light that rays meet, with its MIS weight: lamps and the environment
    Textures,       ///< textures looked up, and the lobes that they ask for
    LightSampling,  ///< points on lights
    Material,       ///< lobes evaluated and sampled
    Mis,            ///< weights of samples and connections, and the rays that will decide whether they count
    Roulette,       ///< paths ended, moved and left behind
    Occluded,       ///< whether something is in the way
    Splat,          ///< light that arrived added to samples and put on the film
    Film,           ///< samples added to pixels
    Count
};

inline constexpr std::size_t kStages = static_cast<std::size_t>(Stage::Count);

/// Holds the names of the stages in reports, in the order of `Stage`.
inline constexpr std::array<std::string_view, kStages> kStageNames{
    "generate", "random numbers", "intersect",      "hit set-up",
    "emission", "textures",       "light sampling", "material evaluation",
    "MIS",      "roulette",       "occluded",       "splat",
    "film"};

}  // namespace etendue
