// A sample of the rays of a render, kept as they stood beside each other, so that they can be traced again.
#pragma once

#include "core/ray.h"
#include "core/ray_columns.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Keeps segments of batches: every segment that was offered is among those kept with the same probability (Vitter,
/// "Random Sampling with a Reservoir", 1985, algorithm R).
class RayRecorder {
  public:
    /// Rays of a segment at most: whole packets, and few enough that replaying them stays in the first-level caches.
    static constexpr std::size_t kSegment = 256;

    /// `capacity` is about how many rays are kept.
    explicit RayRecorder(std::size_t capacity) : most_segments_((capacity + kSegment - 1) / kSegment) {}

    void offer(std::span<const Ray> batch);
    void offer(const RayColumns& batch);

    [[nodiscard]] std::span<const std::vector<Ray>> segments() const { return segments_; }
    [[nodiscard]] std::size_t ray_count() const;
    /// Returns the chance, [0, 1], of each segment that was offered to be among those kept.
    [[nodiscard]] double chance() const { return chance_; }
    /// Adds the segments of another. Of the one whose segments had the better chance so many are left out that it is
    /// the same for all of both. Nothing is offered any more after this.
    void add(const RayRecorder& other);

  private:
    template <typename Batch>
    void offer_segments(const Batch& batch);

    std::size_t most_segments_;
    std::uint64_t offered_ = 0;
    double chance_ = 1.0;
    std::vector<std::vector<Ray>> segments_;
};

}  // namespace etendue
