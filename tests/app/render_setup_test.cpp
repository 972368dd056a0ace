#include "app/render_setup.h"

#include "app/small_files.h"

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

}  // namespace

}  // namespace etendue::test
