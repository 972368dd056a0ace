// A uniform grid: space is cut into equal cells, through which rays step one after the other.
#pragma once

#include "accelerator/accelerator.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// Shares space among equal cells. It has no tree to go down, but cannot follow where triangles are: what is small in a
/// large scene is all in one cell.
class UniformGrid final : public Accelerator {
  protected:
    void make(std::span<const Triangle> triangles) override;
    void trace(RaySearch& search) const override;
    [[nodiscard]] AcceleratorStatistics measure() const override;

  private:
    /// Holds the numbers of a cell on the three axes.
    using Place = std::array<int, 3>;

    /// A cell that a triangle reaches into.
    struct Reference {
        std::uint32_t cell;
        std::uint32_t triangle;
    };

    /// Chooses cells of nearly equal sides, about `cells_wanted` of them.
    void choose_cells(double cells_wanted);
    /// Returns what of the triangles is in which cell; nothing if that is more than `most`.
    [[nodiscard]] std::optional<std::vector<Reference>> find_references(std::size_t most) const;

    [[nodiscard]] double plane(int axis, int number) const { return low_[axis] + number * side_[axis]; }
    [[nodiscard]] int place_of(int axis, double coordinate) const;
    [[nodiscard]] std::size_t cell_count() const;
    [[nodiscard]] std::uint32_t cell_of(const Place& place) const;

    std::span<const Triangle> triangles_;
    Bounds bounds_;
    Vec3d low_{0.0};
    Vec3d side_{0.0};                   ///< sides of a cell, metres
    Place cells_{};                     ///< on each axis
    std::vector<std::uint32_t> first_;  ///< first triangle of each cell in `references_`; one more for the end
    std::vector<std::uint32_t> references_;
};

}  // namespace etendue
