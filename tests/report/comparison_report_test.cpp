#include "report/comparison_report.h"

#include "report/comparison_files.h"
#include "support/page_script.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;

/// A report with something in every part.
ComparisonReport small_comparison() {
    ComparisonReport report;
    report.scene = "box";
    report.width = 40;
    report.height = 30;
    report.crop = PixelRect{1, 2, 21, 22};
    report.seconds = 2.0;
    report.seeds = 3;
    report.reference = {.kind = "pooled", .text = "Pooled.", .weights = {{"bdpt", 0.9}, {"path", 0.1}}};
    report.metrics.push_back({"relmse", "relMSE", "mean (v - r)^2"});
    report.maps["z/path/bdpt"] = {0.0, 4.5};
    VariantReport path{.name = "path", .options = "--integrator path", .seeds = {4, 6, 8}, .spp = 7};
    path.seconds.values = {1.0, 2.0, 3.0};
    path.errors["relmse"].values = {0.5, 0.25, 0.75};
    path.convergence.push_back({.spp = 1, .seconds = {{0.4, 0.6}}, .errors = {{"relmse", {{2.0, 4.0, 6.0}}}}});
    path.slopes["relmse"] = {.spp = -1.0};
    report.variants = {path, {.name = "bdpt"}};
    PairReport pair{.a = "path", .b = "bdpt", .ratios = {{"relmse", {12.0, 10.0, 14.4}}}};
    pair.a_reaches_b = ReachedError{30.0, true};
    pair.agreement =
        BlockAgreement{.blocks_agree = true, .means_agree = false, .p_value = 0.3, .tests = 9, .worst = {}};
    report.pairs.push_back(pair);
    report.regions.push_back({.name = "caustic", .pixels = {3, 4, 5, 6}, .variants = {{.name = "path"}}});
    report.strategies =
        StrategiesReport{.variant = "bdpt", .spp = 8, .longest = 3, .strategies = {{1, 2}, {2, 1}, {0, 4}}};
    return report;
}

TEST(SeedValues, AreSummedUp) {
    const SeedValues values{{1.0, 2.0, 6.0}};
    EXPECT_EQ(values.mean(), 3.0);
    EXPECT_DOUBLE_EQ(values.deviation(), std::sqrt(7.0));
    EXPECT_EQ(values.least(), 1.0);
    EXPECT_EQ(values.largest(), 6.0);
    EXPECT_TRUE(std::isnan(SeedValues{{1.0}}.deviation()));
    EXPECT_TRUE(std::isnan(SeedValues{}.mean()));
}

TEST(ComparisonJson, HoldsWhatWasMeasured) {
    const Json json = Json::parse(to_json(small_comparison()));
    EXPECT_EQ(json["format"], 4);
    EXPECT_EQ(json["scene"]["crop"], Json({1, 2, 21, 22}));
    EXPECT_EQ(json["settings"]["seconds"], 2.0);
    EXPECT_TRUE(json["settings"]["spp"].is_null());
    EXPECT_EQ(json["reference"]["weights"]["bdpt"], 0.9);
    EXPECT_EQ(json["maps"]["z/path/bdpt"]["high"], 4.5);
    const Json& path = json["variants"][0];
    EXPECT_EQ(path["seconds"]["mean"], 2.0);
    EXPECT_EQ(path["seeds"], Json({4, 6, 8}));
    EXPECT_TRUE(path["command_note"].is_null());
    EXPECT_EQ(path["errors"]["relmse"]["deviation"], 0.25);
    EXPECT_EQ(path["errors"]["relmse"]["values"].size(), 3u);
    EXPECT_EQ(path["convergence"][0]["errors"]["relmse"]["max"], 6.0);
    const Json& pair = json["pairs"][0];
    EXPECT_EQ(pair["time_to_reach"]["a_reaches_b"]["extrapolated"], true);
    EXPECT_TRUE(pair["time_to_reach"]["b_reaches_a"].is_null());
    EXPECT_EQ(pair["agreement"]["agree"], false);
    EXPECT_TRUE(pair["different_light"].is_null());
    EXPECT_EQ(json["regions"][0]["x0"], 3);
    EXPECT_EQ(json["strategies"]["rows"].size(), 2u) << "a row for each length of path";
    EXPECT_EQ(json["strategies"]["rows"][0]["images"][1]["s"], 2);
}

TEST(ComparisonJson, WhatIsNotKnownIsNull) {
    ComparisonReport report = small_comparison();
    report.variants[0].efficiency = std::numeric_limits<double>::infinity();
    report.variants[0].errors["relmse"].values = {std::nan("")};
    report.strategies.reset();
    const Json json = Json::parse(to_json(report));
    EXPECT_TRUE(json["variants"][0]["efficiency"].is_null());
    EXPECT_TRUE(json["variants"][0]["errors"]["relmse"]["mean"].is_null());
    EXPECT_TRUE(json["variants"][0]["slopes"]["relmse"]["seconds"].is_null());
    EXPECT_FALSE(json.contains("strategies"));
    EXPECT_TRUE(json["variants"][1]["errors"].empty());
}

TEST(ComparisonReport, OnlyComparableImagesCanDisagree) {
    ComparisonReport report = small_comparison();
    EXPECT_FALSE(report.agrees());
    report.pairs[0].comparable = false;
    EXPECT_TRUE(report.agrees());
    report.pairs[0].comparable = true;
    report.pairs[0].agreement->means_agree = true;
    EXPECT_TRUE(report.agrees());
    report.pairs[0].agreement.reset();
    EXPECT_TRUE(report.agrees()) << "not tested";
}

TEST(ComparisonPlots, CutLongNamesBetweenCharacters) {
    ComparisonReport report = small_comparison();
    report.variants[0].name = "24 letters, then Greek: αβγδεζ";
    std::string text;
    for (const NamedPlot& plot : convergence_plots(report)) text += to_svg(plot.plot);
    EXPECT_NE(text.find("24 letters, then Greek: ..."), std::string::npos) << text;
}

TEST(ComparisonTables, CommandsStayWithinTheirComment) {
    ComparisonReport report = small_comparison();
    report.command = "etendue compare 'a\n\\input{b}'";
    EXPECT_EQ(to_tex(report).find("\n\\input"), std::string::npos);
}

TEST(ComparisonPage, HoldsTheReportAndItsImages) {
    ComparisonReport report = small_comparison();
    report.variants[0].name = "</script><b>@IMAGES@ \"quoted\"";
    const std::string page = make_page(report, {{"image/a", {0, 1, 2, 255}}, {"image/b", {0xfb, 0xff}}});
    EXPECT_EQ(Json::parse(test::page_script(page, "report")), Json::parse(to_json(report)));
    const Json images = Json::parse(test::page_script(page, "images"));
    EXPECT_EQ(images["image/a"], "data:image/png;base64,AAEC/w==");
    EXPECT_EQ(images["image/b"], "data:image/png;base64,+/8=");
    EXPECT_EQ(page.find("@REPORT@"), std::string::npos);
}

}  // namespace

}  // namespace etendue
