// Which bodies a point is in.
//
// Bodies are numbered by precedence: where several overlap, the one with the smallest number fills the space (Schmidt
// and Budge, "Simple Nested Dielectrics in Ray Traced Images", JGT 7(2), 2002). The rule asks only for the set, so it
// says the same whichever way a path came.
#pragma once

#include "world/geometry.h"

#include <array>
#include <cstdint>

namespace etendue {

class Interior {
  public:
    /// Bodies within bodies that are kept; those beyond are as if they were not there.
    static constexpr std::uint32_t kCapacity = 7;

    void enter(std::uint32_t body);
    /// Takes a body out of the set; one that is not in the set is ignored, as meshes with holes make it happen.
    void leave(std::uint32_t body);
    [[nodiscard]] bool is_empty() const { return count_ == 0; }
    /// Returns the body that fills the space, kNone in the open.
    [[nodiscard]] std::uint32_t filling() const;

    /// Returns whether both have the same bodies, in whatever order these were entered.
    friend bool operator==(const Interior& a, const Interior& b);

  private:
    std::array<std::uint32_t, kCapacity> bodies_{};
    std::uint32_t count_ = 0;
};

}  // namespace etendue
