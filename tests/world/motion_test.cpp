// Things that move while the shutter is open, against the same things standing still where they are at one time.
#include "world/motion.h"

#include "world/test_scene.h"

#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

Mat4f rotation_about_y(float angle) {
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    return {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1};
}

/// One piece of a motion and five.
constexpr std::size_t kStepCounts[] = {2, 6};

/// `steps` poses of a body that turns by 2.5 radians while it flies by.
TransformMotion flight(std::size_t steps) {
    TransformMotion motion;
    for (std::size_t i = 0; i < steps; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(steps - 1);
        motion.push_back(rotation_about_y(2.5f * t) * translation({t - 0.5f, 0.3f * t * t, -0.2f * t}));
    }
    return motion;
}

/// Two instances of a soup that move, one that stands still, and a soup that deforms; all of them as they are at `time`
/// if there is one.
SceneDesc moving_scene(std::size_t steps, std::optional<float> time) {
    Random random(5);
    SceneDesc scene = empty_scene();
    const auto material = add_material(scene, diffuse(Rgb(0.5f)));
    PrimitiveDesc shared = soup(random, 60, 0.4f);
    shared.material = material;
    const auto mesh = add_mesh(scene, {shared});
    place(scene, mesh, translation({0.5f, 1.0f, 0.0f}));
    for (const bool mirrored : {false, true}) {
        const Mat4f placed = random_transform(random, mirrored);
        TransformMotion motion = flight(steps);
        for (Mat4f& m : motion) m = placed * m;
        place(scene, mesh, time ? transform_at(motion, *time) : placed);
        if (!time) scene.instances.back().motion = motion;
    }
    PrimitiveDesc deforming = soup(random, 60, 0.4f);
    std::vector<VertexStep> vertex_steps(steps, VertexStep{deforming.positions, deforming.normals});
    for (VertexStep& step : vertex_steps)
        for (std::size_t v = 0; v < step.positions.size(); ++v) {
            step.positions[v] += random_direction(random) * 0.2f;
            step.normals[v] = normalize(step.normals[v] + random_direction(random) * 0.05f);
        }
    if (time) {
        const MotionSegment segment = motion_segment(steps, *time);
        for (std::size_t v = 0; v < deforming.positions.size(); ++v) {
            const auto between = [&](auto member) {
                return (vertex_steps[segment.first].*member)[v] * (1.0f - segment.t) +
                       (vertex_steps[segment.first + 1].*member)[v] * segment.t;
            };
            deforming.positions[v] = between(&VertexStep::positions);
            deforming.normals[v] = normalize(between(&VertexStep::normals));
        }
    } else {
        deforming.motion = vertex_steps;
    }
    add_object(scene, deforming, material, random_transform(random, true));
    return scene;
}

std::vector<Ray> rays_at(float time, std::uint32_t seed) {
    Random random(seed);
    std::vector<Ray> rays(4000);
    for (Ray& ray : rays) {
        const Vec3f direction = random_direction(random);
        ray.origin = direction * (3.0f * random.next());
        ray.direction = random_direction(random);
        ray.time = time;
    }
    return rays;
}

TEST(Motion, RaysHitWhatStandsThereAtTheirTime) {
    for (const std::size_t steps : kStepCounts) {
        const World moving = compile(moving_scene(steps, std::nullopt));
        EXPECT_TRUE(moving.traits().has_motion);
        for (const float time : {0.0f, 0.13f, 0.5f, 0.77f, 1.0f}) {
            const World still = compile(moving_scene(steps, time));
            EXPECT_FALSE(still.traits().has_motion);
            const std::vector<Ray> rays = rays_at(time, 3);
            for (const QueryForm form : {QueryForm::Packet16, QueryForm::Single}) {
                std::vector<Hit> hits(rays.size());
                std::vector<Hit> expected(rays.size());
                moving.geometry().intersect(rays, hits, Coherence::Incoherent, form);
                still.geometry().intersect(rays, expected, Coherence::Incoherent, form);
                std::size_t compared = 0;
                std::size_t different = 0;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    // Rounding lets rays pass edges on either side.
                    if (hits[i].instance != expected[i].instance || hits[i].triangle != expected[i].triangle) {
                        ++different;
                        continue;
                    }
                    if (!hits[i].valid()) continue;
                    ++compared;
                    EXPECT_NEAR(hits[i].t, expected[i].t, 1e-3f);
                    const SurfacePoint point = moving.geometry().surface_point(hits[i]);
                    const SurfacePoint reference = still.geometry().surface_point(expected[i]);
                    EXPECT_LT(length(point.position - (rays[i].origin + rays[i].direction * hits[i].t)), 1e-3f);
                    EXPECT_GT(dot(point.geometric_normal, reference.geometric_normal), 0.999f);
                    // Near a right angle to the triangle, rounding decides whether the normal is used at all.
                    const bool is_used = dot(reference.shading.normal, reference.geometric_normal) > 0.1f;
                    EXPECT_TRUE(!is_used || dot(point.shading.normal, reference.shading.normal) > 0.98f);
                }
                EXPECT_GT(compared, 500u);
                EXPECT_LT(different, rays.size() / 200) << "at " << time;
            }
        }
    }
}

TEST(Motion, ShadowRaysAgreeWithRays) {
    const World world = compile(moving_scene(6, std::nullopt));
    for (const float time : {0.0f, 0.4f, 1.0f}) {
        const std::vector<Ray> rays = rays_at(time, 8);
        std::vector<Hit> hits(rays.size());
        std::vector<std::uint8_t> occluded(rays.size());
        world.geometry().intersect(rays, hits, Coherence::Incoherent);
        world.geometry().occluded(rays, occluded);
        for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(occluded[i] != 0, hits[i].valid());
    }
}

/// Rays that leave a convex body never meet it again, wherever it is at their time.
TEST(Motion, SurfacesDoNotShadowThemselves) {
    SceneDesc scene = empty_scene();
    const auto material = add_material(scene, diffuse(Rgb(0.5f)));
    PrimitiveDesc ball = sphere(Vec3f(0.0f), 1.0f, 24);
    add_object(scene, ball, material, translation({10.0f, 20.0f, 30.0f}));
    for (const Mat4f& m : flight(6)) scene.instances.back().motion.push_back(m * translation({10.0f, 20.0f, 30.0f}));
    for (const Mat4f& m : flight(6)) {
        VertexStep step{ball.positions, ball.normals};
        for (Vec3f& p : step.positions) p = transform_point(m, p);
        for (Vec3f& n : step.normals) n = transform_vector(m, n);
        ball.motion.push_back(step);
    }
    add_object(scene, ball, material, translation({-10.0f, -20.0f, -30.0f}));
    const World world = compile(scene);
    Random random(2);
    std::size_t tested = 0;
    for (int i = 0; i < 20000; ++i) {
        Ray ray;
        ray.time = random.next();
        // Towards the ball at its time.
        const Mat4f at_time = transform_at(flight(6), ray.time);
        const Vec3f center = transform_point(at_time, Vec3f(0.0f)) +
                             (i % 2 == 0 ? Vec3f(10.0f, 20.0f, 30.0f) : Vec3f(-10.0f, -20.0f, -30.0f));
        ray.direction = random_direction(random);
        ray.origin = center - ray.direction * 3.0f + random_direction(random) * 0.5f;
        const Hit hit = intersect(world, ray);
        if (!hit.valid()) continue;
        const SurfacePoint point = world.geometry().surface_point(hit);
        Vec3f wi = random_direction(random);
        if (dot(wi, point.geometric_normal) < 0.0f) wi = -wi;
        Ray leaving;
        leaving.time = ray.time;
        leaving.origin = offset_origin(point.position, point.geometric_normal, point.clearance, wi);
        leaving.direction = wi;
        leaving.t_max = 5.0f;
        ++tested;
        EXPECT_FALSE(occluded(world, leaving));
    }
    EXPECT_GT(tested, 10000u);
}

TEST(Motion, TheCameraIsWhereItIsAtTheTime) {
    SceneDesc scene = empty_scene();
    scene.cameras[0].motion = flight(6);
    const World moving = compile(scene);
    EXPECT_TRUE(moving.traits().has_motion);
    for (const float time : {0.0f, 0.3f, 1.0f}) {
        scene.cameras[0].to_world = transform_at(flight(6), time);
        scene.cameras[0].motion.clear();
        const World still = compile(scene);
        const Ray ray = moving.camera().generate_ray({0.2f, 0.9f}, {0.5f, 0.5f}, time);
        const Ray expected = still.camera().generate_ray({0.2f, 0.9f}, {0.5f, 0.5f}, time);
        EXPECT_EQ(ray.origin, expected.origin);
        EXPECT_EQ(ray.direction, expected.direction);
        EXPECT_EQ(ray.time, time);
    }
}

TEST(Motion, LampsAreSampledWhereTheyAre) {
    SceneDesc scene = empty_scene();
    const auto material = add_material(scene, emissive(Rgb(2.0f)));
    add_object(scene, quad({0, 0, -3}, {1, 0, 0}, {0, 1, 0}), material);
    for (int i = 0; i <= 16; ++i) {
        const float t = static_cast<float>(i) / 16.0f;
        scene.instances[0].motion.push_back(rotation_about_y(0.6f * t) *
                                            translation({2.0f * t - 1.0f, 0.0f, 0.5f * t}));
    }
    ProblemList problems;
    const World world = compile(scene, "Linear Rec.709 (sRGB)", problems);
    EXPECT_TRUE(problems.all().empty());
    Random random(1);
    const Vec3f from(0.2f, 0.1f, 0.0f);
    for (int i = 0; i < 100; ++i) {
        const float time = random.next();
        const ChosenLight chosen =
            world.lights().sample(from, {random.next_2d(), random.next_2d(), random.next_2d()}, time);
        const LightSample& sample = chosen.sample;
        EXPECT_EQ(sample.radiance, Rgb(2.0f));
        Ray ray;
        ray.origin = from;
        ray.direction = sample.wi;
        ray.time = time;
        const Hit hit = intersect(world, ray);
        ASSERT_TRUE(hit.valid());
        EXPECT_NEAR(hit.t, sample.distance, 1e-4f);
        const SurfacePoint point = world.geometry().surface_point(hit);
        EXPECT_NEAR(dot(point.geometric_normal, -sample.wi), sample.cos_light, 1e-3f);
        const float pdf = world.lights().pdf_solid_angle(from, point, ray.direction, hit.t, time);
        EXPECT_NEAR(pdf, sample.pdf_solid_angle, 3e-3f * pdf);
        // It stays within the bounds by which it is chosen.
        const Bounds box = world.lights().bounds(0)->box;
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(point.position[axis], box.min[axis] - 1e-5f);
            EXPECT_LE(point.position[axis], box.max[axis] + 1e-5f);
        }
    }
}

TEST(Motion, RaysLeaveLampsWhereTheyAre) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -3}, {1, 0, 0}, {0, 1, 0}), add_material(scene, emissive(Rgb(2.0f))));
    scene.instances[0].motion = {translation({-1, 0, 0}), translation({1, 0, 0.5f})};
    const World world = compile(scene);
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const float time = random.next();
        const Emission emission = world.emitters().sample(
            random.next_2d(), {random.next_2d(), random.next_2d(), random.next_2d()}, time, false);
        // Back towards the lamp.
        Ray ray;
        ray.origin = emission.ray.origin + emission.ray.direction;
        ray.direction = -emission.ray.direction;
        ray.time = time;
        const Hit hit = intersect(world, ray);
        ASSERT_TRUE(hit.valid());
        EXPECT_NEAR(hit.t, 1.0f, 1e-3f);
    }
}

// Between two steps, linear interpolation shrinks a lamp that turns: no light may be made of the shrunk lamp.
TEST(Motion, LampsOfTwoStepsKeepTheirShape) {
    SceneDesc scene = empty_scene();
    add_object(scene, exact(ShapeKind::Cylinder, {0.2f, 0.5f, 0.2f}), add_material(scene, emissive(Rgb(2.0f))));
    Mat4f tilted;
    tilted.setEulerAngles(Vec3f(0.0f, 0.0f, 0.04f));
    scene.instances[0].motion = {tilted.transposed() * translation({-1, 0, -3}), tilted * translation({1, 0, -3})};
    scene.instances[0].to_world = translation({0, 0, -3});
    ProblemList problems;
    const World world = compile(scene, "Linear Rec.709 (sRGB)", problems);
    EXPECT_TRUE(problems.all().empty());
    EXPECT_FALSE(world.traits().has_unsampled_emitters);
}

// While a spot turns, it lights directions outside the cone that it has at any single moment.
TEST(Motion, BoundsOfSpotsThatTurnAreWide) {
    SceneDesc scene = empty_scene();
    LightDesc spot;
    spot.type = LightType::Spot;
    spot.inner_cone_angle = 0.0f;
    spot.outer_cone_angle = 0.2f;
    const auto cone_after = [&](float angle) {
        spot.motion.clear();
        for (const float a : {-angle, angle}) {
            Mat4f turned;
            turned.setEulerAngles(Vec3f(0.0f, a, 0.0f));
            spot.motion.push_back(turned);
        }
        scene.lights = {spot};
        return compile(scene).lights().bounds(0)->cone.theta_o;
    };
    EXPECT_NEAR(cone_after(0.05f) - cone_after(0.0f), 0.1, 1e-3);
}

TEST(Motion, SunsThatTurnKeepTheirDirectionWithANote) {
    SceneDesc scene = empty_scene();
    LightDesc sun;
    sun.type = LightType::Directional;
    LightDesc point;
    point.type = LightType::Point;
    Mat4f turned;
    turned.setEulerAngles(Vec3f(0.9f, 0.0f, 0.0f));
    sun.motion = point.motion = {Mat4f(), turned * translation({1, 0, 0})};
    LightDesc sliding = sun;
    sliding.motion = {Mat4f(), translation({1, 0, 0})};
    LightDesc spinning = point;
    spinning.type = LightType::Spot;
    scene.lights = {sun, point, sliding, spinning};
    ProblemList problems;
    const World world = compile(scene, "Linear Rec.709 (sRGB)", problems);
    ASSERT_EQ(problems.all().size(), 1u);
    EXPECT_TRUE(problems.all()[0].message.starts_with("2 suns that turn, or spots")) << problems.all()[0].message;
    // The point light moves, however fast it turns.
    const Bounds box = world.lights().bounds(1)->box;
    EXPECT_EQ(box.min.x, 0.0f);
    EXPECT_EQ(box.max.x, 1.0f);
}

TEST(Motion, LampsThatChangeTheirSizeAreLeftToChance) {
    SceneDesc scene = empty_scene();
    const auto material = add_material(scene, emissive(Rgb(2.0f)));
    add_object(scene, quad({0, 0, -3}, {1, 0, 0}, {0, 1, 0}), material);
    Mat4f grown;
    grown.setScale(Vec3f(1.1f));
    scene.instances[0].motion = {translation({0, 0, 0}), grown * translation({1, 0, 0.3f})};
    ProblemList problems;
    const World world = compile(scene, "Linear Rec.709 (sRGB)", problems);
    EXPECT_FALSE(world.traits().has_lights);
    ASSERT_EQ(problems.all().size(), 1u);
    EXPECT_EQ(problems.all()[0].severity, Severity::Note);
    Ray ray;
    ray.origin = {1.5f, 0.0f, 0.0f};
    ray.direction = {0.0f, 0.0f, -1.0f};
    EXPECT_FALSE(intersect(world, ray).valid());
    ray.time = 1.0f;
    const Hit hit = intersect(world, ray);
    ASSERT_TRUE(hit.valid());
    const SurfacePoint point = world.geometry().surface_point(hit);
    EXPECT_EQ(world.materials().emission(point, {0, 0, 1}), Rgb(2.0f));
    EXPECT_EQ(world.lights().pdf_solid_angle(ray.origin, point, ray.direction, hit.t, ray.time), 0.0f);
}

TEST(MotionSegment, TimesFallBetweenSteps) {
    EXPECT_EQ(motion_segment(2, 0.0f).first, 0u);
    EXPECT_EQ(motion_segment(5, 1.0f).first, 3u);
    EXPECT_EQ(motion_segment(5, 1.0f).t, 1.0f);
    EXPECT_EQ(motion_segment(5, 0.5f).first, 2u);
    EXPECT_EQ(motion_segment(5, 0.5f).t, 0.0f);
    EXPECT_NEAR(motion_segment(5, 0.3f).t, 0.2f, 1e-6f);
}

}  // namespace
}  // namespace etendue::test
