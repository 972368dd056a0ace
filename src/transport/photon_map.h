// Photons of all light subpaths of one sample of every pixel, to be looked up by place.
//
// Each lies in a cell of a grid whose cells are at least as wide as a kernel there: radii grow with the distance from
// the camera, and there is one grid for each power of two between them. Cells share buckets by a hash of their place.
#pragma once

#include "core/parallel.h"
#include "transport/merging.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace etendue {

/// Frees photons that were allocated before they were made.
struct FreePhotons {
    std::size_t count = 0;
    void operator()(Photon* photons) const { std::allocator<Photon>().deallocate(photons, count); }
};

class PhotonMap {
  public:
    /// Moves the photons out of `lists` and frees each list that is done, so that memory holds most photons once. Where
    /// a kernel finds several, their order depends on that of the lists alone.
    PhotonMap(std::vector<std::vector<Photon>> lists, const MergeRadius& radius, const ThreadPool& threads);

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::size_t bytes() const;

    /// Calls `take` with each photon within `kernel`, whose radius is that of its position.
    template <typename Take>
    void for_each_in(const MergeKernel& kernel, const Take& take) const {
        if (size_ == 0) return;
        Buckets buckets;
        find_buckets(kernel, buckets);
        for (const std::uint32_t bucket : std::span(buckets.index).first(buckets.count))
            for (std::uint32_t p = begin_[bucket]; p < begin_[bucket + 1]; ++p)
                if (kernel.contains(photons_[p])) take(photons_[p]);
    }

  private:
    /// Holds the buckets that a kernel's photons may be in, each once.
    struct Buckets {
        /// Two grids, as MergeRadius::kMostSlope keeps radii from changing more, and in each no more than three cells
        /// a side.
        static constexpr std::size_t kMost = 2 * 27;
        std::array<std::uint32_t, kMost> index{};
        std::size_t count = 0;
    };

    /// Copies the photons of `lists` to their parts of the map, of 2^`bits` buckets each, and frees the lists. Returns
    /// where each part begins, and behind them the number of photons.
    std::vector<std::uint32_t> sort_into_parts(std::vector<std::vector<Photon>>& lists, int bits,
                                               const ThreadPool& threads);
    /// Sorts the photons of one part, which begin at `first`, into its 2^`bits` buckets.
    void sort_part(std::uint32_t part, int bits, std::uint32_t first, std::uint32_t end);
    [[nodiscard]] std::uint32_t bucket_of(const Vec3f& position) const;
    void find_buckets(const MergeKernel& kernel, Buckets& buckets) const;

    MergeRadius radius_;
    std::uint32_t mask_ = 0;
    std::size_t size_ = 0;
    std::vector<std::uint32_t> begin_;  ///< first photon of each bucket, and behind them the number of photons
    std::unique_ptr<Photon[], FreePhotons> photons_;  ///< photons of each bucket, side by side
};

}  // namespace etendue
