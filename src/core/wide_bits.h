// 32 random bits for each of as many samples as `Wide` has lanes: what hashes and scrambling compute with many at once.
#pragma once

#include "core/wide.h"

#include <array>
#include <cstdint>

namespace etendue {

class WideBits {
  public:
    using Tag = lanes::RebindToUnsigned<Wide::Tag>;
    using Simd = lanes::Vec<Tag>;

    /// Puts `bits` into every lane.
    WideBits(std::uint32_t bits)
        : lanes_(lanes::Set(Tag(), bits)) {}  // NOLINT(google-explicit-constructor): as of Wide
    explicit WideBits(Simd lanes) : lanes_(lanes) {}

    /// Loads `Wide::kWidth` numbers from any address.
    [[nodiscard]] static WideBits load(const std::uint32_t* from) { return WideBits(lanes::LoadU(Tag(), from)); }

    /// Stores `Wide::kWidth` numbers to any address.
    void store_unaligned(std::uint32_t* to) const { lanes::StoreU(lanes_, Tag(), to); }

    /// Returns the bits as floats that are only to be moved: what they stand for is of no meaning.
    [[nodiscard]] Wide as_floats() const { return Wide(lanes::BitCast(Wide::Tag(), lanes_)); }
    /// Returns the bits of `floats`.
    [[nodiscard]] static WideBits of(Wide floats) { return WideBits(lanes::BitCast(Tag(), floats.simd())); }

    WideBits& operator^=(WideBits o) { return *this = *this ^ o; }
    WideBits& operator+=(WideBits o) { return *this = *this + o; }
    WideBits& operator*=(WideBits o) { return *this = *this * o; }

    [[nodiscard]] friend WideBits operator^(WideBits a, WideBits b) { return WideBits(lanes::Xor(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend WideBits operator|(WideBits a, WideBits b) { return WideBits(lanes::Or(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend WideBits operator&(WideBits a, WideBits b) { return WideBits(lanes::And(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend WideBits operator+(WideBits a, WideBits b) { return WideBits(lanes::Add(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend WideBits operator*(WideBits a, WideBits b) { return WideBits(lanes::Mul(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend WideBits operator<<(WideBits a, int bits) {
        return WideBits(lanes::ShiftLeftSame(a.lanes_, bits));
    }
    [[nodiscard]] friend WideBits operator>>(WideBits a, int bits) {
        return WideBits(lanes::ShiftRightSame(a.lanes_, bits));
    }

    [[nodiscard]] friend WideMask operator!=(WideBits a, WideBits b) {
        return WideMask(lanes::RebindMask(Wide::Tag(), lanes::Ne(a.lanes_, b.lanes_)));
    }
    [[nodiscard]] friend WideBits select(WideMask condition, WideBits if_true, WideBits if_false) {
        return of(select(condition, if_true.as_floats(), if_false.as_floats()));
    }
    /// Returns the lanes of `a` that are `kept`, one after the other; those behind them are of no meaning.
    [[nodiscard]] friend WideBits compress(WideBits a, WideMask kept) { return of(compress(a.as_floats(), kept)); }

    /// The upper 24 bits as floats in [0, 1).
    [[nodiscard]] friend Wide to_unit_float(WideBits a) {
        const auto upper = lanes::BitCast(lanes::RebindToSigned<Tag>(), lanes::ShiftRight<8>(a.lanes_));
        return Wide(lanes::ConvertTo(Wide::Tag(), upper)) * 0x1p-24f;
    }

    /// Reverses the bits of each number: its bytes, then the bits of each byte by a matrix, or half by half by a table,
    /// where a single number takes some fourteen steps with masks.
    [[nodiscard]] friend WideBits reverse_bits(WideBits a) {
        using Bytes = lanes::Repartition<std::uint8_t, Tag>;
        alignas(16) static constexpr std::array<std::uint8_t, 16> kReversed{3,  2,  1, 0, 7,  6,  5,  4,
                                                                            11, 10, 9, 8, 15, 14, 13, 12};
        const auto bytes =
            lanes::TableLookupBytes(lanes::BitCast(Bytes(), a.lanes_), lanes::LoadDup128(Bytes(), kReversed.data()));
#if defined(__GFNI__) && defined(__AVX512BW__)  // of processors that are compiled for alone; no level of x86-64 has it
        const __m512i matrix = _mm512_set1_epi64(static_cast<std::int64_t>(0x8040201008040201u));
        return WideBits(Simd{_mm512_gf2p8affine_epi64_epi8(bytes.raw, matrix, 0)});
#else
        alignas(16) static constexpr std::array<std::uint8_t, 16> kHalves{0, 8, 4, 12, 2, 10, 6, 14,
                                                                          1, 9, 5, 13, 3, 11, 7, 15};
        const auto halves = lanes::LoadDup128(Bytes(), kHalves.data());
        const auto low = lanes::And(bytes, lanes::Set(Bytes(), 0x0f));
        const auto high = lanes::And(lanes::BitCast(Bytes(), lanes::ShiftRight<4>(lanes::BitCast(Tag(), bytes))),
                                     lanes::Set(Bytes(), 0x0f));
        const auto to_high = lanes::ShiftLeft<4>(lanes::BitCast(Tag(), lanes::TableLookupBytes(halves, low)));
        return WideBits(lanes::Or(to_high, lanes::BitCast(Tag(), lanes::TableLookupBytes(halves, high))));
#endif
    }

  private:
    Simd lanes_;
};

}  // namespace etendue
