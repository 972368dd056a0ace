#include "integrator/closed_form_scene.h"

#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

namespace etendue::test {

namespace {

/// A rigid transform that takes -Z to `direction`.
Mat4f facing(const Vec3f& position, const Vec3f& direction) {
    const Vec3f z = -direction;
    const Vec3f reference = std::abs(z.y) < 0.9f ? Vec3f(0.0f, 1.0f, 0.0f) : Vec3f(1.0f, 0.0f, 0.0f);
    const Vec3f x = normalize(cross(reference, z));
    const Vec3f y = cross(z, x);
    return {x.x, x.y, x.z, 0.0f, y.x, y.y, y.z, 0.0f, z.x, z.y, z.z, 0.0f, position.x, position.y, position.z, 1.0f};
}

PrimitiveDesc icosahedron() {
    const float g = std::numbers::phi_v<float>;
    PrimitiveDesc p;
    p.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    p.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (Vec3f& corner : p.positions) corner = normalize(corner);
    return p;
}

PrimitiveDesc quarter_triangles(PrimitiveDesc p) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> midpoints;
    const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
        const auto [entry, is_new] =
            midpoints.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(p.positions.size()));
        if (is_new) p.positions.push_back(normalize(p.positions[a] + p.positions[b]));
        return entry->second;
    };
    const auto coarse = std::move(p.triangles);
    p.triangles.clear();
    for (const auto& [a, b, c] : coarse) {
        const std::uint32_t ab = midpoint(a, b);
        const std::uint32_t bc = midpoint(b, c);
        const std::uint32_t ca = midpoint(c, a);
        p.triangles.insert(p.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    return p;
}

/// Each triangle with vertices and a normal of its own.
PrimitiveDesc faceted(const PrimitiveDesc& shared) {
    PrimitiveDesc p;
    p.positions.reserve(3 * shared.triangles.size());
    p.normals.reserve(3 * shared.triangles.size());
    p.triangles.reserve(shared.triangles.size());
    for (const auto& [a, b, c] : shared.triangles) {
        const auto first = static_cast<std::uint32_t>(p.positions.size());
        const Vec3f corners[3] = {shared.positions[a], shared.positions[b], shared.positions[c]};
        p.positions.insert(p.positions.end(), std::begin(corners), std::end(corners));
        p.normals.insert(p.normals.end(), 3, normalize(cross(corners[1] - corners[0], corners[2] - corners[0])));
        p.triangles.push_back({first, first + 1, first + 2});
    }
    return p;
}

}  // namespace

MaterialDesc diffuse(float albedo) {
    MaterialDesc material;
    material.override_model = DiffuseDesc{Rgb(albedo)};
    return material;
}

MaterialDesc emitter(float radiance) {
    MaterialDesc material = diffuse(0.0f);
    material.emissive = Rgb(1.0f);
    material.emissive_strength = radiance;
    return material;
}

MaterialDesc black_card(float alpha, AlphaMode mode) {
    MaterialDesc material = diffuse(0.0f);
    material.alpha_mode = mode;
    material.base_alpha = alpha;
    return material;
}

PrimitiveDesc parallelogram(const Vec3f& center, const Vec3f& edge_u, const Vec3f& edge_v) {
    const Vec3f u = edge_u * 0.5f;
    const Vec3f v = edge_v * 0.5f;
    PrimitiveDesc p;
    p.positions = {center - u - v, center + u - v, center + u + v, center - u + v};
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    return p;
}

PrimitiveDesc quad_facing_up(const Vec3f& center, float size) {
    return parallelogram(center, {0.0f, 0.0f, size}, {size, 0.0f, 0.0f});
}

PrimitiveDesc quad_facing_down(const Vec3f& center, float size) {
    return parallelogram(center, {size, 0.0f, 0.0f}, {0.0f, 0.0f, size});
}

PrimitiveDesc box(const Vec3f& low, const Vec3f& high) {
    const Vec3f middle = (low + high) * 0.5f;
    const Vec3f size = high - low;
    const Vec3f x(size.x, 0.0f, 0.0f);
    const Vec3f y(0.0f, size.y, 0.0f);
    const Vec3f z(0.0f, 0.0f, size.z);
    PrimitiveDesc all;
    const auto add_face = [&](const Vec3f& center, const Vec3f& u, const Vec3f& v) {
        const PrimitiveDesc face = parallelogram(center, u, v);
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), face.positions.begin(), face.positions.end());
        for (const auto& t : face.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    };
    add_face({middle.x, middle.y, high.z}, x, y);
    add_face({middle.x, middle.y, low.z}, y, x);
    add_face({high.x, middle.y, middle.z}, y, z);
    add_face({low.x, middle.y, middle.z}, z, y);
    add_face({middle.x, high.y, middle.z}, z, x);
    add_face({middle.x, low.y, middle.z}, x, z);
    return all;
}

PrimitiveDesc disk_facing_down(const Vec3f& center, float radius, int segments) {
    PrimitiveDesc p;
    p.positions.push_back(center);
    for (int i = 0; i < segments; ++i) {
        const float angle = 2.0f * kPi * static_cast<float>(i) / static_cast<float>(segments);
        p.positions.push_back(center + Vec3f(std::cos(angle), 0.0f, std::sin(angle)) * radius);
    }
    const auto count = static_cast<std::uint32_t>(segments);
    for (std::uint32_t i = 0; i < count; ++i) p.triangles.push_back({0, 1 + i, 1 + (i + 1) % count});
    return p;
}

PrimitiveDesc sphere(const Vec3f& center, float radius, int subdivisions, Facing facing) {
    PrimitiveDesc p = icosahedron();
    for (int i = 0; i < subdivisions; ++i) p = quarter_triangles(std::move(p));
    for (Vec3f& corner : p.positions) corner = center + corner * radius;
    if (facing == Facing::Inwards)
        for (auto& triangle : p.triangles) std::swap(triangle[1], triangle[2]);
    return p;
}

void add(SceneDesc& scene, const PrimitiveDesc& shape, const MaterialDesc& material, const Mat4f& to_world) {
    PrimitiveDesc primitive = shape.shape ? shape : faceted(shape);
    primitive.material.index = static_cast<std::int32_t>(scene.materials.size());
    scene.materials.push_back(material);
    InstanceDesc instance;
    instance.mesh.index = static_cast<std::int32_t>(scene.meshes.size());
    instance.to_world = to_world;
    scene.meshes.emplace_back().primitives.push_back(std::move(primitive));
    scene.instances.push_back(instance);
}

LightDesc& add_light(SceneDesc& scene, LightType type, float intensity, const Vec3f& position, const Vec3f& direction) {
    LightDesc& light = scene.lights.emplace_back();
    light.type = type;
    light.intensity = intensity;
    light.to_world = facing(position, direction);
    return light;
}

void set_environment(SceneDesc& scene) {
    scene.environment.enabled = true;
}

void look(SceneDesc& scene, const Vec3f& eye, const Vec3f& direction, float half_width) {
    CameraDesc& camera = scene.cameras.emplace_back();
    camera.type = CameraType::Orthographic;
    camera.ymag = half_width;
    camera.to_world = facing(eye, direction);
}

}  // namespace etendue::test
