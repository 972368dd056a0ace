#include "picture/render_setup.h"

#include "program/small_files.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

// The schema is what editors check a render.json with; an integrator that it does not know looks wrong there.
TEST(CreateIntegrator, TheSchemaNamesWhatTheRegistryHolds) {
    const nlohmann::json schema =
        nlohmann::json::parse(read_file(std::string(ETENDUE_SOURCE_DIR) + "/scenes/render.schema.json"));
    std::vector<std::string> names;
    for (const IntegratorEntry& entry : integrator_registry()) names.emplace_back(entry.name);
    EXPECT_EQ(schema["properties"]["integrator"]["properties"]["type"]["enum"], nlohmann::json(names));
}

TEST(CreateIntegrator, RefusesPathsThatAreNeverTraced) {
    RenderSettings settings;
    settings.integrator = {.type = "direct", .min_depth = 3};
    EXPECT_THROW((void)create_integrator(settings), SceneError);
    settings.integrator.min_depth = 2;
    EXPECT_NE(create_integrator(settings), nullptr);
}

TEST(CreateIntegrator, OnlyThoseWithStrategiesShowOne) {
    RenderSettings settings;
    settings.integrator = {.type = "path", .strategy = {{1, 2}}};
    EXPECT_THROW((void)create_integrator(settings), SceneError);
    settings.integrator.type = "bdpt";
    EXPECT_NE(create_integrator(settings), nullptr);
}

TEST(IntegratorOptions, AreThoseOfTheSettings) {
    RenderSettings settings;
    settings.integrator = {.type = "bdpt",
                           .max_depth = 9,
                           .min_depth = 2,
                           .roulette_depth = 5,
                           .light_samples = 4,
                           .heuristic = HeuristicType::Power,
                           .strategy = {{1, 2}},
                           .weighted = false,
                           .cached_connections = 3};
    const IntegratorOptions options = integrator_options(settings);
    EXPECT_EQ(options.lengths.max_depth, 9);
    EXPECT_EQ(options.lengths.min_depth, 2);
    EXPECT_EQ(options.lengths.roulette_depth, 5);
    EXPECT_EQ(options.light_samples, 4u);
    EXPECT_EQ(options.heuristic, Heuristic::Power);
    EXPECT_EQ(options.strategy, (Strategy{1, 2}));
    EXPECT_FALSE(options.weighted);
    EXPECT_EQ(options.cached_connections, 3);
}

TEST(IneffectiveSettings, OptionsOfAdaptiveSamplingNeedAnError) {
    RenderSettings settings;
    EXPECT_TRUE(ineffective_settings(settings, false).empty());
    settings.options = {{"/min_spp", "--min-spp"}, {"/adaptive", "--no-adaptive"}};
    const std::vector<std::string> notes = ineffective_settings(settings, false);
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_EQ(notes[0], "--min-spp has no effect without an error to reach (--error)");
    EXPECT_EQ(notes[1], "--adaptive has no effect without an error to reach (--error)");
    settings.adaptive = false;
    EXPECT_EQ(ineffective_settings(settings, false)[1].find("--no-adaptive"), 0u);
    settings.relative_error = 0.1;
    EXPECT_TRUE(ineffective_settings(settings, false).empty());
}

TEST(IneffectiveSettings, OptionsOfStrategiesNeedStrategies) {
    RenderSettings settings;
    settings.integrator = {.type = "path", .heuristic = HeuristicType::Power, .cached_connections = 2};
    EXPECT_TRUE(ineffective_settings(settings, false).empty()) << "of a render.json, for when bdpt is asked for";
    settings.options = {{"/integrator/heuristic", "--heuristic"}, {"/integrator/connections", "--bdpt-connections"}};
    const std::vector<std::string> notes = ineffective_settings(settings, false);
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_EQ(notes[0], "--heuristic has no effect with 'path': it is for 'bdpt', which has strategies");
    EXPECT_EQ(notes[1], "--bdpt-connections has no effect with 'path': it is for 'bdpt', which has strategies");
    settings.integrator.type = "bdpt";
    EXPECT_TRUE(ineffective_settings(settings, false).empty());
}

TEST(IneffectiveSettings, MoreLightSamplesAreForPathTracing) {
    RenderSettings settings;
    settings.integrator = {.type = "bdpt", .light_samples = 4};
    EXPECT_TRUE(ineffective_settings(settings, false).empty()) << "of a render.json, for when path is asked for";
    settings.options = {{"/integrator/light_samples", "--light-samples"}};
    EXPECT_EQ(ineffective_settings(settings, false),
              std::vector<std::string>{"--light-samples has no effect with 'bdpt': it is for 'path' and 'direct'"});
    for (const char* type : {"path", "direct"}) {
        settings.integrator.type = type;
        EXPECT_TRUE(ineffective_settings(settings, false).empty()) << type;
    }
}

TEST(IneffectiveSettings, IndirectLightTakesThreeEdges) {
    RenderSettings settings;
    settings.integrator.max_depth = 2;
    EXPECT_TRUE(ineffective_settings(settings, false).empty());
    settings.clamp_indirect = 1.0f;
    settings.options["/clamp_indirect"] = "--clamp-indirect";
    const std::vector<std::string> notes = ineffective_settings(settings, false);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("--clamp-indirect has no effect: paths have at most 2 edges"), std::string::npos)
        << notes[0];
    EXPECT_TRUE(ineffective_settings(settings, true).empty()) << "media add no edges";
    settings.integrator.max_depth = 3;
    EXPECT_TRUE(ineffective_settings(settings, false).empty());
}

}  // namespace

}  // namespace etendue::test
