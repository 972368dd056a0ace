#include "wave/profile/stage_clock.h"

#include "core/process_time.h"

#include <numeric>

namespace etendue {

void StageClock::add(const StageClock& other) {
    stamps_ += other.stamps_;
    if (other.scale_.is_older_than(scale_)) scale_ = other.scale_;
    for (std::size_t i = 0; i < kStages; ++i) {
        ticks_[i] += other.ticks_[i];
        ticks_in_blocks_[i] += other.ticks_in_blocks_[i];
    }
    ticks_of_blocks_ += other.ticks_of_blocks_;
    for (std::size_t i = 0; i < kRayKinds; ++i) ticks_of_kind_[i] += other.ticks_of_kind_[i];
}

double StageClock::seconds(Stage stage) const {
    const auto index = static_cast<std::size_t>(stage);
    const std::uint64_t in_blocks = std::accumulate(ticks_in_blocks_.begin(), ticks_in_blocks_.end(), std::uint64_t{0});
    const double share =
        in_blocks > 0 ? static_cast<double>(ticks_in_blocks_[index]) / static_cast<double>(in_blocks) : 0.0;
    return in_seconds(static_cast<double>(ticks_[index] + ticks_in_blocks_[index]) +
                      share * static_cast<double>(ticks_of_blocks_));
}

double StageClock::seconds_per_stamp() {
    constexpr int kStamps = 100000;
    StageClock clock;
    // On a busy machine the clock would count what others do meanwhile.
    const double start = thread_cpu_seconds();
    for (int i = 0; i < kStamps; ++i) clock.stamp(Stage::Film);
    return (thread_cpu_seconds() - start) / kStamps;
}

}  // namespace etendue
