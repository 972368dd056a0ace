#include "sampling/alias_table.h"

#include <numeric>

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

}  // namespace etendue
