// The weights that bidirectional path tracing gives to paths, against their definition.
#pragma once

#include "integrator/integrator.h"
#include "transport/mis.h"
#include "world/world.h"

#include <cstddef>
#include <span>

namespace etendue::test {

/// Makes the paths of the samples of `jobs`, one after the other and with other seeds until there are `paths`, and
/// expects of all of them, within 1e-4, that the recursion's weights of all strategies (recursive_weights.h) are those
/// of the definition and sum to 1, and that the weight by the strategy that made the path is among them. One
/// path in 200 may be off by up to 1e-2 if its positions tell directions less exactly than the walk knew them: if an
/// edge is below `short_edge` metres or grazes a surface. Paths with an edge below a hundredth of `short_edge` may be
/// off by any amount. Subpaths merge where `merge` says. Returns how many strategies the paths with the most had.
std::size_t expect_right_weights(const World& world, PathLengths lengths, Heuristic heuristic, MergeAt merge,
                                 std::span<const TileJob> jobs, std::size_t paths, float short_edge);

}  // namespace etendue::test
