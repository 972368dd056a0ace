#include "wave/shadow_ray_queue.h"

#include "wave/film_repeats.h"
#include "wave/profile/wave_profile.h"
#include "wave/ray_batch.h"

#include <bit>
#include <utility>

namespace etendue {

std::size_t ShadowRayQueue::bytes() const {
    std::size_t bytes = vector_bytes(places_, shares_, occluded_);
    for (const auto& column : floats_) bytes += vector_bytes(column);
    for (const auto& column : bits_) bytes += vector_bytes(column);
    return bytes;
}

void ShadowRayQueue::make_room() {
    const std::size_t needed = count_ + 2 * RayColumns::kPacket;
    if (needed <= floats_[0].size()) return;
    for (auto& column : floats_) column.resize(2 * needed);
    for (auto& column : bits_) column.resize(2 * needed);
}

void ShadowRayQueue::to_sample(const Ray& ray, std::uint32_t slot, const Rgb& contribution, LightKind kind,
                               std::span<const ExpressionShare> shares) {
    if (!shares.empty()) shares_.insert(shares_.end(), shares.begin(), shares.end());
    if (rows_ == Wide::kWidth) flush();
    // Filled in where it lies: a copy of what was just written, number by number, would wait until all of that is in
    // the cache.
    Row& row = row_[rows_++];
    row[kOriginX] = ray.origin.x;
    row[kOriginY] = ray.origin.y;
    row[kOriginZ] = ray.origin.z;
    row[kDirectionX] = ray.direction.x;
    row[kDirectionY] = ray.direction.y;
    row[kDirectionZ] = ray.direction.z;
    row[kTMax] = ray.t_max;
    row[kTime] = ray.time;
    row[kRed] = contribution.r;
    row[kGreen] = contribution.g;
    row[kBlue] = contribution.b;
    const auto set_bits = [&](BitColumn column, std::uint32_t bits) {
        row[std::size_t{kFloatColumns} + column] = std::bit_cast<float>(bits);
    };
    set_bits(kAlphaKey, ray.alpha_key);
    set_bits(kSlot, slot);
    set_bits(kLightKind, static_cast<std::uint32_t>(kind));
    set_bits(kEndOfShares, static_cast<std::uint32_t>(shares_.size()));
}

void ShadowRayQueue::flush() {
    if (rows_ == 0) return;
    make_room();
    std::array<const float*, Wide::kWidth> rows;
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = row_[i].data();
    const WideRow row = load_rows(rows);
    for (std::size_t column = 0; column < kFloatColumns; ++column)
        row[column].store_unaligned(&floats_[column][count_]);
    for (std::size_t column = 0; column < kBitColumns; ++column)
        WideBits::of(row[kFloatColumns + column]).store_unaligned(&bits_[column][count_]);
    count_ += std::exchange(rows_, 0);
}

void ShadowRayQueue::to_sample(const WideShadowRays& connections, WideMask which) {
    flush();
    make_room();
    const auto put = [&](auto& column, auto lanes) { compress(lanes, which).store_unaligned(&column[count_]); };
    put(floats_[kOriginX], connections.origin.x);
    put(floats_[kOriginY], connections.origin.y);
    put(floats_[kOriginZ], connections.origin.z);
    put(floats_[kDirectionX], connections.direction.x);
    put(floats_[kDirectionY], connections.direction.y);
    put(floats_[kDirectionZ], connections.direction.z);
    put(floats_[kTMax], connections.t_max);
    put(floats_[kTime], connections.time);
    put(floats_[kRed], connections.contribution.r);
    put(floats_[kGreen], connections.contribution.g);
    put(floats_[kBlue], connections.contribution.b);
    put(bits_[kAlphaKey], connections.alpha_key);
    put(bits_[kSlot], connections.slot);
    put(bits_[kLightKind], select(connections.is_direct, WideBits(static_cast<std::uint32_t>(LightKind::Direct)),
                                  WideBits(static_cast<std::uint32_t>(LightKind::Indirect))));
    put(bits_[kEndOfShares], WideBits(static_cast<std::uint32_t>(shares_.size())));
    count_ += count(which);
}

void ShadowRayQueue::to_film(const Ray& ray, std::uint32_t slot, const Splat& splat, LightKind kind,
                             std::span<const ExpressionShare> shares) {
    to_sample(ray, slot, splat.value, kind, shares);
    places_.push_back({splat.position, splat.depth});
}

RayColumns ShadowRayQueue::rays() const {
    const auto floats = [&](FloatColumn column) { return floats_[column].data(); };
    return {floats(kOriginX),    floats(kOriginY), floats(kOriginZ), floats(kDirectionX),     floats(kDirectionY),
            floats(kDirectionZ), floats(kTMax),    floats(kTime),    bits_[kAlphaKey].data(), count_};
}

void ShadowRayQueue::resolve(const World& world, const TileJob& job, std::span<const CameraSample> samples,
                             SampleLight& light, TileBuffer& tile, RenderCounters& counters) {
    flush();
    if (count_ == 0) return;
    occluded_.resize(count_);
    const RayColumns rays_traced = rays();
    occluded_batch(world, job, kind_, rays_traced, occluded_, counters);
    const std::span<const ExpressionShare> all_shares(shares_);
    const auto add_splat = [&](std::uint32_t slot, const Splat& splat, LightKind kind,
                               std::span<const ExpressionShare> shares) {
        const std::size_t first = tile.splats().size();
        light.add_splat(slot, samples[slot].key.index, splat, kind, shares, tile.splats());
        if (world.traits().film_wraps) repeat_splats(job, first, tile.splats());
    };
    for (std::size_t i = 0, first = 0; i < count_; ++i) {
        const auto shares = all_shares.subspan(first, bits_[kEndOfShares][i] - first);
        first = bits_[kEndOfShares][i];
        const std::uint32_t slot = bits_[kSlot][i];
        light.count_ray(slot);
        if (occluded_[i] == kOccluded) continue;
        Rgb value{floats_[kRed][i], floats_[kGreen][i], floats_[kBlue][i]};
        if (occluded_[i] == kPassesClear) value *= world.geometry().clear_transmittance(rays_traced[i], ends_of(kind_));
        const auto kind = static_cast<LightKind>(bits_[kLightKind][i]);
        if (places_.empty())
            light.add(slot, value, kind, shares);
        else if (is_finite(value) && min_component(value) >= 0.0f)
            add_splat(slot, {.position = places_[i].position, .value = value, .depth = places_[i].depth}, kind, shares);
        else
            counters.drop(located(job, samples[slot]));
    }
    count_ = 0;
    places_.clear();
    shares_.clear();
    stamp(job.profile, Stage::Splat);
}

}  // namespace etendue
