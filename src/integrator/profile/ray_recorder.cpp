#include "integrator/profile/ray_recorder.h"

#include "sampling/hash.h"

#include <algorithm>

namespace etendue {

void RayRecorder::offer(std::span<const Ray> batch) {
    for (std::size_t first = 0; first < batch.size(); first += kSegment) {
        const auto segment = batch.subspan(first, std::min(kSegment, batch.size() - first));
        const std::uint64_t number = offered_++;
        if (segments_.size() < most_segments_) {
            segments_.emplace_back(segment.begin(), segment.end());
            continue;
        }
        const auto bits = hash_combine(hash_combine(0u, static_cast<std::uint32_t>(number)),
                                       static_cast<std::uint32_t>(number >> 32));
        // Of the numbers up to this segment's own; the remainder's bias is less than 2^-32 times their count.
        const std::uint64_t place = (std::uint64_t{bits} * (number + 1)) >> 32;
        if (place < segments_.size()) segments_[place].assign(segment.begin(), segment.end());
    }
}

std::size_t RayRecorder::ray_count() const {
    std::size_t count = 0;
    for (const std::vector<Ray>& segment : segments_) count += segment.size();
    return count;
}

void RayRecorder::add(const RayRecorder& other) {
    segments_.insert(segments_.end(), other.segments_.begin(), other.segments_.end());
    offered_ += other.offered_;
}

}  // namespace etendue
