#include "transport/photon_map.h"

#include "core/vector_bytes.h"
#include "sampling/hash.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace etendue {

namespace {

/// Returns the grid for kernels of this radius, metres: the exponent of the power of two at or below it.
int grid_of(float radius) {
    return std::ilogb(radius);
}

/// Returns the width of the cells of `grid`, metres: that of its largest kernels, or more.
float cell_width(int grid) {
    return std::ldexp(1.0f, grid + 2);
}

std::int32_t cell_of(float coordinate, float width) {
    constexpr float kMost = 1 << 30;
    return static_cast<std::int32_t>(std::clamp(std::floor(coordinate / width), -kMost, kMost));
}

std::uint32_t hash_of_cell(int grid, std::int32_t x, std::int32_t y, std::int32_t z) {
    std::uint32_t hash = hash_u32(static_cast<std::uint32_t>(grid));
    for (const std::int32_t index : {x, y, z}) hash = hash_combine(hash, static_cast<std::uint32_t>(index));
    return hash;
}

}  // namespace

PhotonMap::PhotonMap(std::vector<std::vector<Photon>> lists, const MergeRadius& radius) : radius_(radius) {
    std::size_t total = 0;
    for (const std::vector<Photon>& list : lists) total += list.size();
    if (total == 0) return;
    mask_ = std::bit_ceil(static_cast<std::uint32_t>(total)) - 1;
    begin_.assign(static_cast<std::size_t>(mask_) + 2, 0);
    photons_.reserve(total);
    for (std::vector<Photon>& list : lists) {
        for (const Photon& photon : list) ++begin_[bucket_of(photon.position) + 1];
        photons_.insert(photons_.end(), list.begin(), list.end());
        list = {};
    }
    for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
    // Each photon is swapped to the next free place of its bucket, until the one that lies here belongs here.
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t b = 0; b <= mask_; ++b)
        while (next[b] < begin_[b + 1]) {
            Photon& here = photons_[next[b]];
            const std::uint32_t bucket = bucket_of(here.position);
            if (bucket != b) std::swap(here, photons_[next[bucket]]);
            ++next[bucket];
        }
}

std::size_t PhotonMap::bytes() const {
    return vector_bytes(begin_, photons_);
}

std::uint32_t PhotonMap::bucket_of(const Vec3f& position) const {
    const int grid = grid_of(radius_(position));
    const float width = cell_width(grid);
    return hash_of_cell(grid, cell_of(position.x, width), cell_of(position.y, width), cell_of(position.z, width)) &
           mask_;
}

void PhotonMap::find_buckets(const MergeKernel& kernel, Buckets& buckets) const {
    const float change = kernel.radius * radius_.slope();
    const int least = grid_of(kernel.radius - change);
    const int most = grid_of(kernel.radius + change);
    for (int grid = least; grid <= most; ++grid) {
        const float width = cell_width(grid);
        const auto range = [&](float middle) {
            const std::int32_t first = cell_of(middle - kernel.radius, width);
            return std::array{first, std::min(cell_of(middle + kernel.radius, width), first + 2)};
        };
        const auto [x0, x1] = range(kernel.position.x);
        const auto [y0, y1] = range(kernel.position.y);
        const auto [z0, z1] = range(kernel.position.z);
        for (std::int32_t z = z0; z <= z1; ++z)
            for (std::int32_t y = y0; y <= y1; ++y)
                for (std::int32_t x = x0; x <= x1; ++x)
                    buckets.index[buckets.count++] = hash_of_cell(grid, x, y, z) & mask_;
    }
    const auto found = std::span(buckets.index).first(buckets.count);
    std::ranges::sort(found);
    buckets.count = static_cast<std::size_t>(std::unique(found.begin(), found.end()) - found.begin());
}

}  // namespace etendue
