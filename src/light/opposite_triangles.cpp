#include "light/opposite_triangles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace etendue {

namespace {

/// Cells along each side of a cube around all directions; odd, so that what faces along an axis lies within one.
constexpr int kCells = 9;
/// Directions half way between two axes, as of edges cut at 45 degrees, go to the same one however they are rounded.
constexpr float kClearlyLonger = 1.001f;
/// Between areas of a pair: what is more would only add noise, and in the end is more than floats hold.
constexpr double kMostRatio = 1e4;

/// Where a triangle faces: a cell of three faces of the cube, and whether it is that cell or the opposite one.
struct Facing {
    std::uint32_t cell;
    bool is_opposite;
};

Facing facing(const Vec3f& normal) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(normal[k]) > std::abs(normal[axis]) * kClearlyLonger) axis = k;
    // The signs of both cancel, so that opposite directions have one cell.
    const auto across = [&](int k) {
        const float place = 0.5f + 0.5f * normal[(axis + k) % 3] / normal[axis];
        return std::min(static_cast<int>(place * kCells), kCells - 1);
    };
    return {static_cast<std::uint32_t>((axis * kCells + across(1)) * kCells + across(2)), normal[axis] < 0.0f};
}

struct Entry {
    std::uint32_t side;  ///< twice the cell, and one more for the opposite one
    std::uint32_t triangle;
    double area;
};

}  // namespace

std::vector<std::uint32_t> pair_opposite_triangles(std::span<const Vec3f> normals, std::span<const double> areas) {
    std::vector<std::uint32_t> opposites(normals.size());
    std::iota(opposites.begin(), opposites.end(), 0u);
    std::vector<Entry> entries;
    entries.reserve(normals.size());
    for (std::uint32_t triangle = 0; triangle < normals.size(); ++triangle) {
        // Needles may have an area, but no normal in single precision.
        if (!(areas[triangle] > 0.0) || !(length_squared(normals[triangle]) > 0.0f)) continue;
        const Facing to = facing(normals[triangle]);
        entries.push_back({2 * to.cell + (to.is_opposite ? 1u : 0u), triangle, areas[triangle]});
    }
    std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
        if (a.side != b.side) return a.side < b.side;
        return a.area != b.area ? a.area > b.area : a.triangle < b.triangle;
    });
    for (std::size_t begin = 0; begin < entries.size();) {
        const std::uint32_t cell = entries[begin].side / 2;
        const auto end_of = [&](std::size_t from, std::uint32_t side) {
            while (from < entries.size() && entries[from].side == side) ++from;
            return from;
        };
        const std::size_t middle = end_of(begin, 2 * cell);
        const std::size_t end = end_of(middle, 2 * cell + 1);
        const std::size_t pairs = std::min(middle - begin, end - middle);
        for (std::size_t i = 0; i < pairs; ++i) {
            const Entry& one = entries[begin + i];
            const Entry& other = entries[middle + i];
            if (one.area > kMostRatio * other.area || other.area > kMostRatio * one.area) continue;
            opposites[one.triangle] = other.triangle;
            opposites[other.triangle] = one.triangle;
        }
        begin = end;
    }
    return opposites;
}

}  // namespace etendue
