// How tests see the weights of bidirectional path tracing.
#pragma once

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

}  // namespace etendue
