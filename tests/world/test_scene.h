// Scene descriptions made by hand, for the tests of everything that needs a World.
#pragma once

#include "core/vec.h"
#include "scene/scene_desc.h"
#include "support/random.h"
#include "world/compile.h"
#include "world/world.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace etendue::test {

/// A scene with a camera at the origin that looks along -Z, 4 × 4 pixels, and nothing else.
[[nodiscard]] SceneDesc empty_scene();

/// A diffuse material with this albedo.
[[nodiscard]] MaterialDesc diffuse(const Rgb& albedo);
/// A material that emits and reflects nothing.
[[nodiscard]] MaterialDesc emissive(const Rgb& radiance);

Handle<MaterialDesc> add_material(SceneDesc& scene, MaterialDesc material);
Handle<MeshDesc> add_mesh(SceneDesc& scene, std::vector<PrimitiveDesc> primitives);
void place(SceneDesc& scene, Handle<MeshDesc> mesh, const Mat4f& to_world = Mat4f());
/// Adds a mesh of one primitive and places it.
void add_object(SceneDesc& scene, PrimitiveDesc primitive, Handle<MaterialDesc> material,
                const Mat4f& to_world = Mat4f());

/// The parallelogram center ± x ± y, with its front towards cross(x, y) and texture coordinates as in glTF: u along x,
/// v against y. Normals are flat.
[[nodiscard]] PrimitiveDesc quad(const Vec3f& center, const Vec3f& x, const Vec3f& y);
/// The cube [-1, 1]³ with flat faces and the front outside.
[[nodiscard]] PrimitiveDesc cube();
/// A sphere of longitude-latitude patches with exact normals and the front outside.
[[nodiscard]] PrimitiveDesc sphere(const Vec3f& center, float radius, int rings);
/// An exact shape around the origin with half its size along each axis.
[[nodiscard]] PrimitiveDesc exact(ShapeKind kind, const Vec3f& half_size);
/// `count` random triangles inside the cube [-1, 1]³, of sides up to `size`, flat normals.
[[nodiscard]] PrimitiveDesc soup(Random& random, int count, float size);

/// A path that no other test process uses: CTest runs several at a time.
[[nodiscard]] std::filesystem::path temporary_file(const std::string& name);

/// Writes `texels` (rgba, row by row, values 0 … 255) as a PNG and adds it as a texture.
Handle<TextureDesc> add_texture(SceneDesc& scene, const std::filesystem::path& png, int width,
                                const std::vector<std::array<int, 4>>& texels);

/// Adds the image of this size in a file as a texture.
Handle<TextureDesc> add_texture(SceneDesc& scene, const std::filesystem::path& image, int width, int height);

/// Without copies: what is placed twice is an instance, however small.
inline constexpr CompileOptions kInstanced{.most_copied_triangles = 0};

/// Validates and compiles in Linear Rec.709, so that colours come out as they went in.
[[nodiscard]] World compile(SceneDesc scene, const CompileOptions& options = kInstanced);
[[nodiscard]] World compile(SceneDesc scene, const std::string& working_space, ProblemList& problems,
                            const CompileOptions& options = kInstanced);

[[nodiscard]] Hit intersect(const World& world, const Ray& ray);
[[nodiscard]] bool occluded(const World& world, const Ray& ray);

[[nodiscard]] Vec3f random_direction(Random& random);
[[nodiscard]] Mat4f translation(const Vec3f& t);
[[nodiscard]] Mat4f scaling(const Vec3f& s);
/// A transform with shear, rotation and uneven scale; mirrored if asked for.
[[nodiscard]] Mat4f random_transform(Random& random, bool mirrored);

}  // namespace etendue::test
