// How bidirectional path tracing is asked for.
#pragma once

#include "integrator/integrator.h"
#include "integrator/strategy.h"
#include "transport/heuristic.h"

#include <optional>
#include <span>

namespace etendue {

struct CompletePath;
struct SubpathJob;

/// Sees the weight of every path that is made: for tests.
class WeightObserver {
  public:
    virtual ~WeightObserver() = default;
    /// `weight` is that of the path's strategy by the recursion; `reference` are those of all strategies that could
    /// have made it, s = 0, 1, ..., by their definition. Called from the threads that render.
    virtual void on_weight(const SubpathJob& job, const CompletePath& path, double weight,
                           std::span<const double> reference) = 0;
};

struct BdptOptions {
    PathLengths lengths;
    Heuristic heuristic = Heuristic::Balance;
    std::optional<Strategy> only{};  ///< this strategy alone
    bool weighted = true;            ///< false: it is all there is, as if no other could make its paths
    /// Counts the light vertices of the wave that an eye vertex is connected to; 0: the vertices of its own sample's
    /// light subpath.
    int cached_connections = 0;
    WeightObserver* observer = nullptr;  ///< must outlive the integrator
};

}  // namespace etendue
