// A bounding volume hierarchy: a tree of boxes, each of which holds those below it.
#pragma once

#include "accelerator/accelerator.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Says how a node's triangles are shared among its two children.
enum class BvhSplit {
    SurfaceArea,  ///< where a ray is expected to have the least work
    Middle,       ///< by the middle of their centers, on the longest axis
    EqualCounts,  ///< by half of their number, on the longest axis
};

/// Shares objects among boxes. A triangle is in one leaf only, and the boxes of two leaves may overlap.
class Bvh final : public Accelerator {
  public:
    explicit Bvh(BvhSplit split) : split_(split) {}

  protected:
    void make(std::span<const Triangle> triangles) override;
    void trace(RaySearch& search) const override;
    [[nodiscard]] AcceleratorStatistics measure() const override;

  private:
    /// Is a leaf, or an inner node, whose first child is the next node.
    struct Node {
        Bounds box;
        std::uint32_t first;  ///< first triangle of a leaf in `order_`; of an inner node, the second child
        std::uint32_t count;  ///< number of a leaf's triangles; 0 for an inner node
    };
    struct Builder;

    BvhSplit split_;
    std::span<const Triangle> triangles_;
    std::vector<Node> nodes_;           ///< the root first, and each before all that is below it
    std::vector<std::uint32_t> order_;  ///< triangles, leaf by leaf
    int depth_ = 0;
};

}  // namespace etendue
