// A kd-tree: space is cut in two by a plane across an axis, and each half again.
#pragma once

#include "accelerator/accelerator.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Shares space among leaves, which do not overlap. A triangle is in all leaves that it reaches into, so rays remember
/// which triangles they were tested against; and rays stop at the first leaf that has a hit.
class KdTree final : public Accelerator {
  protected:
    void make(std::span<const Triangle> triangles) override;
    void trace(RaySearch& search) const override;
    [[nodiscard]] AcceleratorStatistics measure() const override;

  private:
    static constexpr std::uint32_t kLeaf = 3;

    /// Is a leaf, or an inner node, whose child below the plane is the next node.
    struct Node {
        float plane;         ///< coordinate on the axis
        std::uint32_t axis;  ///< 0, 1, 2, or kLeaf
        /// Holds the first triangle of a leaf in `references_`; of an inner node, the child above the plane.
        std::uint32_t first;
        std::uint32_t count;  ///< number of a leaf's triangles
    };
    struct Builder;

    std::span<const Triangle> triangles_;
    Bounds bounds_;
    std::vector<Node> nodes_;                ///< the root first, and each before all that is below it
    std::vector<std::uint32_t> references_;  ///< triangles, leaf by leaf
    int depth_ = 0;
};

}  // namespace etendue
