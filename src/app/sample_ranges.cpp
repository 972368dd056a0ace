#include "app/sample_ranges.h"

#include <algorithm>

namespace etendue {

std::vector<SampleRange> split_samples(std::uint32_t spp, std::uint32_t count) {
    constexpr std::uint32_t kPass = 16;
    const std::uint32_t passes = (spp + kPass - 1) / kPass;
    const std::uint32_t unit = passes >= count ? kPass : 1;
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
