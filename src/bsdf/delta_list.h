// All deltas of a lobe at once, for integrators that follow every one of them instead of choosing.
#pragma once

#include "bsdf/bsdf_sample.h"

#include <array>
#include <cstddef>
#include <span>

namespace etendue {

/// `BsdfSample`s whose weight is the albedo of their delta: that of `sample` times the probability of its choice.
class DeltaList {
  public:
    /// A coat's mirror, and of a body what its interface reflects, lets through and gets back, and its opaque share.
    static constexpr std::size_t kCapacity = 6;

    /// Adds `delta` unless it is black; deltas along one direction, up to rounding, become one.
    void add(const BsdfSample& delta) {
        if (is_black(delta.weight)) return;
        for (BsdfSample& known : std::span(deltas_).first(count_))
            if (length_squared(known.wi - delta.wi) < kSameDirection &&
                known.is_transmission == delta.is_transmission) {
                known.weight += delta.weight;
                return;
            }
        if (count_ < kCapacity) deltas_[count_++] = delta;
    }

    [[nodiscard]] bool is_empty() const { return count_ == 0; }
    [[nodiscard]] auto begin() const { return deltas_.begin(); }
    [[nodiscard]] auto end() const { return deltas_.begin() + static_cast<std::ptrdiff_t>(count_); }

  private:
    static constexpr float kSameDirection = 1e-10f;  ///< squared distance

    std::array<BsdfSample, kCapacity> deltas_{};
    std::size_t count_ = 0;
};

}  // namespace etendue
