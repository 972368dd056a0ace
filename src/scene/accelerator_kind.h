// What may find the surfaces that rays meet.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace etendue {

/// Names what finds the surfaces that rays meet: Embree, or for teaching one of the structures of accelerator/.
enum class AcceleratorKind : std::uint8_t { Embree, Bvh, BvhMiddle, BvhCounts, KdTree, Grid, BruteForce };

/// Gives them the names that render.json and the command line have.
inline constexpr std::array<std::pair<std::string_view, AcceleratorKind>, 7> kAcceleratorNames{{
    {"embree", AcceleratorKind::Embree},
    {"bvh", AcceleratorKind::Bvh},
    {"bvh-middle", AcceleratorKind::BvhMiddle},
    {"bvh-counts", AcceleratorKind::BvhCounts},
    {"kdtree", AcceleratorKind::KdTree},
    {"grid", AcceleratorKind::Grid},
    {"brute", AcceleratorKind::BruteForce},
}};

/// Returns the name of `kind`.
[[nodiscard]] constexpr std::string_view accelerator_name(AcceleratorKind kind) {
    return kAcceleratorNames[static_cast<std::size_t>(kind)].first;
}

}  // namespace etendue
