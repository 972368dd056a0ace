// The paths of a wave that are under way, as columns: their rays, and what they have become so far.
#pragma once

#include "core/columns.h"
#include "core/ray_columns.h"
#include "core/ray_cone.h"
#include "wave/camera_wave.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace etendue {

/// How a path has come to where it is, as bits that lanes compute with. `Bits` is std::uint32_t or WideBits.
namespace path_history {

/// Says that no light sample at the last vertex can find what the path meets: it was a delta, a hidden boundary, a
/// medium where no lights are sampled, or the eye.
inline constexpr std::uint32_t kUnsampled = 1u;
/// Every scattering was a delta: the eye sees this directly or in mirrors.
inline constexpr std::uint32_t kOnlyDeltas = 2u;
/// Every scattering but the last was a delta: what the path meets lights what the eye sees directly or in mirrors.
inline constexpr std::uint32_t kIsDirect = 4u;
/// Adds an edge to the count above the flags, of the edges that the path has once its ray has hit. Media, clear
/// surfaces and hidden boundaries add none.
inline constexpr std::uint32_t kOneEdge = 8u;
inline constexpr std::uint32_t kFlags = kOneEdge - 1u;

inline constexpr std::uint32_t kAtEye = kOneEdge | kUnsampled | kOnlyDeltas | kIsDirect;

[[nodiscard]] constexpr int edges(std::uint32_t history) {
    return static_cast<int>(history / kOneEdge);
}
/// Returns true if the eye sees what the path's ray meets, through clear surfaces at most.
[[nodiscard]] constexpr bool is_seen(std::uint32_t history) {
    return edges(history) == 1 && (history & kOnlyDeltas) != 0;
}
/// Returns the history after a scattering that was no delta, `edges` edges on.
template <typename Bits>
[[nodiscard]] Bits after_lobe(Bits history, std::uint32_t edges) {
    return ((history & Bits(~kFlags)) + Bits(edges * kOneEdge)) | ((history & Bits(kOnlyDeltas)) << 1);
}
[[nodiscard]] constexpr std::uint32_t after_delta(std::uint32_t history) {
    const std::uint32_t only_deltas = history & kOnlyDeltas;
    return ((history & ~kFlags) + kOneEdge) | (only_deltas << 1) | only_deltas | kUnsampled;
}

}  // namespace path_history

/// Says which paths of a block go on, and where they are moved to, a `Wide` of them at a time.
class BlockSurvivors {
  public:
    /// Starts with the block of paths [first, first + count), whose first survivor becomes path `kept`.
    BlockSurvivors(std::size_t first, std::size_t kept) : first_(first), kept_(kept) {}

    /// Adds the next `Wide` of paths, of which those in `goes_on` survive.
    void add(WideMask goes_on) {
        masks_[groups_] = goes_on;
        to_[groups_++] = kept_;
        kept_ += count(goes_on);
    }
    /// Moves what `column` holds of the survivors; no path is moved behind where it was.
    template <typename AnyColumn>
    void move(AnyColumn& column) const {
        for (std::size_t group = 0; group < groups_; ++group)
            column.store_unaligned(to_[group], compress(column.load(first_ + group * Wide::kWidth), masks_[group]));
    }
    /// Calls `move(from, to)` for each survivor in turn.
    template <typename Move>
    void for_each(const Move& move) const {
        for (std::size_t group = 0; group < groups_; ++group)
            for (std::size_t lane = 0, to = to_[group]; lane < Wide::kWidth; ++lane)
                if (masks_[group][lane]) move(first_ + group * Wide::kWidth + lane, to++);
    }
    /// Returns how many survivors there are now, those of former blocks included.
    [[nodiscard]] std::size_t kept() const { return kept_; }

  private:
    static constexpr std::size_t kGroups = kBlockLanes / Wide::kWidth;

    std::size_t first_;
    std::size_t kept_;
    std::size_t groups_ = 0;
    std::array<WideMask, kGroups> masks_;
    std::array<std::size_t, kGroups> to_;
};

struct PathColumns {
    /// Paths in a wave: enough to fill ray packets after many have ended, and few enough that they stay in an L2 cache
    /// of 1 MiB.
    static constexpr std::size_t kCapacity = 2048;
    /// Makes room for the paths of a wave, and behind them for as much as a packet reads, which also keeps columns
    /// apart in the sets of a cache.
    static constexpr std::size_t kSize = kCapacity + RayColumns::kPacket;
    static_assert(Wide::kWidth <= RayColumns::kPacket);

    BasicVec3Columns<kSize> origin, direction;
    BasicColumn<kSize> time;
    BasicBitColumn<kSize> alpha_key;
    BasicRgbColumns<kSize> throughput;
    /// Product of eta² over the refractions so far: what radiance scaling took from the throughput and Russian roulette
    /// must not see.
    BasicColumn<kSize> roulette_scale;
    BasicColumn<kSize> pdf_solid_angle;  ///< 1/sr, of the ray's direction; not meaningful after a delta
    BasicColumn<kSize> wavelength_nm;    ///< nanometres once a dispersive body has refracted it, 0 for all wavelengths
    BasicColumn<kSize> cone_width, cone_spread;  ///< around the ray; followed only where there are textures to filter
    BasicBitColumn<kSize> slot;                  ///< which camera sample
    BasicBitColumn<kSize> pixel_seed, index;     ///< SampleKey of the camera sample
    BasicBitColumn<kSize> history;               ///< see path_history

    [[nodiscard]] RayColumns rays(std::size_t count) const {
        return {origin.x.data(),    origin.y.data(), origin.z.data(), direction.x.data(), direction.y.data(),
                direction.z.data(), nullptr,         time.data(),     alpha_key.data(),   count};
    }
    void set_ray(std::size_t i, const Ray& ray) {
        origin.set(i, ray.origin);
        direction.set(i, ray.direction);
        time.set(i, ray.time);
        alpha_key.set(i, ray.alpha_key);
    }
    /// Begins the paths of `samples`, which leave the eye along `rays` and have come nowhere yet.
    void begin(std::span<const Ray> rays, std::span<const CameraSample> samples) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            set_ray(i, rays[i]);
            slot.set(i, static_cast<std::uint32_t>(i));
            pixel_seed.set(i, samples[i].key.pixel_seed);
            index.set(i, samples[i].key.index);
        }
        for (std::size_t i = 0; i < rays.size(); i += Wide::kWidth) {
            throughput.store(i, BasicRgb<Wide>(Wide(1.0f)));
            roulette_scale.store(i, Wide(1.0f));
            pdf_solid_angle.store(i, Wide(0.0f));
            wavelength_nm.store(i, Wide(0.0f));
            history.store(i, WideBits(path_history::kAtEye));
        }
    }
    [[nodiscard]] Ray ray(std::size_t i) const { return rays(kCapacity)[i]; }
    [[nodiscard]] SampleKey key(std::size_t i) const { return {pixel_seed[i], index[i]}; }
    [[nodiscard]] RayCone cone(std::size_t i) const { return {cone_width[i], cone_spread[i]}; }
    void set_cone(std::size_t i, const RayCone& cone) {
        cone_width.set(i, cone.width);
        cone_spread.set(i, cone.spread);
    }
    [[nodiscard]] bool is(std::uint32_t flag, std::size_t i) const { return (history[i] & flag) != 0; }
    /// Returns the lanes that have `flag` among the `Wide` of paths from `first` on.
    [[nodiscard]] WideMask are(std::uint32_t flag, std::size_t first) const {
        return (history.load(first) & WideBits(flag)) != WideBits(0u);
    }
    [[nodiscard]] int edges(std::size_t i) const { return path_history::edges(history[i]); }
};

}  // namespace etendue
