#include "compare/comparison_variants.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

Variant variant_of(const std::string& integrator) {
    Variant result{.name = integrator, .light = "a scene"};
    result.settings.integrator.type = integrator;
    return result;
}

TEST(DifferentLight, IsThatOfOtherPaths) {
    Variant few = variant_of("path");
    few.settings.integrator.lengths.max_depth = 4;
    EXPECT_NE(different_light(variant_of("path"), few).find("1 to 4"), std::string::npos);
    EXPECT_EQ(different_light(few, few), "");
    Variant later = variant_of("path");
    later.settings.integrator.lengths.min_depth = 2;
    EXPECT_NE(different_light(variant_of("path"), later), "");
    EXPECT_NE(different_light(variant_of("path"), variant_of("direct")), "");
    few.settings.integrator.lengths.max_depth = 2;
    EXPECT_EQ(different_light(few, variant_of("direct")), "") << "one bounce";
    EXPECT_EQ(different_light(variant_of("path"), variant_of("bdpt")), "");
}

TEST(DifferentLight, IsThatOfOtherScenesStrategiesAndDebugging) {
    Variant other = variant_of("path");
    other.light = "another scene";
    EXPECT_NE(different_light(variant_of("bdpt"), other).find("scenes"), std::string::npos);
    Variant strategy = variant_of("bdpt");
    strategy.settings.integrator.strategy = {2, 3};
    EXPECT_NE(different_light(variant_of("path"), strategy).find("2,3"), std::string::npos);
    for (const char* name : {"normals", "albedo"})
        EXPECT_NE(different_light(variant_of(name), variant_of("path")).find("something else"), std::string::npos)
            << name;
    Variant faster = variant_of("bdpt");
    faster.settings.integrator.heuristic = Heuristic::Power;
    faster.settings.integrator.cached_connections = 4;
    faster.settings.spp = 7;
    EXPECT_EQ(different_light(variant_of("bdpt"), faster), "");
}

TEST(RenderCommand, IsOfThatImage) {
    Variant of_frame = variant_of("path");
    of_frame.given = {{"--spp", "4"}, {"--integrator", "path"}, {"--seed", "1"}};
    of_frame.settings.frame = 0;
    of_frame.settings.time_limit = 3.0;
    EXPECT_EQ(
        render_command("a scene", of_frame, 8, 9),
        "etendue render 'a scene' --integrator 'path' --frames 0 --spp 8 --seed 9 --time 1e9 --float -o image.exr");
}

}  // namespace

}  // namespace etendue::test
