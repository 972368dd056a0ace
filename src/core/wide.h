// Many floats that are computed with at once: what the functions that are templates of their lane type take for T,
// beside float itself. As many as the machine's widest registers hold, 16 with AVX-512.
//
// Every operation is done lane by lane and is the one that IEEE 754 says, as with float; where the compiler contracts a
// product and a sum to one rounding may differ between the two, and with it the last bit.
#pragma once

#include "core/lane.h"

#include <cstddef>

// GCC 12 takes what its own intrinsics leave undefined on purpose for a mistake (its bug 105593).
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#ifndef __clang__  // which has no such warning
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <experimental/simd>
#pragma GCC diagnostic pop

namespace etendue {

/// What comparisons of `Wide` give, a bool for each lane. `&&` and `||` evaluate both sides.
class WideMask {
  public:
    using Simd = std::experimental::native_simd_mask<float>;

    explicit WideMask(Simd mask) : mask_(mask) {}

    [[nodiscard]] Simd simd() const { return mask_; }
    [[nodiscard]] bool operator[](std::size_t lane) const { return mask_[lane]; }

    [[nodiscard]] friend WideMask operator&&(WideMask a, WideMask b) { return WideMask(a.mask_ && b.mask_); }
    [[nodiscard]] friend WideMask operator||(WideMask a, WideMask b) { return WideMask(a.mask_ || b.mask_); }
    [[nodiscard]] friend WideMask operator!(WideMask a) { return WideMask(!a.mask_); }

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
    void store(float* to) const { lanes_.copy_to(to, std::experimental::vector_aligned); }
    [[nodiscard]] float operator[](std::size_t lane) const { return lanes_[lane]; }

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

    [[nodiscard]] friend Wide select(WideMask condition, Wide if_true, Wide if_false) {
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
    [[nodiscard]] friend Wide log(Wide a) { return Wide(std::experimental::log(a.lanes_)); }
    [[nodiscard]] friend Wide expm1(Wide a) { return Wide(std::experimental::expm1(a.lanes_)); }
    [[nodiscard]] friend Wide sqrt(Wide a) { return Wide(std::experimental::sqrt(a.lanes_)); }
    [[nodiscard]] friend Wide copysign(Wide a, Wide sign) {
        return Wide(std::experimental::copysign(a.lanes_, sign.lanes_));
    }

  private:
    Simd lanes_;
};

/// As of single numbers, but both are evaluated whatever the lanes ask for: with a shortcut where all agree, the
/// compiler could contract what follows in two ways, and a lane's last bits would depend on the lanes beside it.
template <typename IfTrue, typename IfFalse>
[[nodiscard]] auto choose(WideMask condition, const IfTrue& if_true, const IfFalse& if_false) {
    return select(condition, if_true(), if_false());
}

}  // namespace etendue
