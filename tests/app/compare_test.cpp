// etendue compare from outside: what it measures of small scenes, and how it says what is wrong.
#include "app/run_program.h"
#include "app/small_files.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Names = std::vector<std::string>;

class Compare : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(work_);
        write_scene(folder_ / "box");
    }
    [[nodiscard]] ProgramResult compare(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"compare", (folder_ / "box").string(), "-o", "report", "--quiet"});
        return run_etendue(arguments, work_);
    }
    [[nodiscard]] json report() const { return json::parse(read_file(work_ / "report/report.json")); }

    TestFolder folder_;
    fs::path work_ = folder_ / "work";
};

TEST_F(Compare, MeasuresVariantsAgainstEachOther) {
    const ProgramResult result =
        compare({"--spp", "8", "--seeds", "3", "--strategies-depth", "2", "--region", "corner: a:0,0,4,3"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(result.out.empty()) << result.out;
    EXPECT_EQ(list(work_ / "report"), (Names{"index.html", "report.json"})) << "and nothing else";
    const json report = this->report();
    EXPECT_EQ(report["settings"]["spp"], 8);
    EXPECT_TRUE(report["settings"]["seconds"].is_null());
    EXPECT_EQ(report["reference"]["kind"], "pooled");
    EXPECT_NEAR(
        report["reference"]["weights"]["path"].get<double>() + report["reference"]["weights"]["bdpt"].get<double>(),
        1.0, 1e-9);
    ASSERT_EQ(report["variants"].size(), 2u);
    for (const json& variant : report["variants"]) {
        EXPECT_EQ(variant["spp"], 8);
        EXPECT_EQ(variant["errors"]["relmse"]["values"].size(), 3u);
        EXPECT_GT(variant["errors"]["relmse"]["mean"], 0.0);
        EXPECT_GT(variant["errors"]["flip"]["mean"], 0.0);
        std::vector<int> kept;
        for (const json& step : variant["convergence"]) kept.push_back(step["spp"]);
        EXPECT_EQ(kept, (std::vector<int>{1, 2, 3, 4, 6, 8}));
        EXPECT_LT(variant["slopes"]["relmse"]["spp"], -0.5);
    }
    ASSERT_EQ(report["pairs"].size(), 1u);
    EXPECT_EQ(report["pairs"][0]["agreement"]["agree"], true);
    EXPECT_TRUE(report["pairs"][0]["ratios"].contains("relmse_seconds"));
    EXPECT_EQ(report["regions"][0]["name"], "corner: a");
    EXPECT_EQ(report["strategies"]["rows"].size(), 2u);
    const std::string page = read_file(work_ / "report/index.html");
    for (const char* image : {"image/path", "image/bdpt", "reference", "error/relmse/bdpt", "error/flip/path",
                              "z/path/bdpt", "strategy/weighted/1,2", "strategy/unweighted/2,1"})
        EXPECT_NE(page.find(std::string("\"") + image + "\":"), std::string::npos) << image;
}

TEST_F(Compare, StrategiesThatAreLeftOutAreANote) {
    const ProgramResult result = compare({"--spp", "2", "--seeds", "1", "--min-depth", "3", "--strategies-depth", "2"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json report = this->report();
    EXPECT_FALSE(report.contains("strategies"));
    EXPECT_NE(report["notes"].dump().find("--min-depth"), std::string::npos) << report["notes"];
}

TEST_F(Compare, TheCommandsOfTheReportRenderItsImages) {
    ASSERT_EQ(
        compare({"--spp", "4", "--seeds", "3", "--seed", "5", "--size", "12x8", "--strategies-depth", "0"}).exit_code,
        0);
    const json report = this->report();
    const std::string command = report["variants"][1]["command"];
    for (const char* part : {"etendue render", "--integrator bdpt", "--spp '4'", "--seed '5'", "--size '12x8'"})
        EXPECT_NE(command.find(part), std::string::npos) << part << " in " << command;
    EXPECT_EQ(command.find("--seeds"), std::string::npos) << command;
    EXPECT_NE(report["command"].get<std::string>().find("--seeds '3'"), std::string::npos) << report["command"];
    EXPECT_FALSE(report.contains("strategies"));
}

TEST_F(Compare, TakesAnyTwoSettings) {
    ASSERT_EQ(compare({"--spp", "4", "--seeds", "3", "--integrator", "path", "--variant-a", "--max-depth 2",
                       "--variant-b", "--max-depth 2 --seed 9"})
                  .exit_code,
              0);
    const json report = this->report();
    EXPECT_EQ(report["variants"][0]["name"], "a: --max-depth 2");
    EXPECT_EQ(report["variants"][1]["options"], "--max-depth 2 --seed 9");
}

TEST_F(Compare, ImagesThatDifferAreFound) {
    const ProgramResult result = compare({"--spp", "64", "--seeds", "4", "--integrator", "path", "--variant-a",
                                          "--max-depth 1", "--variant-b", "--max-depth 2"});
    EXPECT_EQ(result.exit_code, 1);
    const json report = this->report();
    EXPECT_EQ(report["pairs"][0]["agreement"]["agree"], false);
    EXPECT_EQ(report["reference"]["kind"], "none");
    EXPECT_TRUE(report["variants"][0]["errors"].empty()) << "nothing to measure errors against";
    EXPECT_NE(report["notes"].dump().find("do not make the same image"), std::string::npos) << report["notes"];
}

TEST_F(Compare, MeasuresAgainstAFileOrAnotherIntegrator) {
    ASSERT_EQ(
        run_etendue({"render", (folder_ / "box").string(), "--spp", "64", "-o", "box.exr", "--float", "--quiet"}, work_)
            .exit_code,
        0);
    ASSERT_EQ(compare({"--spp", "2", "--seeds", "1", "--reference", "box.exr", "--integrators", "path"}).exit_code, 0);
    EXPECT_EQ(report()["reference"]["kind"], "file");
    EXPECT_GT(report()["variants"][0]["errors"]["relmse"]["mean"], 0.0);
    ASSERT_EQ(compare({"--spp", "2", "--seeds", "1", "--reference-integrator", "bdpt", "--reference-seconds", "0.1",
                       "--strategies-depth", "0"})
                  .exit_code,
              0);
    EXPECT_EQ(report()["reference"]["kind"], "integrator");
    EXPECT_NE(report()["notes"].dump().find("would not be seen"), std::string::npos)
        << "the reference is made by an algorithm under test";
}

TEST_F(Compare, TimesAreEqual) {
    ASSERT_EQ(compare({"--seconds", "0.4", "--seeds", "1", "--strategies-depth", "0"}).exit_code, 0);
    const json report = this->report();
    EXPECT_EQ(report["settings"]["seconds"], 0.4);
    // At least the time of a pass; on a machine with other work, more.
    for (const json& variant : report["variants"]) EXPECT_GT(variant["seconds"]["mean"], 0.2);
    EXPECT_EQ(report["reference"]["kind"], "none") << "one seed cannot be pooled";
}

TEST_F(Compare, SaysWhatIsWrong) {
    EXPECT_EQ(compare({"--spp", "1", "--seconds", "1"}).exit_code, 2);
    EXPECT_EQ(compare({"--time", "1"}).exit_code, 2);
    EXPECT_EQ(compare({"--integrators", "path,magic"}).exit_code, 2);
    EXPECT_EQ(compare({"--region", "0,0,1,1"}).exit_code, 2);
    EXPECT_EQ(compare({"--reference-seconds", "3"}).exit_code, 2);
    const ProgramResult option = compare({"--variant-a", "--max-dept 3", "--variant-b", ""});
    EXPECT_EQ(option.exit_code, 2);
    EXPECT_NE(option.err.find("--max-dept"), std::string::npos) << option.err;
    const ProgramResult size = compare({"--variant-a", "--size 8x8", "--variant-b", "--size 9x8"});
    EXPECT_EQ(size.exit_code, 3);
    EXPECT_NE(size.err.find("size"), std::string::npos) << size.err;
    const ProgramResult region = compare({"--region", "far:0,0,5000,10"});
    EXPECT_EQ(region.exit_code, 3);
    EXPECT_NE(region.err.find("--region: 'far'"), std::string::npos) << region.err;
    EXPECT_FALSE(fs::exists(work_ / "report/report.json"));
}

}  // namespace

}  // namespace etendue::test
