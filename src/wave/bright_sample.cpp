#include "wave/bright_sample.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace etendue {

namespace {

auto place(const BrightSample& s) {
    return std::tie(s.y, s.x, s.sample_y, s.sample_x, s.sample, s.value.r, s.value.g, s.value.b);
}

}  // namespace

bool is_brighter(const BrightSample& a, const BrightSample& b) {
    if (a.brightness() != b.brightness()) return a.brightness() > b.brightness();
    return place(a) < place(b);
}

void BrightestSamples::offer(const BrightSample& sample) {
    if (capacity_ == 0 || !(sample.brightness() > 0.0f) || sample.brightness() < threshold()) return;
    const auto same = std::ranges::find_if(
        samples_, [&](const BrightSample& kept) { return kept.x == sample.x && kept.y == sample.y; });
    if (same != samples_.end()) {
        if (!is_brighter(sample, *same)) return;
        samples_.erase(same);
    }
    samples_.insert(std::ranges::upper_bound(samples_, sample, is_brighter), sample);
    if (samples_.size() > capacity_) samples_.pop_back();
}

void BrightestSamples::add(const BrightestSamples& other) {
    capacity_ = std::max(capacity_, other.capacity_);
    for (const BrightSample& sample : other.samples_) offer(sample);
}

void BrightestSamples::restore(std::size_t capacity, std::vector<BrightSample> samples) {
    capacity_ = capacity;
    samples_ = std::move(samples);
}

}  // namespace etendue
