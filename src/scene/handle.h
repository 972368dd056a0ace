// Typed indices into the vectors of a SceneDesc.
#pragma once

#include <cstdint>

namespace etendue {

/// An index into the vector of `T` in its SceneDesc; -1 means "none".
template <typename T>
struct Handle {
    std::int32_t index = -1;

    [[nodiscard]] constexpr bool valid() const { return index >= 0; }
    [[nodiscard]] constexpr explicit operator bool() const { return valid(); }
    friend constexpr bool operator==(const Handle&, const Handle&) = default;
};

}  // namespace etendue
