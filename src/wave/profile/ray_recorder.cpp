#include "wave/profile/ray_recorder.h"

#include "sampling/hash.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace etendue {

namespace {

/// Random bits that follow from a number.
std::uint32_t bits_of(std::uint64_t number) {
    return hash_combine(hash_combine(0u, static_cast<std::uint32_t>(number)), static_cast<std::uint32_t>(number >> 32));
}

/// Keeps `share` of the segments, in their order, each with that probability: one more or less where that is no whole
/// number. Other salts keep others (Knuth, "The Art of Computer Programming", volume 2, 3.4.2, algorithm S).
void keep_share(std::vector<std::vector<Ray>>& segments, double share, std::uint32_t salt) {
    const auto number = [&](std::size_t i) {
        return 0x1p-32 * static_cast<double>(hash_combine(salt, static_cast<std::uint32_t>(i)));
    };
    const std::size_t count = segments.size();
    const auto wanted = static_cast<std::size_t>(share * static_cast<double>(count) + number(count));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (number(i) * static_cast<double>(count - i) < static_cast<double>(std::min(wanted, count) - kept))
            std::swap(segments[kept++], segments[i]);
    segments.resize(kept);
}

}  // namespace

template <typename Batch>
void RayRecorder::offer_segments(const Batch& batch) {
    for (std::size_t first = 0; first < batch.size(); first += kSegment) {
        const std::size_t count = std::min(kSegment, batch.size() - first);
        const auto keep_in = [&](std::vector<Ray>& segment) {
            segment.resize(count);
            for (std::size_t i = 0; i < count; ++i) segment[i] = batch[first + i];
        };
        const std::uint64_t number = offered_++;
        if (segments_.size() < most_segments_) {
            keep_in(segments_.emplace_back());
            continue;
        }
        chance_ = static_cast<double>(most_segments_) / static_cast<double>(offered_);
        // Of the numbers up to this segment's own; the remainder's bias is less than 2^-32 times their count.
        const std::uint64_t place = (std::uint64_t{bits_of(number)} * (number + 1)) >> 32;
        if (place < segments_.size()) keep_in(segments_[place]);
    }
}

void RayRecorder::offer(std::span<const Ray> batch) {
    offer_segments(batch);
}

void RayRecorder::offer(const RayColumns& batch) {
    offer_segments(batch);
}

std::size_t RayRecorder::ray_count() const {
    std::size_t count = 0;
    for (const std::vector<Ray>& segment : segments_) count += segment.size();
    return count;
}

void RayRecorder::add(const RayRecorder& other) {
    const double chance = std::min(chance_, other.chance_);
    std::vector<std::vector<Ray>> others = other.segments_;
    const std::uint32_t salt = hash_combine(bits_of(offered_), bits_of(other.offered_));
    keep_share(segments_, chance / chance_, salt);
    keep_share(others, chance / other.chance_, ~salt);
    segments_.insert(segments_.end(), std::make_move_iterator(others.begin()), std::make_move_iterator(others.end()));
    offered_ += other.offered_;
    chance_ = chance;
}

}  // namespace etendue
