#include "film/splat_bands.h"

#include "film/reach.h"

#include <algorithm>
#include <cstdint>

namespace etendue {

SplatBands::SplatBands(std::span<const std::vector<Splat>> lists, const PixelRect& window, float filter_radius,
                       const ThreadPool& threads)
    : lists_(lists), window_(window) {
    const int bands = std::min(window.height(), kBandsPerThread * threads.thread_count());
    std::vector<std::uint32_t> band_of_row;
    for (int band = 0; band <= bands; ++band) {
        edges_.push_back(window.y0 + static_cast<int>(static_cast<std::int64_t>(window.height()) * band / bands));
        band_of_row.resize(static_cast<std::size_t>(edges_.back() - window.y0), static_cast<std::uint32_t>(band - 1));
    }
    splats_.resize(lists.size() * count());
    threads.parallel_for(lists.size(), [&](std::size_t list, int) { sort(list, filter_radius, band_of_row); });
}

void SplatBands::sort(std::size_t list, float filter_radius, std::span<const std::uint32_t> band_of_row) {
    const float top = static_cast<float>(window_.y0) - filter_radius;
    const float bottom = static_cast<float>(window_.y1) + filter_radius;
    const std::span<std::vector<std::uint32_t>> bands = std::span(splats_).subspan(list * count(), count());
    for (std::size_t i = 0; i < lists_[list].size(); ++i) {
        const float y = lists_[list][i].position.y;
        if (!(y >= top && y <= bottom)) continue;
        const Reach rows(y, filter_radius, window_.y0, window_.y1);
        if (rows.begin >= rows.end) continue;
        const std::uint32_t last = band_of_row[static_cast<std::size_t>(rows.end - 1 - window_.y0)];
        for (std::uint32_t band = band_of_row[static_cast<std::size_t>(rows.begin - window_.y0)]; band <= last; ++band)
            bands[band].push_back(static_cast<std::uint32_t>(i));
    }
}

}  // namespace etendue
