#include "report/profile_comparison.h"

#include "core/error.h"
#include "report/profile_fixture.h"
#include "report/profile_report.h"
#include "report/student_t.h"

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <boost/math/distributions/students_t.hpp>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;
using test::made_up_profile;
using test::made_up_run;

TEST(StudentT, IsBoosts) {
    for (const double degrees : {1.0, 1.37, 2.0, 3.5, 4.0, 9.9, 30.0, 1234.5}) {
        const boost::math::students_t distribution(degrees);
        for (const double t : {1e-6, 0.01, 0.5, 1.0, 2.0, 4.303, 25.0, 1e4}) {
            const double expected = 2.0 * boost::math::cdf(boost::math::complement(distribution, t));
            EXPECT_NEAR(student_two_sided(t, degrees), expected, 1e-12 + 1e-10 * expected) << t << ", " << degrees;
        }
        for (const double confidence : {0.1, 0.5, 0.9, 0.95, 0.99, 0.999}) {
            const double expected = boost::math::quantile(distribution, 0.5 + 0.5 * confidence);
            EXPECT_NEAR(student_quantile(confidence, degrees), expected, 1e-9 * expected)
                << confidence << ", " << degrees;
        }
    }
    EXPECT_EQ(student_two_sided(0.0, 3.0), 1.0);
}

/// A profile of one run, whose repetitions took this processor time.
ProfileReport with_times(std::vector<double> cpu_seconds) {
    ProfileReport report = made_up_profile();
    report.runs = {made_up_run(2, std::move(cpu_seconds))};
    return report;
}

ComparedRun compare(std::vector<double> before, std::vector<double> now) {
    return compare_profiles(with_times(std::move(before)), with_times(std::move(now))).runs.at(0);
}

// By hand: logarithms -0.1, 0, 0.1 and 0.3, 0.5 have means 0 and 0.4, variances 0.01 and 0.02, so that e² is
// 0.01 / 3 + 0.02 / 2 and there are e⁴ / ((0.01 / 3)² / 2 + 0.01² / 1) degrees of freedom.
TEST(ProfileComparison, IntervalIsWelchs) {
    const ComparedRun run = compare({std::exp(-0.1), 1.0, std::exp(0.1)}, {std::exp(0.3), std::exp(0.5)});
    const double squared = 0.01 / 3.0 + 0.01;
    const double degrees = squared * squared / (0.01 * 0.01 / 9.0 / 2.0 + 0.0001);
    const double t = boost::math::quantile(boost::math::students_t(degrees), 0.975);
    EXPECT_NEAR(run.ratio, std::exp(0.4), 1e-12);
    EXPECT_NEAR(std::log(run.low), 0.4 - t * std::sqrt(squared), 1e-9);
    EXPECT_NEAR(std::log(run.high), 0.4 + t * std::sqrt(squared), 1e-9);
    EXPECT_EQ(run.verdict, ProfileVerdict::NoDifference);
    EXPECT_NEAR(run.before, 1e-3, 1e-15) << "of one of 1000 samples";
}

TEST(ProfileComparison, TellsSlowerFromFaster) {
    const std::vector<double> times{1.0, 1.001, 0.999, 1.0};
    const std::vector<double> slower{1.05, 1.051, 1.049, 1.05};
    EXPECT_EQ(compare(times, slower).verdict, ProfileVerdict::Slower);
    EXPECT_EQ(compare(slower, times).verdict, ProfileVerdict::Faster);
    EXPECT_EQ(compare(times, times).verdict, ProfileVerdict::NoDifference);
    EXPECT_EQ(compare(times, {1.01, 1.011, 1.009, 1.01}).verdict, ProfileVerdict::NoDifference)
        << "within the tolerance";
    EXPECT_EQ(compare(times, {0.9, 1.4, 1.1, 1.0}).verdict, ProfileVerdict::NoDifference) << "noise";
    EXPECT_EQ(compare({1.0, 1.0}, {2.0, 2.0}).verdict, ProfileVerdict::Slower) << "without any noise";
}

TEST(ProfileComparison, RegressionNeedsOneSlowerRun) {
    const ProfileComparison same = compare_profiles(made_up_profile(), made_up_profile());
    EXPECT_EQ(same.runs.size(), 2u);
    EXPECT_FALSE(same.has_regression());
    ProfileReport slower = made_up_profile();
    for (double& seconds : slower.runs[1].cpu_seconds) seconds *= 1.5;
    EXPECT_TRUE(compare_profiles(made_up_profile(), slower).has_regression());
    EXPECT_EQ(compare_profiles(made_up_profile(), slower).slower_runs(),
              (std::vector<std::string>{"path on 2 threads"}));
    EXPECT_FALSE(compare_profiles(made_up_profile(), slower, {.tolerance = 1.0}).has_regression());
    EXPECT_FALSE(compare_profiles(slower, made_up_profile()).has_regression());
}

TEST(ProfileComparison, OneRepetitionSaysNothing) {
    for (const ComparedRun& run :
         {compare({1.0, 1.0}, {2.0}), compare({1.0, 1.0}, {}), compare({1.0, 1.0}, {0.0, 0.0})}) {
        EXPECT_EQ(run.verdict, ProfileVerdict::NotKnown);
    }
    for (const std::vector<double>& before : {std::vector<double>{}, {1.0}})
        EXPECT_EQ(refusal_to_compare(with_times(before), with_times({})),
                  "the baseline has one repetition of each run, of which nothing can be concluded");
    EXPECT_EQ(refusal_to_compare(with_times({1.0, 1.0}), with_times({})), "") << "those of now are still to come";
}

TEST(ProfileComparison, ComparesPerSample) {
    ProfileReport longer = with_times({2.0, 2.001, 1.999});
    longer.runs[0].samples = 2000;
    longer.runs[0].spp = 32;
    const ProfileComparison comparison = compare_profiles(with_times({1.0, 1.001, 0.999}), longer);
    EXPECT_NEAR(comparison.runs.at(0).ratio, 1.0, 1e-3);
    EXPECT_FALSE(comparison.notes.empty());
}

TEST(ProfileComparison, RefusesOtherWork) {
    const auto refusal = [](const auto& change) {
        ProfileReport before = made_up_profile();
        change(before);
        const ProfileComparison comparison = compare_profiles(before, made_up_profile());
        EXPECT_TRUE(comparison.refusal.empty() || !comparison.has_regression());
        return comparison.refusal;
    };
    EXPECT_EQ(refusal([](ProfileReport&) {}), "");
    EXPECT_EQ(refusal([](ProfileReport& r) { r.scene = "ball"; }), "the baseline is of the scene 'ball', not of 'box'");
    EXPECT_EQ(refusal([](ProfileReport& r) { r.height = 31; }), "the baseline has 64 x 31 pixels, not 64 x 32");
    EXPECT_EQ(refusal([](ProfileReport& r) { r.max_depth = 8; }), "paths of the baseline have up to 8 edges, not 12");
    EXPECT_EQ(refusal([](ProfileReport& r) { r.settings["sampler"] = "random"; }),
              "the setting 'sampler' differs: 'random' in the baseline, 'sobol' now");
    EXPECT_EQ(refusal([](ProfileReport& r) { r.settings["crop"] = "0 0 8 8"; }),
              "the setting 'crop' differs: '0 0 8 8' in the baseline, none now");
    EXPECT_EQ(refusal([](ProfileReport& r) { r.settings.erase("film"); }),
              "the setting 'film' differs: none in the baseline, 'film: filter box' now");
    EXPECT_NE(refusal([](ProfileReport& r) { r.bvh.instanced_triangles = 1; }), "");
    EXPECT_NE(refusal([](ProfileReport& r) { r.runs.clear(); }), "");
    EXPECT_NE(refusal([](ProfileReport& r) { r.runs[0].integrator = r.runs[1].integrator = "bdpt"; }), "");
}

TEST(ProfileComparison, NotesWhatElseDiffers) {
    ProfileReport before = made_up_profile();
    before.processor = "another one";
    before.seed = 8;
    before.runs.pop_back();
    const ProfileComparison comparison = compare_profiles(before, made_up_profile());
    ASSERT_EQ(comparison.notes.size(), 3u);
    EXPECT_EQ(comparison.notes[0], "another seed: '8' before, '7' now");
    EXPECT_EQ(comparison.notes[1], "another processor: 'another one' before, 'made up' now");
    EXPECT_EQ(comparison.notes[2], "path on 2 threads is not in the baseline");
}

TEST(ProfileComparison, FiguresComeWithoutAVerdict) {
    ProfileReport now = made_up_profile();
    now.runs[0].kinds[0].seconds = 0.25;
    now.peak_memory_bytes *= 2;
    const ProfileComparison comparison = compare_profiles(made_up_profile(), now);
    EXPECT_EQ(comparison.runs[0].rays_per_second[0].name, "camera");
    EXPECT_EQ(comparison.runs[0].rays_per_second[0].before, 2000.0);
    EXPECT_EQ(comparison.runs[0].rays_per_second[0].now, 4000.0);
    EXPECT_EQ(comparison.figures.back().name, "peak memory");
    EXPECT_EQ(comparison.figures.back().now, 2.0 * comparison.figures.back().before);
    EXPECT_FALSE(comparison.has_regression());
}

TEST(ProfileComparison, IsWrittenDown) {
    ProfileReport now = made_up_profile();
    for (double& seconds : now.runs[1].cpu_seconds) seconds *= 1.5;
    now.against = compare_profiles(made_up_profile(), now);
    const Json json = Json::parse(to_json(*now.against));
    EXPECT_EQ(json["regression"], true);
    EXPECT_EQ(json["runs"][1]["verdict"], "slower");
    EXPECT_NEAR(json["runs"][1]["ratio"].get<double>(), 1.5, 1e-12);
    EXPECT_EQ(json["runs"][0]["repetitions"]["before"], 3);
    EXPECT_EQ(json["figures"][3]["unit"], "bytes");
    EXPECT_EQ(Json::parse(to_json(now))["against"], json);
    const std::string table = to_table(*now.against);
    EXPECT_NE(table.find("slower"), std::string::npos) << table;
    EXPECT_NE(table.find("1.50"), std::string::npos) << table;
    ProfileReport other = made_up_profile();
    other.scene = "ball";
    EXPECT_NE(to_table(compare_profiles(other, now)).find("cannot be compared"), std::string::npos);
}

/// How often, of `trials`, a program that takes `ratio` times as long is called slower; the repetitions vary by
/// `deviations`, in logarithms, before and now.
double share_called_slower(double ratio, double tolerance, std::pair<int, int> repetitions,
                           std::pair<double, double> deviations, int trials) {
    std::mt19937_64 random(20261122);
    std::normal_distribution<double> normal;
    const auto times = [&](int count, double mean, double deviation) {
        std::vector<double> seconds(static_cast<std::size_t>(count));
        for (double& second : seconds) second = mean * std::exp(deviation * normal(random));
        return with_times(std::move(seconds));
    };
    int slower = 0;
    for (int trial = 0; trial < trials; ++trial) {
        const ProfileReport before = times(repetitions.first, 1.0, deviations.first);
        const ProfileReport now = times(repetitions.second, ratio, deviations.second);
        if (compare_profiles(before, now, {.tolerance = tolerance}).has_regression()) ++slower;
    }
    return static_cast<double>(slower) / trials;
}

constexpr int kTrials = 20000;
/// Four standard deviations of a share of 0.025 among so many trials: exceeded by chance in 1 of 30,000.
const double kChance = 4.0 * std::sqrt(0.025 * 0.975 / kTrials);

// Welch's interval is exact for many repetitions. Of few with equal variances it is too wide, and too narrow where the
// side with fewer varies more.
TEST(ProfileComparison, CallsNoMoreThanOneInTwentyFiveSlowerThatIsNot) {
    EXPECT_NEAR(share_called_slower(1.0, 0.0, {30, 30}, {0.01, 0.02}, kTrials), 0.025, kChance);
    for (const auto& [repetitions, deviations] :
         {std::pair{std::pair{5, 5}, std::pair{0.01, 0.01}}, std::pair{std::pair{3, 3}, std::pair{0.01, 0.01}},
          std::pair{std::pair{3, 3}, std::pair{0.01, 0.03}}, std::pair{std::pair{3, 10}, std::pair{0.03, 0.01}},
          std::pair{std::pair{10, 3}, std::pair{0.01, 0.03}}}) {
        const double share = share_called_slower(1.0, 0.0, repetitions, deviations, kTrials);
        RecordProperty(fmt::format("{}_{}_{}_{}", repetitions.first, repetitions.second,
                                   std::lround(1e3 * deviations.first), std::lround(1e3 * deviations.second)),
                       fmt::format("{:.4f}", share));
        EXPECT_LT(share, 0.04) << repetitions.first << " and " << repetitions.second << " repetitions";
    }
    EXPECT_LT(share_called_slower(1.02, 0.02, {5, 5}, {0.01, 0.01}, kTrials), 0.025 + kChance) << "at the tolerance";
    EXPECT_LT(share_called_slower(1.0, 0.02, {5, 5}, {0.01, 0.01}, kTrials), 0.001) << "far from it";
}

TEST(ProfileComparison, SeesWhatIsATenthSlower) {
    EXPECT_GT(share_called_slower(1.1, 0.02, {5, 5}, {0.01, 0.01}, 2000), 0.999);
}

TEST(ParseProfile, ReadsWhatWasWritten) {
    const ProfileReport report = made_up_profile();
    const ProfileBaseline baseline = parse_profile(to_json(report));
    EXPECT_EQ(baseline.scene, "box");
    EXPECT_EQ(baseline.created, report.created);
    EXPECT_EQ(baseline.peak_memory_bytes, report.peak_memory_bytes);
    EXPECT_EQ(baseline.seed, 7u);
    EXPECT_EQ(baseline.settings, report.settings);
    EXPECT_EQ(baseline.runs.at(1).cpu_seconds, report.runs[1].cpu_seconds);
    const ProfileComparison comparison = compare_profiles(baseline, report);
    EXPECT_EQ(comparison.refusal, "");
    EXPECT_TRUE(comparison.notes.empty());
    for (const ComparedFigure& figure : comparison.figures) EXPECT_EQ(figure.before, figure.now) << figure.name;
    EXPECT_EQ(to_json(comparison), to_json(compare_profiles(report, report)));
}

/// The place and the message of the error that the profile gives with `value` put at `pointer`.
std::string error_with(const std::string& pointer, const Json& value) {
    Json json = Json::parse(to_json(made_up_profile()));
    json[Json::json_pointer(pointer)] = value;
    try {
        (void)parse_profile(json.dump(-1, ' ', false, Json::error_handler_t::replace), "old.json");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "none";
}

TEST(ParseProfile, SaysWhatIsWrong) {
    const auto expect = [](const std::string& pointer, const Json& value, const std::string& message) {
        const std::string error = error_with(pointer, value);
        EXPECT_NE(error.find("old.json#" + pointer), std::string::npos) << error;
        EXPECT_NE(error.find(message), std::string::npos) << error;
    };
    expect("/format", 1, "another version");
    expect("/scene/seed", std::uint64_t{1} << 32, "is not in");
    expect("/scene/settings", "none", "must be an object");
    expect("/scene/settings", {{"film", 1}}, "must be an object of texts");
    expect("/scene/settings", {{"film", "a\x1b[31m"}}, "control characters");
    expect("/scene/settings", {{"\x1b[31m", "film"}}, "control characters");
    expect("/scene/width", -1, "whole number");
    expect("/scene/width", 0, "[1, ");
    expect("/scene/height", 1e300, "whole number");
    expect("/scene/name", "a\x1b[31m", "control characters");
    expect("/scene/name", std::string(2000, 'x'), "longer than");
    expect("/scene/name", Json::array(), "must be a text");
    expect("/runs", "none", "must be an array");
    expect("/runs/0/cpu_seconds/1", -1.0, "is not in");
    expect("/runs/0/cpu_seconds/1", 0.0, "is not in");
    expect("/runs/0/cpu_seconds/1", nullptr, "must be a number");
    expect("/runs/1/samples", 0, "is not in");
    expect("/runs/1/threads", std::uint64_t{1} << 40, "is not in");
    expect("/runs/1/kinds/0/rays", 1.5, "whole number");
    EXPECT_EQ(error_with("/load/first_pixel_seconds", nullptr), "none") << "it may not be known";
    EXPECT_EQ(error_with("/more", 1), "none") << "keys may be added";
}

TEST(ParseProfile, TakesNothingForAProfileThatIsNone) {
    for (const std::string& text :
         {std::string(), std::string("{"), std::string("[]"), std::string("null"), std::string("{\"format\": 1}"),
          std::string("\xff\xfe"), std::string(1000000, '['), std::string("{\"format\": 1e999}")})
        EXPECT_THROW((void)parse_profile(text), SceneError) << text.substr(0, 20);
}

TEST(ParseProfile, NoCutOffProfileIsRead) {
    ProfileReport report = made_up_profile();
    report.runs.resize(1);
    const std::string text = to_json(report);
    for (std::size_t length = 0; length + 2 < text.size(); length += 7)
        EXPECT_THROW((void)parse_profile(text.substr(0, length)), SceneError) << length;
}

}  // namespace

}  // namespace etendue
