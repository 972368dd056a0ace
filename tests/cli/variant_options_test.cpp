#include "cli/variant_options.h"

#include "cli/settings_options.h"
#include "session/usage_error.h"

#include <utility>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(WithOptions, AddsToThoseOfAllVariants) {
    CLI::App app;
    RenderRequest common;
    add_settings_options(app, common.overrides);
    app.parse("--max-depth 3 --camera 'the main one'", false);
    common.given = given_options(std::as_const(app).get_options());
    const RenderRequest request = with_options(common, "--max-depth 5 --unweighted --strategy 1,2");
    RenderSettings settings;
    request.overrides.apply(settings);
    EXPECT_EQ(settings.integrator.lengths.max_depth, 5);
    EXPECT_EQ(settings.camera, "the main one");
    EXPECT_EQ(command_line("render", request.given),
              "render --camera 'the main one' --max-depth '5' --strategy '1,2' --unweighted");
}

TEST(WithOptions, RefusesWhatIsDecidedForAll) {
    for (const char* options : {"--seed 1", "--spp 3", "--time 1", "--frames 1:3", "--half", "--float"})
        EXPECT_THROW((void)with_options({}, options), CLI::ParseError) << options;
    for (const char* options : {"--help", "more"}) EXPECT_THROW((void)with_options({}, options), UsageError) << options;
    EXPECT_NO_THROW((void)with_options({}, "--quality preview"));
}

}  // namespace

}  // namespace etendue::test
