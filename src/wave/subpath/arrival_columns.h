// Densities with which the subpaths of a block arrive where their rays have hit.
#pragma once

#include "core/columns.h"
#include "transport/mis.h"

#include <array>
#include <cstddef>

namespace etendue {

/// Holds densities of a block of subpaths in columns of doubles, about 5 KiB.
class ArrivalColumns {
  public:
    /// Sets what DepartingDensities::arrive takes in `lane`; `departing` is not from infinity.
    void set(std::size_t lane, const DepartingDensities& departing, double squared_distance, double cos_arriving) {
        d_[lane] = departing.d;
        merged_[lane] = departing.merged;
        pdf_forward_[lane] = departing.pdf_forward;
        cosine_[lane] = departing.cosine;
        is_connectible_[lane] = departing.is_connectible ? 1.0 : 0.0;
        squared_distance_[lane] = squared_distance;
        cos_arriving_[lane] = cos_arriving;
    }
    /// Computes the densities of arrival in lanes [0, count), whether or not these were set.
    void arrive(std::size_t count, const Raised& raised);
    [[nodiscard]] SubpathDensities operator[](std::size_t lane) const {
        return {.a = a_[lane], .b = b_[lane], .merge_b = merge_b_[lane]};
    }

  private:
    using Doubles = std::array<double, kBlockLanes>;
    Doubles d_{}, merged_{}, pdf_forward_{}, cosine_{}, is_connectible_{}, squared_distance_{}, cos_arriving_{};
    Doubles a_{}, b_{}, merge_b_{};
};

}  // namespace etendue
