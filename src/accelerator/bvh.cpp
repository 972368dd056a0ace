#include "accelerator/bvh.h"

#include "accelerator/ray_search.h"
#include "accelerator/surface_area.h"
#include "core/vector_bytes.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>

namespace etendue {

namespace {

/// Counts the places on each axis at which the surface area heuristic may split (Wald, "On fast Construction of
/// SAH-based Bounding Volume Hierarchies", 2007).
constexpr std::size_t kBins = 16;
/// Limits a leaf's triangles, where they can be told apart.
constexpr std::size_t kMostInLeaf = 4;
/// Limits the depth of splits by place. Below it halves are taken, so that no leaf is deeper than 32 levels more, and
/// rays need no more memory than `kMostWaiting` entries.
constexpr int kMostPlaceSplits = 60;
constexpr std::size_t kMostWaiting = 96;

int longest_axis(const Bounds& box) {
    const Vec3f size = box.size();
    if (size.x >= size.y && size.x >= size.z) return 0;
    return size.y >= size.z ? 1 : 2;
}

}  // namespace

struct Bvh::Builder {
    Bvh& bvh;
    std::vector<Bounds> boxes;     ///< bounds of each triangle
    std::vector<Vec3f> centers{};  ///< centre of each box

    using Range = std::span<std::uint32_t>;

    /// Makes the node of the triangles `range`, which lie in `order_` from `first` on, and all below it.
    void add(Range range, std::uint32_t first, int depth) {
        bvh.depth_ = std::max(bvh.depth_, depth);
        Bounds box, middle;
        for (const std::uint32_t i : range) {
            box.extend(boxes[i]);
            middle.extend(centers[i]);
        }
        const std::size_t node = bvh.nodes_.size();
        bvh.nodes_.push_back({box, first, static_cast<std::uint32_t>(range.size())});
        const std::size_t left = split(range, box, middle, depth);
        if (left == 0) return;
        add(range.first(left), first, depth + 1);
        bvh.nodes_[node].first = static_cast<std::uint32_t>(bvh.nodes_.size());
        bvh.nodes_[node].count = 0;
        add(range.subspan(left), first + static_cast<std::uint32_t>(left), depth + 1);
    }

    /// Puts the triangles of the first child before the others and returns how many it has; 0 for a leaf. `middle` is
    /// the box around the centers.
    std::size_t split(Range range, const Bounds& box, const Bounds& middle, int depth) const {
        if (range.size() < 2) return 0;
        std::optional<std::size_t> left;
        if (bvh.split_ == BvhSplit::SurfaceArea)
            left = split_by_area(range, box, middle);
        else if (range.size() <= kMostInLeaf)
            left = 0;
        else if (bvh.split_ == BvhSplit::Middle)
            left = split_at(range, longest_axis(middle), middle.center()[longest_axis(middle)]);
        if (left == range.size()) left = 0;
        const bool may_be_leaf = range.size() <= kMostInLeaf;
        if (!left || (*left == 0 && !may_be_leaf) || (*left != 0 && depth >= kMostPlaceSplits))
            return split_in_half(range, middle);
        return *left;
    }

    std::size_t split_in_half(Range range, const Bounds& middle) const {
        const int axis = longest_axis(middle);
        const std::size_t half = range.size() / 2;
        std::ranges::nth_element(range, range.begin() + static_cast<std::ptrdiff_t>(half), {},
                                 [&](std::uint32_t i) { return centers[i][axis]; });
        return half;
    }

    /// Puts triangles whose center is below `place` first, and returns how many there are.
    std::size_t split_at(Range range, int axis, float place) const {
        const auto right =
            std::partition(range.begin(), range.end(), [&](std::uint32_t i) { return centers[i][axis] < place; });
        return static_cast<std::size_t>(right - range.begin());
    }

    struct Bin {
        Bounds box;
        std::size_t count = 0;
    };

    /// Splits where the expected work is least, by bins of the centers. Returns 0 if it is less in a leaf, and nothing
    /// if the centers are all in one place.
    std::optional<std::size_t> split_by_area(Range range, const Bounds& box, const Bounds& middle) const {
        const auto count = static_cast<double>(range.size());
        double least = std::numeric_limits<double>::infinity();
        int best_axis = 0;
        float best_place = 0.0f;
        for (int axis = 0; axis < 3; ++axis) {
            const float start = middle.min[axis];
            const float width = (middle.max[axis] - start) / static_cast<float>(kBins);
            if (!(width > 0.0f && width < std::numeric_limits<float>::infinity())) continue;
            std::array<Bin, kBins> bins{};
            for (const std::uint32_t i : range) {
                const auto bin = static_cast<std::size_t>((centers[i][axis] - start) / width);
                bins[std::min(bin, kBins - 1)].box.extend(boxes[i]);
                ++bins[std::min(bin, kBins - 1)].count;
            }
            // From the right: the work in all bins from each on.
            std::array<double, kBins> right{};
            Bin sum;
            for (std::size_t i = kBins; i-- > 1;) {
                sum.box.extend(bins[i].box);
                sum.count += bins[i].count;
                right[i] = half_area(sum.box) * static_cast<double>(sum.count);
            }
            sum = {};
            for (std::size_t i = 1; i < kBins; ++i) {
                sum.box.extend(bins[i - 1].box);
                sum.count += bins[i - 1].count;
                const double work = half_area(sum.box) * static_cast<double>(sum.count) + right[i];
                if (sum.count == 0 || sum.count == range.size() || work >= least) continue;
                least = work;
                best_axis = axis;
                best_place = start + width * static_cast<float>(i);
            }
        }
        if (least == std::numeric_limits<double>::infinity()) return std::nullopt;
        const double area = half_area(box);
        if (range.size() <= kMostInLeaf && count * area <= kStepCost * area + least) return 0;
        return split_at(range, best_axis, best_place);
    }
};

void Bvh::make(std::span<const Triangle> triangles) {
    triangles_ = triangles;
    order_.resize(triangles.size());
    std::iota(order_.begin(), order_.end(), 0u);
    if (triangles.empty()) return;
    Builder builder{*this, {}};
    builder.boxes.reserve(triangles.size());
    builder.centers.reserve(triangles.size());
    for (const Triangle& triangle : triangles) {
        builder.boxes.push_back(bounds_of(triangle));
        // Halves first, as sums of large coordinates are none.
        builder.centers.push_back(builder.boxes.back().min * 0.5f + builder.boxes.back().max * 0.5f);
    }
    nodes_.reserve(triangles.size());
    builder.add(order_, 0, 0);
    nodes_.shrink_to_fit();
}

void Bvh::trace(RaySearch& search) const {
    if (nodes_.empty()) return;
    struct Waiting {
        float near;
        std::uint32_t node;
    };
    std::array<Waiting, kMostWaiting> stack;
    std::size_t waiting = 0;
    const SlabTest slabs(search.ray, nodes_[0].box);
    const SlabTest::Interval all = slabs.in_box(nodes_[0].box, search.t_most());
    if (all.empty()) return;
    stack[waiting++] = {all.near, 0};
    while (waiting > 0) {
        const Waiting next = stack[--waiting];
        // A hit may have come nearer since.
        if (next.near > search.t_most()) continue;
        search.enter();
        const Node& node = nodes_[next.node];
        for (std::uint32_t i = 0; i < node.count; ++i)
            if (search.test(triangles_, order_[node.first + i])) return;
        if (node.count > 0) continue;
        std::uint32_t first = next.node + 1;
        std::uint32_t second = node.first;
        SlabTest::Interval in_first = slabs.in_box(nodes_[first].box, search.t_most());
        SlabTest::Interval in_second = slabs.in_box(nodes_[second].box, search.t_most());
        if (in_second.near < in_first.near) {
            std::swap(first, second);
            std::swap(in_first, in_second);
        }
        // The nearer child is on top.
        if (!in_second.empty()) stack[waiting++] = {in_second.near, second};
        if (!in_first.empty()) stack[waiting++] = {in_first.near, first};
    }
}

AcceleratorStatistics Bvh::measure() const {
    return {
        .bytes = vector_bytes(nodes_, order_), .nodes = nodes_.size(), .references = order_.size(), .depth = depth_};
}

}  // namespace etendue
