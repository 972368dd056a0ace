#include "wave/render_counters.h"

namespace etendue {

void RenderCounters::drop(const DroppedSample& sample) {
    ++dropped;
    if (first_dropped.size() < kMaxLocated) first_dropped.push_back(sample);
}

void RenderCounters::add(const RenderCounters& other) {
    rays.add(other.rays);
    samples += other.samples;
    dropped += other.dropped;
    for (const DroppedSample& sample : other.first_dropped)
        if (first_dropped.size() < kMaxLocated) first_dropped.push_back(sample);
    brightest.add(other.brightest);
}

}  // namespace etendue
