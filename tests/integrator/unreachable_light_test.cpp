// What integrators say that they cannot find, and that those which say nothing find it.
#include "integrator/bdpt/render_bdpt.h"
#include "integrator/integrator.h"
#include "render/whole_image.h"
#include "world/test_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

using Names = std::vector<std::string>;

constexpr const char* kTransport[] = {"path", "direct", "naive", "light", "bdpt", "whitted"};

/// Those of whose sentences one contains `text`.
Names who_says(const World& world, std::string_view text) {
    Names names;
    for (const char* name : kTransport)
        if (std::ranges::any_of(make_integrator(name, {})->unreachable_light(world),
                                [&](const std::string& said) { return said.find(text) != std::string::npos; }))
            names.emplace_back(name);
    return names;
}

/// Of the whole image, splats included.
MeanEstimate render_by(const World& world, const char* integrator) {
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    const auto made = make_integrator(integrator, {.lengths = {.max_depth = 2}});
    RenderOptions options = whole_image(4, 4, 256);
    options.filter = PixelFilter(FilterShape::Box);
    std::vector<double> means;
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        options.seed = seed;
        means.push_back(mean_of(render(world, *made, options, threads, stop, {}).film.resolve()));
    }
    return MeanEstimate(means);
}

void expect_same_as_path(const World& world, const std::vector<const char*>& integrators) {
    const MeanEstimate path = render_by(world, "path");
    EXPECT_GT(path.mean, 0.01);
    for (const char* name : integrators) {
        const MeanEstimate other = render_by(world, name);
        EXPECT_NEAR(other.mean, path.mean, 5.0 * std::hypot(other.error, path.error) + 1e-5) << name;
    }
}

/// A wall under a lamp out of view.
SceneDesc wall_and_lamp() {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -3}, {4, 0, 0}, {0, 4, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    add_object(scene, quad({0, 2, -2}, {0.8f, 0, 0}, {0, 0, 0.8f}), add_material(scene, emissive(Rgb(8.0f))));
    return scene;
}

TEST(UnreachableLight, IndirectLightIsLeftOutByName) {
    EXPECT_EQ(who_says(compile(wall_and_lamp()), "left out"), (Names{"direct", "whitted"}));
}

TEST(UnreachableLight, PointsAreNotMetByChanceNorSeenFromMirrors) {
    SceneDesc scene = wall_and_lamp();
    EXPECT_EQ(who_says(compile(scene), "never met by chance"), Names());
    LightDesc lamp;
    lamp.type = LightType::Point;
    lamp.intensity = 1.0f;
    scene.lights.push_back(lamp);
    EXPECT_EQ(who_says(compile(scene), "never met by chance"), Names{"naive"});
    EXPECT_EQ(who_says(compile(scene), "cannot be found by eye paths"), Names());
    MaterialDesc mirror;
    mirror.override_model = ConductorDesc{};
    add_object(scene, quad({0, 0, -5}, {1, 0, 0}, {0, 1, 0}), add_material(scene, mirror));
    EXPECT_EQ(who_says(compile(scene), "cannot be found by eye paths"), (Names{"path", "direct"}));
}

TEST(UnreachableLight, UnlitSurfacesAreNotFoundFromTheLight) {
    SceneDesc scene = wall_and_lamp();
    EXPECT_EQ(who_says(compile(scene), "unlit"), Names());
    MaterialDesc sign;
    sign.unlit = true;
    add_object(scene, quad({0, 0, -2.5f}, {0.5f, 0, 0}, {0, 0.5f, 0}), add_material(scene, sign));
    const World world = compile(std::move(scene));
    EXPECT_EQ(who_says(world, "unlit"), Names{"light"});
    expect_same_as_path(world, {"naive", "bdpt", "direct", "whitted"});
    EXPECT_LT(render_by(world, "light").mean, 0.9 * render_by(world, "path").mean);
}

TEST(UnreachableLight, EmittersThatMoveAreNotFoundFromTheLight) {
    SceneDesc scene = wall_and_lamp();
    EXPECT_EQ(who_says(compile(scene), "not sampled"), Names());
    // What moves but does not glow is found by all.
    scene.instances.front().motion = {Mat4f(), translation({0.1f, 0, 0})};
    EXPECT_EQ(who_says(compile(scene), "not sampled"), Names());
    scene.instances.back().motion = {Mat4f(), translation({0.1f, 0, 0})};
    const World world = compile(std::move(scene));
    EXPECT_EQ(who_says(world, "not sampled"), (Names{"light", "whitted"}));
    expect_same_as_path(world, {"naive", "bdpt", "direct"});
    EXPECT_EQ(render_by(world, "light").mean, 0.0);
    EXPECT_EQ(render_by(world, "whitted").mean, 0.0);
}

}  // namespace

}  // namespace etendue::test
