#include "render/render_profile.h"

#include "core/process_time.h"

#include <algorithm>

namespace etendue {

RenderProfile::RenderProfile(int threads, std::size_t recorded_rays)
    : workers_(static_cast<std::size_t>(threads), Worker{WaveProfile(recorded_rays), {}}) {}

double RenderProfile::now() const {
    return seconds_since(begin_);
}

WaveProfile RenderProfile::total() const {
    WaveProfile total(0);
    for (const Worker& worker : workers_) total.add(worker.wave);
    return total;
}

std::vector<TileTime> RenderProfile::tiles() const {
    std::vector<TileTime> tiles;
    for (const Worker& worker : workers_) tiles.insert(tiles.end(), worker.tiles.begin(), worker.tiles.end());
    std::ranges::sort(tiles, {}, &TileTime::start);
    return tiles;
}

}  // namespace etendue
