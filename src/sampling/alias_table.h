// Choosing one of n with given probabilities in constant time.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Walker's alias table, built by Vose's method (Vose, "A Linear Algorithm for Generating Random Numbers with a Given
/// Distribution", IEEE TSE 17(9), 1991). 12 bytes an entry.
class AliasTable {
  public:
    AliasTable() = default;
    /// `weights` >= 0 and finite, any sum. If all are zero, every entry is equally likely.
    explicit AliasTable(std::span<const double> weights);

    struct Choice {
        std::uint32_t index;
        float probability;
    };
    /// `u` in [0, 1)²: the first number picks a bin, the second decides between its two entries. One number for both
    /// would have no digits left for the decision in a large table. The table must not be empty.
    [[nodiscard]] Choice sample(Vec2f u) const;
    [[nodiscard]] float probability(std::size_t index) const { return bins_[index].probability; }
    /// Has the first entries fetched from memory.
    void fetch() const { __builtin_prefetch(bins_.data()); }
    [[nodiscard]] std::size_t size() const { return bins_.size(); }
    [[nodiscard]] bool empty() const { return bins_.empty(); }
    [[nodiscard]] std::size_t bytes() const { return bins_.capacity() * sizeof(Bin); }

  private:
    struct Bin {
        float threshold;      ///< share of the bin that belongs to its own entry
        std::uint32_t alias;  ///< entry that owns the rest
        float probability;
    };
    std::vector<Bin> bins_;
};

inline AliasTable::Choice AliasTable::sample(Vec2f u) const {
    const float scaled = u.x * static_cast<float>(bins_.size());
    const auto bin = std::min(static_cast<std::uint32_t>(scaled), static_cast<std::uint32_t>(bins_.size() - 1));
    const Bin& b = bins_[bin];
    const std::uint32_t index = u.y < b.threshold ? bin : b.alias;
    return {index, bins_[index].probability};
}

}  // namespace etendue
