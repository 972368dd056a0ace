#include "compare/comparison_notes.h"

#include <string>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

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

TEST(ReferenceNoise, OfAPooledOneIsNotedWhereItIsMoreThanAnError) {
    ComparisonReport report;
    report.reference = {.kind = "pooled", .noise_rel_mse = 0.01};
    report.regions.push_back({.name = "caustic",
                              .variants = {{.name = "path", .errors = {{"relmse", {{9.0}}}}},
                                           {.name = "bdpt", .errors = {{"relmse", {{0.2}}}}}},
                              .reference_noise = 0.1});
    EXPECT_EQ(reference_noise(report), "");
    report.regions[0].reference_noise = 2.5;
    EXPECT_NE(reference_noise(report).find("in 'caustic' (its relMSE is 2.5, that of 'bdpt' 0.2)"), std::string::npos)
        << reference_noise(report);
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
