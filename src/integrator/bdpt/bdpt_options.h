// How bidirectional path tracing is asked for.
#pragma once

#include "integrator/integrator.h"
#include "integrator/subpath/subpath_densities.h"

#include <optional>
#include <span>

namespace etendue {

/// One way to make a path: `s` vertices from the light, `t` from the eye, those on the light and on the lens included.
struct Strategy {
    int s = 0;
    int t = 0;
    friend bool operator==(const Strategy&, const Strategy&) = default;
};

struct CompletePath;

/// Sees the weight of every path that is made: for tests.
class WeightObserver {
  public:
    virtual ~WeightObserver() = default;
    /// `weight` is that of the path's strategy by the recursion; `reference` are those of all strategies that could
    /// have made it, s = 0, 1, ..., by their definition. Called from the threads that render.
    virtual void on_weight(const CompletePath& path, double weight, std::span<const double> reference) = 0;
};

struct BdptOptions {
    IntegratorOptions lengths;
    Heuristic heuristic = Heuristic::Power;
    std::optional<Strategy> only{};      ///< this strategy alone
    bool weighted = true;                ///< false: it is all there is, as if no other could make its paths
    WeightObserver* observer = nullptr;  ///< must outlive the integrator
};

}  // namespace etendue
