#include "camera/camera.h"

#include "core/frame.h"
#include "support/chi2.h"
#include "support/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

Mat4f translation(const Vec3f& t) {
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, t.x, t.y, t.z, 1};
}
Mat4f scaling(const Vec3f& s) {
    return {s.x, 0, 0, 0, 0, s.y, 0, 0, 0, 0, s.z, 0, 0, 0, 0, 1};
}
/// About +X: +Y goes to +Z.
Mat4f turn_x(float a) {
    return {1, 0, 0, 0, 0, std::cos(a), std::sin(a), 0, 0, -std::sin(a), std::cos(a), 0, 0, 0, 0, 1};
}
/// About +Y: +Z goes to +X.
Mat4f turn_y(float a) {
    return {std::cos(a), 0, -std::sin(a), 0, 0, 1, 0, 0, std::sin(a), 0, std::cos(a), 0, 0, 0, 0, 1};
}

CameraPose tilted_pose() {
    return CameraPose::from_matrix(turn_x(0.4f) * turn_y(1.1f) * translation({3, -2, 5}));
}

constexpr Vec2f kCenter{0.3f, -0.2f};
constexpr ClipRange kClip{0.4f, 9.0f};

std::vector<Camera> cameras() {
    const PinholeCamera pinhole{tilted_pose(), 0.8f, 0.45f};
    const PinholeCamera shifted{tilted_pose(), 0.8f, 0.45f, kCenter, kClip};
    return {pinhole,
            ThinLensCamera{pinhole, 0.1f, 4.0f},
            OrthographicCamera{tilted_pose(), 2.0f, 1.5f},
            shifted,
            ThinLensCamera{shifted, 0.1f, 4.0f, {.blades = 5, .rotation = 0.3f, .ratio = 1.6f}},
            OrthographicCamera{tilted_pose(), 2.0f, 1.5f, kCenter, kClip}};
}

constexpr ClipRange kRound{0.4f, 9.0f};

std::vector<Camera> panoramas() {
    return {EquirectangularCamera{tilted_pose(), kRound},
            FisheyeCamera{.pose = tilted_pose(), .half_width = 1.2f, .half_height = 1.0f, .half_angle = kPi},
            FisheyeCamera{.pose = tilted_pose(),
                          .half_width = 0.9f,
                          .half_height = 0.7f,
                          .center = {0.05f, -0.1f},
                          .half_angle = 1.8f,
                          .mapping = FisheyeMapping::Equisolid,
                          .clip = kRound}};
}

std::vector<Camera> all_cameras() {
    std::vector<Camera> all = cameras();
    for (const Camera& camera : panoramas()) all.push_back(camera);
    return all;
}

TEST(CameraPose, LooksAlongMinusZWithYUp) {
    const CameraPose pose = CameraPose::from_matrix(Mat4f());
    EXPECT_EQ(pose.forward, Vec3f(0, 0, -1));
    EXPECT_EQ(pose.right, Vec3f(1, 0, 0));
    EXPECT_EQ(pose.up, Vec3f(0, 1, 0));
    // A quarter turn about +Y, counter-clockwise from above, looks along -X.
    const CameraPose turned = CameraPose::from_matrix(turn_y(kPi / 2.0f) * translation({1, 2, 3}));
    EXPECT_LT(length(turned.forward - Vec3f(-1, 0, 0)), 1e-6f);
    EXPECT_LT(length(turned.right - Vec3f(0, 0, -1)), 1e-6f);
    EXPECT_EQ(turned.position, Vec3f(1, 2, 3));
}

TEST(CameraPose, IgnoresScaleAndNeverMirrorsTheImage) {
    for (const Vec3f& scale : {Vec3f(5, 5, 5), Vec3f(0.1f, 2, 7), Vec3f(-1, 1, 1)}) {
        const CameraPose pose = CameraPose::from_matrix(scaling(scale) * turn_x(0.4f) * turn_y(1.1f));
        const CameraPose plain = CameraPose::from_matrix(turn_x(0.4f) * turn_y(1.1f));
        EXPECT_LT(length(pose.forward - plain.forward), 1e-5f);
        EXPECT_LT(length(pose.up - plain.up), 1e-5f);
        EXPECT_LT(length(pose.right - plain.right), 1e-5f);
    }
    const CameraPose pose = CameraPose::from_matrix(scaling({-3, 0.5f, 2}) * turn_x(2.0f));
    EXPECT_NEAR(dot(cross(pose.right, pose.up), -pose.forward), 1.0f, 1e-5f);
}

TEST(Camera, ConnectIsTheInverseOfGenerateRay) {
    Random random(12);
    for (const Camera& camera : all_cameras())
        for (int i = 0; i < 200; ++i) {
            // Filters reach beyond the film. Around poles, a step across the ray is a large one around them.
            const Vec2f film = is_panoramic(camera) ? random.next_2d() * 0.8f + Vec2f(0.1f, 0.1f)
                                                    : random.next_2d() * 1.2f - Vec2f(0.1f, 0.1f);
            const Vec2f lens = random.next_2d();
            const Ray ray = generate_ray(camera, film, lens);
            if (ray.t_max == 0.0f || (is_panoramic(camera) && dot(ray.direction, tilted_pose().forward) < -0.8f))
                continue;
            const Vec3f point = ray.origin + ray.direction * (0.5f + 5.0f * random.next());
            const CameraConnection connection = connect(camera, point, lens);
            EXPECT_LT(length(connection.lens - ray.origin), 1e-5f);
            EXPECT_NEAR(connection.film.x, film.x, 1e-5f);
            EXPECT_NEAR(connection.film.y, film.y, 1e-5f);
            // How fast the film point moves with the point, across the ray.
            constexpr float kStep = 1e-2f;
            const Frame across = Frame::from_normal(ray.direction);
            const auto moved = [&](const Vec3f& axis) {
                const Vec2f plus = connect(camera, point + axis * kStep, lens).film;
                const Vec2f minus = connect(camera, point - axis * kStep, lens).film;
                return (plus - minus) * (0.5f / kStep);
            };
            const Vec2f a = moved(across.tangent);
            const Vec2f b = moved(across.bitangent);
            EXPECT_NEAR(std::abs(a.x * b.y - a.y * b.x) / connection.importance_area, 1.0f, 0.02f);
        }
}

TEST(Camera, ManyRaysAtOnceAreTheSameRays) {
    Random random(13);
    std::array<Vec2f, 5> film;
    std::array<Vec2f, 5> lens;
    for (std::size_t i = 0; i < film.size(); ++i) {
        film[i] = random.next_2d();
        lens[i] = random.next_2d();
    }
    for (const Camera& camera : all_cameras()) {
        std::array<Ray, 5> rays;
        generate_rays(camera, film, lens, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Ray ray = generate_ray(camera, film[i], lens[i]);
            EXPECT_EQ(rays[i].origin, ray.origin);
            EXPECT_EQ(rays[i].direction, ray.direction);
        }
    }
}

TEST(Camera, WhatLiesBehindIsNotSeen) {
    for (const Camera& camera : cameras())
        EXPECT_EQ(connect(camera, tilted_pose().position - tilted_pose().forward, {0.5f, 0.5f}).importance_area, 0.0f);
}

TEST(Camera, FilmRunsRightAndDownFromTheTopLeft) {
    for (const Camera& camera : cameras()) {
        const CameraPose pose = tilted_pose();
        const Vec2f middle_of_lens(0.5f, 0.5f);
        // On the plane of focus, to compare places rather than directions.
        const auto place = [&](Vec2f film) {
            const Ray ray = generate_ray(camera, film, middle_of_lens);
            EXPECT_NEAR(length(ray.direction), 1.0f, 1e-6f);
            const float depth = camera_depth(camera, ray.origin);
            return ray.origin + ray.direction * ((4.0f - depth) / dot(ray.direction, pose.forward)) - pose.position;
        };
        const Vec3f center = place({0.5f, 0.5f});
        const bool is_shifted = clip_of(camera).start > 0.0f;
        const float size = std::holds_alternative<OrthographicCamera>(camera) ? 1.0f : 4.0f;
        const Vec2f expected = is_shifted ? kCenter * size : Vec2f(0.0f, 0.0f);
        EXPECT_NEAR(dot(center, pose.right), expected.x, 1e-5f);
        EXPECT_NEAR(dot(center, pose.up), expected.y, 1e-5f);
        EXPECT_GT(dot(place({0.9f, 0.5f}) - center, pose.right), 0.5f);
        EXPECT_GT(dot(place({0.5f, 0.1f}) - center, pose.up), 0.5f);
        EXPECT_LT(dot(place({0.5f, 0.9f}) - center, pose.up), -0.5f);
    }
}

// Rays begin at the near plane, and what lies before it or beyond the far one is not seen.
TEST(Camera, ClippingIsAlongTheViewingDirection) {
    Random random(14);
    for (const Camera& camera : all_cameras()) {
        const ClipRange clip = clip_of(camera);
        for (int i = 0; i < 50; ++i) {
            const Vec2f lens = random.next_2d();
            const Ray ray = generate_ray(camera, random.next_2d(), lens);
            if (ray.t_max == 0.0f) continue;
            EXPECT_NEAR(camera_depth(camera, ray.origin), clip.start, 1e-5f);
            const float rate = is_panoramic(camera) ? 1.0f : dot(ray.direction, pose_of(camera).forward);
            const auto is_seen = [&](float depth) {
                const Vec3f point = ray.origin + ray.direction * ((depth - clip.start) / rate);
                return connect(camera, point, lens).importance_area > 0.0f;
            };
            EXPECT_EQ(is_seen(0.39f), clip.start == 0.0f);
            EXPECT_TRUE(is_seen(0.41f));
            EXPECT_TRUE(is_seen(8.9f));
            EXPECT_EQ(is_seen(9.1f), std::isinf(clip.end));
        }
    }
}

TEST(Camera, ProjectsWhatItIsConnectedToAndWhatItDoesNotShow) {
    Random random(15);
    constexpr Vec2f kMiddle{0.5f, 0.5f};
    for (const Camera& camera : all_cameras())
        for (int i = 0; i < 50; ++i) {
            const Vec2f film = random.next_2d();
            const Ray ray = generate_ray(camera, film, kMiddle);
            if (ray.t_max == 0.0f) continue;
            // Before the near plane, between the two and beyond the far one.
            for (const float t : {-0.2f, 3.0f, 20.0f}) {
                const Vec3f point = ray.origin + ray.direction * t;
                if (t < 0.0f && clip_of(camera).start == 0.0f) continue;
                const std::optional<Vec2f> seen = project(camera, point);
                ASSERT_TRUE(seen);
                EXPECT_NEAR(seen->x, film.x, 1e-4f);
                EXPECT_NEAR(seen->y, film.y, 1e-4f);
                const CameraConnection view = connect(camera, point, kMiddle);
                EXPECT_TRUE(!(view.importance_area > 0.0f) || view.film == *seen);
            }
        }
}

TEST(Camera, ProjectsBesideTheCircleOfAFisheyeAndNotBehindAPinhole) {
    const FisheyeCamera fisheye{.pose = {}, .half_width = 1.0f, .half_height = 1.0f, .half_angle = 0.5f};
    const Vec3f aside(std::sin(0.75f), 0.0f, -std::cos(0.75f));
    EXPECT_EQ(connect(fisheye, aside, {0.5f, 0.5f}).importance_area, 0.0f);
    ASSERT_TRUE(project(fisheye, aside));
    EXPECT_NEAR(project(fisheye, aside)->x, 1.25f, 1e-5f) << "one and a half radii beside the middle";
    EXPECT_FALSE(project(PinholeCamera{}, {0.1f, 0.1f, 1.0f}));
    EXPECT_TRUE(project(OrthographicCamera{}, {0.1f, 0.1f, 1.0f})) << "where it stands does not matter";
}

TEST(Camera, RaysBeginInABox) {
    Random random(16);
    for (const Camera& camera : all_cameras()) {
        const Bounds box = bounds_of_origins(camera);
        Bounds found;
        for (int i = 0; i < 500; ++i) {
            const Ray ray = generate_ray(camera, random.next_2d() * 2.0f - Vec2f(0.5f, 0.5f), random.next_2d());
            if (ray.t_max == 0.0f) continue;
            found.extend(ray.origin);
        }
        constexpr float kRounding = 1e-5f;
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(found.min[axis], box.min[axis] - kRounding);
            EXPECT_LE(found.max[axis], box.max[axis] + kRounding);
        }
        EXPECT_LE(length(box.size()), 2.0f * length(found.size()) + kRounding) << "it is not far too large";
    }
}

TEST(Pinhole, TheEdgesOfTheFilmAreTheFieldOfView) {
    const PinholeCamera camera{{}, 0.8f, 0.45f};
    const Vec3f corner = camera.generate_ray({0.0f, 0.0f}, {}).direction;
    EXPECT_NEAR(corner.x / -corner.z, -0.8f, 1e-6f);
    EXPECT_NEAR(corner.y / -corner.z, 0.45f, 1e-6f);
}

/// Returns the density per solid angle of the directions of rays through the middle of the lens, for uniform film
/// points: what the camera sees of a surface that faces it one metre away; 0 outside of the image.
float camera_pdf_solid_angle(const Camera& camera, const Vec3f& direction) {
    const CameraConnection view = connect(camera, pose_of(camera).position + direction, {0.5f, 0.5f});
    const bool is_inside = view.film.x >= 0.0f && view.film.x <= 1.0f && view.film.y >= 0.0f && view.film.y <= 1.0f;
    return is_inside ? view.importance_area : 0.0f;
}

TEST(Pinhole, DirectionsHaveTheStatedDensity) {
    const PinholeCamera shapes[] = {{tilted_pose(), 0.8f, 0.45f},
                                    {{}, 3.0f, 2.0f},
                                    {{}, 0.01f, 0.02f},
                                    {tilted_pose(), 0.8f, 0.45f, {1.1f, -0.7f}}};
    for (const PinholeCamera& pinhole : shapes) {
        const Camera camera = pinhole;
        const auto sampler = [&](Random& random) -> std::optional<Vec3f> {
            return generate_ray(camera, random.next_2d(), {0.5f, 0.5f}).direction;
        };
        const SamplerCheck check = check_sphere_sampler(
            sampler, [&](const Vec3f& w) { return static_cast<double>(camera_pdf_solid_angle(camera, w)); });
        EXPECT_GT(check.chi2.p_value, sidak_level(kFamilyLevel, std::size(shapes))) << check.chi2.str();
        EXPECT_NEAR(check.pdf_integral, 1.0, 5e-3);
    }
}

TEST(Pinhole, OutsideOfTheImageThereIsNoDensity) {
    const Camera camera = PinholeCamera{{}, 0.8f, 0.45f};
    EXPECT_EQ(camera_pdf_solid_angle(camera, {0, 0, 1}), 0.0f);
    EXPECT_EQ(camera_pdf_solid_angle(camera, normalize(Vec3f(0.81f, 0, -1))), 0.0f);
    EXPECT_EQ(camera_pdf_solid_angle(camera, normalize(Vec3f(0, -0.46f, -1))), 0.0f);
    EXPECT_GT(camera_pdf_solid_angle(camera, normalize(Vec3f(0.79f, -0.44f, -1))), 0.0f);
}

TEST(ThinLens, RaysOfAFilmPointMeetInThePlaneOfFocus) {
    const ThinLensCamera camera{{tilted_pose(), 0.8f, 0.45f}, 0.25f, 4.0f};
    const CameraPose& pose = camera.pinhole.pose;
    Random random(2);
    float widest = 0.0f;
    for (int i = 0; i < 50; ++i) {
        const Vec2f film = random.next_2d();
        const Ray through_center = camera.pinhole.generate_ray(film, {});
        const Vec3f focus =
            through_center.origin + through_center.direction * (4.0f / dot(through_center.direction, pose.forward));
        for (int j = 0; j < 50; ++j) {
            const Ray ray = camera.generate_ray(film, random.next_2d());
            const Vec3f from_center = ray.origin - pose.position;
            EXPECT_LE(length(from_center), 0.25f + 1e-5f);
            EXPECT_NEAR(dot(from_center, pose.forward), 0.0f, 1e-5f);
            EXPECT_LT(length(cross(focus - ray.origin, ray.direction)), 1e-4f);
            widest = std::max(widest, length(from_center));
        }
    }
    EXPECT_GT(widest, 0.24f);
}

// The middle of a side is on the right, in line with Cycles, and the ratio makes the opening narrower after it has been
// turned.
TEST(ThinLens, TheApertureIsAsWideAsItsBladesSay) {
    const auto extent = [](const Aperture& aperture) {
        Random random(21);
        Vec2f largest(0.0f, 0.0f);
        for (int i = 0; i < 20000; ++i) {
            const Vec2f p = aperture.point(random.next_2d());
            EXPECT_LE(std::hypot(p.x * aperture.ratio, p.y), 1.0f + 1e-5f);
            largest = {std::max(largest.x, p.x), std::max(largest.y, p.y)};
        }
        return largest;
    };
    // Of 20000 points, the one nearest to a corner is some 2% of the radius away from it.
    const auto expect = [&](const Aperture& aperture, Vec2f expected) {
        const Vec2f found = extent(aperture);
        EXPECT_NEAR(found.x, expected.x, 0.03f / aperture.ratio);
        EXPECT_NEAR(found.y, expected.y, 0.03f);
    };
    expect({}, {1.0f, 1.0f});
    expect({.ratio = 2.0f}, {0.5f, 1.0f});
    expect({.blades = 4}, {std::sqrt(0.5f), std::sqrt(0.5f)});
    expect({.blades = 4, .rotation = kPi / 4.0f, .ratio = 0.5f}, {2.0f, 1.0f});
    expect({.blades = 3}, {0.5f, std::sqrt(0.75f)});
}

// Every pixel's solid angle is its share of the film over the density there.
TEST(Panoramas, PixelsTogetherCoverWhatTheFilmSees) {
    constexpr int kSide = 400;
    const auto solid_angle = [&](const Camera& camera) {
        double sum = 0.0;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const Vec2f film((static_cast<float>(x) + 0.5f) / kSide, (static_cast<float>(y) + 0.5f) / kSide);
                const Ray ray = generate_ray(camera, film, {0.5f, 0.5f});
                if (ray.t_max == 0.0f) continue;
                const RayCone cone = pixel_cone(camera, ray.direction, 1.0f / (kSide * kSide));
                const double pdf = static_cast<double>(camera_pdf_solid_angle(camera, ray.direction));
                EXPECT_NEAR(static_cast<double>(cone.spread * cone.spread) * pdf * kSide * kSide, 1.0, 1e-3);
                sum += 1.0 / (pdf * kSide * kSide);
            }
        return sum / static_cast<double>(kPi);
    };
    // Pixels that the edge of a circle crosses, 1 in 125 of those within, count as a whole or not at all.
    EXPECT_NEAR(solid_angle(EquirectangularCamera{}), 4.0, 1e-3);
    EXPECT_NEAR(solid_angle(FisheyeCamera{.pose = {}, .half_angle = kPi}), 4.0, 0.02);
    EXPECT_NEAR(solid_angle(FisheyeCamera{.pose = {}, .half_angle = 1.0f}), 2.0 - 2.0 * std::cos(1.0), 0.01);
    EXPECT_NEAR(solid_angle(FisheyeCamera{.pose = {}, .half_angle = 2.5f, .mapping = FisheyeMapping::Equisolid}),
                2.0 - 2.0 * std::cos(2.5), 0.02);
}

TEST(Panoramas, LookAlongTheViewingDirectionWithRightOnTheRight) {
    const Camera camera = EquirectangularCamera{};
    const auto expect = [&](Vec2f film, const Vec3f& direction) {
        EXPECT_LT(length(generate_ray(camera, film, {}).direction - direction), 1e-6f);
    };
    expect({0.5f, 0.5f}, {0, 0, -1});
    expect({0.75f, 0.5f}, {1, 0, 0});
    expect({0.0f, 0.5f}, {0, 0, 1});
    expect({0.3f, 0.0f}, {0, 1, 0});
    // Beyond the top, half a turn away and upside down; beyond a side, from the other one on.
    const auto equal = [&](Vec2f a, Vec2f b) {
        EXPECT_LT(length(generate_ray(camera, a, {}).direction - generate_ray(camera, b, {}).direction), 2e-6f);
    };
    equal({0.2f, -0.1f}, {0.7f, 0.1f});
    equal({0.2f, 1.1f}, {0.7f, 0.9f});
    equal({-0.1f, 0.4f}, {0.9f, 0.4f});
    EXPECT_TRUE(film_wraps(camera));
    EXPECT_FALSE(world_to_screen(camera).has_value());
}

TEST(Panoramas, AFisheyeSeesAnglesWhereItsMappingSays) {
    const auto angle = [](const FisheyeCamera& camera, float radius) {
        const Vec3f direction = camera.generate_ray({0.5f + 0.5f * radius / camera.half_width, 0.5f}, {}).direction;
        EXPECT_GE(direction.x, -1e-6f);
        return std::acos(std::clamp(-direction.z, -1.0f, 1.0f));
    };
    const FisheyeCamera equidistant{.pose = {}, .half_angle = 2.0f};
    EXPECT_NEAR(angle(equidistant, 0.5f), 1.0f, 1e-5f);
    const FisheyeCamera equisolid{
        .pose = {}, .half_width = 1.5f, .half_angle = 2.0f, .mapping = FisheyeMapping::Equisolid};
    EXPECT_NEAR(angle(equisolid, 0.5f), 2.0f * std::asin(0.5f * std::sin(1.0f)), 1e-5f);
    EXPECT_NEAR(angle(equisolid, 0.999f), 2.0f, 0.01f);
    EXPECT_EQ(equisolid.generate_ray({1.0f, 0.5f}, {}).t_max, 0.0f) << "beyond the circle";
    EXPECT_EQ(equisolid.connect(equisolid.generate_ray({0.5f, 0.5f}, {}).direction * -1.0f, {}).importance_area, 0.0f);
    EXPECT_EQ(camera_pdf_solid_angle(equisolid, {0, 0, 1}), 0.0f);
}

TEST(Orthographic, RaysAreParallelAndFillTheRectangle) {
    const OrthographicCamera camera{tilted_pose(), 2.0f, 1.5f};
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const Vec2f film = random.next_2d();
        const Ray ray = camera.generate_ray(film, {});
        EXPECT_EQ(ray.direction, camera.pose.forward);
        const Vec3f offset = ray.origin - camera.pose.position;
        EXPECT_NEAR(dot(offset, camera.pose.right), (2.0f * film.x - 1.0f) * 2.0f, 1e-5f);
        EXPECT_NEAR(dot(offset, camera.pose.up), (1.0f - 2.0f * film.y) * 1.5f, 1e-5f);
    }
}

// Between the rays through the corners of a small pixel: the area that they span at a distance of one metre, and for
// parallel rays where they start.
TEST(PixelCone, IsAsLargeAsThePixel) {
    constexpr float kSide = 1e-3f;
    Random random(5);
    for (const Camera& camera : cameras()) {
        const bool parallel = std::holds_alternative<OrthographicCamera>(camera);
        for (int i = 0; i < 100; ++i) {
            const Vec2f film = random.next_2d();
            const auto at = [&](float x, float y) {
                const Ray ray = generate_ray(camera, film + Vec2f(x, y), {0.5f, 0.5f});
                return parallel ? ray.origin : ray.direction;
            };
            const Vec3f right = at(kSide, 0.0f) - at(0.0f, 0.0f);
            const Vec3f down = at(0.0f, kSide) - at(0.0f, 0.0f);
            const float side = std::sqrt(length(cross(right, down)));
            const Ray ray = generate_ray(camera, film, {0.5f, 0.5f});
            const RayCone cone = pixel_cone(camera, ray.direction, kSide * kSide);
            EXPECT_NEAR(parallel ? cone.width : cone.spread, side, 5e-3f * side);
            if (parallel)
                EXPECT_EQ(cone.spread, 0.0f);
            else
                EXPECT_NEAR(cone.width, side * length(ray.origin - pose_of(camera).position), 0.01f * side);
        }
    }
}

// x and y in [-1, 1] over the image, y up.
TEST(WorldToScreen, TakesPointsOfARayToTheirFilmPoint) {
    Random random(4);
    for (const Camera& camera : cameras()) {
        const Mat4f matrix = world_to_screen(camera).value();
        for (int i = 0; i < 100; ++i) {
            const Vec2f film = random.next_2d();
            const Ray ray = generate_ray(camera, film, {0.5f, 0.5f});
            const Vec3f p = ray.origin + ray.direction * (0.5f + 20.0f * random.next());
            Vec3f screen;
            matrix.multVecMatrix(p, screen);
            EXPECT_NEAR(screen.x, 2.0f * film.x - 1.0f, 2e-4f);
            EXPECT_NEAR(screen.y, 1.0f - 2.0f * film.y, 2e-4f);
        }
    }
}

TEST(WorldToCamera, PutsTheCameraAtTheOriginLookingAlongMinusZ) {
    for (const Camera& camera : cameras()) {
        const CameraPose pose = tilted_pose();
        const Mat4f matrix = world_to_camera(camera);
        EXPECT_LT(length(transform_point(matrix, pose.position)), 1e-5f);
        EXPECT_LT(length(transform_point(matrix, pose.position + pose.forward * 2.0f) - Vec3f(0, 0, -2)), 1e-5f);
        EXPECT_LT(length(transform_point(matrix, pose.position + pose.right) - Vec3f(1, 0, 0)), 1e-5f);
        EXPECT_LT(length(transform_point(matrix, pose.position + pose.up) - Vec3f(0, 1, 0)), 1e-5f);
    }
}

}  // namespace

}  // namespace etendue::test
