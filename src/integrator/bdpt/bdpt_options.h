// How bidirectional path tracing is asked for.
#pragma once

#include "integrator/integrator.h"
#include "transport/heuristic.h"
#include "transport/merge_radius.h"
#include "transport/strategy.h"

#include <optional>

namespace etendue {

struct CompletePath;
struct SubpathJob;

/// Sees the weight of every path that is made: tests compare it with the definition.
class WeightObserver {
  public:
    virtual ~WeightObserver() = default;
    /// Sees `path`, whose strategy has this `weight` by the recursion. Called from the threads that render.
    virtual void on_weight(const SubpathJob& job, const CompletePath& path, double weight) = 0;
};

struct BdptOptions {
    PathLengths lengths;
    Heuristic heuristic = Heuristic::Balance;
    std::optional<Strategy> only{};  ///< this strategy alone
    bool weighted = true;            ///< false: it is all there is, as if no other could make its paths
    /// Counts the light vertices of the wave that an eye vertex is connected to; 0: the vertices of its own sample's
    /// light subpath.
    int cached_connections = 0;
    MergeOptions merging{};
    WeightObserver* observer = nullptr;  ///< must outlive the integrator
};

}  // namespace etendue
