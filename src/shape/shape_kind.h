// The kinds of exact shapes, and their names.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace etendue {

/// Says which unit shape a shape is made of: each fills the cube [-1, 1]³, or its square in z = 0 if it is flat.
enum class ShapeKind {
    Sphere,
    Disk,       ///< its front towards -z
    Rectangle,  ///< its front towards -z; two triangles where rays are concerned
    Cylinder,   ///< around the y axis, closed at both ends
};

/// Names the kinds as render.json spells them.
inline constexpr std::array<std::pair<std::string_view, ShapeKind>, 4> kShapeKinds{{
    {"sphere", ShapeKind::Sphere},
    {"disk", ShapeKind::Disk},
    {"rectangle", ShapeKind::Rectangle},
    {"cylinder", ShapeKind::Cylinder},
}};

[[nodiscard]] constexpr std::string_view shape_name(ShapeKind kind) {
    return kShapeKinds[static_cast<std::size_t>(kind)].first;
}
/// Returns whether a shape of this kind has no thickness, and so encloses nothing.
[[nodiscard]] constexpr bool is_flat(ShapeKind kind) {
    return kind == ShapeKind::Disk || kind == ShapeKind::Rectangle;
}

}  // namespace etendue
