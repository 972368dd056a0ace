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
    /// Has what `sample` will look at fetched from memory.
    void fetch(Vec2f u) const { __builtin_prefetch(&bins_[bin(u)]); }
    [[nodiscard]] std::size_t size() const { return bins_.size(); }
    [[nodiscard]] bool empty() const { return bins_.empty(); }
    [[nodiscard]] std::size_t bytes() const { return bins_.capacity() * sizeof(Bin); }

  private:
    struct Bin {
        float threshold;      ///< share of the bin that belongs to its own entry
        std::uint32_t alias;  ///< entry that owns the rest
        float probability;
    };
    [[nodiscard]] std::size_t bin(Vec2f u) const {
        const auto bin = static_cast<std::uint32_t>(u.x * static_cast<float>(bins_.size()));
        return std::min<std::size_t>(bin, bins_.size() - 1);
    }

    std::vector<Bin> bins_;
};

inline AliasTable::Choice AliasTable::sample(Vec2f u) const {
    const std::size_t first = bin(u);
    const Bin& b = bins_[first];
    const std::uint32_t index = u.y < b.threshold ? static_cast<std::uint32_t>(first) : b.alias;
    return {index, bins_[index].probability};
}

}  // namespace etendue
