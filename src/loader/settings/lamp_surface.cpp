#include "loader/settings/lamp_surface.h"

#include "loader/settings/material_factors.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace etendue {

namespace {

/// Triangles in double precision, counter-clockwise seen from outside, or from -Z.
struct LampTriangles {
    std::vector<Vec3d> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

double area_of(const LampTriangles& surface) {
    double area = 0.0;
    for (const auto& t : surface.triangles) {
        const Vec3d& p0 = surface.positions[t[0]];
        area += 0.5 * (surface.positions[t[1]] - p0).cross(surface.positions[t[2]] - p0).length();
    }
    return area;
}

/// Scales `surface` about the origin until it has this area.
LampTriangles scaled_to(double area, LampTriangles surface) {
    const double scale = std::sqrt(area / area_of(surface));
    for (Vec3d& p : surface.positions) p *= scale;
    return surface;
}

LampTriangles rectangle() {
    return {{{-0.5, -0.5, 0.0}, {0.5, -0.5, 0.0}, {0.5, 0.5, 0.0}, {-0.5, 0.5, 0.0}}, {{0, 2, 1}, {0, 3, 2}}};
}

LampTriangles disk() {
    constexpr std::uint32_t kCorners = 64;
    LampTriangles fan;
    fan.positions.emplace_back(0.0);
    for (std::uint32_t i = 0; i < kCorners; ++i) {
        const double phi = 2.0 * std::numbers::pi * i / kCorners;
        fan.positions.emplace_back(std::cos(phi), std::sin(phi), 0.0);
        fan.triangles.push_back({0, 1 + (i + 1) % kCorners, 1 + i});
    }
    return scaled_to(std::numbers::pi, std::move(fan));
}

LampTriangles icosahedron() {
    constexpr double kGolden = std::numbers::phi;
    return {{{-1, kGolden, 0},
             {1, kGolden, 0},
             {-1, -kGolden, 0},
             {1, -kGolden, 0},
             {0, -1, kGolden},
             {0, 1, kGolden},
             {0, -1, -kGolden},
             {0, 1, -kGolden},
             {kGolden, 0, -1},
             {kGolden, 0, 1},
             {-kGolden, 0, -1},
             {-kGolden, 0, 1}},
            {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

/// Splits every triangle into four, whose corners are on the unit sphere.
LampTriangles split(const LampTriangles& surface) {
    LampTriangles finer{surface.positions, {}};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [entry, is_new] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(finer.positions.size()));
        if (is_new) finer.positions.push_back((finer.positions[a] + finer.positions[b]).normalized());
        return entry->second;
    };
    for (const auto& [a, b, c] : surface.triangles) {
        const std::uint32_t ab = middle(a, b);
        const std::uint32_t bc = middle(b, c);
        const std::uint32_t ca = middle(c, a);
        finer.triangles.insert(finer.triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    return finer;
}

LampTriangles sphere() {
    constexpr int kSplits = 3;
    LampTriangles ball = icosahedron();
    for (Vec3d& p : ball.positions) p.normalize();
    for (int i = 0; i < kSplits; ++i) ball = split(ball);
    return scaled_to(4.0 * std::numbers::pi, std::move(ball));
}

LampTriangles triangles_of(LampShape shape) {
    switch (shape) {
        case LampShape::Disk:
            return disk();
        case LampShape::Sphere:
            return sphere();
        case LampShape::Rectangle:
            break;
    }
    return rectangle();
}

}  // namespace

double lamp_area(LampShape shape, const Mat4f& to_world) {
    LampTriangles surface = triangles_of(shape);
    const Imath::M44d exact(to_world);
    for (Vec3d& p : surface.positions) p = p * exact;
    return area_of(surface);
}

void add_surface_lamp(const SurfaceLamp& lamp, SceneDesc& scene) {
    const auto last = [](const auto& things) { return static_cast<std::int32_t>(things.size()) - 1; };
    MaterialDesc& material = scene.materials.emplace_back();
    material.name = lamp.data_name;
    if (lamp.stops_light) {
        material.override_model = DiffuseDesc{.albedo = Rgb(0.0f)};
    } else {
        // A pane that reflects nothing: all integrators go on through it, and their shadow rays and connections, too.
        material.metallic = 0.0f;
        material.roughness = 0.0f;
        material.ior = 1.0f;
        material.specular = 0.0f;
        material.transmission = 1.0f;
    }
    material.beam = lamp.beam;
    material.visible_to_camera = lamp.visible_to_camera;
    material.location = lamp.location;
    set_emission(lamp.color, lamp.radiance, material);

    const LampTriangles surface = triangles_of(lamp.shape);
    MeshDesc& mesh = scene.meshes.emplace_back();
    mesh.name = lamp.data_name;
    mesh.location = lamp.location;
    PrimitiveDesc& primitive = mesh.primitives.emplace_back();
    for (const Vec3d& p : surface.positions) primitive.positions.emplace_back(p);
    primitive.triangles = surface.triangles;
    primitive.material = {last(scene.materials)};
    primitive.location = lamp.location;

    InstanceDesc& instance = scene.instances.emplace_back();
    instance.name = lamp.name;
    instance.mesh = {last(scene.meshes)};
    instance.to_world = lamp.to_world;
    instance.location = lamp.location;
    instance.node = lamp.node;
}

}  // namespace etendue
