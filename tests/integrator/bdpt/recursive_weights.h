// The weights of all strategies of a given path by the recursion, as each of them would have found it.
#pragma once

#include "integrator/bdpt/reference_weights.h"

#include <vector>

namespace etendue::test {

/// Element i is the weight of the strategy with i vertices from the light, 0 if it cannot make the path. The recursion
/// runs along the path from both ends, whichever strategy has made it: every strategy takes all densities of the sides
/// that its two subpaths see, so that nothing but their being right makes the sum 1.
[[nodiscard]] std::vector<double> recursive_weights(const MisContext& mis, const CompletePath& path);

}  // namespace etendue::test
