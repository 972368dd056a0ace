// No structure at all: what the others are measured against, and what says whether they are right.
#pragma once

#include "accelerator/accelerator.h"

#include <span>

namespace etendue {

/// Tests every ray against every triangle.
class BruteForce final : public Accelerator {
  protected:
    void make(std::span<const Triangle> triangles) override { triangles_ = triangles; }
    void trace(RaySearch& search) const override;
    [[nodiscard]] AcceleratorStatistics measure() const override { return {}; }

  private:
    std::span<const Triangle> triangles_;
};

}  // namespace etendue
