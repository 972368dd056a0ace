// Which splats fall on which rows of a film, so that threads can add them side by side.
#pragma once

#include "core/parallel.h"
#include "core/pixel_rect.h"
#include "film/splat_film.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Bands of whole rows of a window, a few for each thread, and the splats whose filter may reach each. One look at each
/// splat; four bytes for each and band that it reaches, one or two in all but low images.
class SplatBands {
  public:
    /// `lists` must outlive this. What has no finite position is in no band.
    SplatBands(std::span<const std::vector<Splat>> lists, const PixelRect& window, float filter_radius,
               const ThreadPool& threads);

    [[nodiscard]] std::size_t count() const { return edges_.size() - 1; }
    /// The pixels of the window that are in a band.
    [[nodiscard]] PixelRect pixels(std::size_t band) const {
        return {window_.x0, edges_[band], window_.x1, edges_[band + 1]};
    }
    /// Calls `body(splat)` for each splat of a band, in the order of the lists.
    template <typename Function>
    void for_each(std::size_t band, const Function& body) const {
        for (std::size_t list = 0; list < lists_.size(); ++list) {
            const std::vector<std::uint32_t>& of_band = splats_[list * count() + band];
            for (std::size_t i = 0; i < of_band.size(); ++i) {
                if (i + kAhead < of_band.size()) __builtin_prefetch(&lists_[list][of_band[i + kAhead]]);
                body(lists_[list][of_band[i]]);
            }
        }
    }

  private:
    /// Enough that bands with more splats do not keep the others waiting long.
    static constexpr int kBandsPerThread = 4;
    /// Number of splats that are prefetched. A band's splats lie apart in their list, farther with more threads; with
    /// 64 bands, prefetching cuts the time of adding to 0.4.
    static constexpr std::size_t kAhead = 16;

    void sort(std::size_t list, float filter_radius, std::span<const std::uint32_t> band_of_row);

    std::span<const std::vector<Splat>> lists_;
    PixelRect window_;
    std::vector<int> edges_;                          ///< rows of the full image; one more than bands
    std::vector<std::vector<std::uint32_t>> splats_;  ///< by list and band, as indices in the list
};

}  // namespace etendue
