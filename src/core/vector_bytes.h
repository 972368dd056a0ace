// Memory that containers hold.
#pragma once

#include <cstddef>
#include <vector>

namespace etendue {

/// Bytes that the vectors have reserved for their elements, whatever those hold elsewhere.
template <typename... T>
[[nodiscard]] std::size_t vector_bytes(const std::vector<T>&... vectors) {
    // Of pointers it is they that are held.
    return (std::size_t{0} + ... + (vectors.capacity() * sizeof(T)));  // NOLINT(bugprone-sizeof-expression)
}

}  // namespace etendue
