// What the threads of a render do, tile by tile, for `etendue profile`.
#pragma once

#include "core/pixel_rect.h"
#include "wave/profile/wave_profile.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// A tile of one pass.
struct TileTime {
    PixelRect rect;
    int slot = 0;  ///< slot of the thread that rendered the tile
    std::uint32_t first_sample = 0;
    std::uint64_t samples = 0;
    double start = 0.0;  ///< seconds since the profile began
    double end = 0.0;
    double cpu_seconds = 0.0;  ///< processor time of the thread, without what it waited for others
};

class RenderProfile {
  public:
    /// `recorded_rays` is about how many rays of each kind a thread keeps.
    RenderProfile(int threads, std::size_t recorded_rays);

    /// Returns the wave profile of the thread with this slot.
    [[nodiscard]] WaveProfile& wave(int slot) { return workers_[static_cast<std::size_t>(slot)].wave; }
    /// Seconds since the profile began.
    [[nodiscard]] double now() const;
    /// Adds a tile that the thread with its slot has rendered.
    void add_tile(const TileTime& tile) { workers_[static_cast<std::size_t>(tile.slot)].tiles.push_back(tile); }
    /// Adds seconds, summed over all threads, in which splats were put on the film.
    void add_splatting(double seconds) { splat_seconds_ += seconds; }

    /// Returns the sum of the wave profiles of all threads.
    [[nodiscard]] WaveProfile total() const;
    [[nodiscard]] double splat_seconds() const { return splat_seconds_; }
    /// Returns the tiles of all threads, in the order in which they began.
    [[nodiscard]] std::vector<TileTime> tiles() const;

  private:
    struct Worker {
        WaveProfile wave;
        std::vector<TileTime> tiles;
    };
    using Clock = std::chrono::steady_clock;

    Clock::time_point begin_ = Clock::now();
    std::vector<Worker> workers_;
    double splat_seconds_ = 0.0;
};

}  // namespace etendue
