// The letters of light paths: what happens at the camera, at each vertex, and at the light.
//
// A path is a word of events, here always from the eye to the light: the camera, a scattering for each vertex, a source
// (Heckbert, "Adaptive Radiosity Textures for Bidirectional Ray Tracing", 1990, whose letters are L, D, S and E; the
// kinds are those of Open Shading Language's light path expressions).
#pragma once

#include <cstddef>
#include <cstdint>

namespace etendue {

/// Names what a vertex does to light. Diffuse: to all sides; glossy: around a direction; singular: into single
/// directions. Volume: what a medium scatters.
enum class ScatterEvent : std::uint8_t {
    ReflectDiffuse,
    ReflectGlossy,
    ReflectSingular,
    TransmitDiffuse,
    TransmitGlossy,
    TransmitSingular,
    Volume
};
inline constexpr std::size_t kScatterEvents = 7;

/// Names what light comes from.
enum class SourceEvent : std::uint8_t {
    Surface,      ///< one that emits
    Lamp,         ///< without a surface: point, spot, directional
    Environment,  ///< from infinitely far away
};
inline constexpr std::size_t kSourceEvents = 3;

/// Kinds of events, labels apart, as bits: scatterings, sources, the camera.
using EventKinds = std::uint32_t;

[[nodiscard]] constexpr EventKinds kind_of(ScatterEvent event) {
    return 1u << static_cast<unsigned>(event);
}
[[nodiscard]] constexpr EventKinds kind_of(SourceEvent event) {
    return 1u << (kScatterEvents + static_cast<unsigned>(event));
}
inline constexpr EventKinds kCameraKind = 1u << (kScatterEvents + kSourceEvents);
inline constexpr EventKinds kAllScatterKinds = (1u << kScatterEvents) - 1;
inline constexpr EventKinds kAllSourceKinds = ((1u << kSourceEvents) - 1) << kScatterEvents;
inline constexpr EventKinds kAllKinds = kAllScatterKinds | kAllSourceKinds | kCameraKind;

}  // namespace etendue
