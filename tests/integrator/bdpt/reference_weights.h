// The weights of all strategies of a given path, from their definition: every density of every vertex computed anew
// (Veach 1997, section 10.2). Slow; what the recursion of transport/mis.h must say, too.
#pragma once

#include "integrator/bdpt/complete_path.h"

#include <vector>

namespace etendue::test {

/// Returns the weights of all strategies that could have made `path`: element i is that of the strategy with i vertices
/// from the light, up to that of t = 1; then come those of merges at each inner vertex, from the light to the lens.
[[nodiscard]] std::vector<double> reference_weights(const MisContext& mis, const CompletePath& path);

}  // namespace etendue::test
