#include "report/batch_report.h"

#include "support/page_script.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;
using Files = std::vector<std::vector<unsigned char>>;

BatchUnit rendered(const std::string& name) {
    BatchUnit unit;
    unit.name = name;
    unit.image = name + ".exr";
    unit.preview = name + ".png";
    unit.outcome = UnitOutcome::Rendered;
    unit.seconds = UnitSeconds{1.0, 2.0, 30.0, 0.5};
    unit.rays = 100;
    unit.peak_memory_bytes = 4096;
    return unit;
}

BatchUnit with_outcome(BatchUnit unit, UnitOutcome outcome) {
    unit.outcome = outcome;
    return unit;
}

BatchReport small_report() {
    BatchReport report;
    report.title = "out";
    report.started = "2026-11-22T08:00:00Z";
    report.units = {rendered("a"), rendered("b.0001"), with_outcome(rendered("c"), UnitOutcome::UpToDate),
                    with_outcome({.name = "d"}, UnitOutcome::Failed)};
    report.units[1].frame = 1;
    report.units[1].peak_memory_bytes = 8192;
    report.units[3].error = "no such file";
    report.units[3].log = {"one", "two"};
    return report;
}

Json script(const std::string& page, const std::string& id) {
    return Json::parse(test::page_script(page, id));
}

TEST(BatchTotals, CountOutcomesAndSumUpWhatThisBatchRendered) {
    const BatchTotals sum = totals(small_report());
    EXPECT_EQ(sum.units, 4u);
    EXPECT_EQ(sum.rendered, 2u);
    EXPECT_EQ(sum.up_to_date, 1u);
    EXPECT_EQ(sum.failed, 1u);
    EXPECT_EQ(sum.seconds.render, 60.0);
    EXPECT_EQ(sum.seconds.total(), 67.0);
    EXPECT_EQ(sum.rays, 200u);
    EXPECT_EQ(sum.peak_memory_bytes, 8192u);
}

TEST(BatchTotals, LeaveOutWhatWasRenderedBefore) {
    BatchReport report = small_report();
    report.units[0].seconds_before = 20.0;
    report.units[0].rays_before = 60;
    report.units[1].seconds_before = 31.0;
    const BatchTotals sum = totals(report);
    EXPECT_EQ(sum.seconds.render, 10.0) << "and never less than nothing";
    EXPECT_EQ(sum.rays, 140u);
}

TEST(BatchTotals, CountWarningsWhatWasNotTriedAndTheTimeOfDenoising) {
    BatchReport report = small_report();
    report.units[0].seconds->denoise = 4.0;
    report.units[2].seconds->denoise = 8.0;
    report.units[2].warnings = {"warning: one", "warning: two"};
    report.units.push_back({.name = "e", .error = std::string(kNotTried)});
    report.units.push_back({.name = "f"});
    const BatchTotals sum = totals(report);
    EXPECT_EQ(sum.seconds.denoise, 4.0) << "the other one was made before";
    EXPECT_EQ(sum.seconds.total(), 71.0);
    EXPECT_EQ(sum.with_warnings, 1u);
    EXPECT_EQ(sum.not_started, 2u);
    EXPECT_EQ(sum.not_tried, 1u);
    const Json json = Json::parse(to_json(report));
    EXPECT_EQ(json["totals"]["with_warnings"], 1);
    EXPECT_EQ(json["totals"]["not_tried"], 1);
    EXPECT_EQ(json["units"][0]["seconds"]["denoise"], 4.0);
    EXPECT_EQ(json["units"][2]["warnings"], Json({"warning: one", "warning: two"}));
}

TEST(BatchTotals, EveryOutcomeHasItsCount) {
    BatchReport report;
    for (const UnitOutcome outcome :
         {UnitOutcome::Rendered, UnitOutcome::UpToDate, UnitOutcome::Failed, UnitOutcome::Interrupted,
          UnitOutcome::Running, UnitOutcome::RunningElsewhere, UnitOutcome::NotStarted})
        report.units.push_back(with_outcome({}, outcome));
    const Json sums = Json::parse(to_json(report))["totals"];
    for (const char* outcome :
         {"rendered", "up_to_date", "failed", "interrupted", "running", "running_elsewhere", "not_started"})
        EXPECT_EQ(sums[outcome], 1) << outcome;
}

TEST(BatchJson, HoldsWhatIsKnown) {
    const Json json = Json::parse(to_json(small_report()));
    EXPECT_EQ(json["format"], 1);
    EXPECT_EQ(json["title"], "out");
    EXPECT_TRUE(json["ended"].is_null()) << "under way";
    EXPECT_EQ(json["state"], "planning");
    EXPECT_EQ(json["units"].size(), 4u);
    const Json& frame = json["units"][1];
    EXPECT_EQ(frame["frame"], 1);
    EXPECT_EQ(frame["outcome"], "rendered");
    EXPECT_EQ(frame["seconds"]["total"], 33.5);
    const Json& failed = json["units"][3];
    EXPECT_EQ(failed["outcome"], "failed");
    EXPECT_EQ(failed["error"], "no such file");
    EXPECT_EQ(failed["log"], Json({"one", "two"}));
    EXPECT_EQ(failed["warnings"], Json::array());
    EXPECT_TRUE(failed.at("relative_error").is_null());
    EXPECT_TRUE(failed.at("relative_error_requested").is_null());
    for (const char* key : {"frame", "variant", "camera", "fraction", "seconds_left", "spp_requested", "reason",
                            "signal", "host", "width", "height", "spp", "integrator", "halt_reason", "seconds",
                            "estimated_seconds", "rays", "rays_per_second", "peak_memory_bytes"})
        EXPECT_TRUE(failed.contains(key) && failed[key].is_null()) << key;
}

TEST(BatchJson, TakesAnyBytes) {
    BatchReport report = small_report();
    report.units[0].name = "\xff</script>";
    EXPECT_EQ(Json::parse(to_json(report))["units"][0]["name"], "\xef\xbf\xbd</script>");
}

TEST(BatchPage, HoldsTheReportAndItsThumbnails) {
    BatchReport report = small_report();
    report.units[0].name = "</script>@IMAGES@\"";
    const std::string page = make_batch_page(report, {.files{{0xff, 0xd8}, {0x89, 0x50}, {}, {}}, .note = "coarse"});
    EXPECT_EQ(script(page, "report"), Json::parse(to_json(report)));
    const Json images = script(page, "thumbnails");
    EXPECT_EQ(images["note"], "coarse");
    EXPECT_EQ(images["units"][0]["thumbnail"], "data:image/jpeg;base64,/9g=");
    EXPECT_EQ(images["units"][1]["thumbnail"], "data:image/png;base64,iVA=");
    EXPECT_FALSE(images["units"][2].contains("thumbnail"));
    EXPECT_EQ(page.find("@SCRIPT@"), std::string::npos);
    EXPECT_EQ(page.find("@STYLE@"), std::string::npos);
}

TEST(BatchPage, LinksLeadToTheImagesBesideIt) {
    BatchReport report = small_report();
    report.units[0].preview = "javascript:a/\"x\" <y>?#%\xff.png";
    report.units[2].preview.clear();
    const Json units = script(make_batch_page(report, {.files = Files(4)}), "thumbnails")["units"];
    EXPECT_EQ(units[0]["link"], "./javascript%3Aa/%22x%22%20%3Cy%3E%3F%23%25%FF.png");
    EXPECT_EQ(units[1]["link"], "./b.0001.png");
    EXPECT_FALSE(units[2].contains("link")) << "there is no PNG";
    EXPECT_FALSE(units[3].contains("link")) << "what failed has no image";
}

TEST(BatchPage, TakesOneThumbnailForEachUnit) {
    EXPECT_THROW((void)make_batch_page(small_report(), {.files = Files(3)}), std::invalid_argument);
}

}  // namespace

}  // namespace etendue
