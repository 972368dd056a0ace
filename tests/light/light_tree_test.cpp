#include "light/light_tree.h"

#include "core/process_time.h"
#include "support/chi2.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr float kSceneRadius = 10.0f;

Vec3f random_point(Random& random, float size) {
    const Vec2f xy = random.next_2d();
    return Vec3f(xy.x - 0.5f, xy.y - 0.5f, random.next() - 0.5f) * size;
}

Vec3f random_axis(Random& random) {
    Vec3f axis;
    do {
        axis = random_point(random, 2.0f);
    } while (!(length_squared(axis) > 0.01f));
    return normalize(axis);
}

/// Like the temperatures of lamps, powers span orders of magnitude.
float random_power(Random& random) {
    return std::exp2(10.0f * random.next() - 5.0f);
}

MeshLight random_mesh(Random& random) {
    std::vector<LightTriangle> triangles;
    triangles.reserve(3);
    const Vec3f corner = random_point(random, 8.0f);
    const float size = 0.05f + random.next();
    for (int i = 0; i < 3; ++i)
        triangles.push_back(
            {corner + random_point(random, size), random_axis(random) * size, random_axis(random) * size});
    const Rgb radiance(random_power(random));
    return {triangles, radiance, radiance, random.next() < 0.5f, random.next() < 0.5f, true, Vec3f(0.0f)};
}

Light random_light(Random& random) {
    const float which = random.next();
    if (which < 0.3f) return PointLight{random_point(random, 8.0f), Rgb(random_power(random))};
    if (which < 0.7f) return random_mesh(random);
    const float cos_outer = 2.0f * random.next() - 1.0f;
    return SpotLight{.position = random_point(random, 8.0f),
                     .axis = random_axis(random),
                     .intensity = Rgb(random_power(random)),
                     .cos_inner = cos_outer + (1.0f - cos_outer) * random.next() * 0.9f,
                     .cos_outer = cos_outer};
}

std::vector<Light> random_lights(std::size_t count, std::uint32_t seed) {
    Random random(seed);
    std::vector<Light> lights;
    while (lights.size() < count) lights.push_back(random_light(random));
    return lights;
}

/// As bright as it is from half of all directions, and black elsewhere.
ImageEnvironment half_sky(float radiance) {
    ImageF image(64, 32, 3);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 64; ++x)
            for (float& channel : image.pixel(x, y)) channel = radiance;
    return {std::move(image), 0.0f};
}

/// Some at infinity, one without power, and several in one place, where no split tells them apart.
std::vector<Light> lights_of_all_kinds() {
    std::vector<Light> lights = random_lights(40, 3);
    lights.emplace_back(DirectionalLight{{0, -1, 0}, Rgb(0.5f)});
    lights.emplace_back(PointLight{{1, 1, 1}, Rgb(0.0f)});
    lights.emplace_back(half_sky(0.1f));
    for (int i = 0; i < 5; ++i) lights.emplace_back(PointLight{{2, 2, 2}, Rgb(1.0f)});
    return lights;
}

/// Lamps along a line, side by side.
std::vector<Light> row_of_lamps(std::size_t count) {
    std::vector<Light> lights;
    for (std::size_t i = 0; i < count; ++i)
        lights.emplace_back(PointLight{{static_cast<float>(i), 2.0f, 0.0f}, Rgb(1.0f)});
    return lights;
}

/// The formula of docs/derivations.md, equations 15 to 17, with angles and in double.
double importance(const LightBounds& light, double power, const LightReceiver& receiver) {
    const Vec3d low(light.box.min);
    const Vec3d high(light.box.max);
    const Vec3d p(receiver.position);
    Vec3d nearest(0.0);
    Vec3d farthest(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        nearest[axis] = std::max({low[axis] - p[axis], p[axis] - high[axis], 0.0});
        farthest[axis] = std::max(p[axis] - low[axis], high[axis] - p[axis]);
    }
    const double near_squared = std::max(nearest.length2(), 0.02 * (high - low).length2());
    const double by_distance = 1.0 / std::sqrt(near_squared * std::max(farthest.length2(), near_squared));
    const Vec3d to_light = (low + high) * 0.5 - p;
    const double distance = to_light.length();
    const double radius = (high - low).length() / 2.0;
    const bool is_inside = distance <= radius;
    const double theta_b = is_inside ? std::numbers::pi / 2.0 : std::asin(radius / distance);
    const auto angle_to = [&](const Vec3f& direction) {
        return std::acos(std::clamp(Vec3d(direction).dot(to_light) / distance, -1.0, 1.0));
    };
    double emitted = 1.0;
    if (!is_inside) {
        const double from_axis = std::numbers::pi - angle_to(light.cone.axis);
        const double theta = light.cone.two_sided ? std::min(from_axis, std::numbers::pi - from_axis) : from_axis;
        const double rest = std::max(0.0, theta - light.cone.theta_o - theta_b);
        emitted = rest > light.cone.theta_e ? 1e-3 : std::max(std::cos(rest), 1e-3);
    }
    double received = by_distance;
    if (receiver.has_normal()) {
        const double theta_i = angle_to(receiver.normal);
        const double least_theta_i = std::max(0.0, theta_i - theta_b);
        const double cos_most = is_inside ? 1.0 : std::max(std::cos(least_theta_i), 1e-3);
        const double height = std::max(Vec3d(receiver.normal).dot(to_light), 0.0);
        const double diffuse =
            0.9 * height / std::pow(distance * distance + radius * radius / 3.0, 1.5) + 0.1 * cos_most * by_distance;
        const Vec3d half = (to_light / distance + Vec3d(receiver.wo)).normalized();
        const double cos_h = Vec3d(receiver.normal).dot(half);
        const double alpha2 = std::min(1.0, std::pow(static_cast<double>(receiver.alpha), 2.0) +
                                                std::pow(std::min(1.0, radius / distance), 2.0) / 4.0);
        const double lobe = alpha2 / std::pow(cos_h * cos_h * (alpha2 - 1.0) + 1.0, 2.0) / 4.0 /
                            std::max(Vec3d(receiver.normal).dot(Vec3d(receiver.wo)), 0.1);
        const double mirrored = by_distance * (cos_most > 1e-3 ? std::max(lobe, 1e-3) : 1e-3);
        const auto glossy = static_cast<double>(receiver.glossy);
        received = (1.0 - glossy) * diffuse + glossy * mirrored;
    }
    return power / light.cone.measure() * emitted * received;
}

/// Returns bare points, diffuse surfaces and glossy surfaces in turn.
LightReceiver random_receiver(Random& random, float size, int i) {
    LightReceiver receiver(random_point(random, size));
    if (i % 3 == 0) return receiver;
    receiver.normal = random_axis(random);
    if (i % 3 == 1) return receiver;
    do {
        receiver.wo = random_axis(random);
    } while (!(dot(receiver.wo, receiver.normal) > 0.0f));
    receiver.glossy = random.next();
    receiver.alpha = 0.01f + 0.9f * random.next() * random.next();
    return receiver;
}

TEST(LightTree, ProbabilitiesAddUpToOne) {
    for (const std::size_t count : {1u, 2u, 3u, 17u, 1000u}) {
        const std::vector<Light> lights = count == 17 ? lights_of_all_kinds() : random_lights(count, 1);
        const LightTree tree(lights, kSceneRadius);
        Random random(2);
        for (int i = 0; i < 200; ++i) {
            const LightReceiver receiver = random_receiver(random, i % 2 == 0 ? 8.0f : 1000.0f, i);
            double sum = 0.0;
            for (std::size_t light = 0; light < lights.size(); ++light)
                sum += static_cast<double>(tree.probability(receiver, light));
            EXPECT_NEAR(sum, 1.0, 1e-5) << count << " lights, " << receiver.position;
        }
    }
}

TEST(LightTree, ChildrenShareByTheFormula) {
    Random random(14);
    for (int seed = 0; seed < 300; ++seed) {
        // So few that all are children of the root.
        const std::vector<Light> lights = random_lights(5, static_cast<std::uint32_t>(100 + seed));
        const LightTree tree(lights, kSceneRadius);
        const LightReceiver receiver = random_receiver(random, 10.0f, seed);
        std::vector<double> importances;
        importances.reserve(lights.size());
        for (const Light& light : lights)
            importances.push_back(
                importance(*light_bounds(light), static_cast<double>(light_power(light, kSceneRadius)), receiver));
        const double sum = std::accumulate(importances.begin(), importances.end(), 0.0);
        for (std::size_t i = 0; i < lights.size(); ++i) {
            EXPECT_NEAR(tree.probability(receiver, i), 0.97 * importances[i] / sum + 0.006, 1e-4)
                << "light " << i << " of set " << seed << ", " << receiver.position;
        }
    }
}

// False-positive rate of the whole table: kFamilyLevel.
TEST(LightTree, ChoosesWithTheProbabilitiesItStates) {
    const std::vector<std::vector<Light>> scenes = {random_lights(2, 4), lights_of_all_kinds(), random_lights(300, 5),
                                                    row_of_lamps(64)};
    constexpr int kPoints = 8;
    constexpr int kSamples = 40'000;
    const double level = sidak_level(kFamilyLevel, scenes.size() * kPoints);
    Random random(6);
    for (const std::vector<Light>& lights : scenes) {
        const LightTree tree(lights, kSceneRadius);
        for (int p = 0; p < kPoints; ++p) {
            const LightReceiver receiver = random_receiver(random, 8.0f, p);
            std::vector<double> expected;
            for (std::size_t i = 0; i < lights.size(); ++i)
                expected.push_back(kSamples * static_cast<double>(tree.probability(receiver, i)));
            std::vector<double> observed(lights.size());
            for (int i = 0; i < kSamples; ++i) {
                const LightTree::Choice choice = tree.sample(receiver, random.next_2d());
                EXPECT_EQ(choice.probability, tree.probability(receiver, choice.light));
                ++observed[choice.light];
            }
            const Chi2Result result = chi2_counts(observed, expected);
            EXPECT_GT(result.p_value, level) << lights.size() << " lights, " << receiver.position << '\n'
                                             << result.str();
        }
    }
}

TEST(LightTree, ChoosesForManyAsForEach) {
    // Roots of one child, of some, of all that there may be, and none; lamps that have no power.
    const std::vector<std::vector<Light>> scenes = {
        random_lights(1, 4), random_lights(2, 4),    {PointLight{{1, 2, 1}, Rgb(1.0f)}, half_sky(0.1f)},
        random_lights(5, 9), lights_of_all_kinds(),  {PointLight{{1, 1, 1}, Rgb()}, PointLight{{2, 1, 1}, Rgb()}},
        row_of_lamps(16),    random_lights(3000, 5), {half_sky(0.1f)}};
    for (std::size_t scene = 0; scene < scenes.size(); ++scene) {
        const LightTree tree(scenes[scene], kSceneRadius);
        Random random(21);
        for (const std::size_t count : {0u, 1u, 5u, 16u, 17u, 75u}) {
            // All bare, all diffuse, all glossy, and in turn.
            for (int kinds = 0; kinds < 4; ++kinds) {
                std::vector<LightReceiver> receivers;
                std::vector<Vec2f> u;
                for (std::size_t i = 0; i < count; ++i) {
                    // From so far away floats do not tell lamps apart.
                    const float size = i % 7 == 3 ? 1e25f : 8.0f;
                    receivers.push_back(random_receiver(random, size, kinds < 3 ? kinds : static_cast<int>(i)));
                    u.push_back(random.next_2d());
                }
                std::vector<LightTree::Choice> choices(count);
                tree.sample(receivers, u, choices);
                for (std::size_t i = 0; i < count; ++i) {
                    const LightTree::Choice alone = tree.sample(receivers[i], u[i]);
                    EXPECT_EQ(choices[i].light, alone.light) << "scene " << scene << ", receiver " << i;
                    EXPECT_EQ(choices[i].probability, alone.probability) << "scene " << scene << ", receiver " << i;
                }
            }
        }
    }
}

TEST(LightTree, LampsThatTouchTheSurfaceAreChosenToo) {
    for (const float distance : {0.0f, 1e-30f, 1e-16f, 1e-10f}) {
        const std::vector<Light> lights = {PointLight{{0, distance, 0}, Rgb(1.0f)}, PointLight{{0, 1, 0}, Rgb(1.0f)}};
        const LightTree tree(lights, kSceneRadius);
        LightReceiver receiver(Vec3f(0.0f), {0, 1, 0});
        receiver.wo = receiver.normal;
        receiver.alpha = 0.1f;
        for (const float glossy : {0.0f, 1.0f}) {
            receiver.glossy = glossy;
            EXPECT_NEAR(tree.probability(receiver, 0) + tree.probability(receiver, 1), 1.0f, 1e-5f) << distance;
            for (const float u : {0.0f, 0.5f, 0.9999999f}) EXPECT_LT(tree.sample(receiver, {u, u}).light, 2u);
        }
    }
}

// Far lamps of a hundred thousand share what digits the numbers have.
TEST(LightTree, NumbersReachEveryLightOfMany) {
    constexpr std::size_t kCount = 100'000;
    const LightTree tree(row_of_lamps(kCount), kSceneRadius);
    const Vec3f point(50'000.0f, 0.0f, 0.0f);
    Random random(7);
    constexpr int kSamples = 200'000;
    constexpr std::size_t kCells = 50;
    std::vector<double> expected(kCells);
    std::vector<double> observed(kCells);
    for (std::size_t i = 0; i < kCount; ++i)
        expected[i % kCells] += kSamples * static_cast<double>(tree.probability(point, i));
    for (int i = 0; i < kSamples; ++i) {
        const LightTree::Choice choice = tree.sample(point, random.next_2d());
        ++observed[choice.light % kCells];
    }
    const Chi2Result result = chi2_counts(observed, expected);
    EXPECT_GT(result.p_value, kFamilyLevel) << result.str();
}

TEST(LightTree, NoLightThatContributesIsImpossible) {
    std::vector<Light> lights = lights_of_all_kinds();
    Random random(8);
    // Of these, some lie above a point and shine on it, and others below.
    for (int i = 0; i < 200; ++i)
        lights.emplace_back(SpotLight{random_point(random, 8.0f), {0, -1, 0}, Rgb(1.0f), 0.2f, 0.05f});
    const LightTree tree(lights, kSceneRadius);
    int lit = 0;
    for (int i = 0; i < 2000; ++i) {
        const LightReceiver receiver = random_receiver(random, i % 2 == 0 ? 8.0f : 100.0f, i);
        const Vec3f& point = receiver.position;
        for (std::size_t light = 0; light < lights.size(); ++light) {
            const LightSample sample = sample_light(lights[light], point, random.next_2d(), random.next_2d());
            if (is_black(sample.radiance)) continue;
            ++lit;
            EXPECT_GT(tree.probability(receiver, light), 0.0f) << "light " << light << ", " << point;
        }
    }
    EXPECT_GT(lit, 40'000);
    EXPECT_EQ(tree.probability(Vec3f(0.0f), 41), 0.0f) << "a light without power";
}

// No importance but of those that can shine there: without their own floor and the uniform choices the others have
// none.
TEST(LightTree, PrefersWhatIsNearAndFacesThePoint) {
    const auto spot = [](const Vec3f& position, const Vec3f& axis, float intensity) {
        return SpotLight{position, axis, Rgb(intensity), 0.9f, 0.7f};
    };
    const std::vector<Light> lights = {
        spot({0, 1, 0}, {0, -1, 0}, 1.0f),  // near, faces the point
        spot({0, 1, 0}, {0, 1, 0}, 1.0f),   // near, turned away
        spot({0, 9, 0}, {0, -1, 0}, 1.0f),  // far
        spot({0, 9, 0}, {0, -1, 0}, 8.0f),  // far and strong
    };
    const LightTree tree(lights, kSceneRadius);
    const auto probability = [&](std::size_t light) { return tree.probability(Vec3f(0.0f), light); };
    EXPECT_GT(probability(0), 0.6f);
    EXPECT_LT(probability(1), 0.03f);
    EXPECT_GT(probability(3) - 0.0075f, 4.0f * (probability(2) - 0.0075f));
}

TEST(LightTree, PrefersWhatTheSurfaceFacesAndMirrors) {
    const std::vector<Light> lights = {
        PointLight{{3, 3, 0}, Rgb(1.0f)},    // as strong and as far away, where a mirror would show it
        PointLight{{-3, 3, 0}, Rgb(1.0f)},   // the other way
        PointLight{{3, -3, 0}, Rgb(10.0f)},  // behind the surface
    };
    const LightTree tree(lights, kSceneRadius);
    const Vec3f wo = normalize(Vec3f(-1, 1, 0));
    const LightReceiver bare(Vec3f(0.0f));
    const LightReceiver diffuse(Vec3f(0.0f), {0, 1, 0});
    LightReceiver glossy = diffuse;
    glossy.wo = wo;
    glossy.glossy = 1.0f;
    glossy.alpha = 0.1f;
    EXPECT_GT(tree.probability(bare, 2), 0.7f);
    EXPECT_LT(tree.probability(diffuse, 2), 0.02f);
    EXPECT_NEAR(tree.probability(diffuse, 0), tree.probability(diffuse, 1), 1e-5f);
    EXPECT_GT(tree.probability(glossy, 0), 0.9f);
    EXPECT_LT(tree.probability(glossy, 1), 0.05f);
}

// The point of it all: where many lamps stand about, what is chosen brings nearly the same whichever it is.
TEST(LightTree, WeighsLampsAsTheyContribute) {
    constexpr std::size_t kCount = 10'000;
    std::vector<Light> lights;
    for (int z = 0; z < 100; ++z)
        for (int x = 0; x < 100; ++x)
            lights.emplace_back(PointLight{{static_cast<float>(x), 2.0f, static_cast<float>(z)}, Rgb(1.0f)});
    const LightTree tree(lights, 100.0f);
    const AliasTable by_power = choice_by_power(lights, 100.0f);
    Random random(9);
    double tree_variance = 0.0;
    double floor_variance = 0.0;
    double power_variance = 0.0;
    for (int p = 0; p < 20; ++p) {
        const Vec3f point(20.0f + 60.0f * random.next(), 0.0f, 20.0f + 60.0f * random.next());
        const LightReceiver floor(point, {0, 1, 0});
        double sum = 0.0;
        double reflected = 0.0;
        double with_tree = 0.0;
        double with_normal = 0.0;
        double with_power = 0.0;
        for (std::size_t i = 0; i < kCount; ++i) {
            const LightSample sample = sample_light(lights[i], point, {0.5f, 0.5f}, {0.5f, 0.5f});
            const auto arrives = static_cast<double>(average(sample.radiance));
            const double reflects = arrives * static_cast<double>(sample.wi.y);
            sum += arrives;
            reflected += reflects;
            with_normal += reflects * reflects / static_cast<double>(tree.probability(floor, i));
            with_tree += arrives * arrives / static_cast<double>(tree.probability(point, i));
            with_power += arrives * arrives / static_cast<double>(by_power.probability(i));
        }
        tree_variance += with_tree / (sum * sum) - 1.0;
        floor_variance += with_normal / (reflected * reflected) - 1.0;
        power_variance += with_power / (sum * sum) - 1.0;
    }
    EXPECT_LT(tree_variance, 0.05 * power_variance);
    EXPECT_LT(tree_variance / 20.0, 1.0);
    EXPECT_LT(floor_variance / 20.0, 0.5);
    std::printf("relative variance %.3f, of what a floor reflects %.3f\n", tree_variance / 20.0, floor_variance / 20.0);
}

TEST(LightTree, OneLightIsCertain) {
    const std::vector<Light> point = {PointLight{{1, 2, 3}, Rgb(1.0f)}};
    const std::vector<Light> sky = {half_sky(0.1f)};
    for (const std::vector<Light>& lights : {point, sky}) {
        const LightTree tree(lights, kSceneRadius);
        for (const Vec2f& u : {Vec2f(0.0f, 0.0f), Vec2f(0.3f, 0.9f), Vec2f(0x1.fffffep-1f, 0x1.fffffep-1f)}) {
            EXPECT_EQ(tree.sample(Vec3f(0.0f), u).light, 0u);
            EXPECT_EQ(tree.sample(Vec3f(0.0f), u).probability, 1.0f);
        }
        EXPECT_EQ(tree.probability(Vec3f(1, 2, 3), 0), 1.0f);
    }
    EXPECT_TRUE(LightTree({}, 1.0f).empty());
}

TEST(LightTree, NeitherTheSkyNorLampsStarve) {
    for (const float sky : {1e-6f, 1e6f}) {
        const std::vector<Light> lights = {PointLight{{0, 1, 0}, Rgb(1.0f)}, half_sky(sky)};
        const LightTree tree(lights, kSceneRadius);
        EXPECT_NEAR(tree.probability(Vec3f(0.0f), 0), sky < 1.0f ? 0.9f : 0.1f, 1e-6f);
        EXPECT_NEAR(tree.probability(Vec3f(0.0f), 1), sky < 1.0f ? 0.1f : 0.9f, 1e-6f);
    }
}

// A lamp of intensity I, d away, and a sky of radiance L from above: I / d² against what of the sky is above its mean,
// L / 2, from half of 4 pi: its power over the scene's disk.
TEST(LightTree, TheSkyAndLampsShareByIrradiance) {
    const std::vector<Light> lights = {PointLight{{0, 2, 0}, Rgb(5.0f)}, half_sky(0.7f)};
    const LightTree tree(lights, kSceneRadius);
    const double lamp = 5.0 / 4.0;
    const double sky = 2.0 * std::numbers::pi * 0.35;
    // The image is sampled by means over cells, so that its border has a width.
    EXPECT_NEAR(tree.probability(Vec3f(0.0f), 0), lamp / (lamp + sky), 0.01);
}

TEST(LightTree, WhatIsTheSameEverywhereIsLeftToOtherSamples) {
    EXPECT_TRUE(LightTree(std::vector<Light>{ConstantEnvironment{Rgb(0.1f)}}, kSceneRadius).empty());
    const std::vector<Light> lights = {PointLight{{0, 1, 0}, Rgb(1e-6f)}, ConstantEnvironment{Rgb(1e6f)}};
    const LightTree tree(lights, kSceneRadius);
    ASSERT_FALSE(tree.empty());
    EXPECT_EQ(tree.probability(Vec3f(0.0f), 0), 1.0f);
    EXPECT_EQ(tree.probability(Vec3f(0.0f), 1), 0.0f);
    EXPECT_EQ(tree.sample(Vec3f(0.0f), {0.999f, 0.999f}).light, 0u);
}

// Where floats overflow, all are as good.
TEST(LightTree, WhatIsTooFarAwayIsChosenEvenly) {
    const std::vector<Light> lights = random_lights(4, 15);
    const LightTree tree(lights, kSceneRadius);
    for (std::size_t i = 0; i < lights.size(); ++i)
        EXPECT_NEAR(tree.probability(Vec3f(1e25f, 0.0f, 0.0f), i), 0.25f, 1e-6f);
}

TEST(LightTree, WithoutPowerAllAreEquallyLikely) {
    const std::vector<Light> lights = {PointLight{{0, 0, 0}, Rgb(0.0f)}, PointLight{{0, 0, 0}, Rgb(0.0f)}};
    const LightTree tree(lights, 1.0f);
    for (std::size_t i = 0; i < lights.size(); ++i) EXPECT_NEAR(tree.probability(Vec3f(1, 1, 1), i), 0.5f, 1e-6f);
}

TEST(LightTree, ManyLightsAreBuiltInBoundedTimeAndMemory) {
    constexpr std::size_t kCount = 100'000;
    const std::vector<Light> lights = random_lights(kCount, 10);
    const double begin = thread_cpu_seconds();
    const LightTree tree(lights, kSceneRadius);
    const double seconds = thread_cpu_seconds() - begin;
    // Some twenty times what it takes: what is meant is a growth other than n log n.
    EXPECT_LT(seconds, 20.0);
    EXPECT_LE(tree.bytes(), 160 * kCount);
    std::printf("%.0f bytes and %.2f us a light\n", static_cast<double>(tree.bytes()) / kCount, seconds * 1e6 / kCount);
}

// Lamps whose places and powers halve are split off one by one, and those in one place are halved below all of them:
// the deepest tree there is.
TEST(LightTree, HoldsTheWayToTheDeepestLeaf) {
    std::vector<Light> lights;
    float x = 0x1p60f;
    for (int i = 0; i < 140; ++i, x *= 0.5f) lights.emplace_back(PointLight{{x, 0, 0}, Rgb(x)});
    for (int i = 0; i < 5000; ++i) lights.emplace_back(PointLight{{0, 0, 0}, Rgb(0x1p-90f)});
    const LightTree tree(lights, kSceneRadius);
    Random random(11);
    for (const Vec3f& point : {Vec3f(0, 0, 1e-3f), Vec3f(0, 0, 1e-15f)}) {
        double sum = 0.0;
        for (std::size_t light = 0; light < lights.size(); ++light)
            sum += static_cast<double>(tree.probability(point, light));
        EXPECT_NEAR(sum, 1.0, 1e-5);
        for (int i = 0; i < 20'000; ++i) {
            const LightTree::Choice choice = tree.sample(point, random.next_2d());
            ASSERT_LT(choice.light, lights.size());
            EXPECT_EQ(choice.probability, tree.probability(point, choice.light));
        }
    }
}

TEST(LightTree, IsTheSameEveryTime) {
    const std::vector<Light> lights = random_lights(2000, 12);
    const LightTree one(lights, kSceneRadius);
    const LightTree other(lights, kSceneRadius);
    Random random(13);
    for (int i = 0; i < 20; ++i) {
        const Vec3f point = random_point(random, 8.0f);
        for (std::size_t light = 0; light < lights.size(); ++light)
            ASSERT_EQ(one.probability(point, light), other.probability(point, light));
    }
}

}  // namespace

}  // namespace etendue::test
