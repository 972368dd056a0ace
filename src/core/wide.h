// Many floats that are computed with at once: what the functions that are templates of their lane type take for T,
// beside float itself. As many as the machine's widest registers hold, 16 with AVX-512.
//
// Every operation is done lane by lane and, but for logarithms and exponentials, is the one that IEEE 754 says, as with
// float; where the compiler contracts a product and a sum to one rounding may differ between the two, and with it the
// last bit.
#pragma once

#include "core/lane.h"

#include <array>
#include <bit>
#include <cstddef>
#include <limits>

// GCC 12 takes what its own intrinsics leave undefined on purpose for a mistake (its bug 105593).
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#ifndef __clang__  // which has no such warning
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <experimental/simd>
#pragma GCC diagnostic pop
#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace etendue {

/// What comparisons of `Wide` give, a bool for each lane. `&&` and `||` evaluate both sides.
class WideMask {
  public:
    using Simd = std::experimental::native_simd_mask<float>;

    WideMask() = default;
    explicit WideMask(Simd mask) : mask_(mask) {}

    [[nodiscard]] Simd simd() const { return mask_; }
    [[nodiscard]] bool operator[](std::size_t lane) const { return mask_[lane]; }

    [[nodiscard]] friend WideMask operator&&(WideMask a, WideMask b) { return WideMask(a.mask_ && b.mask_); }
    [[nodiscard]] friend WideMask operator||(WideMask a, WideMask b) { return WideMask(a.mask_ || b.mask_); }
    [[nodiscard]] friend WideMask operator!(WideMask a) { return WideMask(!a.mask_); }

    /// True in the first `lanes` of them.
    [[nodiscard]] static WideMask first(std::size_t lanes) {
        using Floats = std::experimental::native_simd<float>;
        return WideMask(Floats([](auto lane) { return static_cast<float>(lane); }) < static_cast<float>(lanes));
    }
    /// In how many lanes it is true.
    [[nodiscard]] friend std::size_t count(WideMask a) {
        return static_cast<std::size_t>(std::experimental::popcount(a.mask_));
    }

  private:
    Simd mask_;
};

class Wide {
  public:
    using Simd = std::experimental::native_simd<float>;
    static constexpr std::size_t kWidth = Simd::size();
    /// Of memory that is loaded from and stored to, bytes.
    static constexpr std::size_t kAlignment = std::experimental::memory_alignment_v<Simd>;

    Wide() = default;
    /// The same number in every lane.
    Wide(float value) : lanes_(value) {}  // NOLINT(google-explicit-constructor): numbers mix with it as with float
    explicit Wide(Simd lanes) : lanes_(lanes) {}

    /// `kWidth` floats from an aligned address.
    [[nodiscard]] static Wide load(const float* from) { return Wide(Simd(from, std::experimental::vector_aligned)); }
    /// From any address.
    [[nodiscard]] static Wide load_unaligned(const float* from) {
        return Wide(Simd(from, std::experimental::element_aligned));
    }
    void store(float* to) const { lanes_.copy_to(to, std::experimental::vector_aligned); }
    /// To any address.
    void store_unaligned(float* to) const { lanes_.copy_to(to, std::experimental::element_aligned); }
    [[nodiscard]] float operator[](std::size_t lane) const { return lanes_[lane]; }
    void set(std::size_t lane, float value) { lanes_[lane] = value; }
    [[nodiscard]] Simd simd() const { return lanes_; }

    Wide& operator+=(Wide o) { return *this = *this + o; }
    Wide& operator-=(Wide o) { return *this = *this - o; }
    Wide& operator*=(Wide o) { return *this = *this * o; }

    [[nodiscard]] friend Wide operator+(Wide a, Wide b) { return Wide(a.lanes_ + b.lanes_); }
    [[nodiscard]] friend Wide operator-(Wide a, Wide b) { return Wide(a.lanes_ - b.lanes_); }
    [[nodiscard]] friend Wide operator*(Wide a, Wide b) { return Wide(a.lanes_ * b.lanes_); }
    [[nodiscard]] friend Wide operator/(Wide a, Wide b) { return Wide(a.lanes_ / b.lanes_); }
    [[nodiscard]] friend Wide operator-(Wide a) { return Wide(-a.lanes_); }

    [[nodiscard]] friend WideMask operator<(Wide a, Wide b) { return WideMask(a.lanes_ < b.lanes_); }
    [[nodiscard]] friend WideMask operator>(Wide a, Wide b) { return WideMask(a.lanes_ > b.lanes_); }
    [[nodiscard]] friend WideMask operator<=(Wide a, Wide b) { return WideMask(a.lanes_ <= b.lanes_); }
    [[nodiscard]] friend WideMask operator>=(Wide a, Wide b) { return WideMask(a.lanes_ >= b.lanes_); }
    [[nodiscard]] friend WideMask operator==(Wide a, Wide b) { return WideMask(a.lanes_ == b.lanes_); }
    [[nodiscard]] friend WideMask operator!=(Wide a, Wide b) { return WideMask(a.lanes_ != b.lanes_); }

    // Two instructions, which the compiler takes for too many where there are many of it; a call saves every register.
    [[nodiscard, gnu::always_inline]] friend Wide select(WideMask condition, Wide if_true, Wide if_false) {
        std::experimental::where(condition.simd(), if_false.lanes_) = if_true.lanes_;
        return if_false;
    }
    /// `table[index]`, lane by lane; the indices are whole numbers.
    [[nodiscard]] friend Wide gather(const float* table, Wide index) {
        const auto whole = std::experimental::static_simd_cast<int>(index.lanes_);
        return Wide(Simd([&](auto lane) { return table[whole[lane]]; }));
    }
    // As those of the standard library are for what is no number.
    [[nodiscard]] friend Wide min(Wide a, Wide b) { return select(b < a, b, a); }
    [[nodiscard]] friend Wide max(Wide a, Wide b) { return select(a < b, b, a); }
    [[nodiscard]] friend Wide clamp(Wide a, Wide low, Wide high) { return min(max(a, low), high); }
    [[nodiscard]] friend Wide abs(Wide a) { return Wide(std::experimental::abs(a.lanes_)); }
    [[nodiscard]] friend Wide floor(Wide a) { return Wide(std::experimental::floor(a.lanes_)); }
    [[nodiscard]] friend Wide sqrt(Wide a) { return Wide(std::experimental::sqrt(a.lanes_)); }
    [[nodiscard]] friend Wide copysign(Wide a, Wide sign) {
        return Wide(std::experimental::copysign(a.lanes_, sign.lanes_));
    }

  private:
    Simd lanes_;
};

/// The lanes of `a` that are `kept`, one after the other; those behind them are of no meaning.
[[nodiscard]] inline Wide compress(Wide a, WideMask kept) {
#ifdef __AVX512F__
    static_assert(sizeof(Wide::Simd) == sizeof(__m512));
    return Wide(std::bit_cast<Wide::Simd>(
        _mm512_maskz_compress_ps(std::bit_cast<__mmask16>(kept.simd()), std::bit_cast<__m512>(a.simd()))));
#else
    std::array<float, Wide::kWidth> lanes{};
    std::size_t next = 0;
    for (std::size_t lane = 0; lane < Wide::kWidth; ++lane) {
        lanes[next] = a[lane];
        next += kept[lane] ? 1 : 0;
    }
    return Wide::load_unaligned(lanes.data());
#endif
}

/// The way back: the first lanes of `a` where lanes are `kept`, `otherwise` in the others.
[[nodiscard]] inline Wide expand(Wide a, WideMask kept, Wide otherwise) {
#ifdef __AVX512F__
    return Wide(std::bit_cast<Wide::Simd>(_mm512_mask_expand_ps(std::bit_cast<__m512>(otherwise.simd()),
                                                                std::bit_cast<__mmask16>(kept.simd()),
                                                                std::bit_cast<__m512>(a.simd()))));
#else
    std::size_t next = 0;
    for (std::size_t lane = 0; lane < Wide::kWidth; ++lane)
        if (kept[lane]) otherwise.set(lane, a[next++]);
    return otherwise;
#endif
}

// The library takes logarithms and exponentials of one lane after the other; these are to some roundings.

/// Numbers as 2^exponent mantissa, the mantissas between the roots of 1/2 and 2; normal positive ones.
class WideBinary {
  public:
    explicit WideBinary(Wide a) : number_(a) {
        constexpr unsigned kRootOfHalf = 0x3f3504f3;  // its bits
        const Bits bits = std::bit_cast<Bits>(a.simd());
        const Int exponent = std::bit_cast<Int>(bits - kRootOfHalf) >> kMantissaBits;
        exponent_ = Wide(std::experimental::static_simd_cast<Wide::Simd>(exponent));
        mantissa_ = Wide(std::bit_cast<Wide::Simd>(bits - (std::bit_cast<Bits>(exponent) << kMantissaBits)));
    }

    /// 2^`exponent`, which are whole numbers within [-126, 127].
    [[nodiscard]] static Wide power_of_two(Wide exponent) {
        constexpr int kBias = 127;
        return Wide(std::bit_cast<Wide::Simd>((std::experimental::static_simd_cast<Int>(exponent.simd()) + kBias)
                                              << kMantissaBits));
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
    using Int = std::experimental::rebind_simd_t<int, Wide::Simd>;
    using Bits = std::experimental::rebind_simd_t<unsigned, Wide::Simd>;
    static constexpr int kMantissaBits = 23;

    Wide number_, exponent_, mantissa_;
};

inline constexpr float kLn2 = 0.693147180559945309f;

/// Of denormal numbers as of zero, as is that to the base 2.
[[nodiscard]] inline Wide log(Wide a) {
    return WideBinary(a).logarithm(kLn2, 1.0f);
}
[[nodiscard]] inline Wide log2(Wide a) {
    return WideBinary(a).logarithm(1.0f, 1.0f / kLn2);
}
/// Beyond 87 as at 87.
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

/// As of single numbers, but both are evaluated whatever the lanes ask for: with a shortcut where all agree, the
/// compiler could contract what follows in two ways, and a lane's last bits would depend on the lanes beside it.
template <typename IfTrue, typename IfFalse>
[[nodiscard]] auto choose(WideMask condition, const IfTrue& if_true, const IfFalse& if_false) {
    return select(condition, if_true(), if_false());
}

}  // namespace etendue
