#include "world/test_scene.h"

#include "color/color_config.h"
#include "core/parallel.h"
#include "image/write.h"
#include "world/compile.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <unistd.h>

namespace etendue::test {

SceneDesc empty_scene() {
    SceneDesc scene;
    scene.name = "test";
    scene.file = "test.gltf";
    scene.cameras.emplace_back().name = "main";
    scene.settings.film.width = 4;
    scene.settings.film.height = 4;
    return scene;
}

MaterialDesc diffuse(const Rgb& albedo) {
    MaterialDesc material;
    material.override_model = DiffuseDesc{albedo};
    return material;
}

MaterialDesc emissive(const Rgb& radiance) {
    MaterialDesc material = diffuse(Rgb(0.0f));
    const float strength = std::max(1.0f, max_component(radiance));
    material.emissive = radiance / strength;
    material.emissive_strength = strength;
    return material;
}

Handle<MaterialDesc> add_material(SceneDesc& scene, MaterialDesc material) {
    scene.materials.push_back(std::move(material));
    return {static_cast<std::int32_t>(scene.materials.size() - 1)};
}

Handle<MeshDesc> add_mesh(SceneDesc& scene, std::vector<PrimitiveDesc> primitives) {
    scene.meshes.emplace_back().primitives = std::move(primitives);
    return {static_cast<std::int32_t>(scene.meshes.size() - 1)};
}

void place(SceneDesc& scene, Handle<MeshDesc> mesh, const Mat4f& to_world) {
    InstanceDesc& instance = scene.instances.emplace_back();
    instance.mesh = mesh;
    instance.to_world = to_world;
}

void add_object(SceneDesc& scene, PrimitiveDesc primitive, Handle<MaterialDesc> material, const Mat4f& to_world) {
    primitive.material = material;
    place(scene, add_mesh(scene, {std::move(primitive)}), to_world);
}

PrimitiveDesc exact(ShapeKind kind, const Vec3f& half_size) {
    PrimitiveDesc primitive;
    primitive.shape = {kind, half_size};
    primitive.positions = primitive.shape->corners();
    return primitive;
}

PrimitiveDesc quad(const Vec3f& center, const Vec3f& x, const Vec3f& y) {
    PrimitiveDesc primitive;
    primitive.positions = {center - x - y, center + x - y, center + x + y, center - x + y};
    primitive.normals.assign(4, normalize(cross(x, y)));
    primitive.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    primitive.triangles = {{0, 1, 2}, {0, 2, 3}};
    return primitive;
}

PrimitiveDesc cube() {
    PrimitiveDesc all;
    for (const float side : {-1.0f, 1.0f})
        for (int axis = 0; axis < 3; ++axis) {
            Vec3f out(0.0f), x(0.0f), y(0.0f);
            out[axis] = side;
            x[(axis + 1) % 3] = side;
            y[(axis + 2) % 3] = 1.0f;
            const PrimitiveDesc face = quad(out, x, y);
            const auto first = static_cast<std::uint32_t>(all.positions.size());
            all.positions.insert(all.positions.end(), face.positions.begin(), face.positions.end());
            for (const auto& [a, b, c] : face.triangles) all.triangles.push_back({first + a, first + b, first + c});
        }
    return all;
}

PrimitiveDesc sphere(const Vec3f& center, float radius, int rings) {
    PrimitiveDesc primitive;
    const int sectors = 2 * rings;
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s <= sectors; ++s) {
            const float theta = kPi * static_cast<float>(r) / static_cast<float>(rings);
            const float phi = 2.0f * kPi * static_cast<float>(s) / static_cast<float>(sectors);
            const Vec3f n(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
            primitive.positions.push_back(center + n * radius);
            primitive.normals.push_back(n);
            primitive.uv0.emplace_back(phi / (2.0f * kPi), theta / kPi);
        }
    const auto index = [&](int r, int s) { return static_cast<std::uint32_t>(r * (sectors + 1) + s); };
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < sectors; ++s) {
            if (r + 1 < rings) primitive.triangles.push_back({index(r, s), index(r + 1, s), index(r + 1, s + 1)});
            if (r > 0) primitive.triangles.push_back({index(r, s), index(r + 1, s + 1), index(r, s + 1)});
        }
    return primitive;
}

PrimitiveDesc soup(Random& random, int count, float size) {
    PrimitiveDesc primitive;
    const auto in_cube = [&](float half) {
        const float x = random.next();
        const float y = random.next();
        return (Vec3f(x, y, random.next()) * 2.0f - Vec3f(1.0f)) * half;
    };
    for (int i = 0; i < count; ++i) {
        const Vec3f p = in_cube(1.0f - size);
        const Vec3f q = p + in_cube(size);
        const Vec3f r = p + in_cube(size);
        const auto first = static_cast<std::uint32_t>(primitive.positions.size());
        primitive.positions.insert(primitive.positions.end(), {p, q, r});
        primitive.normals.insert(primitive.normals.end(), 3, normalize(cross(q - p, r - p)));
        primitive.triangles.push_back({first, first + 1, first + 2});
    }
    return primitive;
}

std::filesystem::path temporary_file(const std::string& name) {
    return std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "-" + name);
}

Handle<TextureDesc> add_texture(SceneDesc& scene, const std::filesystem::path& png, int width,
                                const std::vector<std::array<int, 4>>& texels) {
    ImageF image(width, static_cast<int>(texels.size()) / width, 4);
    for (std::size_t i = 0; i < texels.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c) image.pixels[i * 4 + c] = static_cast<float>(texels[i][c]) / 255.0f;
    write_image(png, image, {.depth = PixelDepth::UInt8});
    return add_texture(scene, png, image.width, image.height);
}

Handle<TextureDesc> add_texture(SceneDesc& scene, const std::filesystem::path& image, int width, int height) {
    ImageDesc& desc = scene.images.emplace_back();
    desc.path = image;
    desc.width = width;
    desc.height = height;
    TextureDesc& texture = scene.textures.emplace_back();
    texture.image.index = static_cast<std::int32_t>(scene.images.size() - 1);
    return {static_cast<std::int32_t>(scene.textures.size() - 1)};
}

World compile(SceneDesc scene, const CompileOptions& options) {
    ProblemList problems;
    return compile(std::move(scene), kGltfColorSpace, problems, options);
}

World compile(SceneDesc scene, const std::string& working_space, ProblemList& problems, const CompileOptions& options) {
    const ProblemList invalid = validate(scene);
    for (const Problem& problem : invalid.all()) EXPECT_NE(problem.severity, Severity::Error) << problem.str();
    static const ColorConfig colors = ColorConfig::built_in();
    const ThreadPool threads(2);
    return compile_world(std::move(scene), colors, working_space, threads, problems, options);
}

Hit intersect(const World& world, const Ray& ray) {
    Hit hit;
    world.geometry().intersect({&ray, 1}, {&hit, 1}, Coherence::Incoherent);
    return hit;
}

bool occluded(const World& world, const Ray& ray) {
    std::uint8_t result = 0;
    world.geometry().occluded({&ray, 1}, {&result, 1});
    return result != 0;
}

Vec3f random_direction(Random& random) {
    const float z = 2.0f * random.next() - 1.0f;
    const float phi = 2.0f * kPi * random.next();
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

Mat4f translation(const Vec3f& t) {
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, t.x, t.y, t.z, 1};
}

Mat4f scaling(const Vec3f& s) {
    return {s.x, 0, 0, 0, 0, s.y, 0, 0, 0, 0, s.z, 0, 0, 0, 0, 1};
}

Mat4f random_transform(Random& random, bool mirrored) {
    for (;;) {
        Vec3f axes[3];
        for (Vec3f& axis : axes) axis = random_direction(random) * (0.3f + 1.4f * random.next());
        const float volume = dot(cross(axes[0], axes[1]), axes[2]);
        if (std::abs(volume) < 0.2f) continue;
        if ((volume < 0.0f) != mirrored) axes[2] = -axes[2];
        const Vec3f t = random_direction(random) * 1.5f;
        return {axes[0].x, axes[0].y, axes[0].z, 0, axes[1].x, axes[1].y, axes[1].z, 0,
                axes[2].x, axes[2].y, axes[2].z, 0, t.x,       t.y,       t.z,       1};
    }
}

}  // namespace etendue::test
