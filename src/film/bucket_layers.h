// Samples in buckets, from which an image is made that single samples cannot spoil: which layers of a film hold them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace etendue {

/// Sample i of each pixel is in bucket i mod `count`. That number is odd: in a base-2 sequence such as Sobol's, every
/// second sample lies in one half of the first dimension, and buckets by an even number would each see a part of it.
struct BucketLayers {
    std::size_t count = 0;        ///< 0: there are none
    std::size_t first_light = 0;  ///< the light layer of the first bucket; the others follow
    std::size_t first_value = 0;  ///< the first averaged value: the buckets' weights, then their samples

    [[nodiscard]] std::size_t of(std::uint32_t sample) const { return sample % count; }
    /// Returns how many averaged values the buckets take.
    [[nodiscard]] std::size_t value_count() const { return 2 * count; }
};

}  // namespace etendue
