// Contributions that count if nothing is in the way of their rays, and wait for these.
#pragma once

#include "core/ray.h"
#include "core/ray_columns.h"
#include "core/wide_bits.h"
#include "core/wide_rows.h"
#include "film/splat_film.h"
#include "wave/camera_wave.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Holds contributions to samples with their rays, of as many paths as `Wide` has lanes, without shares of expressions.
struct WideShadowRays {
    Imath::Vec3<Wide> origin, direction;
    Wide t_max, time;
    WideBits alpha_key;
    WideBits slot;
    BasicRgb<Wide> contribution;
    WideMask is_direct;
};

/// Where a connection falls on the film, as in Splat.
struct SplatPlace {
    Vec2f position{0.0f, 0.0f};
    float depth = 0.0f;
};

class ShadowRayQueue {
  public:
    /// `kind` is that of their rays.
    explicit ShadowRayQueue(RayKind kind) : kind_(kind) {}

    /// Has `contribution` go to the light of sample `slot` if nothing is in the way of `ray`; expressions have `shares`
    /// of it.
    void to_sample(const Ray& ray, std::uint32_t slot, const Rgb& contribution, LightKind kind,
                   std::span<const ExpressionShare> shares);
    /// Has the contributions of the lanes in `which` go to the samples in their slots if nothing is in the way.
    void to_sample(const WideShadowRays& connections, WideMask which);
    /// Has `splat`, which the light path of sample `slot` has made, go to the film if nothing is in the way of `ray`;
    /// expressions have `shares` of it.
    void to_film(const Ray& ray, std::uint32_t slot, const Splat& splat, LightKind kind,
                 std::span<const ExpressionShare> shares);
    /// Has the contributions of the lanes in `which` go to the film if nothing is in the way, each to the place that
    /// `place_of(lane)` returns.
    template <typename PlaceOf>
    void to_film(const WideShadowRays& connections, WideMask which, const PlaceOf& place_of) {
        to_sample(connections, which);
        for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
            if (which[lane]) places_.push_back(place_of(lane));
    }

    /// Traces all rays and adds what arrives, in the order of the calls above.
    void resolve(const World& world, const TileJob& job, std::span<const CameraSample> samples, SampleLight& light,
                 TileBuffer& tile, RenderCounters& counters);
    [[nodiscard]] std::size_t bytes() const;
    /// True once there are enough to fill a batch.
    [[nodiscard]] bool is_full() const { return count_ + rows_ >= kBatch; }

  private:
    /// Rays traced together: enough for full packets, and their 36 bytes each, 60 with what they bring, stay in a cache
    /// of 1 MiB.
    static constexpr std::size_t kBatch = 8192;
    static_assert(Wide::kWidth <= RayColumns::kPacket);

    /// Numbers the columns of floats.
    enum FloatColumn : std::size_t {
        kOriginX,
        kOriginY,
        kOriginZ,
        kDirectionX,
        kDirectionY,
        kDirectionZ,
        kTMax,
        kTime,
        kRed,
        kGreen,
        kBlue,
        kFloatColumns
    };
    /// Numbers the columns of bits.
    enum BitColumn : std::size_t {
        kAlphaKey,
        kSlot,
        kLightKind,
        kEndOfShares,  ///< where a connection's shares end; they begin where those of the one before end
        kBitColumns
    };
    /// A number for each column: floats, then bits.
    struct alignas(kRowFloats * sizeof(float)) Row : std::array<float, kRowFloats> {};
    static_assert(std::size_t{kFloatColumns} + std::size_t{kBitColumns} <= kRowFloats);

    /// Makes room for as many as a packet has, and for a packet behind them.
    void make_room();
    /// Moves rows to where columns end.
    void flush();
    [[nodiscard]] RayColumns rays() const;

    RayKind kind_;
    // Those that come one by one are put into rows, and moved to the columns many at a time.
    std::array<Row, Wide::kWidth> row_{};
    std::size_t rows_ = 0;
    std::size_t count_ = 0;  ///< in columns
    std::array<std::vector<float>, kFloatColumns> floats_;
    std::array<std::vector<std::uint32_t>, kBitColumns> bits_;
    std::vector<SplatPlace> places_;  ///< places of splats: for all connections or for none
    std::vector<ExpressionShare> shares_;
    std::vector<std::uint8_t> occluded_;
};

}  // namespace etendue
