// Finds surfaces that lie within rounding of each other.
#pragma once

#include "core/bounds.h"
#include "core/parallel.h"
#include "core/vec.h"
#include "world/placed_triangle.h"
#include "world/world_data.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace etendue {

struct Slot {
    std::uint32_t index = 0;
    std::uint32_t instance = 0;
    std::uint32_t geometry = 0;
};

/// How surfaces of two slots touch.
struct Touch {
    static constexpr std::size_t kMostPlaces = 4096;

    double distance = 0.0;       ///< metres within which they count as one, the largest of their triangles
    int alike = 0;               ///< pairs of triangles whose fronts are on one side, less those that face each other
    std::vector<Bounds> places;  ///< where they do, each of a pair of triangles; all in one box if they are more
};

struct Touches {
    /// Holds touches by pairs of slots, of which the first is the lower, or the same.
    std::map<std::pair<std::uint32_t, std::uint32_t>, Touch> pairs;
    /// False if there was more to look at than is sensible: what is not listed may touch, too.
    bool is_complete = true;
};

/// Returns how many triangles of `geometry` may touch others. A disk counts as the one around it; shapes that are not
/// flat have none.
[[nodiscard]] std::uint32_t touching_triangles(const Geometry& geometry);

/// Triangles that are looked at in all, some seconds of it.
inline constexpr std::size_t kMostWorkForTouches = std::size_t{1} << 24;

/// All that touch of which one is an emitter, the boundary of a body or a thin sheet: for others it does not matter.
/// Needs materials, geometry and the BVH in `data`.
[[nodiscard]] Touches find_touches(const WorldData& data, const ThreadPool& threads,
                                   std::size_t most_work = kMostWorkForTouches);

}  // namespace etendue
