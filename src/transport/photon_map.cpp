#include "transport/photon_map.h"

#include "core/vector_bytes.h"
#include "sampling/hash.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace etendue {

namespace {

/// Bounds the parts of a map that threads sort apart: 2 to this power.
constexpr int kPartBits = 6;

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

PhotonMap::PhotonMap(std::vector<std::vector<Photon>> lists, const MergeRadius& radius, const ThreadPool& threads)
    : radius_(radius) {
    for (const std::vector<Photon>& list : lists) size_ += list.size();
    if (size_ == 0) return;
    mask_ = std::bit_ceil(static_cast<std::uint32_t>(size_)) - 1;
    begin_.resize(static_cast<std::size_t>(mask_) + 2);
    begin_.back() = static_cast<std::uint32_t>(size_);
    photons_ = {std::allocator<Photon>().allocate(size_), FreePhotons{size_}};
    const int bits = std::max(0, static_cast<int>(std::bit_width(mask_)) - kPartBits);
    const std::vector<std::uint32_t> parts = sort_into_parts(lists, bits, threads);
    threads.parallel_for(parts.size() - 1, [&](std::size_t part, int) {
        sort_part(static_cast<std::uint32_t>(part), bits, parts[part], parts[part + 1]);
    });
}

std::vector<std::uint32_t> PhotonMap::sort_into_parts(std::vector<std::vector<Photon>>& lists, int bits,
                                                      const ThreadPool& threads) {
    const std::size_t parts = (mask_ >> bits) + 1;
    const auto part_of = [&](const Photon& photon) { return bucket_of(photon.position) >> bits; };
    // How many photons of each list go to each part, and then where the first of them goes: list after list.
    std::vector<std::uint32_t> places(parts * lists.size(), 0);
    threads.parallel_for(lists.size(), [&](std::size_t list, int) {
        const std::span row = std::span(places).subspan(list * parts, parts);
        for (const Photon& photon : lists[list]) ++row[part_of(photon)];
    });
    std::vector<std::uint32_t> begins;
    std::uint32_t before = 0;
    for (std::size_t part = 0; part < parts; ++part) {
        begins.push_back(before);
        for (std::size_t list = 0; list < lists.size(); ++list)
            before += std::exchange(places[list * parts + part], before);
    }
    begins.push_back(before);
    threads.parallel_for(lists.size(), [&](std::size_t list, int) {
        const std::span row = std::span(places).subspan(list * parts, parts);
        for (const Photon& photon : lists[list]) std::construct_at(&photons_[row[part_of(photon)]++], photon);
        std::vector<Photon>().swap(lists[list]);  // frees it
    });
    return begins;
}

void PhotonMap::sort_part(std::uint32_t part, int bits, std::uint32_t first, std::uint32_t end) {
    const std::uint32_t first_bucket = part << bits;
    std::vector<std::uint32_t> next(std::size_t{1} << bits, 0);
    for (std::uint32_t p = first; p < end; ++p) ++next[bucket_of(photons_[p].position) - first_bucket];
    std::uint32_t before = first;
    for (std::size_t b = 0; b < next.size(); ++b) {
        begin_[first_bucket + b] = before;
        before += std::exchange(next[b], before);
    }
    // Each photon is swapped to the next free place of its bucket, until the one that lies here belongs here.
    for (std::size_t b = 0; b < next.size(); ++b) {
        const std::uint32_t end_of_bucket = b + 1 < next.size() ? begin_[first_bucket + b + 1] : end;
        while (next[b] < end_of_bucket) {
            Photon& here = photons_[next[b]];
            const std::uint32_t bucket = bucket_of(here.position) - first_bucket;
            if (bucket != b) std::swap(here, photons_[next[bucket]]);
            ++next[bucket];
        }
    }
}

std::size_t PhotonMap::bytes() const {
    return vector_bytes(begin_) + size_ * sizeof(Photon);
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
