// The slopes of a normal map, row by row, and their moments over each texel. For this room only.
#pragma once

#include "core/vec.h"
#include "texture/slope_distribution.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace etendue {

class SlopeRows {
  public:
    /// Prepares for a map of this size, whose normals are `interpolated` between texels where it is magnified.
    SlopeRows(int width, int height, bool interpolated)
        : width_(width), height_(height), offset_(interpolated ? kGaussOffset : 0.0f) {
        held_.fill(-1);
    }

    /// Means over the part of the map that belongs to texel (x, y). `read(y, slopes)` reads a row; the last few are
    /// kept.
    //
    // Between four texels a slope is bilinear and its products are quadratic along each axis: two points a side of
    // Gauss's rule have their mean exactly. Each texel has one of the four points of each square that it is a corner
    // of. Beyond the border slopes stay as they are there.
    template <typename Read>
    [[nodiscard]] SlopeMoments moments(int x, int y, const Read& read) {
        const std::vector<Vec2f>& here = row(y, read);
        const std::vector<Vec2f>* const beside[] = {&row(std::max(0, y - 1), read),
                                                    &row(std::min(height_ - 1, y + 1), read)};
        SlopeMoments sum{};
        for (const int neighbour : {std::max(0, x - 1), std::min(width_ - 1, x + 1)}) {
            const auto along = [&](const std::vector<Vec2f>& slopes) {
                const Vec2f& slope = slopes[static_cast<std::size_t>(x)];
                return slope + (slopes[static_cast<std::size_t>(neighbour)] - slope) * offset_;
            };
            const Vec2f in_row = along(here);
            for (const std::vector<Vec2f>* const other : beside) {
                const SlopeMoments point = moments_of(in_row + (along(*other) - in_row) * offset_);
                for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += 0.25f * point[i];
            }
        }
        return sum;
    }

  private:
    /// Distance of a point of Gauss's rule from the nearer end of a unit segment: (1 - 1/sqrt(3)) / 2.
    static constexpr float kGaussOffset = 0.21132487f;
    static constexpr int kHeld = 8;

    template <typename Read>
    [[nodiscard]] const std::vector<Vec2f>& row(int y, const Read& read) {
        const auto slot = static_cast<std::size_t>(y % kHeld);
        std::vector<Vec2f>& slopes = rows_[slot];
        if (held_[slot] == y) return slopes;
        slopes.resize(static_cast<std::size_t>(width_));
        held_[slot] = -1;
        read(y, slopes);
        held_[slot] = y;
        return slopes;
    }

    int width_;
    int height_;
    float offset_;  ///< how far the points lie from the texel's centre, texels
    std::array<std::vector<Vec2f>, kHeld> rows_;
    std::array<int, kHeld> held_{};
};

}  // namespace etendue
