// Many floats that are computed with at once: what the functions that are templates of their lane type take for T,
// beside float itself. As many as the machine's widest registers hold, 16 with AVX-512.
//
// Every operation is done lane by lane and, but for logarithms and exponentials, is the one that IEEE 754 says, as with
// float; where the compiler contracts a product and a sum to one rounding may differ between the two, and with it the
// last bit.
#pragma once

#include "core/lane.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

// For the instructions that this source is compiled for; of those the ones that x86-64-v2 lacks are not asked for.
#define HWY_COMPILE_ONLY_STATIC
#define HWY_DISABLE_PCLMUL_AES
// GCC 12 takes what its own intrinsics leave undefined on purpose for a mistake (its bug 105593).
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#ifndef __clang__  // which has no such warning
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <hwy/highway.h>
#pragma GCC diagnostic pop

namespace etendue {

/// Highway's functions for the instructions that a source is compiled for.
namespace lanes = hwy::HWY_NAMESPACE;

/// Holds what comparisons of `Wide` give, a bool for each lane. `&&` and `||` evaluate both sides.
class WideMask {
  public:
    using Tag = lanes::ScalableTag<float>;
    using Simd = lanes::Mask<Tag>;

    WideMask() = default;
    explicit WideMask(Simd mask) : mask_(mask) {}

    [[nodiscard]] Simd simd() const { return mask_; }
    [[nodiscard]] bool operator[](std::size_t lane) const {
        std::array<std::uint8_t, 8> bits;  // as many as are written at least
        lanes::StoreMaskBits(Tag(), mask_, bits.data());
        return ((bits[lane / 8] >> (lane % 8)) & 1u) != 0;
    }

    [[nodiscard]] friend WideMask operator&&(WideMask a, WideMask b) { return WideMask(lanes::And(a.mask_, b.mask_)); }
    [[nodiscard]] friend WideMask operator||(WideMask a, WideMask b) { return WideMask(lanes::Or(a.mask_, b.mask_)); }
    [[nodiscard]] friend WideMask operator!(WideMask a) { return WideMask(lanes::Not(a.mask_)); }

    /// Returns a mask that is true in its first `count` lanes.
    [[nodiscard]] static WideMask first(std::size_t count) { return WideMask(lanes::FirstN(Tag(), count)); }
    /// Returns whether the mask is true in any lane.
    [[nodiscard]] friend bool any(WideMask a) { return !lanes::AllFalse(Tag(), a.mask_); }
    /// Returns in how many lanes the mask is true.
    [[nodiscard]] friend std::size_t count(WideMask a) { return lanes::CountTrue(Tag(), a.mask_); }

  private:
    Simd mask_;
};

class Wide {
  public:
    using Tag = WideMask::Tag;
    using Simd = lanes::Vec<Tag>;
    static constexpr std::size_t kWidth = lanes::MaxLanes(Tag());
    /// Bytes to which memory that is loaded and stored must be aligned. It is one number for every width, so that the
    /// layout of memory does not depend on the width.
    static constexpr std::size_t kAlignment = 64;
    static_assert(sizeof(Simd) <= kAlignment);
    /// The most lanes that any processor has: so many numbers behind an array can be loaded with its last ones.
    static constexpr std::size_t kMostLanes = kAlignment / sizeof(float);

    Wide() = default;
    /// Puts `value` into every lane.
    Wide(float value) : lanes_(lanes::Set(Tag(), value)) {}  // NOLINT(google-explicit-constructor): mixes as float does
    explicit Wide(Simd lanes) : lanes_(lanes) {}

    /// Loads `kWidth` floats from an aligned address.
    [[nodiscard]] static Wide load(const float* from) { return Wide(lanes::Load(Tag(), from)); }
    /// Loads `kWidth` floats from any address.
    [[nodiscard]] static Wide load_unaligned(const float* from) { return Wide(lanes::LoadU(Tag(), from)); }
    void store(float* to) const { lanes::Store(lanes_, Tag(), to); }
    /// Stores `kWidth` floats to any address.
    void store_unaligned(float* to) const { lanes::StoreU(lanes_, Tag(), to); }
    [[nodiscard]] float operator[](std::size_t lane) const { return lanes::ExtractLane(lanes_, lane); }
    void set(std::size_t lane, float value) { lanes_ = lanes::InsertLane(lanes_, lane, value); }
    [[nodiscard]] Simd simd() const { return lanes_; }

    Wide& operator+=(Wide o) { return *this = *this + o; }
    Wide& operator-=(Wide o) { return *this = *this - o; }
    Wide& operator*=(Wide o) { return *this = *this * o; }

    [[nodiscard]] friend Wide operator+(Wide a, Wide b) { return Wide(lanes::Add(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend Wide operator-(Wide a, Wide b) { return Wide(lanes::Sub(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend Wide operator*(Wide a, Wide b) { return Wide(lanes::Mul(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend Wide operator/(Wide a, Wide b) { return Wide(lanes::Div(a.lanes_, b.lanes_)); }
    // The compiler's own negation and not lanes::Neg, which it would not contract with a product.
    [[nodiscard]] friend Wide operator-(Wide a) { return Wide(Simd{-a.lanes_.raw}); }

    [[nodiscard]] friend WideMask operator<(Wide a, Wide b) { return WideMask(lanes::Lt(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend WideMask operator>(Wide a, Wide b) { return WideMask(lanes::Gt(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend WideMask operator<=(Wide a, Wide b) { return WideMask(lanes::Le(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend WideMask operator>=(Wide a, Wide b) { return WideMask(lanes::Ge(a.lanes_, b.lanes_)); }
    [[nodiscard]] friend WideMask operator==(Wide a, Wide b) { return WideMask(lanes::Eq(a.lanes_, b.lanes_)); }
    // lanes::Ne is false of what is no number.
    [[nodiscard]] friend WideMask operator!=(Wide a, Wide b) { return !(a == b); }

    // Two instructions, which the compiler takes for too many where there are many of it; a call saves every register.
    [[nodiscard, gnu::always_inline]] friend Wide select(WideMask condition, Wide if_true, Wide if_false) {
        return Wide(lanes::IfThenElse(condition.simd(), if_true.lanes_, if_false.lanes_));
    }
    /// `table[index]`, lane by lane; the indices are whole numbers.
    [[nodiscard]] friend Wide gather(const float* table, Wide index) {
        return Wide(lanes::GatherIndex(Tag(), table, lanes::ConvertTo(lanes::RebindToSigned<Tag>(), index.lanes_)));
    }
    // As those of the standard library are for what is no number, since x86 takes the second operand then.
    [[nodiscard]] friend Wide min(Wide a, Wide b) { return Wide(lanes::Min(b.lanes_, a.lanes_)); }
    [[nodiscard]] friend Wide max(Wide a, Wide b) { return Wide(lanes::Max(b.lanes_, a.lanes_)); }
    [[nodiscard]] friend Wide clamp(Wide a, Wide low, Wide high) { return min(max(a, low), high); }
    [[nodiscard]] friend Wide abs(Wide a) { return Wide(lanes::Abs(a.lanes_)); }
    [[nodiscard]] friend Wide floor(Wide a) { return Wide(lanes::Floor(a.lanes_)); }
    [[nodiscard]] friend Wide sqrt(Wide a) { return Wide(lanes::Sqrt(a.lanes_)); }
    [[nodiscard]] friend Wide copysign(Wide a, Wide sign) { return Wide(lanes::CopySign(a.lanes_, sign.lanes_)); }

  private:
    Simd lanes_;
};

/// The lanes of `a` that are `kept`, one after the other; those behind them are of no meaning.
[[nodiscard]] inline Wide compress(Wide a, WideMask kept) {
    return Wide(lanes::Compress(a.simd(), kept.simd()));
}

/// Undoes `compress`: puts the first lanes of `a` into the lanes that are `kept`, and `otherwise` into the others.
[[nodiscard]] inline Wide expand(Wide a, WideMask kept, Wide otherwise) {
#if HWY_TARGET <= HWY_AVX3  // Highway has no such function before version 1.0.4
    return Wide(Wide::Simd{_mm512_mask_expand_ps(otherwise.simd().raw, kept.simd().raw, a.simd().raw)});
#else
    std::size_t next = 0;
    for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
        if (kept[lane]) otherwise.set(lane, a[next++]);
    return otherwise;
#endif
}

// Highway's own (hwy/contrib/math) are off by up to 4 units in the last place, these by 3; and its logarithms of
// infinity are numbers.

/// Numbers as 2^exponent mantissa, the mantissas between the roots of 1/2 and 2; normal positive ones.
class WideBinary {
  public:
    explicit WideBinary(Wide a) : number_(a) {
        constexpr unsigned kRootOfHalf = 0x3f3504f3;  // its bits
        const auto bits = lanes::BitCast(Bits(), a.simd());
        const auto exponent =
            lanes::ShiftRight<kMantissaBits>(lanes::BitCast(Int(), lanes::Sub(bits, lanes::Set(Bits(), kRootOfHalf))));
        exponent_ = Wide(lanes::ConvertTo(Wide::Tag(), exponent));
        mantissa_ = Wide(lanes::BitCast(
            Wide::Tag(), lanes::Sub(bits, lanes::ShiftLeft<kMantissaBits>(lanes::BitCast(Bits(), exponent)))));
    }

    /// 2^`exponent`, which are whole numbers within [-126, 127].
    [[nodiscard]] static Wide power_of_two(Wide exponent) {
        constexpr int kBias = 127;
        const auto biased = lanes::Add(lanes::ConvertTo(Int(), exponent.simd()), lanes::Set(Int(), kBias));
        return Wide(lanes::BitCast(Wide::Tag(), lanes::ShiftLeft<kMantissaBits>(biased)));
    }

    /// `of_exponent` times the exponent plus `of_mantissa` times the natural logarithm of the mantissa. Denormal
    /// numbers count as zero.
    [[nodiscard]] Wide logarithm(float of_exponent, float of_mantissa) const {
        // The series of the inverse hyperbolic tangent; t is at most 0.172.
        const Wide t = (mantissa_ - 1.0f) / (mantissa_ + 1.0f);
        const Wide t2 = t * t;
        const Wide natural =
            t * (2.0f + t2 * (2.0f / 3.0f + t2 * (2.0f / 5.0f + t2 * (2.0f / 7.0f + t2 * (2.0f / 9.0f)))));
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        const Wide special = select(number_ >= Wide(0.0f), select(number_ > Wide(1.0f), number_, Wide(-kInfinity)),
                                    Wide(std::numeric_limits<float>::quiet_NaN()));
        return select(number_ >= Wide(std::numeric_limits<float>::min()) && number_ < Wide(kInfinity),
                      of_exponent * exponent_ + of_mantissa * natural, special);
    }

  private:
    using Int = lanes::RebindToSigned<Wide::Tag>;
    using Bits = lanes::RebindToUnsigned<Wide::Tag>;
    static constexpr int kMantissaBits = 23;

    Wide number_, exponent_, mantissa_;
};

inline constexpr float kLn2 = 0.693147180559945309f;

/// Returns the natural logarithm of each lane; denormal numbers count as zero, in `log2` too.
[[nodiscard]] inline Wide log(Wide a) {
    return WideBinary(a).logarithm(kLn2, 1.0f);
}
[[nodiscard]] inline Wide log2(Wide a) {
    return WideBinary(a).logarithm(1.0f, 1.0f / kLn2);
}
/// Returns e^a - 1 of each lane; numbers outside of [-87, 87] count as the nearer end.
[[nodiscard]] inline Wide expm1(Wide a) {
    // e^a = 2^n e^r with |r| at most half of ln 2; taken off in two parts, of which the first is exact, n leaves r all
    // its digits.
    constexpr float kLn2High = 0.693359375f;
    constexpr float kLn2Low = -2.12194440e-4f;
    const Wide within = clamp(a, Wide(-87.0f), Wide(87.0f));
    const Wide n = floor(within * (1.0f / kLn2) + 0.5f);
    const Wide r = within - n * kLn2High - n * kLn2Low;
    // Taylor's series of (e^r - 1) / r.
    Wide series(1.0f / 40320.0f);
    for (const float factorial : {5040.0f, 720.0f, 120.0f, 24.0f, 6.0f, 2.0f, 1.0f})
        series = series * r + 1.0f / factorial;
    const Wide power = WideBinary::power_of_two(n);
    return power * (series * r) + (power - 1.0f);
}

/// Evaluates both `if_true()` and `if_false()`, whatever the lanes ask for, and takes from them lane by lane as
/// `condition` says: with a shortcut where all lanes agree, the compiler could contract what follows in two ways, and a
/// lane's last bits would depend on the lanes beside it.
template <typename IfTrue, typename IfFalse>
[[nodiscard]] auto choose(WideMask condition, const IfTrue& if_true, const IfFalse& if_false) {
    return select(condition, if_true(), if_false());
}

}  // namespace etendue
