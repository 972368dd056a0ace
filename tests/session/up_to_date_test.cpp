#include "session/up_to_date.h"

#include "program/small_files.h"
#include "render/render.h"
#include "session/input_files.h"
#include "session/prepared_scene.h"

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;

class UpToDate : public testing::Test {
  protected:
    void SetUp() override {
        write_scene(folder_ / "box");
        write_file(output_.exr, "exr");
        write_file(output_.png, "png");
        write_report();
    }
    [[nodiscard]] RenderStatistics complete() const {
        const PreparedScene prepared = prepare_scene(scene_, overrides_);
        RenderStatistics statistics;
        statistics.settings_hash = settings_hash(prepared.scene, PixelDepth::Half);
        statistics.requested_settings = requested_settings(prepared.scene.settings);
        statistics.spp_requested = statistics.spp_done = prepared.scene.settings.spp;
        return statistics;
    }
    void write_report() { write_report(complete()); }
    void write_report(RenderStatistics statistics) {
        PreparedScene prepared = prepare_scene(scene_, overrides_);
        hash_inputs(prepared.scene, prepared.inputs);
        statistics.inputs = prepared.inputs;
        write_file(output_.json, to_json(statistics));
    }
    static void age(const fs::path& file, int seconds) {
        fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::seconds(seconds));
    }
    /// Why the image is to be rendered again; empty if it is not.
    [[nodiscard]] std::string reason(PixelDepth depth = PixelDepth::Half) const {
        if (const auto stale = why_unfinished(output_)) return stale->reason;
        if (const auto stale = why_outdated(output_, scene_)) return stale->reason;
        const PreparedScene prepared = prepare_scene(scene_, overrides_);
        EXPECT_EQ(is_up_to_date(output_, scene_, prepared.scene, depth), !why_outdated(output_, prepared.scene, depth));
        const auto stale = why_outdated(output_, prepared.scene, depth);
        return stale ? stale->reason : "";
    }

    /// Why the image is to be rendered again with other options than it was made with.
    [[nodiscard]] std::string reason_with(const std::vector<std::pair<std::string, std::string>>& options) {
        const SettingsOverrides before = overrides_;
        for (const auto& [option, value] : options) overrides_.give(option, value);
        std::string why = reason();
        overrides_ = before;
        return why;
    }

    TestFolder folder_;
    SettingsOverrides overrides_{};
    fs::path scene_ = folder_ / "box";
    fs::path bin_ = scene_ / "triangle.bin";
    OutputPaths output_ = OutputPaths::beside(folder_ / "image.exr");
};

TEST_F(UpToDate, WhenMadeOfTheSameFilesWithTheSameSettings) {
    EXPECT_EQ(reason(), "");
    EXPECT_EQ(reason(PixelDepth::Float), "settings changed");
    EXPECT_EQ(reason_with({{"--seed", "3"}}), "settings changed: seed: 0 -> 3");
}

/// The scene has 2 samples.
TEST_F(UpToDate, WhenWhatIsAskedWasReached) {
    EXPECT_EQ(reason_with({{"--time", "60"}}), "") << "it has all samples in any time";
    EXPECT_EQ(reason_with({{"--error", "0.01"}}), "") << "it has the most that every pixel may get";
    EXPECT_EQ(reason_with({{"--time", "60"}, {"--seed", "3"}}), "settings changed: seed: 0 -> 3; time: 0 -> 60");
    EXPECT_EQ(reason_with({{"--spp", "4"}}), "settings changed: spp: 2 -> 4");
    EXPECT_EQ(reason_with({{"--spp", "1"}}), "settings changed: spp: 2 -> 1");
}

TEST_F(UpToDate, WhenTheTimeLimitThatIsAskedWasReached) {
    overrides_.give("--spp", "1000");
    overrides_.give("--time", "60");
    RenderStatistics statistics = complete();
    statistics.spp_done = 300;
    statistics.render.wall = 57.0;
    statistics.halt_reason = halt_reason_name(HaltReason::TimeLimit);
    write_report(statistics);
    EXPECT_EQ(reason(), "");
    EXPECT_EQ(reason_with({{"--time", "59"}}), "") << "the next pass would have been too much";
    EXPECT_EQ(reason_with({{"--time", "30"}}), "") << "it was rendered for longer";
    EXPECT_EQ(reason_with({{"--time", "90"}}), "settings changed: time: 60 -> 90");
    EXPECT_EQ(reason_with({{"--time", "0"}}), "settings changed: time: 60 -> 0");
    EXPECT_EQ(reason_with({{"--spp", "300"}}), "") << "it has all of these";
    EXPECT_EQ(reason_with({{"--spp", "2000"}}), "") << "the time is over before";
    EXPECT_EQ(reason_with({{"--spp", "200"}}), "settings changed: spp: 1000 -> 200");
}

TEST_F(UpToDate, WhenTheErrorThatIsAskedWasReached) {
    overrides_.give("--spp", "1000");
    overrides_.give("--error", "0.02");
    RenderStatistics statistics = complete();
    statistics.spp_done = 48;
    statistics.adaptive = RenderStatistics::AdaptiveSpp{48, 120.0, 300};
    statistics.relative_error = 0.019;
    write_report(statistics);
    EXPECT_EQ(reason_with({{"--error", "0.03"}}), "");
    EXPECT_EQ(reason_with({{"--error", "0.01"}}), "settings changed: error: 0.02 -> 0.01");
    EXPECT_EQ(reason_with({{"--error", "0"}, {"--spp", "300"}}), "settings changed: spp: 1000 -> 300; error: 0.02 -> 0")
        << "not every pixel has these";
}

TEST_F(UpToDate, WithoutAPreviewIfNoneIsWanted) {
    fs::remove(output_.png);
    EXPECT_EQ(reason(), "image.png is missing");
    output_.png.clear();
    EXPECT_EQ(reason(), "");
}

TEST_F(UpToDate, NotWhenAnInputHasAnotherContentHoweverOldItIs) {
    const std::string content = read_file(bin_);
    std::string other = content;
    other.back() = static_cast<char>(other.back() ^ 1);
    for (const int seconds : {-100, 10, 100'000}) {
        write_file(bin_, other);
        age(bin_, seconds);
        EXPECT_EQ(reason(), "input triangle.bin has changed") << seconds;
        write_file(bin_, content);
        age(bin_, seconds);
        EXPECT_EQ(reason(), "") << "the same content at another time, " << seconds;
    }
    write_file(bin_, content + "x");
    EXPECT_EQ(reason(), "input triangle.bin has changed");
}

TEST_F(UpToDate, NotWhenAnInputChangedWhileItWasRead) {
    PreparedScene prepared = prepare_scene(scene_, {});
    const std::string content = read_file(bin_);
    write_file(bin_, content);
    age(bin_, 1);  // the same, but who knows what was there when it was read
    hash_inputs(prepared.scene, prepared.inputs);
    RenderStatistics statistics = complete();
    statistics.inputs = prepared.inputs;
    write_file(output_.json, to_json(statistics));
    EXPECT_EQ(reason(), "input triangle.bin changed while the image was made of it");
    for (const InputFile& file : stamp_inputs(prepared.scene, fs::file_time_type::min()))
        EXPECT_EQ(file.modified, InputFile::kChanged);
}

// Archives give files the time 1970, and clocks of other machines give them times of the future.
TEST_F(UpToDate, WithInputsOfTheYear1970OrOfTomorrow) {
    const fs::file_time_type now = fs::file_time_type::clock::now();
    const auto since_1970 = std::chrono::file_clock::to_sys(now).time_since_epoch();
    for (const fs::file_time_type time : {now - since_1970, now + std::chrono::hours(24)}) {
        fs::last_write_time(bin_, time);
        PreparedScene prepared = prepare_scene(scene_, {});
        hash_inputs(prepared.scene, prepared.inputs);
        RenderStatistics statistics = complete();
        statistics.inputs = prepared.inputs;
        write_file(output_.json, to_json(statistics));
        EXPECT_EQ(reason(), "");
    }
}

TEST_F(UpToDate, NotWhenThereAreNewInputs) {
    const std::string settings = read_file(scene_ / "render.json");
    fs::remove(scene_ / "render.json");
    write_report();
    EXPECT_EQ(reason(), "");
    write_file(scene_ / "render.json", settings);
    EXPECT_EQ(reason(), "input render.json is new");
}

TEST_F(UpToDate, NotWhenATextureIsThereThatWasMissingOrBroken) {
    name_missing_texture(scene_);
    write_report();
    EXPECT_EQ(reason(), "");
    write_file(scene_ / "missing.hdr", "no image");
    EXPECT_EQ(reason(), "") << "materials do without it still";
    write_file(scene_ / "missing.hdr", hdr_bytes());
    EXPECT_EQ(reason(), "input missing.hdr is new");
    write_report();
    EXPECT_EQ(reason(), "");
    fs::remove(scene_ / "missing.hdr");
    EXPECT_EQ(reason(), "input missing.hdr is missing");
}

TEST_F(UpToDate, AlsoWhereTheSceneHasBeenMovedOrCopied) {
    fs::create_directory(folder_ / "elsewhere");
    fs::rename(scene_, folder_ / "elsewhere/box");
    scene_ = folder_ / "elsewhere/box";
    EXPECT_EQ(reason(), "");
    fs::copy(scene_, folder_ / "copied", fs::copy_options::recursive);
    EXPECT_FALSE(why_outdated(output_, folder_ / "copied" / "scene.gltf"));
}

TEST_F(UpToDate, NotWhenAFileIsMissing) {
    for (const fs::path& file : {output_.exr, output_.png, output_.json, bin_}) {
        const fs::path away = folder_ / "away";
        fs::rename(file, away);
        EXPECT_EQ(reason(), file == bin_ ? "input triangle.bin is missing" : file.filename().string() + " is missing");
        fs::rename(away, file);
        EXPECT_EQ(reason(), "");
    }
}

TEST_F(UpToDate, NotWhenAFileOfALayerIsMissing) {
    RenderStatistics statistics = complete();
    statistics.layer_files = {"image.depth.exr"};
    write_report(statistics);
    EXPECT_EQ(reason(), "image.depth.exr is missing");
    write_file(folder_ / "image.depth.exr", "exr");
    EXPECT_EQ(reason(), "");
}

TEST_F(UpToDate, NotWhenAFileIsDamaged) {
    RenderStatistics statistics = complete();
    statistics.file_sizes = {{"image.exr", 3}, {"image.png", 100}};
    write_report(statistics);
    EXPECT_EQ(reason(), "image.png is damaged: 3 of 100 bytes");
    write_file(output_.png, std::string("small\0\0\0\0IEND\xae\x42\x60\x82", 17));
    EXPECT_EQ(reason(), "") << "somebody has made it smaller";
    write_file(output_.exr, "ex");
    EXPECT_EQ(reason(), "image.exr is damaged: 2 of 3 bytes");
    write_file(output_.exr, "with more in its header");
    EXPECT_EQ(reason(), "");
    write_file(output_.png, "");
    output_.png.clear();
    EXPECT_EQ(reason(), "") << "nobody asks for it";
}

TEST_F(UpToDate, NotWhenTheRenderWasCutShortOrItsReportIsForeign) {
    RenderStatistics statistics = complete();
    statistics.complete = false;
    statistics.spp_requested = statistics.spp_done = 0;
    write_report(statistics);
    EXPECT_EQ(reason(), "was not finished");
    for (const char* text : {"", "{", "[]", "null", "{}", R"({"complete": true})", R"({"settings_hash": "abc"})",
                             R"({"complete": 1, "settings_hash": "abc"})", R"({"complete": true, "settings_hash": 7})",
                             R"({"complete": true, "settings_hash": "abc", "inputs": 3})",
                             R"({"complete": true, "settings_hash": "abc", "inputs": [3]})"}) {
        write_file(output_.json, text);
        EXPECT_NE(reason(), "") << text;
    }
}

TEST_F(UpToDate, NotWhenItsReportOrItsPngIsAPipeWhichIsNothingToWaitFor) {
    for (const fs::path& file : {output_.json, output_.png}) {
        fs::remove(file);
        ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    }
    EXPECT_EQ(reason(), "was not finished");
    EXPECT_FALSE(is_whole_png(output_.png));
}

TEST(OutputPaths, StandBesideTheExr) {
    const OutputPaths paths = OutputPaths::beside("some.dir/image.v2.exr");
    EXPECT_EQ(paths.exr, "some.dir/image.v2.exr");
    EXPECT_EQ(paths.png, "some.dir/image.v2.png");
    EXPECT_EQ(paths.json, "some.dir/image.v2.json");
}

}  // namespace

}  // namespace etendue::test
