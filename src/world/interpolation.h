// Vertex attributes at a point of a triangle.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace etendue {

/// Interpolates with the weights of the second and third vertex; where all three have one value, exactly that.
template <typename T>
[[nodiscard]] T interpolate(const std::vector<T>& values, const std::array<std::uint32_t, 3>& triangle,
                            Vec2f barycentric) {
    const T& first = values[triangle[0]];
    return first + (values[triangle[1]] - first) * barycentric.x + (values[triangle[2]] - first) * barycentric.y;
}

/// Interpolates texture coordinates; (0, 0) where the mesh has no such coordinates.
[[nodiscard]] inline Vec2f interpolate_uv(const std::vector<Vec2f>& uv, const std::array<std::uint32_t, 3>& triangle,
                                          Vec2f barycentric) {
    return uv.empty() ? Vec2f(0.0f, 0.0f) : interpolate(uv, triangle, barycentric);
}

}  // namespace etendue
