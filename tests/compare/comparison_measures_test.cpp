#include "compare/comparison_measures.h"

#include "compare/comparison_images.h"
#include "compare/comparison_notes.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

TEST(FindRegions, AreWhereErrorsDifferMost) {
    std::vector<ImageF> maps(2, ImageF(48, 48, 1));
    const auto fill = [](ImageF& map, const PixelRect& block, float error) {
        for (int y = block.y0; y < block.y1; ++y)
            for (int x = block.x0; x < block.x1; ++x) map.pixel(x, y)[0] = error;
    };
    fill(maps[1], {16, 24, 24, 32}, 5.0f);
    fill(maps[0], {40, 0, 48, 8}, 7.0f);
    maps[0].pixel(2, 2)[0] = 1e6f;  // a firefly
    const std::vector<NamedRegion> regions = find_regions(maps, {100, 200, 148, 248});
    ASSERT_EQ(regions.size(), 3u);
    EXPECT_EQ(regions[0].pixels, (PixelRect{140, 200, 148, 208}));
    EXPECT_EQ(regions[1].pixels, (PixelRect{116, 224, 124, 232}));
    EXPECT_TRUE(find_regions(std::span(maps).first(1), {0, 0, 48, 48}).empty()) << "one has none to differ from";
}

TEST(FindRegions, LeaveOutWhatIsNoNumber) {
    std::vector<ImageF> maps(2, ImageF(48, 48, 1));
    for (int i = 0; i < 48 * 48; ++i) {
        const int block = 6 * (i / 48 / 8) + i % 48 / 8;
        maps[1].pixels[static_cast<std::size_t>(i)] = block % 3 == 0   ? std::numeric_limits<float>::quiet_NaN()
                                                      : block % 3 == 1 ? std::numeric_limits<float>::infinity()
                                                                       : static_cast<float>(block);
    }
    const std::vector<NamedRegion> regions = find_regions(maps, {0, 0, 48, 48});
    ASSERT_EQ(regions.size(), 3u);
    EXPECT_EQ(regions[0].pixels, (PixelRect{40, 40, 48, 48}));
    EXPECT_EQ(regions[1].pixels, (PixelRect{16, 40, 24, 48}));
}

TEST(DropDrowned, LeavesWhatIsAboveTheNoise) {
    ErrorsByMetric errors{
        {"relmse", {{0.3, -0.1}}}, {"relmse-trimmed", {{0.1, -0.2}}}, {"mse", {{0.0, 0.0}}}, {"mae", {{0.0, 0.0}}}};
    drop_drowned(errors);
    EXPECT_DOUBLE_EQ(errors.at("relmse").mean(), 0.1) << "one seed's may be negative by chance";
    EXPECT_TRUE(std::isnan(errors.at("relmse-trimmed").mean()));
    EXPECT_TRUE(std::isnan(errors.at("mse").mean()));
    EXPECT_EQ(errors.at("mae").mean(), 0.0) << "it has no noise taken off";
    ComparisonReport report;
    report.variants = {{.name = "path", .errors = errors}, {.name = "bdpt", .errors = {{"relmse", {{1.0}}}}}};
    EXPECT_EQ(drowned_errors(report), "") << "without a reference of known noise";
    report.reference.noise_rel_mse = 0.5;
    EXPECT_NE(drowned_errors(report).find("a relMSE of 0.5, hides errors of 'path', which"), std::string::npos)
        << drowned_errors(report);
}

TEST(FitStrategies, TakesNoLongerThanTheirShare) {
    EXPECT_EQ(fit_strategies(10.0, 1.0, 1.0).spp, 8u);
    EXPECT_EQ(fit_strategies(3.9, 2.0, 0.5).spp, 4u);
    EXPECT_EQ(fit_strategies(3.9, 2.0, 0.5).scale, 1.0);
    EXPECT_EQ(fit_strategies(1.0, 4.0, 0.5).spp, 1u);
    EXPECT_EQ(fit_strategies(1.0, 4.0, 0.5).scale, 0.5);
    EXPECT_EQ(fit_strategies(1.0, 400.0, 0.5).scale, 0.25) << "of less nothing can be seen";
}

}  // namespace

}  // namespace etendue::test
