#include "picture/sample_ranges.h"

#include "render/tiles.h"

#include <algorithm>

namespace etendue {

std::vector<SampleRange> split_samples(std::uint32_t spp, std::uint32_t count) {
    const std::uint32_t passes = (spp + kLargestPass - 1) / kLargestPass;
    const std::uint32_t unit = passes >= count ? kLargestPass : 1;
    const std::uint64_t units = passes >= count ? passes : spp;
    const auto ranges = static_cast<std::uint32_t>(std::min<std::uint64_t>(count, units));
    const auto border = [&](std::uint64_t i) {
        return std::min(spp, static_cast<std::uint32_t>(units * i / ranges * unit));
    };
    std::vector<SampleRange> result;
    result.reserve(ranges);
    for (std::uint32_t i = 0; i < ranges; ++i) result.push_back({border(i), border(i + 1)});
    return result;
}

}  // namespace etendue
