// The samples of an image, cut into ranges that different machines render.
#pragma once

#include <cstdint>
#include <vector>

namespace etendue {

/// Holds a range of the sample sequence of every pixel, from `begin` to before `end`.
struct SampleRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  ///< > begin

    friend bool operator==(const SampleRange&, const SampleRange&) = default;
};

/// `spp` > 0 samples in `count` > 0 ranges, or in `spp` of them if there are fewer samples than that. Borders are
/// multiples of 16 where there are samples enough for it: a render in one piece begins its passes there too, and the
/// sums of both are rounded in the same order.
[[nodiscard]] std::vector<SampleRange> split_samples(std::uint32_t spp, std::uint32_t count);

}  // namespace etendue
