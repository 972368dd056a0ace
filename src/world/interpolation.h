// Vertex attributes at a point of a triangle.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace etendue {

/// `barycentric` are the weights of the second and third vertex.
template <typename T>
[[nodiscard]] T interpolate(const std::vector<T>& values, const std::array<std::uint32_t, 3>& triangle,
                            Vec2f barycentric) {
    return values[triangle[0]] * (1.0f - barycentric.x - barycentric.y) + values[triangle[1]] * barycentric.x +
           values[triangle[2]] * barycentric.y;
}

/// Interpolates texture coordinates; (0, 0) where the mesh has no such coordinates.
[[nodiscard]] inline Vec2f interpolate_uv(const std::vector<Vec2f>& uv, const std::array<std::uint32_t, 3>& triangle,
                                          Vec2f barycentric) {
    return uv.empty() ? Vec2f(0.0f, 0.0f) : interpolate(uv, triangle, barycentric);
}

}  // namespace etendue
