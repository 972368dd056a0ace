// Triangle meshes as plain arrays, and exact shapes.
#pragma once

#include "core/error.h"
#include "core/vec.h"
#include "scene/handle.h"
#include "scene/material_desc.h"
#include "shape/shape_kind.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// The material of a primitive in one of the scene's variants.
struct VariantMaterial {
    std::uint32_t variant = 0;  ///< index into SceneDesc::variants
    Handle<MaterialDesc> material;
};

/// The vertices of a primitive at one moment of its motion.
struct VertexStep {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;  ///< empty where the primitive has none
};

/// Describes an exact shape around the origin of its mesh: an ellipsoid, an ellipse, a rectangle or an elliptic
/// cylinder.
struct ShapeDesc {
    ShapeKind kind = ShapeKind::Sphere;
    Vec3f half_size{1.0f};  ///< metres along each axis, > 0; z is not looked at if it is flat

    /// Returns the corners of its box.
    [[nodiscard]] std::vector<Vec3f> corners() const;
    /// Returns the area, m², of its surface once `to_world`, which must be invertible, has placed it; of a cylinder
    /// only if it stays a round one.
    [[nodiscard]] double area(const Mat4f& to_world) const;
};

/// Triangles with one material, or a shape in their place. Attribute arrays are empty or as long as `positions`. Strips
/// and fans are already unrolled into `triangles`, whose indices are all below positions.size().
struct PrimitiveDesc {
    /// Takes the place of triangles: `positions` are the corners of its box, and all other arrays are empty.
    std::optional<ShapeDesc> shape;
    std::vector<Vec3f> positions;  ///< metres, mesh space, finite
    std::vector<Vec3f> normals;    ///< unit length; empty if every triangle is flat
    std::vector<Vec4f> tangents;   ///< xyz unit length, w = ±1 is the bitangent's sign; empty if the file has none
    std::vector<Vec2f> uv0;
    std::vector<Vec2f> uv1;
    std::vector<Vec4f> colors;  ///< linear Rec.709 rgb and alpha, multiplied with the base colour
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// The vertices at equally spaced times from the shutter's opening to its closing, moving in straight lines between
    /// them; empty if they stay where they are. Tangents are those of the middle, as is everything above.
    std::vector<VertexStep> motion;
    Handle<MaterialDesc> material;
    std::vector<VariantMaterial> variants;  ///< where it has another material than `material`
    SourceLocation location;
};

struct MeshDesc {
    std::string name;
    std::vector<PrimitiveDesc> primitives;
    SourceLocation location;
};

/// The transforms of something that moves, at equally spaced times from the shutter's opening to its closing; each
/// number of the matrix changes linearly between them. Empty for what stays where it is.
using TransformMotion = std::vector<Mat4f>;

/// Most moments of a motion, of transforms and of vertices: what Embree takes.
inline constexpr std::size_t kMaxMotionSteps = 129;

/// A place in the hierarchy of the scene file, for names and for what looks at a node: instances, lamps and cameras
/// have their transforms already.
struct NodeDesc {
    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::string name;
    std::uint32_t parent = kNone;  ///< index into SceneDesc::nodes, smaller than its own; kNone at the top
    std::uint32_t number = 0;      ///< number of the node in the file
    Mat4f to_world{};              ///< in the middle of the shutter, from the scene's origin
    /// Holds `to_world` at equally spaced times while the shutter is open; empty if the node stands still, or is flat
    /// at some time.
    TransformMotion motion{};

    [[nodiscard]] Vec3f position() const { return {to_world[3][0], to_world[3][1], to_world[3][2]}; }
};

/// A mesh placed in the world. Meshes used once and small ones are baked, other shared ones and those that move become
/// instances of one BVH.
struct InstanceDesc {
    std::string name;
    Handle<MeshDesc> mesh;
    Mat4f to_world;  ///< mesh space to world space, in the middle of the shutter; may mirror, must not be singular
    TransformMotion motion;
    SourceLocation location;
    std::uint32_t node = NodeDesc::kNone;  ///< index into SceneDesc::nodes
    bool is_deformed = false;              ///< a skin has placed its vertices in the world
};

}  // namespace etendue
