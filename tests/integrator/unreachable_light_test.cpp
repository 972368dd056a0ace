// What integrators say that they cannot find, and that those which say nothing find it.
#include "integrator/agreement_room.h"
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

constexpr const char* kTransport[] = {"path", "direct", "naive", "light", "bdpt", "vcm", "whitted"};

/// Those of whose sentences one contains `text`.
Names who_says(const World& world, std::string_view text) {
    Names names;
    for (const char* name : kTransport)
        if (std::ranges::any_of(make_integrator(name, {})->unreachable_light(world),
                                [&](const std::string& said) { return said.find(text) != std::string::npos; }))
            names.emplace_back(name);
    return names;
}

/// Of the whole image, splats included; of paths of at most `max_depth` edges.
MeanEstimate render_by(const World& world, const char* integrator, int max_depth = 2) {
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    const auto made = make_integrator(integrator, {.lengths = {.max_depth = max_depth}});
    RenderOptions options = whole_image(4, 4, 256);
    options.filter = PixelFilter(FilterShape::Box);
    std::vector<double> means;
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        options.seed = seed;
        means.push_back(mean_of(render(world, *made, options, threads, stop, {}).film.resolve()));
    }
    return MeanEstimate(means);
}

void expect_same_as_path(const World& world, const std::vector<const char*>& integrators, int max_depth = 2) {
    const MeanEstimate path = render_by(world, "path", max_depth);
    EXPECT_GT(path.mean, 0.01);
    for (const char* name : integrators) {
        const MeanEstimate other = render_by(world, name, max_depth);
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

/// A mirror in front of the camera, and behind it a wall that is lit by way of the mirror only.
SceneDesc wall_in_mirror() {
    SceneDesc scene = empty_scene();
    MaterialDesc mirror;
    mirror.override_model = ConductorDesc{};
    add_object(scene, quad({0, 0, -3}, {8, 0, 0}, {0, 8, 0}), add_material(scene, mirror));
    add_object(scene, quad({0, 0, 1}, {-8, 0, 0}, {0, 8, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    return scene;
}

TEST(UnreachableLight, MirrorsAreBlackFromTheLight) {
    EXPECT_EQ(who_says(compile(wall_and_lamp()), "what the eye sees in mirrors"), Names());
    SceneDesc scene = wall_in_mirror();
    add_object(scene, quad({0, 1.5f, 0.2f}, {-0.3f, 0, 0}, {0, 0.3f, 0}), add_material(scene, emissive(Rgb(8.0f))));
    const World world = compile(std::move(scene));
    EXPECT_EQ(who_says(world, "what the eye sees in mirrors"), Names{"light"});
    EXPECT_EQ(who_says(world, "where the eye sees it in a mirror"), Names()) << "paths that meet the lamp by chance";
    constexpr int kEdges = 4;
    expect_same_as_path(world, {"naive", "bdpt"}, kEdges);
    EXPECT_EQ(render_by(world, "light", kEdges).mean, 0.0);
}

// Specular, diffuse, specular, with no end that a ray could meet: neither side can be connected to the wall.
TEST(UnreachableLight, CausticsOfPointsAreNotSeenInMirrors) {
    LightDesc lamp;
    lamp.type = LightType::Spot;
    lamp.intensity = 100.0f;
    lamp.to_world = translation({0, 1.5f, 0.2f});
    SceneDesc unmirrored = wall_and_lamp();
    unmirrored.lights.push_back(lamp);
    EXPECT_EQ(who_says(compile(std::move(unmirrored)), "where the eye sees it in a mirror"), Names());
    SceneDesc scene = wall_in_mirror();
    scene.lights.push_back(lamp);
    const World world = compile(std::move(scene));
    EXPECT_EQ(who_says(world, "where the eye sees it in a mirror"), Names{"bdpt"});
    for (const char* name : {"path", "light", "bdpt"}) EXPECT_EQ(render_by(world, name, 6).mean, 0.0) << name;
    EXPECT_GT(render_by(world, "vcm", 6).mean, 0.0);
}

/// Returns what `vcm` with `settings` says of `world`, one sentence after the other.
std::string vcm_says(const World& world, const IntegratorSettings& settings) {
    const auto vcm = make_integrator("vcm", settings);
    std::string all;
    for (const auto& sentences : {vcm->unreachable_light(world), vcm->ineffective_options(world)})
        for (const std::string& sentence : sentences) all += sentence + "\n";
    return all;
}

TEST(UnreachableLight, MergingSaysWhatItsOptionsLeaveOut) {
    SceneDesc scene = wall_in_mirror();
    scene.lights.push_back(light(LightType::Point, 10.0f, translation({0, 1.5f, 0.2f})));
    const World world = compile(std::move(scene));
    EXPECT_EQ(vcm_says(world, {}), "");
    const MergeSettings none{.at = MergeAt::Nothing};
    EXPECT_NE(vcm_says(world, {.merging = none}).find("'vcm' with '--merge sds' finds it"), std::string::npos);
    EXPECT_EQ(vcm_says(world, {.strategy = Strategy{2, 2}, .merging = none}), "");
    EXPECT_EQ(vcm_says(world, {.strategy = Strategy{2, 2}}), "");

    const MergeSettings wide{.radius = 3.0};
    const char* const no_effect = "--merge-radius and --merge-alpha have no effect: no vertices merge\n";
    EXPECT_EQ(vcm_says(world, {.merging = wide}), "");
    EXPECT_EQ(vcm_says(world, {.strategy = Strategy{2, 2}, .merging = wide}), "") << "its weight depends on it";
    EXPECT_EQ(vcm_says(world, {.strategy = Strategy{2, 2}, .weighted = false, .merging = wide}), no_effect);
    EXPECT_EQ(vcm_says(compile(wall_and_lamp()), {.merging = wide}), no_effect);

    const auto alone = [&](int max_depth, MergeAt at) {
        return vcm_says(world, {.lengths = {.max_depth = max_depth}, .strategy = kMerges, .merging = {.at = at}});
    };
    EXPECT_EQ(alone(4, MergeAt::SeenByDeltas), "");
    EXPECT_NE(alone(3, MergeAt::SeenByDeltas).find("have 4 edges at least, and"), std::string::npos);
    EXPECT_EQ(alone(2, MergeAt::Everywhere), "");
    EXPECT_NE(alone(1, MergeAt::Everywhere).find("have 2 edges at least, and"), std::string::npos);
}

TEST(UnreachableLight, TheSkyItselfIsNotFoundFromTheLight) {
    EXPECT_EQ(who_says(compile(wall_and_lamp()), "the environment itself"), Names());
    SceneDesc scene = empty_scene();
    scene.environment.enabled = true;
    const World world = compile(std::move(scene));
    EXPECT_EQ(who_says(world, "the environment itself"), Names{"light"});
    for (const char* name : {"path", "naive", "direct", "whitted", "bdpt"})
        EXPECT_NEAR(render_by(world, name).mean, 1.0, 1e-6) << name;
    EXPECT_EQ(render_by(world, "light").mean, 0.0);
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

TEST(UnreachableLight, EmittersThatGrowAreNotFoundFromTheLight) {
    SceneDesc scene = wall_and_lamp();
    EXPECT_EQ(who_says(compile(scene), "not sampled"), Names());
    // All integrators find a lamp that only shifts, and a wall that moves but does not glow.
    scene.instances.front().motion = {Mat4f(), translation({0.1f, 0, 0})};
    scene.instances.back().motion = {Mat4f(), translation({0.1f, 0, 0})};
    EXPECT_EQ(who_says(compile(scene), "not sampled"), Names());
    Mat4f grown;
    grown.setScale(Vec3f(1.2f));
    scene.instances.back().motion = {Mat4f(), grown};
    const World world = compile(std::move(scene));
    EXPECT_EQ(who_says(world, "not sampled"), (Names{"light", "whitted"}));
    expect_same_as_path(world, {"naive", "bdpt", "direct"});
    EXPECT_EQ(render_by(world, "light").mean, 0.0);
    EXPECT_EQ(render_by(world, "whitted").mean, 0.0);
}

}  // namespace

}  // namespace etendue::test
