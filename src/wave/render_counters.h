// What threads count as they render.
#pragma once

#include "film/dropped_sample.h"
#include "wave/bright_sample.h"
#include "wave/ray_kind.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace etendue {

/// Holds what one thread counts as it renders; those of all threads are added up at the end.
struct RenderCounters {
    RaysByKind rays;
    std::uint64_t samples = 0;
    std::uint64_t dropped = 0;
    std::vector<DroppedSample> first_dropped;  ///< at most kMaxLocated, the first by sample and place
    BrightestSamples brightest;

    static constexpr std::size_t kMaxLocated = 8;

    void drop(const DroppedSample& sample) {
        ++dropped;
        keep(sample);
    }
    void add(const RenderCounters& other) {
        rays.add(other.rays);
        samples += other.samples;
        dropped += other.dropped;
        for (const DroppedSample& sample : other.first_dropped) keep(sample);
        brightest.add(other.brightest);
    }

  private:
    void keep(const DroppedSample& sample) {
        const auto order = [](const DroppedSample& each) { return std::tuple(each.sample, each.y, each.x); };
        const auto place = std::ranges::upper_bound(first_dropped, order(sample), {}, order);
        first_dropped.insert(place, sample);
        if (first_dropped.size() > kMaxLocated) first_dropped.pop_back();
    }
};

}  // namespace etendue
