#include "loader/gltf/gltf_builder.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A triangle whose node is animated along `path` with keys at 1 s and 3 s.
GltfBuilder animated(const std::string& path, const std::vector<float>& values, int components,
                     const char* interpolation) {
    GltfBuilder builder;
    builder.add_triangle();
    const int input = builder.floats({1.0f, 3.0f}, 1);
    const int output = builder.floats(values, components);
    builder.json["animations"] = {
        {{"name", "move"},
         {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
    return builder;
}

/// Asks for that moment of the animation of that name.
LoadOptions at_time(double seconds, const std::string& animation = {}) {
    return {.adjust = [=](RenderSettings& settings) {
        settings.time_code = seconds;
        if (!animation.empty()) settings.animations = {animation};
    }};
}

/// Where the point goes at `seconds`.
Vec3f moved(const GltfBuilder& builder, double seconds, const Vec3f& point) {
    const LoadedScene loaded = builder.load(at_time(seconds, "move"));
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    return transform_point(loaded.scene.instances.at(0).to_world, point);
}

TEST(Animation, TranslationsAreInterpolatedAndHeldAtTheEnds) {
    const GltfBuilder builder = animated("translation", {0, 0, 0, 4, 8, 0}, 3, "LINEAR");
    EXPECT_EQ(moved(builder, -1.0, Vec3f(0.0f)), Vec3f(0, 0, 0));
    EXPECT_EQ(moved(builder, 1.5, Vec3f(0.0f)), Vec3f(1, 2, 0));
    EXPECT_EQ(moved(builder, 3.0, Vec3f(0.0f)), Vec3f(4, 8, 0));
    EXPECT_EQ(moved(builder, 99.0, Vec3f(0.0f)), Vec3f(4, 8, 0));
}

TEST(Animation, FramesHaveTheStageOfTheWhole) {
    GltfBuilder builder = animated("translation", {0, 0, 0, 4, 8, 0}, 3, "LINEAR");
    for (const int frame : {0, 36, 999}) {
        const LoadedScene loaded = builder.load({.frame = frame});
        EXPECT_EQ(loaded.swept.bounds.min, Vec3f(0, 0, 0));
        EXPECT_EQ(loaded.swept.bounds.max, Vec3f(5, 9, 0));
        EXPECT_EQ(loaded.swept.lowest, 0.0f);
        EXPECT_EQ(loaded.scene.instances.size(), 1u);
        EXPECT_EQ(loaded.scene.nodes.size(), 1u);
    }
    EXPECT_TRUE(builder.load(at_time(2.0)).swept.bounds.empty()) << "a moment is framed by itself";
    builder.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    builder.json["nodes"][0]["camera"] = 0;
    EXPECT_FALSE(builder.load({.frame = 0}).swept.bounds.empty()) << "the studio may have a ground";
    builder.json["nodes"][0]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    EXPECT_TRUE(builder.load({.frame = 0}).swept.bounds.empty()) << "nothing has to be placed";
}

TEST(Animation, StepsWaitForTheNextKey) {
    const GltfBuilder builder = animated("scale", {1, 1, 1, 2, 2, 2}, 3, "STEP");
    EXPECT_EQ(moved(builder, 2.999, Vec3f(1.0f)), Vec3f(1.0f));
    EXPECT_EQ(moved(builder, 3.0, Vec3f(1.0f)), Vec3f(2.0f));
}

// Key times are the nearest floats to the times of frames, above or below.
TEST(Animation, EachFrameReachesItsOwnKey) {
    constexpr int kFrames = 240;
    std::vector<float> times;
    std::vector<float> places;
    for (int frame = 0; frame < kFrames; ++frame) {
        times.push_back(static_cast<float>(static_cast<double>(frame) / 24.0));
        for (const float number : {static_cast<float>(frame) / kFrames, 0.0f, 0.0f}) places.push_back(number);
    }
    GltfBuilder builder = animated("translation", places, 3, "STEP");
    builder.json["animations"][0]["samplers"][0]["input"] = builder.floats(times, 1);
    for (int frame = 0; frame < kFrames; ++frame)
        ASSERT_EQ(moved(builder, static_cast<double>(frame) / 24.0, Vec3f(0.0f)).x,
                  static_cast<float>(frame) / kFrames);
}

// Between the keys at 1 s and 3 s.
TEST(Animation, KeysThatAreNotFiniteAreLeftOut) {
    const float inf = std::numeric_limits<float>::infinity();
    const auto expect = [](const GltfBuilder& builder, const char* said) {
        EXPECT_EQ(moved(builder, 2.0, Vec3f(0.0f)), Vec3f(2, 4, 0));
        EXPECT_TRUE(
            has_problem(builder.load(at_time(2.0)).problems, Severity::Warning, said, "/animations/0/channels/0"));
    };
    GltfBuilder values = animated("translation", {0, 0, 0, 9, NAN, 9, 4, 8, 0, inf, 0, 0}, 3, "LINEAR");
    values.json["animations"][0]["samplers"][0]["input"] = values.floats({1, 2, 3, 4}, 1);
    expect(values, "2 keys are not finite and are left out");
    GltfBuilder times = animated("translation", {9, 9, 9, 0, 0, 0, 4, 8, 0}, 3, "LINEAR");
    times.json["animations"][0]["samplers"][0]["input"] = times.floats({-inf, 1, 3}, 1);
    expect(times, "1 keys are not finite");
    GltfBuilder cubic =
        animated("translation", {0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 9, 9, 9, 9, 9, 9, NAN, 9, 0, 0, 0, 4, 8, 0, 0, 0, 0}, 3,
                 "CUBICSPLINE");
    cubic.json["animations"][0]["samplers"][0]["input"] = cubic.floats({1, 2, 3}, 1);
    expect(cubic, "1 keys are not finite");
    const GltfBuilder none = animated("translation", {NAN, 0, 0, NAN, 8, 0}, 3, "LINEAR");
    EXPECT_EQ(moved(none, 2.0, Vec3f(0.0f)), Vec3f(0, 0, 0)) << "as the node has it";
}

TEST(Animation, TheLaterOfTwoKeysAtOneTimeCounts) {
    GltfBuilder builder = animated("translation", {0, 0, 0, 2, 0, 0, 5, 0, 0, 6, 0, 0}, 3, "LINEAR");
    builder.json["animations"][0]["samplers"][0]["input"] = builder.floats({0.0f, 1.0f, 1.0f, 2.0f}, 1);
    EXPECT_EQ(moved(builder, 0.5, Vec3f(0.0f)).x, 1.0f);
    EXPECT_EQ(moved(builder, 1.0, Vec3f(0.0f)).x, 5.0f);
    EXPECT_EQ(moved(builder, 1.5, Vec3f(0.0f)).x, 5.5f);
    EXPECT_TRUE(has_problem(builder.load(at_time(1.0)).problems, Severity::Warning, "keys 1 and 2 have the same time"));
}

// A quarter turn about z, given as its antipode: the shorter way, at an even pace.
TEST(Animation, RotationsGoTheShorterWayAtAnEvenPace) {
    const float s = std::sqrt(0.5f);
    const GltfBuilder builder = animated("rotation", {0, 0, 0, 1, 0, 0, -s, -s}, 4, "LINEAR");
    for (const double share : {0.25, 0.5, 0.75}) {
        const double angle = share * 1.5707963;
        const Vec3f expected(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0.0f);
        EXPECT_LT(length(moved(builder, 1.0 + 2.0 * share, {1, 0, 0}) - expected), 1e-5f) << share;
    }
}

// Tangents of 1 m/s along y at the first key and of 2 m/s along z at the second: x = 0 to 4 smoothly.
TEST(Animation, CubicSplinesUseTheirTangentsPerSecond) {
    const GltfBuilder builder =
        animated("translation", {9, 9, 9, 0, 0, 0, 0, 1, 0, 0, 0, 2, 4, 0, 0, 9, 9, 9}, 3, "CUBICSPLINE");
    // At the middle Hermite's basis is 1/2, 1/8, 1/2, -1/8; the tangents count for the two seconds between.
    EXPECT_LT(length(moved(builder, 2.0, Vec3f(0.0f)) - Vec3f(2.0f, 0.25f, -0.5f)), 1e-6f);
    // After a quarter of the time 27/32, 9/64, 5/32 and -3/64.
    EXPECT_LT(length(moved(builder, 1.5, Vec3f(0.0f)) - Vec3f(0.625f, 0.28125f, -0.1875f)), 1e-6f);
    EXPECT_EQ(moved(builder, 1.0, Vec3f(0.0f)), Vec3f(0.0f));
}

TEST(Animation, AtRestWithoutATimeCode) {
    const LoadedScene loaded = animated("translation", {5, 0, 0, 4, 8, 0}, 3, "LINEAR").load();
    EXPECT_EQ(transform_point(loaded.scene.instances.at(0).to_world, Vec3f(0.0f)), Vec3f(0.0f));
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Note, "--time-code", "/animations"));
}

TEST(Animation, UnknownNamesAreErrorsAndNoAnimationIsNone) {
    const GltfBuilder builder = animated("translation", {0, 0, 0, 4, 8, 0}, 3, "LINEAR");
    EXPECT_TRUE(has_problem(builder.load(at_time(1.0, "mvoe")).problems, Severity::Error, "did you mean 'move'?",
                            "/animations"));
    GltfBuilder still;
    still.add_triangle();
    EXPECT_TRUE(has_problem(still.load(at_time(1.0)).problems, Severity::Warning, "has no animation"));
}

TEST(Animation, WhatCannotBeReadIsAnError) {
    const auto error_of = [](const auto& spoil) {
        GltfBuilder builder = animated("translation", {0, 0, 0, 4, 8, 0}, 3, "LINEAR");
        spoil(builder.json["animations"][0], builder);
        return listing(builder.load(at_time(1.0)).problems);
    };
    using Json = nlohmann::json;
    EXPECT_NE(error_of([](Json& a, GltfBuilder&) { a["channels"][0]["sampler"] = 3; }).find("sampler 3 does not exist"),
              std::string::npos);
    EXPECT_NE(error_of([](Json& a, GltfBuilder& b) {
                  a["samplers"][0]["input"] = b.floats({3.0f, 1.0f}, 1);
              }).find("the time of key 1 is before that of key 0"),
              std::string::npos);
    EXPECT_NE(error_of([](Json& a, GltfBuilder& b) {
                  a["samplers"][0]["output"] = b.floats({1, 2, 3}, 3);
              }).find("do not make 2 keys"),
              std::string::npos);
    EXPECT_NE(
        error_of([](Json& a, GltfBuilder&) { a["channels"][0]["target"]["node"] = 7; }).find("refers to number 7"),
        std::string::npos);
}

/// Two triangles that move 4 m within 2 s: "rise" lifts the first, "slide" moves the second, and "turn", with its
/// scale, the first as well.
GltfBuilder with_three_animations() {
    GltfBuilder builder;
    builder.add_triangle();
    builder.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}};
    builder.json["scenes"][0]["nodes"] = {0, 1};
    const int input = builder.floats({0.0f, 2.0f}, 1);
    const int output = builder.floats({0, 0, 0, 4, 4, 4}, 3);
    const nlohmann::json samplers = {{{"input", input}, {"output", output}}};
    const auto channel = [](int node, const char* path) {
        return nlohmann::json{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}};
    };
    builder.json["animations"] = {
        {{"name", "rise"}, {"samplers", samplers}, {"channels", {channel(0, "translation")}}},
        {{"name", "slide"}, {"samplers", samplers}, {"channels", {channel(1, "translation")}}},
        {{"name", "turn"}, {"samplers", samplers}, {"channels", {channel(1, "scale"), channel(0, "translation")}}}};
    return builder;
}

/// Where the two triangles and the scale of the second are after 2 s if these animations are asked for.
Vec3f moved_by(const GltfBuilder& builder, const std::vector<std::string>& names, ProblemList* problems = nullptr) {
    const LoadedScene loaded = builder.load({.adjust = [&](RenderSettings& settings) {
        settings.time_code = 1.0;
        settings.animations = names;
    }});
    if (problems != nullptr)
        *problems = loaded.problems;
    else
        EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    if (loaded.scene.instances.size() < 2) return Vec3f(-1.0f);
    const Mat4f& first = loaded.scene.instances[0].to_world;
    const Mat4f& second = loaded.scene.instances[1].to_world;
    return {first[3][0], second[3][0], second[0][0]};
}

TEST(Animation, AllThatDoNotConflictPlay) {
    const GltfBuilder builder = with_three_animations();
    ProblemList problems;
    EXPECT_EQ(moved_by(builder, {}, &problems), Vec3f(2, 2, 1)) << "all of 'turn' is left out, its scale, too";
    EXPECT_TRUE(has_problem(problems, Severity::Warning, "animations before them: 'turn'", "/animations"))
        << listing(problems);
    EXPECT_EQ(moved_by(builder, {"turn", "rise"}, &problems), Vec3f(2, 0, 2)) << "the first that is asked for";
    EXPECT_TRUE(has_problem(problems, Severity::Warning, "animations before them: 'rise'", "/animations"));
    EXPECT_EQ(moved_by(builder, {"turn", "slide"}, &problems), Vec3f(2, 2, 2));
    EXPECT_TRUE(problems.all().empty()) << listing(problems);
}

TEST(Animation, NamesChooseWhichPlay) {
    const GltfBuilder builder = with_three_animations();
    EXPECT_EQ(moved_by(builder, {"slide"}), Vec3f(0, 2, 1));
    EXPECT_EQ(moved_by(builder, {"slide", "slide", "rise"}), Vec3f(2, 2, 1));
    EXPECT_EQ(moved_by(builder, {"none"}), Vec3f(0, 0, 1));
    ProblemList problems;
    (void)moved_by(builder, {"rise", "none"}, &problems);
    EXPECT_TRUE(has_problem(problems, Severity::Error, "'none' stands alone", "/animation")) << listing(problems);
    const LoadedScene frame =
        builder.load({.frame = 1, .adjust = [](RenderSettings& settings) { settings.animations = {"none"}; }});
    EXPECT_TRUE(has_problem(frame.problems, Severity::Error, "no animation is to play, so all frames"));
}

/// A triangle with a target that lifts its third vertex by 2 along z.
GltfBuilder morphing() {
    GltfBuilder builder;
    builder.add_triangle()["targets"] = {{{"POSITION", builder.floats({0, 0, 0, 0, 0, 0, 0, 0, 2}, 3)}}};
    return builder;
}

Vec3f third_vertex(const LoadedScene& loaded) {
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const Handle<MeshDesc> mesh = loaded.scene.instances.at(0).mesh;
    return loaded.scene.meshes.at(static_cast<std::size_t>(mesh.index)).primitives.at(0).positions.at(2);
}

// A weight of a mesh lies within all weights of it, whichever is animated first.
TEST(Animation, PointersWithinEachOtherConflict) {
    for (const bool whole_first : {false, true}) {
        GltfBuilder builder = morphing();
        const int input = builder.floats({0.0f, 2.0f}, 1);
        const auto to = [&](const char* pointer, float end) {
            const nlohmann::json extension = {{"KHR_animation_pointer", {{"pointer", pointer}}}};
            return nlohmann::json{
                {"name", pointer},
                {"samplers", {{{"input", input}, {"output", builder.floats({end, end}, 1)}}}},
                {"channels", {{{"sampler", 0}, {"target", {{"path", "pointer"}, {"extensions", extension}}}}}}};
        };
        builder.json["extensionsUsed"] = {"KHR_animation_pointer"};
        builder.json["animations"] = {to("/meshes/0/weights", 0.5f), to("/meshes/0/weights/0", 0.25f)};
        if (!whole_first) std::swap(builder.json["animations"][0], builder.json["animations"][1]);
        const LoadedScene loaded = builder.load(at_time(1.0));
        EXPECT_EQ(third_vertex(loaded).z, whole_first ? 1.0f : 0.5f) << listing(loaded.problems);
        EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "not played"));
    }
}

TEST(Animation, ThoseThatAreNotShownAreReadIfAsked) {
    GltfBuilder builder = animated("translation", {0, 0, 0, 4, 8, 0}, 3, "LINEAR");
    builder.json["animations"].push_back(builder.json["animations"][0]);
    builder.json["animations"][1]["samplers"][0]["input"] = builder.floats({3.0f, 1.0f}, 1);
    EXPECT_FALSE(has_problem(builder.load().problems, Severity::Warning, "", "/animations/1/channels/0"));
    for (const LoadOptions& options :
         {LoadOptions{.every_animation = true}, LoadOptions{.adjust = at_time(1.0).adjust, .every_animation = true}}) {
        const ProblemList problems = builder.load(options).problems;
        EXPECT_FALSE(problems.has_errors()) << listing(problems);
        EXPECT_TRUE(has_problem(problems, Severity::Warning, "is before", "/animations/1/channels/0"))
            << listing(problems);
    }
}

TEST(Animation, ThoseThatAreNotShownShareOneBudget) {
    // Nothing in the file is as long as its accessors, which 99 animations read.
    GltfBuilder builder = animated("translation", {0, 0, 0, 4, 8, 0}, 3, "LINEAR");
    nlohmann::json& accessors = builder.json["accessors"];
    const std::size_t input = accessors.size();
    accessors.push_back({{"type", "SCALAR"}, {"componentType", 5126}, {"count", 1 << 24}});
    accessors.push_back({{"type", "VEC3"}, {"componentType", 5126}, {"count", 1 << 24}});
    nlohmann::json& animations = builder.json["animations"];
    animations[0]["samplers"][0] = {{"input", input}, {"output", input + 1}};
    const nlohmann::json animation = animations[0];
    for (int i = 1; i < 99; ++i) animations.push_back(animation);
    const ProblemList problems = builder.load(LoadOptions{.every_animation = true}).problems;
    EXPECT_FALSE(problems.has_errors()) << listing(problems);
    EXPECT_TRUE(has_problem(problems, Severity::Warning, "refers to the same things so often", "/channels/0"))
        << listing(problems);
    EXPECT_LT(problems.all().size(), 20u) << "the rest is not read";
}

TEST(Morph, WeightsOfTheNodeComeBeforeTheMeshs) {
    GltfBuilder builder = morphing();
    EXPECT_EQ(third_vertex(builder.load()), Vec3f(0, 1, 0));
    builder.json["meshes"][0]["weights"] = {0.5};
    EXPECT_EQ(third_vertex(builder.load()), Vec3f(0, 1, 1));
    builder.json["nodes"][0]["weights"] = {1.0};
    EXPECT_EQ(third_vertex(builder.load()), Vec3f(0, 1, 2));
}

TEST(Morph, WhatTargetsCannotMoveIsSaid) {
    GltfBuilder builder = morphing();
    builder.json["meshes"][0]["primitives"][0]["targets"][0]["COLOR_0"] =
        builder.floats({0, 0, 0, 0, 0, 0, 0, 0, 2}, 3);
    const LoadedScene loaded = builder.load();
    EXPECT_EQ(third_vertex(loaded), Vec3f(0, 1, 0));
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "are ignored", "/targets/0/COLOR_0"))
        << listing(loaded.problems);
}

TEST(Morph, DisplacementsThatAreNotFiniteAreNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    GltfBuilder builder;
    builder.add_triangle()["targets"] = {{{"POSITION", builder.floats({0, 0, 0, 0, nan, 0, 0, 0, 2}, 3)}}};
    builder.json["meshes"][0]["weights"] = {1.0};
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "1 displacements are not finite"))
        << listing(loaded.problems);
    EXPECT_FALSE(loaded.problems.has_errors());
    const Handle<MeshDesc> mesh = loaded.scene.instances.at(0).mesh;
    const PrimitiveDesc& moved = loaded.scene.meshes.at(static_cast<std::size_t>(mesh.index)).primitives.at(0);
    EXPECT_EQ(moved.positions.at(1), Vec3f(1, 0, 0));
    EXPECT_EQ(moved.positions.at(2).z, 2.0f);
}

TEST(Morph, AnimatedWeightsComeFirst) {
    GltfBuilder builder = morphing();
    builder.json["nodes"][0]["weights"] = {1.0};
    builder.json["animations"] = {
        {{"samplers", {{{"input", builder.floats({0, 1}, 1)}, {"output", builder.floats({0, 4}, 1)}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
    EXPECT_EQ(third_vertex(builder.load(at_time(0.25))), Vec3f(0, 1, 2));
}

// At rest the third vertex lies on the edge of the other two; the target lifts it.
TEST(Morph, OpensTrianglesThatAreFlatAtRest) {
    GltfBuilder builder = morphing();
    nlohmann::json& primitive = builder.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = builder.floats({0, 0, 0, 1, 0, 0, 0.5f, 0, 0}, 3);
    const LoadedScene flat = builder.load();
    ASSERT_FALSE(flat.problems.has_errors()) << listing(flat.problems);
    const auto triangles = [](const LoadedScene& loaded) {
        std::size_t count = 0;
        for (const InstanceDesc& instance : loaded.scene.instances)
            for (const PrimitiveDesc& p :
                 loaded.scene.meshes.at(static_cast<std::size_t>(instance.mesh.index)).primitives)
                count += p.triangles.size();
        return count;
    };
    EXPECT_EQ(triangles(flat), 0u);
    builder.json["nodes"][0]["weights"] = {1.0};
    const LoadedScene open = builder.load();
    EXPECT_EQ(triangles(open), 1u);
    EXPECT_EQ(third_vertex(open), Vec3f(0.5f, 0, 2));
}

TEST(Morph, NormalsFollow) {
    GltfBuilder builder = morphing();
    builder.json["meshes"][0]["weights"] = {0.5};
    nlohmann::json& primitive = builder.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    primitive["targets"][0]["NORMAL"] = builder.floats({0, -2, 0, 0, 0, 0, 0, 0, 0}, 3);
    const LoadedScene loaded = builder.load();
    const auto mesh = static_cast<std::size_t>(loaded.scene.instances.at(0).mesh.index);
    const float s = std::sqrt(0.5f);
    EXPECT_LT(length(loaded.scene.meshes[mesh].primitives[0].normals[0] - Vec3f(0, -s, s)), 1e-6f);
}

/// A triangle whose third vertex hangs on a second joint.
GltfBuilder skinned() {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    const std::vector<std::uint8_t> joints{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
    primitive["attributes"]["JOINTS_0"] = builder.accessor(joints, "VEC4", 5121, 3);
    primitive["attributes"]["WEIGHTS_0"] = builder.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4);
    builder.json["nodes"][0]["skin"] = 0;
    builder.json["nodes"][0]["translation"] = {100, 0, 0};
    builder.json["nodes"].push_back({{"translation", {0, 0, 1}}, {"children", {2}}});
    builder.json["nodes"].push_back({{"translation", {0, 5, 0}}});
    builder.json["scenes"][0]["nodes"] = {0, 1};
    // The second joint was at (0, 1, 0) when the mesh was bound to it.
    const std::vector<float> inverse{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                     1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
    builder.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", builder.accessor(inverse, "MAT4", 5126, 2)}}};
    return builder;
}

TEST(Skin, MovesVerticesWithTheirJointsAndNotWithTheNode) {
    const LoadedScene loaded = skinned().load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const InstanceDesc& instance = loaded.scene.instances.at(0);
    const PrimitiveDesc& p = loaded.scene.meshes.at(static_cast<std::size_t>(instance.mesh.index)).primitives.at(0);
    EXPECT_EQ(transform_point(instance.to_world, p.positions[0]), Vec3f(0, 0, 1));
    EXPECT_EQ(transform_point(instance.to_world, p.positions[2]), Vec3f(0, 5, 1));
}

TEST(Skin, WeightsNeedNotAddUpToOne) {
    GltfBuilder builder = skinned();
    builder.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        builder.floats({0.5f, 0, 0, 0, 2, 0, 0, 0, 0.5f, 0.5f, 0, 0}, 4);
    const LoadedScene loaded = builder.load();
    const auto mesh = static_cast<std::size_t>(loaded.scene.instances.at(0).mesh.index);
    EXPECT_EQ(loaded.scene.meshes[mesh].primitives[0].positions[1], Vec3f(1, 0, 1));
    EXPECT_EQ(loaded.scene.meshes[mesh].primitives[0].positions[2], Vec3f(0, 3, 1)) << "between the two joints";
}

TEST(Skin, WeightsThatAreNotFiniteOrNegativeCountAsNone) {
    const float inf = std::numeric_limits<float>::infinity();
    GltfBuilder builder = skinned();
    builder.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        builder.floats({1, NAN, 0, 0, inf, 0, 0, 0, 1, -3, 0, 0}, 4);
    const LoadedScene loaded = builder.load();
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "negative or not finite are set to 0 (3 times",
                            "/meshes/0/primitives/0/attributes"))
        << listing(loaded.problems);
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const auto mesh = static_cast<std::size_t>(loaded.scene.instances.at(0).mesh.index);
    const std::vector<Vec3f>& positions = loaded.scene.meshes[mesh].primitives.at(0).positions;
    EXPECT_EQ(positions, (std::vector<Vec3f>{{0, 0, 1}, {1, 0, 0}, {0, 5, 1}})) << "the second has no joint left";
}

TEST(Skin, KeepsItsFrontWhereJointsMirror) {
    GltfBuilder builder = skinned();
    builder.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        builder.floats({0, 0.6f, 0.8f, 0, 0.6f, 0.8f, 0, 0.6f, 0.8f}, 3);
    builder.json["nodes"].push_back({{"scale", {-1, 1, 1}}, {"children", {0, 1}}});
    builder.json["scenes"][0]["nodes"] = {3};
    const LoadedScene loaded = builder.load();
    ASSERT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    const auto mesh = static_cast<std::size_t>(loaded.scene.instances.at(0).mesh.index);
    const PrimitiveDesc& p = loaded.scene.meshes[mesh].primitives[0];
    const auto& [a, b, c] = p.triangles.at(0);
    const Vec3f front = cross(p.positions[b] - p.positions[a], p.positions[c] - p.positions[a]);
    EXPECT_GT(front.z, 0.0f) << "a mirror across x turns no front around";
    EXPECT_GT(dot(p.normals[0], front), 0.0f) << "else the smooth normals are of no use";
}

TEST(Skin, JointsWithoutWeightNeedNotExist) {
    GltfBuilder builder = skinned();
    const std::vector<std::uint8_t> joints{0, 255, 255, 255, 0, 255, 255, 255, 1, 255, 255, 255};
    builder.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = builder.accessor(joints, "VEC4", 5121, 3);
    const LoadedScene loaded = builder.load();
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    EXPECT_EQ(third_vertex(loaded), Vec3f(0, 5, 1));
}

TEST(Skin, WhatCannotBeReadIsAnError) {
    const auto error_of = [](const auto& spoil) {
        GltfBuilder builder = skinned();
        spoil(builder);
        return listing(builder.load().problems);
    };
    EXPECT_NE(error_of([](GltfBuilder& b) {
                  b.json["skins"][0]["joints"] = {1};
              }).find("refers to joint 1, but the skin has 1"),
              std::string::npos);
    EXPECT_NE(error_of([](GltfBuilder& b) { b.json["scenes"][0]["nodes"] = {0}; }).find("is not in the scene"),
              std::string::npos);
    EXPECT_NE(error_of([](GltfBuilder& b) { b.json["accessors"][3]["count"] = 1; }).find("1 inverse bind matrices"),
              std::string::npos);
    EXPECT_NE(error_of([](GltfBuilder& b) {
                  b.json["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
              }).find("has no WEIGHTS_0"),
              std::string::npos);
    EXPECT_NE(error_of([](GltfBuilder& b) {
                  b.json["skins"][0]["joints"] = {1, 9};
              }).find("refers to number 9"),
              std::string::npos);
}

}  // namespace
}  // namespace etendue
