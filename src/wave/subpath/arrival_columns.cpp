#include "wave/subpath/arrival_columns.h"

namespace etendue {

void ArrivalColumns::arrive(std::size_t count, const Raised& raised) {
    const auto arrive_all = [&](const Raised& rule) {
        for (std::size_t l = 0; l < count; ++l) {
            const DepartingDensities departing{.d = d_[l],
                                               .merged = merged_[l],
                                               .pdf_forward = pdf_forward_[l],
                                               .cosine = cosine_[l],
                                               .is_connectible = is_connectible_[l] > 0.0};
            const SubpathDensities arrived = departing.arrive(rule, squared_distance_[l], cos_arriving_[l]);
            a_[l] = arrived.a;
            b_[l] = arrived.b;
            merge_b_[l] = arrived.merge_b;
        }
    };
    // Known to the compiler in each loop.
    if (raised.heuristic == Heuristic::Power)
        arrive_all({Heuristic::Power});
    else
        arrive_all({Heuristic::Balance});
}

}  // namespace etendue
