#include "accelerator/kd_tree.h"

#include "accelerator/clip.h"
#include "accelerator/ray_search.h"
#include "accelerator/surface_area.h"
#include "core/vector_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace etendue {

namespace {

/// Counts the planes that are tried on each axis of nodes with many triangles. Of few, all planes are tried at which a
/// triangle begins or ends, as the cost is least at one of these (Wald and Havran, "On building fast kd-Trees for Ray
/// Tracing, and on doing that in O(N log N)", 2006).
constexpr std::size_t kPlanes = 32;
constexpr std::size_t kFew = 256;
/// Makes it worth its while to cut empty space off.
constexpr double kEmptyBonus = 0.8;
/// Limits the references to triangles, in units of the triangles that there are.
constexpr std::size_t kMostKdReferences = 8;
/// Limits the depth, and so what rays have to remember.
constexpr int kMostDepth = 56;

}  // namespace

struct KdTree::Builder {
    KdTree& tree;
    int most_depth;

    /// A triangle, and the box around what of it is in the node.
    struct Part {
        std::uint32_t triangle;
        Bounds box;
        [[nodiscard]] bool is_below(int axis, float plane) const {
            return box.min[axis] < plane || box.max[axis] == plane;
        }
        [[nodiscard]] bool is_above(int axis, float plane) const { return box.max[axis] > plane; }
    };
    using Parts = std::vector<Part>;

    /// A plane across an axis, and what it would cost.
    struct Split {
        /// Holds the expected work in both children, times the node's half area.
        double work = std::numeric_limits<double>::infinity();
        int axis = 0;
        float plane = 0.0f;
    };

    /// Makes the node of `parts` in `box`, and all below it. The leaves may have `most` references together.
    void add(Parts parts, const Bounds& box, std::size_t most, int depth) {
        tree.depth_ = std::max(tree.depth_, depth);
        const Split split = depth < most_depth ? best_split(parts, box) : Split{};
        const auto count = static_cast<double>(parts.size());
        if (split.work + kStepCost * half_area(box) >= count * half_area(box)) return add_leaf(parts);

        const auto [below_box, above_box] = halves(box, split);
        Parts below = parts_in(parts, below_box, [&](const Part& p) { return p.is_below(split.axis, split.plane); });
        Parts above = parts_in(parts, above_box, [&](const Part& p) { return p.is_above(split.axis, split.plane); });
        const std::size_t sum = below.size() + above.size();
        if (sum > most) return add_leaf(parts);
        parts = {};  // not needed while what is below it is made
        const std::size_t node = tree.nodes_.size();
        tree.nodes_.push_back({split.plane, static_cast<std::uint32_t>(split.axis), 0, 0});
        const auto share = static_cast<std::size_t>(static_cast<double>(most - sum) *
                                                    static_cast<double>(below.size()) / static_cast<double>(sum));
        const std::size_t most_below = below.size() + share;
        const std::size_t most_above = most - most_below;
        add(std::move(below), below_box, most_below, depth + 1);
        tree.nodes_[node].first = static_cast<std::uint32_t>(tree.nodes_.size());
        add(std::move(above), above_box, most_above, depth + 1);
    }

    void add_leaf(const Parts& parts) {
        tree.nodes_.push_back({0.0f, kLeaf, static_cast<std::uint32_t>(tree.references_.size()),
                               static_cast<std::uint32_t>(parts.size())});
        for (const Part& part : parts) tree.references_.push_back(part.triangle);
    }

    static std::pair<Bounds, Bounds> halves(const Bounds& box, const Split& split) {
        std::pair<Bounds, Bounds> both{box, box};
        both.first.max[split.axis] = split.plane;
        both.second.min[split.axis] = split.plane;
        return both;
    }

    /// Returns those of `parts` that are in a child, whose box is `box`, cut to it.
    template <typename IsIn>
    [[nodiscard]] Parts parts_in(const Parts& parts, const Bounds& box, const IsIn& is_in) const {
        Parts kept;
        for (const Part& part : parts) {
            if (!is_in(part)) continue;
            const bool is_whole = part.box.min.x >= box.min.x && part.box.min.y >= box.min.y &&
                                  part.box.min.z >= box.min.z && part.box.max.x <= box.max.x &&
                                  part.box.max.y <= box.max.y && part.box.max.z <= box.max.z;
            if (is_whole)
                kept.push_back(part);
            else if (const auto cut = clipped_bounds(tree.triangles_[part.triangle], Vec3d(box.min), Vec3d(box.max)))
                kept.push_back({part.triangle, *cut});
        }
        return kept;
    }

    static Split best_split(const Parts& parts, const Bounds& box) {
        Split best;
        std::vector<float> begins, ends, planes;
        for (int axis = 0; axis < 3; ++axis) {
            begins.clear();
            ends.clear();
            planes.clear();
            for (const Part& part : parts) {
                begins.push_back(part.box.min[axis]);
                ends.push_back(part.box.max[axis]);
            }
            if (parts.size() <= kFew) {
                planes = begins;
                planes.insert(planes.end(), ends.begin(), ends.end());
                std::ranges::sort(begins);
                std::ranges::sort(ends);
                for (const float plane : planes) {
                    const auto below = std::ranges::lower_bound(begins, plane) - begins.begin();
                    const auto above = ends.end() - std::ranges::upper_bound(ends, plane);
                    try_plane(box, axis, plane, static_cast<double>(below), static_cast<double>(above), best);
                }
            } else {
                try_even_planes(box, axis, begins, ends, best);
            }
        }
        return best;
    }

    /// Tries planes at equal distances, with as many triangles on each side as begin or end there.
    static void try_even_planes(const Bounds& box, int axis, std::span<const float> begins, std::span<const float> ends,
                                Split& best) {
        const float start = box.min[axis];
        const float width = (box.max[axis] - start) / static_cast<float>(kPlanes + 1);
        if (!(width > 0.0f && width < std::numeric_limits<float>::infinity())) return;
        std::array<std::size_t, kPlanes + 1> begun{}, ended{};
        const auto cell = [&](float place) {
            return std::min(static_cast<std::size_t>(std::max(0.0f, (place - start) / width)), kPlanes);
        };
        for (const float place : begins) ++begun[cell(place)];
        for (const float place : ends) ++ended[cell(place)];
        std::size_t below = 0;
        std::size_t above = begins.size();
        for (std::size_t i = 0; i < kPlanes; ++i) {
            below += begun[i];
            above -= ended[i];
            try_plane(box, axis, start + width * static_cast<float>(i + 1), static_cast<double>(below),
                      static_cast<double>(above), best);
        }
    }

    static void try_plane(const Bounds& box, int axis, float plane, double below, double above, Split& best) {
        if (!(plane > box.min[axis] && plane < box.max[axis])) return;
        const auto [below_box, above_box] = halves(box, {0.0, axis, plane});
        double work = half_area(below_box) * below + half_area(above_box) * above;
        if (below == 0.0 || above == 0.0) work *= kEmptyBonus;
        if (work < best.work) best = {work, axis, plane};
    }
};

void KdTree::make(std::span<const Triangle> triangles) {
    triangles_ = triangles;
    if (triangles.empty()) return;
    Builder::Parts parts;
    parts.reserve(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        parts.push_back({i, bounds_of(triangles[i])});
        bounds_.extend(parts.back().box);
    }
    const auto most_depth = static_cast<int>(8.0 + 1.5 * std::log2(static_cast<double>(triangles.size())));
    Builder builder{*this, std::min(most_depth, kMostDepth)};
    builder.add(std::move(parts), bounds_, kMostKdReferences * triangles.size(), 0);
    nodes_.shrink_to_fit();
    references_.shrink_to_fit();
}

void KdTree::trace(RaySearch& search) const {
    if (nodes_.empty()) return;
    struct Waiting {
        SlabTest::Interval part;  ///< part of the ray in the node
        std::uint32_t node;
    };
    std::array<Waiting, kMostDepth + 1> stack;
    std::size_t waiting = 0;
    const SlabTest slabs(search.ray, bounds_);
    const SlabTest::Interval all = slabs.in_box(bounds_, search.t_most());
    if (all.empty()) return;
    Mailbox tested;
    stack[waiting++] = {all, 0};
    while (waiting > 0) {
        auto [part, index] = stack[--waiting];
        // A hit may have come nearer than this node since.
        if (part.near > search.t_most()) continue;
        search.enter();
        while (nodes_[index].axis != kLeaf) {
            const Node& node = nodes_[index];
            const auto axis = static_cast<int>(node.axis);
            const SlabTest::Interval plane = slabs.at_plane(axis, node.plane);
            std::uint32_t first = index + 1;
            std::uint32_t second = node.first;
            if (!slabs.rises(axis)) std::swap(first, second);
            // The ray is in the first child until it has left the plane, and in the second from when it comes to it.
            const SlabTest::Interval before{part.near, std::min(part.far, plane.far)};
            const SlabTest::Interval after{std::max(part.near, plane.near), part.far};
            if (before.empty()) {
                part = after;
                index = second;
            } else {
                if (!after.empty()) stack[waiting++] = {after, second};
                part = before;
                index = first;
            }
            search.enter();
        }
        const Node& leaf = nodes_[index];
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
            const std::uint32_t triangle = references_[leaf.first + i];
            if (tested.is_new(triangle) && search.test(triangles_, triangle)) return;
        }
    }
}

AcceleratorStatistics KdTree::measure() const {
    return {.bytes = vector_bytes(nodes_, references_),
            .nodes = nodes_.size(),
            .references = references_.size(),
            .depth = depth_};
}

}  // namespace etendue
