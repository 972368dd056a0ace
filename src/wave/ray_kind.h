// What rays are traced for.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string_view>

namespace etendue {

enum class RayKind : std::uint8_t {
    Primary,        ///< from the camera, the first of an eye path
    Bounce,         ///< the others of an eye path
    Shadow,         ///< to a sampled light
    LightSubpath,   ///< a ray of a path from a light
    Connection,     ///< between a vertex of an eye path and one of a light path
    LightToCamera,  ///< from a light path to the lens
    LampInView,     ///< from the camera, where pixels beside that of the sample ask for lamps
    LampImage,      ///< from the camera and mirrors, for images of lamps
    Count
};

inline constexpr std::size_t kRayKinds = static_cast<std::size_t>(RayKind::Count);

/// Holds the names of the kinds of rays in reports and statistics, in the order of `RayKind`.
inline constexpr std::array<std::string_view, kRayKinds> kRayKindNames{
    "camera", "bounce", "shadow", "light-subpath", "connection", "light-to-camera", "lamp-in-view", "lamp-image"};

/// True of rays whose neighbours go nearly where they do.
[[nodiscard]] constexpr bool is_coherent(RayKind kind) {
    return kind == RayKind::Primary || kind == RayKind::LampInView;
}

/// True of rays that ask whether something is in the way, false of those that look for the nearest surface.
[[nodiscard]] constexpr bool asks_for_occlusion(RayKind kind) {
    return kind == RayKind::Shadow || kind == RayKind::Connection || kind == RayKind::LightToCamera;
}

/// A number for each kind.
struct RaysByKind {
    std::array<std::uint64_t, kRayKinds> counts{};

    [[nodiscard]] std::uint64_t& operator[](RayKind kind) { return counts[static_cast<std::size_t>(kind)]; }
    [[nodiscard]] std::uint64_t operator[](RayKind kind) const { return counts[static_cast<std::size_t>(kind)]; }
    [[nodiscard]] std::uint64_t total() const {
        return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    }
    void add(const RaysByKind& other) {
        for (std::size_t kind = 0; kind < kRayKinds; ++kind) counts[kind] += other.counts[kind];
    }
};

}  // namespace etendue
