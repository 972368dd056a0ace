// A ray on its way through a structure, and which boxes it passes: what all structures share.
#pragma once

#include "accelerator/accelerator.h"
#include "accelerator/triangle_test.h"
#include "core/position_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace etendue {

/// Looks for the nearest hit of a ray, or for any, among the triangles that it is handed.
class RaySearch {
  public:
    RaySearch(const Ray& searched, bool any, TriangleFilter* filter, RayWork& work)
        : ray(searched), test_(searched), any_(any), filter_(filter), work_(work) {}

    const Ray& ray;

    /// Counts a box or a cell that the ray goes into.
    void enter() { ++work_.nodes; }
    /// Tests a triangle. Returns true if the search is over.
    bool test(std::span<const Triangle> triangles, std::uint32_t index) {
        ++work_.triangles;
        TriangleHit hit;
        hit.triangle = index;
        if (!test_.meets(triangles[index], hit) || !is_before(hit)) return false;
        if (filter_ != nullptr && !filter_->stops(hit)) return false;
        nearest_ = hit;
        return any_;
    }
    /// Returns how far away a triangle may be to matter still, metres.
    [[nodiscard]] float t_most() const { return std::min(ray.t_max, nearest_.t); }
    [[nodiscard]] const TriangleHit& nearest() const { return nearest_; }

  private:
    /// Returns true if `hit` is nearer than the nearest so far, or as near and of a triangle that comes before it.
    [[nodiscard]] bool is_before(const TriangleHit& hit) const {
        return hit.t < nearest_.t || (hit.t == nearest_.t && hit.triangle < nearest_.triangle);
    }

    TriangleTest test_;
    bool any_;
    TriangleFilter* filter_;
    RayWork& work_;
    TriangleHit nearest_;
};

/// Tells when a ray is in boxes and between planes. Each is taken to reach further by a bound of what rounding can do
/// here (Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013, has the usual relative one), so that no hit is lost because
/// its box was passed by.
class SlabTest {
  public:
    /// `all` is the box around everything that the ray will be asked about.
    SlabTest(const Ray& ray, const Bounds& all) : origin_(ray.origin) {
        for (int i = 0; i < 3; ++i) inverse_[i] = 1.0f / ray.direction[i];
        const float reach = std::max(max_abs(all.min - origin_), max_abs(all.max - origin_));
        margin_ = kPositionError * reach;
    }

    /// Holds the part of a ray, metres along it, that is inside of something; it is empty if the far end is nearer.
    struct Interval {
        float near;
        float far;

        [[nodiscard]] bool empty() const { return near > far; }
    };

    /// Returns the part of the ray from 0 to `t_most` that is in `box`. The ray may run along a face, where 0 times
    /// infinity is no number; `min` and `max` then keep what they have.
    [[nodiscard]] Interval in_box(const Bounds& box, float t_most) const {
        Interval part{0.0f, t_most};
        for (int i = 0; i < 3; ++i) {
            const float low = ((box.min[i] - origin_[i]) - margin_) * inverse_[i];
            const float high = ((box.max[i] - origin_[i]) + margin_) * inverse_[i];
            part.near = std::max(part.near, std::min(low, high));
            part.far = std::min(part.far, std::max(low, high));
        }
        return part;
    }

    /// Returns the part of the ray that is at the plane `axis` = `place`.
    [[nodiscard]] Interval at_plane(int axis, float place) const {
        const float from = place - origin_[axis];
        const float low = (from - margin_) * inverse_[axis];
        const float high = (from + margin_) * inverse_[axis];
        return {std::min(low, high), std::max(low, high)};
    }
    /// Returns true if the ray runs, along `axis`, towards larger coordinates or stays where it is.
    [[nodiscard]] bool rises(int axis) const { return !std::signbit(inverse_[axis]); }

  private:
    Vec3f origin_;
    Vec3f inverse_;
    float margin_;  ///< metres
};

/// Remembers the last triangles that a ray was tested against, where several cells or leaves name the same one.
/// Amanatides and Woo ("A Fast Voxel Traversal Algorithm", 1987) have each triangle remember its last ray; here each
/// ray remembers triangles, so that threads share nothing (Shevtsov, Soupikov and Kapustin, "Highly Parallel Fast
/// KD-tree Construction", 2007).
class Mailbox {
  public:
    Mailbox() { triangles_.fill(kNoTriangle); }

    /// Returns true if `triangle` is none of those remembered, and remembers it.
    [[nodiscard]] bool is_new(std::uint32_t triangle) {
        std::uint32_t& place = triangles_[triangle % kPlaces];
        if (place == triangle) return false;
        place = triangle;
        return true;
    }

  private:
    static constexpr std::size_t kPlaces = 64;
    std::array<std::uint32_t, kPlaces> triangles_;
};

}  // namespace etendue
