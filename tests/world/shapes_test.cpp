// Exact shapes in a World: what rays meet of them, one by one and in packets, and what is known there.
#include "core/position_error.h"
#include "scene/accelerator_kind.h"
#include "shape/shape.h"
#include "world/accelerated_scene.h"
#include "world/test_scene.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr ShapeKind kShapes[] = {ShapeKind::Sphere, ShapeKind::Disk, ShapeKind::Cylinder};
const Vec3f kHalfSize{1.2f, 0.8f, 1.0f};

ExactShape reference(ShapeKind kind, const Mat4f& to_world) {
    return ExactShape(kind, scaling(kHalfSize) * to_world);
}

/// One of each kind, or several of each.
SceneDesc scene_of_shapes(bool are_instanced, std::vector<Mat4f>& places, MaterialDesc material = diffuse(Rgb(0.5f))) {
    Random random(5);
    SceneDesc scene = empty_scene();
    const auto handle = add_material(scene, std::move(material));
    for (const ShapeKind kind : kShapes) {
        PrimitiveDesc primitive = exact(kind, kHalfSize);
        primitive.material = handle;
        const auto mesh = add_mesh(scene, {primitive});
        for (const bool mirrored : {false, true}) {
            if (mirrored && !are_instanced) break;
            places.push_back(random_transform(random, mirrored));
            place(scene, mesh, places.back());
        }
    }
    return scene;
}

ShapeKind kind_of(const SceneDesc& scene, std::size_t instance) {
    return scene.meshes[static_cast<std::size_t>(scene.instances[instance].mesh.index)].primitives[0].shape->kind;
}

std::vector<Ray> rays_around(std::size_t count) {
    Random random(6);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        ray.origin = random_direction(random) * (4.0f * random.next());
        ray.direction = random_direction(random);
        if (random.next() < 0.3f) ray.t_max = 2.0f * random.next();
    }
    return rays;
}

TEST(Shapes, AreMetWhereTheirEquationsSay) {
    for (const bool are_instanced : {false, true}) {
        std::vector<Mat4f> places;
        const SceneDesc scene = scene_of_shapes(are_instanced, places);
        std::vector<ExactShape> shapes;
        for (std::size_t i = 0; i < places.size(); ++i) shapes.push_back(reference(kind_of(scene, i), places[i]));
        const World world = compile(scene);
        const std::vector<Ray> rays = rays_around(4000);
        std::vector<Hit> hits(rays.size());
        world.geometry().intersect(rays, hits, Coherence::Incoherent);
        int met = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            double nearest = static_cast<double>(rays[i].t_max);
            std::uint32_t of = kNone;
            for (std::uint32_t s = 0; s < shapes.size(); ++s) {
                const ShapeCrossings crossings = shapes[s].crossings(rays[i].origin, rays[i].direction);
                for (std::size_t c = 0; c < crossings.count; ++c)
                    if (crossings.all[c].t > 0.0 && crossings.all[c].t < nearest) {
                        nearest = crossings.all[c].t;
                        of = s;
                    }
            }
            ASSERT_EQ(hits[i].instance, of) << i;
            if (of == kNone) continue;
            ++met;
            EXPECT_NEAR(static_cast<double>(hits[i].t), nearest, 1e-5 * (1.0 + nearest));
            const SurfacePoint point = world.geometry().surface_point(hits[i]);
            EXPECT_LT(length(point.position - rays[i].origin - rays[i].direction * hits[i].t), 2e-5f);
            EXPECT_NEAR(length(point.geometric_normal), 1.0f, 1e-5f);
            EXPECT_EQ(point.shading.normal, point.geometric_normal);
        }
        EXPECT_GT(met, 500);
    }
}

TEST(Shapes, AreMetAlikeByAllQueries) {
    std::vector<Mat4f> places;
    MaterialDesc veil = diffuse(Rgb(0.5f));
    veil.alpha_mode = AlphaMode::Blend;
    veil.base_alpha = 0.5f;
    for (const bool are_instanced : {false, true}) {
        const World world = compile(scene_of_shapes(are_instanced, places, veil));
        const std::vector<Ray> rays = rays_around(1000);
        std::vector<Hit> single(rays.size());
        world.geometry().intersect(rays, single, Coherence::Incoherent, QueryForm::Single);
        for (const QueryForm form : {QueryForm::Packet8, QueryForm::Packet16})
            for (const Coherence coherence : {Coherence::Coherent, Coherence::Incoherent}) {
                std::vector<Hit> hits(rays.size());
                world.geometry().intersect(rays, hits, coherence, form);
                std::vector<std::uint8_t> occluded(rays.size());
                world.geometry().occluded(rays, occluded, form);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    ASSERT_EQ(hits[i].instance, single[i].instance) << i;
                    if (hits[i].valid()) {
                        EXPECT_EQ(hits[i].t, single[i].t);
                        EXPECT_EQ(hits[i].triangle, single[i].triangle);
                    }
                    EXPECT_EQ(occluded[i], hits[i].valid() ? kOccluded : kFree) << i;
                }
            }
    }
}

/// A disk or a cylinder of `kHalfSize` with so many sides, whose corners are on the exact one.
PrimitiveDesc faceted(ShapeKind kind, int sides) {
    PrimitiveDesc primitive;
    const auto corner = [&](int side, float end) {
        const float angle = 2.0f * kPi * static_cast<float>(side) / static_cast<float>(sides);
        return kHalfSize * (kind == ShapeKind::Disk ? Vec3f(std::cos(angle), std::sin(angle), 0.0f)
                                                    : Vec3f(std::cos(angle), end, std::sin(angle)));
    };
    const auto add = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c) {
        const auto first = static_cast<std::uint32_t>(primitive.positions.size());
        primitive.positions.insert(primitive.positions.end(), {a, b, c});
        primitive.normals.insert(primitive.normals.end(), 3, normalize(cross(b - a, c - a)));
        primitive.triangles.push_back({first, first + 1, first + 2});
    };
    for (int side = 0; side < sides; ++side) {
        if (kind == ShapeKind::Disk) {
            add(Vec3f(0.0f), corner(side, 0.0f), corner(side + 1, 0.0f));
            continue;
        }
        for (const float end : {-1.0f, 1.0f})
            add(kHalfSize * Vec3f(0.0f, end, 0.0f), corner(side, end), corner(side + 1, end));
        add(corner(side, -1.0f), corner(side + 1, -1.0f), corner(side + 1, 1.0f));
        add(corner(side, -1.0f), corner(side + 1, 1.0f), corner(side, 1.0f));
    }
    return primitive;
}

/// How far from its axis a disk or a cylinder in a World ends in this direction, in its radii there.
double radius_towards(const World& world, ShapeKind kind, float angle, float height) {
    const Vec2f to(std::cos(angle), std::sin(angle));
    if (kind == ShapeKind::Cylinder) {
        constexpr float kFar = 3.0f;
        const Vec3f axis = kHalfSize * Vec3f(0.0f, height, 0.0f);
        const Vec3f outwards = kHalfSize * Vec3f(to.x, 0.0f, to.y);
        const Hit hit = intersect(world, {.origin = axis + outwards * kFar, .direction = normalize(-outwards)});
        return static_cast<double>(hit.valid() ? kFar - hit.t / length(outwards) : 0.0f);
    }
    float inside = 0.0f;
    float outside = 2.0f;
    for (int i = 0; i < 24; ++i) {
        const float middle = 0.5f * (inside + outside);
        const Vec3f origin = kHalfSize * Vec3f(to.x * middle, to.y * middle, 2.0f);
        (intersect(world, {.origin = origin, .direction = {0.0f, 0.0f, -1.0f}}).valid() ? inside : outside) = middle;
    }
    return static_cast<double>(inside);
}

// Between corners on a circle, n chords end before it by (pi / n)² / 3 radii on average, and by higher powers of that.
TEST(Shapes, AreWhatFinerAndFinerFacetsComeTo) {
    constexpr int kDirections = 100;
    const auto world_of = [](const PrimitiveDesc& primitive) {
        SceneDesc scene = empty_scene();
        add_object(scene, primitive, add_material(scene, diffuse(Rgb(0.5f))));
        return compile(std::move(scene));
    };
    for (const ShapeKind kind : {ShapeKind::Disk, ShapeKind::Cylinder}) {
        const World exactly = world_of(exact(kind, kHalfSize));
        for (const int sides : {16, 32, 64, 128}) {
            SCOPED_TRACE(testing::Message() << shape_name(kind) << " of " << sides << " sides");
            const World facets = world_of(faceted(kind, sides));
            double error = 0.0;
            for (int i = 0; i < kDirections; ++i) {
                const auto angle = static_cast<float>(2.0 * static_cast<double>(kPi) * std::numbers::phi * i);
                const float height = 1.6f * (static_cast<float>(i) + 0.5f) / kDirections - 0.8f;
                const double of_exact = radius_towards(exactly, kind, angle, height);
                ASSERT_NEAR(of_exact, 1.0, 2e-6);
                error += (of_exact - radius_towards(facets, kind, angle, height)) / kDirections;
            }
            const double expected = std::pow(static_cast<double>(kPi) / sides, 2.0) / 3.0;
            EXPECT_NEAR(error / expected, 1.0, 0.1);
        }
    }
}

// Whichever way a ray leaves a point, it meets no shape there; through a ball it meets the other side.
TEST(Shapes, NeverMeetTheRaysThatLeaveThem) {
    for (const float away : {0.0f, 1000.0f})
        for (const bool are_instanced : {false, true}) {
            std::vector<Mat4f> places;
            SceneDesc scene = scene_of_shapes(are_instanced, places);
            for (InstanceDesc& instance : scene.instances) instance.to_world[3][0] += away;
            const World world = compile(scene);
            std::vector<Ray> rays = rays_around(4000);
            Random random(8);
            for (Ray& ray : rays) ray.origin.x += away;
            for (const Ray& ray : rays) {
                const Hit hit = intersect(world, ray);
                if (!hit.valid()) continue;
                const SurfacePoint point = world.geometry().surface_point(hit);
                for (int way = 0; way < 4; ++way) {
                    Ray next;
                    next.direction = random_direction(random);
                    // Half of them graze.
                    if (way % 2 == 0) next.direction = normalize(point.shading.tangent + next.direction * 1e-3f);
                    next.origin =
                        offset_origin(point.position, point.geometric_normal, point.clearance, next.direction);
                    const Hit other = intersect(world, next);
                    if (!other.valid() || other.instance != hit.instance) continue;
                    // Only of what is closed and from within.
                    const ShapeKind kind = kind_of(scene, hit.instance);
                    ASSERT_FALSE(is_flat(kind));
                    ASSERT_LT(dot(next.direction, point.geometric_normal), 0.0f);
                    // The path leaves the shape there instead of meeting its own start again.
                    const SurfacePoint end = world.geometry().surface_point(other);
                    ASSERT_GT(dot(next.direction, end.geometric_normal), 0.0f);
                }
            }
        }
}

// Alpha 1/2 lets rays pass each of the two sides of a ball with this chance, independently.
TEST(Shapes, LetRaysPassEachOfTheirSidesByItself) {
    SceneDesc scene = empty_scene();
    MaterialDesc veil = diffuse(Rgb(0.5f));
    veil.alpha_mode = AlphaMode::Blend;
    veil.base_alpha = 0.5f;
    add_object(scene, exact(ShapeKind::Sphere, Vec3f(1.0f)), add_material(scene, veil));
    const World world = compile(scene);
    constexpr int kRays = 4000;
    int passed = 0;
    int front = 0;
    for (int i = 0; i < kRays; ++i) {
        Ray ray{.origin = {0.1f, 0.2f, 5.0f}, .direction = {0.0f, 0.0f, -1.0f}};
        ray.alpha_key = static_cast<std::uint32_t>(i) * 7919u;
        const Hit hit = intersect(world, ray);
        if (!hit.valid()) ++passed;
        if (hit.valid() && hit.t < 5.0f) ++front;
        EXPECT_EQ(occluded(world, ray), hit.valid());
    }
    // Six standard deviations.
    EXPECT_NEAR(passed, 0.25 * kRays, 165.0);
    EXPECT_NEAR(front, 0.5 * kRays, 190.0);
}

TEST(Shapes, MoveWithTheirInstances) {
    // What a ray along -z meets of each at x = 0.2 and y = 0.3, and the normal there.
    const Vec3f on_sphere(0.2f, 0.3f, std::sqrt(1.0f - 0.13f));
    const Vec3f on_tube(0.2f, 0.0f, std::sqrt(1.0f - 0.04f));
    const Vec3f to_front(0.0f, 0.0f, -1.0f);
    const struct {
        ShapeKind kind;
        float z;
        Vec3f normal;
    } cases[] = {{ShapeKind::Sphere, on_sphere.z, on_sphere},
                 {ShapeKind::Disk, 0.0f, to_front},
                 {ShapeKind::Rectangle, 0.0f, to_front},
                 {ShapeKind::Cylinder, on_tube.z, on_tube}};
    for (const auto& [kind, z, normal] : cases) {
        SceneDesc scene = empty_scene();
        add_object(scene, exact(kind, Vec3f(1.0f)), add_material(scene, diffuse(Rgb(0.5f))));
        scene.instances[0].motion = {translation({-1.0f, 0.0f, 0.0f}), translation({1.0f, 0.0f, 0.0f})};
        const World world = compile(scene);
        for (const float time : {0.0f, 0.25f, 1.0f}) {
            SCOPED_TRACE(testing::Message() << shape_name(kind) << " at " << time);
            const float x = 2.0f * time - 1.0f;
            const auto ray_at = [&](float from_middle, float y) {
                return Ray{.origin = {x + from_middle, y, 5.0f}, .direction = {0.0f, 0.0f, -1.0f}, .time = time};
            };
            const Hit hit = intersect(world, ray_at(0.2f, 0.3f));
            ASSERT_TRUE(hit.valid());
            const SurfacePoint point = world.geometry().surface_point(hit);
            EXPECT_LT(length(point.geometric_normal - normal), 1e-5f);
            EXPECT_LT(length(point.position - Vec3f(x + 0.2f, 0.3f, z)), 1e-5f);
            // It ends one metre to both sides of where it is then.
            for (const float side : {-1.0f, 1.0f}) {
                EXPECT_TRUE(intersect(world, ray_at(0.98f * side, 0.0f)).valid());
                EXPECT_FALSE(intersect(world, ray_at(1.02f * side, 0.0f)).valid());
            }
        }
    }
}

// Where a tessellation of the same ball has its tangents, generated from its texture coordinates.
TEST(Shapes, HaveTheTangentsOfTheirTexture) {
    const auto texture_file = temporary_file("shape_normals.png");
    for (const bool mirrored : {false, true}) {
        SceneDesc scene = empty_scene();
        MaterialDesc bumpy = diffuse(Rgb(0.5f));
        const auto texture = add_texture(scene, texture_file, 1, {{200, 160, 220, 255}});
        bumpy.normal_texture.texture = texture;
        const auto material = add_material(scene, bumpy);
        const Mat4f to_world = scaling({mirrored ? -1.0f : 1.0f, 1.0f, 1.0f});
        add_object(scene, exact(ShapeKind::Rectangle, Vec3f(1.0f)), material, to_world);
        // The rectangle's front is towards -z: u along -x, v against y.
        add_object(scene, quad({0.0f, 0.0f, 3.0f}, {-1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}), material, to_world);
        const World world = compile(scene);
        Vec3f normals[2];
        for (int i = 0; i < 2; ++i) {
            const Ray ray{.origin = {0.3f, 0.4f, i == 0 ? -2.0f : 1.5f}, .direction = {0.0f, 0.0f, 1.0f}};
            const Hit hit = intersect(world, ray);
            ASSERT_TRUE(hit.valid());
            const SurfacePoint point = world.geometry().surface_point(hit);
            normals[i] = point.shading.normal;
            EXPECT_GT(std::abs(point.shading.normal.x), 0.1f);
            EXPECT_NEAR(point.uv[0].y, 0.3f, 1e-5f);
            EXPECT_NEAR(point.uv[0].x, mirrored ? 0.65f : 0.35f, 1e-5f);
        }
        EXPECT_LT(length(normals[0] - normals[1]), 1e-5f) << mirrored;
    }
}

TEST(Shapes, AreMetByOtherAccelerators) {
    std::vector<Mat4f> places;
    MaterialDesc veil = diffuse(Rgb(0.5f));
    veil.alpha_mode = AlphaMode::Blend;
    veil.base_alpha = 0.5f;
    for (const bool are_instanced : {false, true}) {
        SceneDesc scene = scene_of_shapes(are_instanced, places, veil);
        add_object(scene, quad({0.0f, 0.0f, 0.2f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}), {0});
        const World world = compile(scene);
        const auto accelerated = world.geometry().accelerate(AcceleratorKind::Bvh);
        const std::vector<Ray> rays = rays_around(2000);
        for (const bool occlusion : {false, true}) {
            const HitAgreement agreement = accelerated->compare_with_embree(rays, occlusion);
            EXPECT_EQ(agreement.differ, 0u);
            EXPECT_LT(agreement.largest_error, 1e-6);
        }
        // Brute force tests the two triangles and every shape.
        const auto brute = world.geometry().accelerate(AcceleratorKind::BruteForce);
        RayWork work;
        (void)brute->closest(rays[0], RayEnds::InScene, work);
        EXPECT_EQ(work.triangles, 2 + (are_instanced ? 6u : 3u));
        const Ray past{.origin = {0.0f, 0.0f, 90.0f}, .direction = {0.0f, 0.0f, 1.0f}};
        EXPECT_EQ(brute->occlusion(past, RayEnds::InScene, work), kFree);
        EXPECT_EQ(work.triangles, 2 * (2 + (are_instanced ? 6u : 3u)));
    }
}

// A lamp in the plane of a ceiling shines, and the ceiling is all that is seen from above.
TEST(Shapes, DisksThatTouchOtherSurfacesAreMetBeforeThem) {
    Mat4f facing_down;
    facing_down.setEulerAngles(Vec3f(-0.5f * kPi, 0.0f, 0.0f));
    for (const float height : {0.3f, 3.7f})
        for (const bool are_instanced : {false, true}) {
            SceneDesc scene = empty_scene();
            const auto ceiling = add_material(scene, diffuse(Rgb(0.5f)));
            const auto lamp = add_material(scene, emissive(Rgb(1.0f)));
            add_object(scene, quad({0.1f, height, 0.2f}, {7.0f, 0.3f, 0.0f}, {0.0f, 0.2f, 5.0f}), ceiling);
            // In the same plane, which rounding has not on the same side everywhere.
            const Vec3f up = normalize(cross(Vec3f(0.0f, 0.2f, 5.0f), Vec3f(7.0f, 0.3f, 0.0f)));
            const Frame frame = Frame::from_normal(up);
            Mat4f to_world;
            for (int i = 0; i < 3; ++i) {
                to_world[0][i] = frame.tangent[i];
                to_world[1][i] = frame.bitangent[i];
                to_world[2][i] = up[i];
                to_world[3][i] = Vec3f(0.1f, height, 0.2f)[i];
            }
            add_object(scene, exact(ShapeKind::Disk, {0.5f, 1.0f, 1.0f}), lamp, to_world);
            if (are_instanced) {
                scene.instances.push_back(scene.instances.back());
                scene.instances.back().to_world[3][0] += 1.5f;
                scene.instances.back().to_world[3][1] += 1.5f * 0.3f / 7.0f;
            }
            const World world = compile(scene);
            EXPECT_EQ(world.lights().count(), are_instanced ? 2u : 1u);
            Random random(3);
            int on_disk = 0;
            for (int i = 0; i < 1000; ++i) {
                const bool is_below = i % 2 == 0;
                const Vec2f u = random.next_2d();
                const Vec3f target = transform_point(to_world, {u.x - 0.5f, 2.0f * u.y - 1.0f, 0.0f});
                const bool is_inside = std::hypot(2.0f * u.x - 1.0f, 2.0f * u.y - 1.0f) < 0.99f;
                if (!is_inside) continue;
                ++on_disk;
                const Vec3f from =
                    target +
                    normalize(Vec3f(random.next() - 0.5f, is_below ? -1.0f : 1.0f, random.next() - 0.5f)) * 2.0f;
                const Hit hit = intersect(world, {.origin = from, .direction = normalize(target - from)});
                ASSERT_TRUE(hit.valid());
                EXPECT_TRUE(hit.in_contact);
                EXPECT_EQ(world.materials().at(hit)->emits, is_below) << target;
            }
            EXPECT_GT(on_disk, 500);
        }
}

// The same as a mesh of two triangles, which is what rays meet.
TEST(Shapes, RectanglesAreSampledAsRectangles) {
    SceneDesc scene = empty_scene();
    const auto lamp = add_material(scene, emissive(Rgb(1.0f)));
    add_object(scene, exact(ShapeKind::Rectangle, {1.0f, 0.5f, 1.0f}), lamp);
    const World world = compile(scene);
    ASSERT_EQ(world.lights().count(), 1u);
    ASSERT_NE(world.lights().even_mesh(0), nullptr);
    EXPECT_EQ(world.lights().even_mesh(0)->area(), 2.0f);
    // Its front looks along -z: only from there it shines, with one density in all directions.
    const LightNumbers u{{0.1f, 0.2f}, {0.3f, 0.4f}, {0.5f, 0.6f}};
    const LightNumbers v{{0.1f, 0.2f}, {0.8f, 0.1f}, {0.9f, 0.2f}};
    const float density = world.lights().sample(Vec3f(0.0f, 0.0f, -0.3f), u, 0.0f).sample.pdf_solid_angle;
    EXPECT_GT(density, 0.0f);
    EXPECT_NEAR(world.lights().sample(Vec3f(0.0f, 0.0f, -0.3f), v, 0.0f).sample.pdf_solid_angle / density, 1.0f, 1e-4f);
    EXPECT_EQ(world.lights().sample(Vec3f(0.0f, 0.0f, 0.3f), u, 0.0f).sample.pdf_solid_angle, 0.0f);
}

TEST(Shapes, EncloseBodiesIfTheyAreNotFlat) {
    for (const auto& [name, kind] : kShapeKinds) {
        SceneDesc scene = empty_scene();
        MaterialDesc glass;
        glass.override_model = DielectricDesc{};
        add_object(scene, exact(kind, Vec3f(1.0f)), add_material(scene, glass));
        ProblemList problems;
        const World world = compile(scene, "Linear Rec.709 (sRGB)", problems);
        EXPECT_TRUE(world.traits().has_bodies);
        EXPECT_EQ(problems.all().size(), is_flat(kind) ? 1u : 0u) << name;
    }
}

TEST(Shapes, AreSampledLightsUnlessTheyAreUnevenCylinders) {
    SceneDesc scene = empty_scene();
    const auto lamp = add_material(scene, emissive(Rgb(1.0f)));
    add_object(scene, exact(ShapeKind::Sphere, Vec3f(1.0f)), lamp, scaling(Vec3f(3.0f)));
    add_object(scene, exact(ShapeKind::Disk, {1.0f, 2.0f, 1.0f}), lamp, translation({9.0f, 0.0f, 0.0f}));
    add_object(scene, exact(ShapeKind::Cylinder, {1.0f, 2.0f, 1.0f}), lamp, translation({0.0f, 9.0f, 0.0f}));
    ProblemList problems;
    const World even = compile(scene, "Linear Rec.709 (sRGB)", problems);
    EXPECT_EQ(even.lights().count(), 3u);
    EXPECT_FALSE(even.traits().has_unsampled_emitters);
    EXPECT_TRUE(problems.all().empty());
    add_object(scene, exact(ShapeKind::Sphere, {1.0f, 2.0f, 1.0f}), lamp, translation({-9.0f, 0.0f, 0.0f}));
    EXPECT_FALSE(compile(scene, "Linear Rec.709 (sRGB)", problems).traits().has_unsampled_emitters);
    add_object(scene, exact(ShapeKind::Cylinder, {1.0f, 2.0f, 3.0f}), lamp, translation({-9.0f, 9.0f, 0.0f}));
    const World uneven = compile(scene, "Linear Rec.709 (sRGB)", problems);
    EXPECT_EQ(uneven.lights().count(), 4u);
    EXPECT_TRUE(uneven.traits().has_unsampled_emitters);
    EXPECT_EQ(problems.all().size(), 1u);
}

}  // namespace

}  // namespace etendue::test
