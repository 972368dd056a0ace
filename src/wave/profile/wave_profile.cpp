#include "wave/profile/wave_profile.h"

#include <algorithm>
#include <tuple>

namespace etendue {

namespace {

/// Longer paths first, and those of one length by their places: no matter which thread traced them.
bool is_before(const LongPath& a, const LongPath& b) {
    return std::tuple(-a.rays, a.y, a.x, a.sample) < std::tuple(-b.rays, b.y, b.x, b.sample);
}

void keep(std::vector<LongPath>& longest, const LongPath& path) {
    longest.insert(std::ranges::upper_bound(longest, path, is_before), path);
    if (longest.size() > WaveProfile::kLongPaths) longest.pop_back();
}

}  // namespace

void PathTally::count(PathEnding ending, int rays) {
    ++endings_[static_cast<std::size_t>(ending)];
    ++lengths_[static_cast<std::size_t>(std::clamp(rays, 0, kMostRays))];
}

void PathTally::add(const PathTally& other) {
    for (std::size_t i = 0; i < endings_.size(); ++i) endings_[i] += other.endings_[i];
    for (std::size_t i = 0; i < lengths_.size(); ++i) lengths_[i] += other.lengths_[i];
}

std::vector<std::uint64_t> PathTally::lengths() const {
    std::size_t size = lengths_.size();
    while (size > 0 && lengths_[size - 1] == 0) --size;
    return {lengths_.begin(), lengths_.begin() + static_cast<std::ptrdiff_t>(size)};
}

WaveProfile::WaveProfile(std::size_t recorded_rays) : recorders_(kRayKinds, RayRecorder(recorded_rays)) {}

void WaveProfile::count_eye_path_end(PathEnding ending, const LongPath& path) {
    eye_paths_.count(ending, path.rays);
    if (longest_.size() < kLongPaths || is_before(path, longest_.back())) keep(longest_, path);
}

void WaveProfile::add(const WaveProfile& other) {
    clock_.add(other.clock_);
    for (std::size_t i = 0; i < kRayKinds; ++i) recorders_[i].add(other.recorders_[i]);
    hits_.add(other.hits_);
    eye_paths_.add(other.eye_paths_);
    light_paths_.add(other.light_paths_);
    for (const LongPath& path : other.longest_) keep(longest_, path);
    use_.light_samples += other.use_.light_samples;
    use_.bsdf_samples += other.use_.bsdf_samples;
    use_.phase_samples += other.use_.phase_samples;
    use_.bsdf_met_light += other.use_.bsdf_met_light;
}

}  // namespace etendue
