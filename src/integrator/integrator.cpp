#include "integrator/integrator.h"

namespace etendue {

void RenderCounters::drop(const DroppedSample& sample) {
    ++dropped;
    if (first_dropped.size() < kMaxLocated) first_dropped.push_back(sample);
}

void RenderCounters::add(const RenderCounters& other) {
    camera_rays += other.camera_rays;
    bounce_rays += other.bounce_rays;
    shadow_rays += other.shadow_rays;
    samples += other.samples;
    dropped += other.dropped;
    for (const DroppedSample& sample : other.first_dropped)
        if (first_dropped.size() < kMaxLocated) first_dropped.push_back(sample);
    brightest.add(other.brightest);
}

}  // namespace etendue
