// What lies between the stages of shading a block of paths, or of its look-ups, and what paths of a wave are between
// their rays, as columns that are computed with many at once.
//
// Which of its steps a path takes depends on the path alone, on its surface and on its light, never on how many others
// take them too: lanes without such a path are computed with the rest, and what comes of them is not looked at.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "core/wide.h"
#include "core/wide_bits.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace etendue {

/// Counts the paths of a block, which go from one stage of shading to the next together: what lies between the stages
/// stays in the first-level cache.
inline constexpr std::size_t kBlockLanes = 64;
static_assert(kBlockLanes % Wide::kWidth == 0);

/// Holds one number for each of `kSize` paths.
template <std::size_t kSize>
class BasicColumn {
  public:
    [[nodiscard]] float operator[](std::size_t lane) const { return values_[lane]; }
    void set(std::size_t lane, float value) { values_[lane] = value; }
    /// Loads the numbers of `Wide::kWidth` paths from path `first` on, which is a multiple of that width.
    [[nodiscard]] Wide load(std::size_t first) const { return Wide::load(&values_[first]); }
    void store(std::size_t first, Wide values) { values.store(&values_[first]); }
    [[nodiscard]] Wide load_unaligned(std::size_t first) const { return Wide::load_unaligned(&values_[first]); }
    void store_unaligned(std::size_t first, Wide values) { values.store_unaligned(&values_[first]); }
    [[nodiscard]] const float* data() const { return values_.data(); }

  private:
    static_assert(kSize % Wide::kWidth == 0);
    alignas(Wide::kAlignment) std::array<float, kSize> values_{};
};

/// Holds 32 bits for each of `kSize` paths.
template <std::size_t kSize>
class BasicBitColumn {
  public:
    [[nodiscard]] std::uint32_t operator[](std::size_t lane) const { return values_[lane]; }
    void set(std::size_t lane, std::uint32_t bits) { values_[lane] = bits; }
    [[nodiscard]] WideBits load(std::size_t first) const { return WideBits::load(&values_[first]); }
    void store(std::size_t first, WideBits bits) { store_unaligned(first, bits); }
    void store_unaligned(std::size_t first, WideBits bits) { bits.store_unaligned(&values_[first]); }
    [[nodiscard]] const std::uint32_t* data() const { return values_.data(); }

  private:
    static_assert(kSize % Wide::kWidth == 0);
    alignas(Wide::kAlignment) std::array<std::uint32_t, kSize> values_{};
};

template <std::size_t kSize>
struct BasicVec2Columns {
    BasicColumn<kSize> x, y;

    [[nodiscard]] Vec2f operator[](std::size_t lane) const { return {x[lane], y[lane]}; }
    void set(std::size_t lane, Vec2f v) {
        x.set(lane, v.x);
        y.set(lane, v.y);
    }
    [[nodiscard]] Imath::Vec2<Wide> load(std::size_t first) const { return {x.load(first), y.load(first)}; }
    void store(std::size_t first, const Imath::Vec2<Wide>& v) {
        x.store(first, v.x);
        y.store(first, v.y);
    }
};

template <std::size_t kSize>
struct BasicVec3Columns {
    BasicColumn<kSize> x, y, z;

    [[nodiscard]] Vec3f operator[](std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
    void set(std::size_t lane, const Vec3f& v) {
        x.set(lane, v.x);
        y.set(lane, v.y);
        z.set(lane, v.z);
    }
    [[nodiscard]] Imath::Vec3<Wide> load(std::size_t first) const {
        return {x.load(first), y.load(first), z.load(first)};
    }
    void store(std::size_t first, const Imath::Vec3<Wide>& v) {
        x.store(first, v.x);
        y.store(first, v.y);
        z.store(first, v.z);
    }
};

template <std::size_t kSize>
struct BasicRgbColumns {
    BasicColumn<kSize> r, g, b;

    [[nodiscard]] Rgb operator[](std::size_t lane) const { return {r[lane], g[lane], b[lane]}; }
    void set(std::size_t lane, const Rgb& c) {
        r.set(lane, c.r);
        g.set(lane, c.g);
        b.set(lane, c.b);
    }
    [[nodiscard]] BasicRgb<Wide> load(std::size_t first) const { return {r.load(first), g.load(first), b.load(first)}; }
    void store(std::size_t first, const BasicRgb<Wide>& c) {
        r.store(first, c.r);
        g.store(first, c.g);
        b.store(first, c.b);
    }
};

using Column = BasicColumn<kBlockLanes>;
using BitColumn = BasicBitColumn<kBlockLanes>;
using Vec2Columns = BasicVec2Columns<kBlockLanes>;
using Vec3Columns = BasicVec3Columns<kBlockLanes>;
using RgbColumns = BasicRgbColumns<kBlockLanes>;

}  // namespace etendue
