#include "sampling/alias_table.h"

#include <algorithm>
#include <numeric>

#include "sampling/warp.h"

namespace etendue {

AliasTable::AliasTable(std::span<const double> weights) : bins_(weights.size()) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    const auto count = static_cast<double>(weights.size());
    std::vector<double> scaled(weights.size());
    std::vector<std::uint32_t> small;
    std::vector<std::uint32_t> large;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double probability = total > 0.0 ? weights[i] / total : 1.0 / count;
        bins_[i] = {1.0f, static_cast<std::uint32_t>(i), static_cast<float>(probability)};
        scaled[i] = probability * count;
        (scaled[i] < 1.0 ? small : large).push_back(static_cast<std::uint32_t>(i));
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t lender = large.back();
        const std::uint32_t borrower = small.back();
        small.pop_back();
        bins_[borrower].threshold = static_cast<float>(scaled[borrower]);
        bins_[borrower].alias = lender;
        scaled[lender] -= 1.0 - scaled[borrower];
        if (scaled[lender] < 1.0) {
            large.pop_back();
            small.push_back(lender);
        }
    }
}

AliasTable::Choice AliasTable::sample(float u) const {
    const float scaled = u * static_cast<float>(bins_.size());
    const auto bin = std::min(static_cast<std::uint32_t>(scaled), static_cast<std::uint32_t>(bins_.size() - 1));
    const float within = std::min(scaled - static_cast<float>(bin), kOneMinusEpsilon);
    const Bin& b = bins_[bin];
    if (within < b.threshold) return {bin, b.probability, std::min(within / b.threshold, kOneMinusEpsilon)};
    const float rest = (within - b.threshold) / (1.0f - b.threshold);
    return {b.alias, bins_[b.alias].probability, std::min(rest, kOneMinusEpsilon)};
}

}  // namespace etendue
