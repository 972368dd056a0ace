#include "batch/batch_page.h"

#include "batch/batch_table.h"
#include "core/error.h"
#include "image/write.h"
#include "program/small_files.h"

#include <chrono>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;
using test::TestFolder;

/// What no encoder makes small.
ImageF noise(int width, int height) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> values;
    ImageF image(width, height, 3);
    for (float& value : image.pixels) value = values(random);
    return image;
}

BatchReport report_of(const std::vector<std::string>& names) {
    BatchReport report;
    report.title = "out";
    for (const std::string& name : names) {
        BatchUnit unit;
        unit.name = name;
        unit.image = name + ".exr";
        unit.preview = name + ".png";
        unit.outcome = UnitOutcome::Rendered;
        report.units.push_back(unit);
    }
    return report;
}

TEST(BatchTable, CountsWhatWasNotStarted) {
    BatchReport report = report_of({"a", "b"});
    report.units[1].outcome = UnitOutcome::NotStarted;
    EXPECT_NE(to_table(report, "out").find("\n1 image was not started\n"), std::string::npos);
    report.units[0].outcome = UnitOutcome::NotStarted;
    EXPECT_NE(to_table(report, "out").find("\n2 images were not started\n"), std::string::npos);
    report.units[0].error = kNotTried;
    EXPECT_NE(to_table(report, "out")
                  .find("\n1 image was not tried, as its scene failed\n1 image was not started\n"
                        "0 rendered in 0.0 s; out/index.html\n"),
              std::string::npos)
        << to_table(report, "out");
}

TEST(BatchTable, SumsUp) {
    BatchReport report = report_of({"a", "b", "c"});
    report.units[1].warnings = {"warning: one", "warning: two"};
    report.units[2].outcome = UnitOutcome::Failed;
    report.seconds = 142.0;
    const std::string table = to_table(report, "out");
    EXPECT_NE(table.find("\n2 rendered, 1 failed in 2:22; 1 with warnings; out/index.html\n"), std::string::npos)
        << table;
}

TEST(BatchTable, HasAColumnForErrorsThatWereAskedFor) {
    BatchReport report = report_of({"a", "b"});
    EXPECT_EQ(to_table(report, "out").find("error"), std::string::npos);
    report.units[1].relative_error = 0.0341234;
    report.units[1].relative_error_requested = 0.01;
    const std::string table = to_table(report, "out");
    EXPECT_NE(table.find("  0.0341/0.01  out/b.exr\n"), std::string::npos) << table;
    EXPECT_NE(table.find("  -  out/a.exr\n"), std::string::npos) << table;
}

Json images_of(const std::filesystem::path& page) {
    const std::string text = test::read_file(page);
    const std::size_t begin = text.find('>', text.find("id=\"thumbnails\" type")) + 1;
    return Json::parse(text.substr(begin, text.find("</script>", begin) - begin));
}

TEST(BatchReportFiles, HoldThumbnailsOfTheImages) {
    const TestFolder folder;
    write_image(folder / "large.png", noise(900, 500), {.depth = PixelDepth::UInt8});
    write_image(folder / "tall.png", noise(40, 2000), {.depth = PixelDepth::UInt8});
    BatchPageWriter(folder.path()).write(report_of({"large", "tall"}));
    EXPECT_EQ(Json::parse(test::read_file(folder / "report.json"))["units"].size(), 2u);
    const Json images = images_of(folder / "index.html");
    for (const Json& unit : images["units"]) {
        const auto url = unit.at("thumbnail").get<std::string>();
        EXPECT_TRUE(url.starts_with("data:image/jpeg;base64,"));
        EXPECT_LT(url.size(), 20'000u * 4 / 3 + 40);
        EXPECT_GT(url.size(), 1'000u);
    }
    EXPECT_EQ(images["note"], "");
}

TEST(BatchReportFiles, ImagesThatCannotBeReadLeaveAnEmptyPlace) {
    const TestFolder folder;
    write_image(folder / "whole.png", noise(30, 30), {.depth = PixelDepth::UInt8});
    test::write_file(folder / "broken.png", "\x89PNG\r\n\x1a\n and no more");
    BatchPageWriter(folder.path()).write(report_of({"missing", "broken", "whole"}));
    const Json units = images_of(folder / "index.html")["units"];
    EXPECT_FALSE(units[0].contains("thumbnail"));
    EXPECT_FALSE(units[1].contains("thumbnail"));
    EXPECT_TRUE(units[2].contains("thumbnail"));
}

TEST(BatchReportFiles, WhatFailedShowsNoOlderImage) {
    const TestFolder folder;
    write_image(folder / "old.png", noise(30, 30), {.depth = PixelDepth::UInt8});
    BatchReport report = report_of({"old"});
    report.units[0].outcome = UnitOutcome::Failed;
    BatchPageWriter(folder.path()).write(report);
    EXPECT_TRUE(images_of(folder / "index.html")["units"][0].empty());
}

TEST(BatchReportFiles, TooManyImagesHaveNoThumbnailsAndThePageSaysSo) {
    const TestFolder folder;
    BatchPageWriter(folder.path()).write(report_of(std::vector<std::string>(30'000, "missing")));
    const Json images = images_of(folder / "index.html");
    EXPECT_NE(images["note"].get<std::string>().find("too many"), std::string::npos);
}

TEST(BatchReportFiles, MakeAThumbnailAnewOnlyOfAnImageThatHasChanged) {
    const TestFolder folder;
    write_image(folder / "a.png", noise(30, 30), {.depth = PixelDepth::UInt8});
    BatchPageWriter writer(folder.path());
    const auto thumbnail = [&] {
        writer.write(report_of({"a"}));
        return images_of(folder / "index.html")["units"][0].value("thumbnail", "");
    };
    const std::string first = thumbnail();
    const auto time = std::filesystem::last_write_time(folder / "a.png");
    test::write_file(folder / "a.png", "broken");
    std::filesystem::last_write_time(folder / "a.png", time);
    EXPECT_EQ(thumbnail(), first) << "it was not looked at again";
    std::filesystem::last_write_time(folder / "a.png", time + std::chrono::seconds(1));
    EXPECT_EQ(thumbnail(), "");
}

TEST(BatchReportFiles, AreNotWrittenWhereTheyCannotBe) {
    const TestFolder folder;
    EXPECT_THROW(BatchPageWriter(folder / "missing").write(report_of({})), IoError);
}

}  // namespace

}  // namespace etendue
