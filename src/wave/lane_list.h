// Some of the paths of a block.
#pragma once

#include "core/columns.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace etendue {

/// Lists lanes in the order in which they were offered, each at most once.
class LaneList {
  public:
    /// Numbers a lane. It is no byte: a byte may be a part of anything, and compilers would read the count anew after
    /// every one they write.
    using Lane = std::uint16_t;

    void clear() { count_ = 0; }
    void add(std::size_t lane) { add_if(true, lane); }
    /// Adds `lane` if `is_one`, without a branch: which paths these are is chance, which no processor foretells.
    void add_if(bool is_one, std::size_t lane) {
        lanes_[count_] = static_cast<Lane>(lane);
        count_ += is_one ? 1 : 0;
    }

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] std::size_t operator[](std::size_t i) const { return lanes_[i]; }
    [[nodiscard]] const Lane* begin() const { return lanes_.data(); }
    [[nodiscard]] const Lane* end() const { return lanes_.data() + count_; }

  private:
    std::size_t count_ = 0;
    std::array<Lane, kBlockLanes> lanes_{};
};

}  // namespace etendue
