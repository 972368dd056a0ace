#include "compare/comparison_measures.h"

#include "compare/comparison_images.h"

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

TEST(UnequalTimes, AreThoseMoreThanATenthApart) {
    ComparisonReport report;
    report.seconds = 2.0;
    report.variants = {{.name = "path"}, {.name = "bdpt"}};
    report.variants[0].cpu_seconds.values = {2.0, 2.0};
    report.variants[1].cpu_seconds.values = {2.1, 2.2};
    report.variants[1].seconds.values = {9.0, 9.0};
    EXPECT_EQ(unequal_times(report), "");
    report.variants[1].cpu_seconds.values = {2.2, 2.4};
    EXPECT_NE(unequal_times(report).find("'bdpt' 2.3 s, 15% more"), std::string::npos) << unequal_times(report);
    report.seconds.reset();
    EXPECT_EQ(unequal_times(report), "") << "of equal samples times need not be equal";
}

TEST(ReferenceNoise, IsNotedWhereItIsMuchOfTheLeastError) {
    ComparisonReport report;
    report.reference = {.kind = "integrator", .noise_rel_mse = 0.3};
    report.variants = {{.name = "path", .errors = {{"relmse", {{1.0, 2.0}}}}},
                       {.name = "bdpt", .errors = {{"relmse", {{4.0}}}}},
                       {.name = "light", .errors = {{"relmse", {{kUnknown}}}}}};
    EXPECT_NE(reference_noise(report).find("a relMSE of 0.3, is 20% of the least"), std::string::npos)
        << reference_noise(report);
    report.reference.kind = "pooled";
    EXPECT_EQ(reference_noise(report), "");
    report.reference = {.kind = "file", .noise_rel_mse = 0.14};
    EXPECT_EQ(reference_noise(report), "");
    report.reference.noise_rel_mse = kUnknown;
    EXPECT_EQ(reference_noise(report), "");
}

TEST(FitStrategies, TakesNoLongerThanTheirShare) {
    EXPECT_EQ(fit_strategies(10.0, 1.0, 1.0).spp, 8u);
    EXPECT_EQ(fit_strategies(3.9, 2.0, 0.5).spp, 4u);
    EXPECT_EQ(fit_strategies(3.9, 2.0, 0.5).scale, 1.0);
    EXPECT_EQ(fit_strategies(1.0, 4.0, 0.5).spp, 1u);
    EXPECT_EQ(fit_strategies(1.0, 4.0, 0.5).scale, 0.5);
    EXPECT_EQ(fit_strategies(1.0, 400.0, 0.5).scale, 0.25) << "of less nothing can be seen";
}

TEST(OffBudget, AreMeansMoreThanATenthFromTheTimeAskedFor) {
    ComparisonReport report;
    report.seconds = 2.0;
    report.variants = {{.name = "path"}, {.name = "bdpt"}};
    report.variants[0].cpu_seconds.values = {1.8, 2.0};
    report.variants[1].cpu_seconds.values = {1.7, 1.8};
    EXPECT_NE(off_budget(report).find("CPU time asked for: 'bdpt' 1.75 s;"), std::string::npos) << off_budget(report);
    report.variants[1].cpu_seconds.values = {2.1, 2.1};
    EXPECT_EQ(off_budget(report), "");
    report.seconds.reset();
    report.variants[1].cpu_seconds.values = {9.0};
    EXPECT_EQ(off_budget(report), "") << "of equal samples there is no such time";
}

}  // namespace

}  // namespace etendue::test
