// Sixteen floats of each of as many places in memory as `Wide` has lanes, read and written a register at a time: one
// place after the other, number by number, takes longer than what is computed with them.
#pragma once

#include "core/wide.h"

#include <array>
#include <cstddef>
#include <utility>

namespace etendue {

inline constexpr std::size_t kRowFloats = 16;
static_assert(kRowFloats % Wide::kWidth == 0);

/// Holds a row of memory in each lane: element i has number i of every row.
using WideRow = std::array<Wide, kRowFloats>;

/// Rows that become columns: lane j of row i and lane i of row j change places.
class WideSquare {
  public:
    std::array<Wide, Wide::kWidth> rows;

    void transpose() {
        // Each step interleaves the upper half of the rows with the lower one; after as many as doublings make the
        // width, the bits of where a number stands have gone once around.
        for (std::size_t size = 1; size < Wide::kWidth; size *= 2) interleave(std::make_index_sequence<kHalf>());
    }

  private:
    static constexpr std::size_t kHalf = Wide::kWidth / 2;

    /// Returns lanes of `a` and `b` in turns, from lane `kFirst` of either on.
    template <std::size_t kFirst, std::size_t... kLane>
    [[nodiscard]] static Wide interleaved(Wide a, Wide b, std::index_sequence<kLane...>) {
        return Wide(Wide::Simd{__builtin_shufflevector(
            a.simd().raw, b.simd().raw, static_cast<int>(kFirst + kLane / 2 + (kLane % 2) * Wide::kWidth)...)});
    }
    template <std::size_t... kRow>
    void interleave(std::index_sequence<kRow...>) {
        constexpr std::make_index_sequence<Wide::kWidth> kLanes;
        std::array<Wide, Wide::kWidth> next;
        ((next[2 * kRow] = interleaved<0>(rows[kRow], rows[kRow + kHalf], kLanes),
          next[2 * kRow + 1] = interleaved<kHalf>(rows[kRow], rows[kRow + kHalf], kLanes)),
         ...);
        rows = next;
    }
};

/// Loads a row from each address; addresses are aligned to `kRowFloats` floats.
[[nodiscard]] inline WideRow load_rows(const std::array<const float*, Wide::kWidth>& from) {
    WideRow row;
    for (std::size_t part = 0; part < kRowFloats; part += Wide::kWidth) {
        WideSquare square;
        for (std::size_t i = 0; i < Wide::kWidth; ++i) square.rows[i] = Wide::load(from[i] + part);
        square.transpose();
        for (std::size_t i = 0; i < Wide::kWidth; ++i) row[part + i] = square.rows[i];
    }
    return row;
}

/// Stores a row to each address; addresses are aligned to `kRowFloats` floats.
inline void store_rows(const WideRow& row, const std::array<float*, Wide::kWidth>& to) {
    for (std::size_t part = 0; part < kRowFloats; part += Wide::kWidth) {
        WideSquare square;
        for (std::size_t i = 0; i < Wide::kWidth; ++i) square.rows[i] = row[part + i];
        square.transpose();
        for (std::size_t i = 0; i < Wide::kWidth; ++i) square.rows[i].store(to[i] + part);
    }
}

}  // namespace etendue
