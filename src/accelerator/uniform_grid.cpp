#include "accelerator/uniform_grid.h"

#include "accelerator/clip.h"
#include "accelerator/ray_search.h"
#include "core/vector_bytes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue {

namespace {

/// Sets about how many cells there are to a triangle. More are passed in less time each, until there is nothing left in
/// most of them.
constexpr double kCellsPerTriangle = 4.0;
constexpr double kMostCellsOnAxis = 1024.0;
/// Limits the references to triangles, in units of the triangles that there are, and of a small scene in all.
constexpr std::size_t kMostGridReferences = 16;
constexpr std::size_t kFewGridReferences = 4096;
/// Makes cells reach into each other by this share of the largest side of the grid, far more than the steps of a ray
/// are rounded by, so that a ray that passes where cells meet finds all that is there in either.
constexpr double kOverlap = 1e-9;
/// Stands for the smallest extent of a scene, metres, so that nothing is divided by zero.
constexpr double kLeastSize = 1e-60;
/// Is more than the relative error of a distance in single precision.
constexpr double kDistanceError = 1e-6;

}  // namespace

void UniformGrid::choose_cells(double cells_wanted) {
    const Vec3d size = Vec3d(bounds_.max) - Vec3d(bounds_.min);
    const double largest = std::max({size.x, size.y, size.z, kLeastSize});
    // A flat scene has one layer of cells.
    Vec3d thick;
    for (int axis = 0; axis < 3; ++axis) thick[axis] = std::max(size[axis], 1e-3 * largest);
    const double side = std::cbrt(thick.x / largest * (thick.y / largest) * (thick.z / largest) / cells_wanted);
    low_ = Vec3d(bounds_.min);
    for (int axis = 0; axis < 3; ++axis) {
        const double count = std::clamp(std::floor(size[axis] / largest / side), 1.0, kMostCellsOnAxis);
        cells_[static_cast<std::size_t>(axis)] = static_cast<int>(count);
        side_[axis] = size[axis] / count;
    }
}

int UniformGrid::place_of(int axis, double coordinate) const {
    const int last = cells_[static_cast<std::size_t>(axis)] - 1;
    const double place = (coordinate - low_[axis]) / side_[axis];
    // Of a grid without thickness this is no number.
    return place > 0.0 ? static_cast<int>(std::min(place, static_cast<double>(last))) : 0;
}

std::size_t UniformGrid::cell_count() const {
    return static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]) *
           static_cast<std::size_t>(cells_[2]);
}

std::uint32_t UniformGrid::cell_of(const Place& place) const {
    return static_cast<std::uint32_t>((place[2] * cells_[1] + place[1]) * cells_[0] + place[0]);
}

std::optional<std::vector<UniformGrid::Reference>> UniformGrid::find_references(std::size_t most) const {
    std::vector<Reference> references;
    const Vec3d size = Vec3d(bounds_.max) - Vec3d(bounds_.min);
    const Vec3d overlap(kOverlap * std::max({size.x, size.y, size.z}));
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        const Bounds box = bounds_of(triangles_[i]);
        Place from, to;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<int>(axis);
            from[axis] = place_of(a, static_cast<double>(box.min[a]) - overlap[a]);
            to[axis] = place_of(a, static_cast<double>(box.max[a]) + overlap[a]);
        }
        const bool is_in_one = from == to;
        Place at;
        for (at[2] = from[2]; at[2] <= to[2]; ++at[2])
            for (at[1] = from[1]; at[1] <= to[1]; ++at[1])
                for (at[0] = from[0]; at[0] <= to[0]; ++at[0]) {
                    const Vec3d low(plane(0, at[0]), plane(1, at[1]), plane(2, at[2]));
                    if (!is_in_one && !clipped_bounds(triangles_[i], low - overlap, low + side_ + overlap)) continue;
                    if (references.size() == most) return std::nullopt;
                    references.push_back({cell_of(at), i});
                }
    }
    return references;
}

void UniformGrid::make(std::span<const Triangle> triangles) {
    triangles_ = triangles;
    if (triangles.empty()) return;
    for (const Triangle& triangle : triangles) bounds_.extend(bounds_of(triangle));
    double cells_wanted = kCellsPerTriangle * static_cast<double>(triangles.size());
    std::optional<std::vector<Reference>> found;
    while (!found) {
        choose_cells(cells_wanted);
        found = find_references(kMostGridReferences * triangles.size() + kFewGridReferences);
        cells_wanted /= 8.0;  // where large triangles lie in very many cells, half as many on each axis
    }
    // Sorted by cells, in two passes.
    first_.assign(cell_count() + 1, 0);
    for (const Reference& reference : *found) ++first_[reference.cell + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    references_.resize(found->size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const Reference& reference : *found) references_[next[reference.cell]++] = reference.triangle;
}

// Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing" (1987). The distance to each next plane is
// computed from the plane, and not added up, so that errors do not add up either.
void UniformGrid::trace(RaySearch& search) const {
    if (references_.empty()) return;
    const SlabTest::Interval inside = SlabTest(search.ray, bounds_).in_box(bounds_, search.t_most());
    if (inside.empty()) return;
    const Vec3d origin(search.ray.origin);
    const Vec3d direction(search.ray.direction);
    Place at, step;
    std::array<double, 3> leaves;  // how far along the ray its cell ends on each axis, metres
    const auto set_end = [&](std::size_t axis) {
        const auto a = static_cast<int>(axis);
        leaves[axis] = step[axis] == 0 ? std::numeric_limits<double>::infinity()
                                       : (plane(a, at[axis] + (step[axis] > 0)) - origin[a]) / direction[a];
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<int>(axis);
        step[axis] = direction[a] > 0.0 ? 1 : direction[a] < 0.0 ? -1 : 0;
        at[axis] = place_of(a, origin[a] + direction[a] * static_cast<double>(inside.near));
        set_end(axis);
    }
    Mailbox tested;
    for (;;) {
        search.enter();
        const std::uint32_t cell = cell_of(at);
        for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i)
            if (tested.is_new(references_[i]) && search.test(triangles_, references_[i])) return;
        const auto axis = static_cast<std::size_t>(std::ranges::min_element(leaves) - leaves.begin());
        // What lies beyond this cell is further away than what was met in it.
        if (step[axis] == 0 || leaves[axis] > (1.0 + kDistanceError) * static_cast<double>(search.t_most())) return;
        at[axis] += step[axis];
        if (at[axis] < 0 || at[axis] >= cells_[axis]) return;
        set_end(axis);
    }
}

AcceleratorStatistics UniformGrid::measure() const {
    return {.bytes = vector_bytes(first_, references_), .nodes = cell_count(), .references = references_.size()};
}

}  // namespace etendue
