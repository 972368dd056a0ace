#include "picture/render_setup.h"

#include "scene/setting.h"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

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
    EXPECT_EQ(notes[1], "--min-spp has no effect without --error");
    EXPECT_EQ(notes[0], "--no-adaptive has no effect without --error");
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
    EXPECT_EQ(notes[0], "--heuristic has no effect with 'path': it is for 'bdpt'");
    EXPECT_EQ(notes[1], "--bdpt-connections has no effect with 'path': it is for 'bdpt'");
    settings.integrator.type = "bdpt";
    EXPECT_TRUE(ineffective_settings(settings, false).empty());
}

TEST(IneffectiveSettings, TheTableNamesTheIntegratorsThatTheRegistryDoes) {
    for (const IntegratorEntry& entry : integrator_registry()) {
        const auto is_named = [&](const char* pointer) {
            return find_setting(pointer)->integrators.find(entry.name) != std::string_view::npos;
        };
        EXPECT_EQ(is_named("/integrator/light_samples"), entry.splits_light_samples) << entry.name;
        EXPECT_EQ(is_named("/integrator/heuristic"), entry.has_strategies) << entry.name;
        EXPECT_EQ(is_named("/integrator/connections"), entry.has_strategies) << entry.name;
    }
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
