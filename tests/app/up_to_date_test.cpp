#include "app/up_to_date.h"

#include "app/small_files.h"

#include <chrono>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

namespace fs = std::filesystem;

class UpToDate : public testing::Test {
  protected:
    void SetUp() override {
        for (const fs::path& input : inputs_) write_file(input, "input");
        write_file(output_.exr, "exr");
        write_file(output_.png, "png");
        write_report("true", "\"abc\"");
        for (const fs::path& input : inputs_) age(input, 100);
        for (const fs::path& file : {output_.exr, output_.png, output_.json}) age(file, 50);
    }
    void write_report(const std::string& complete, const std::string& hash) {
        write_file(output_.json, R"({"complete": )" + complete + R"(, "settings_hash": )" + hash + "}");
    }
    static void age(const fs::path& file, int seconds) {
        fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::seconds(seconds));
    }
    [[nodiscard]] bool up_to_date(const std::string& hash = "abc") const {
        return is_up_to_date(output_, inputs_, hash);
    }

    TestFolder folder_;
    OutputPaths output_ = OutputPaths::beside(folder_ / "image.exr");
    std::vector<fs::path> inputs_{folder_ / "scene.gltf", folder_ / "render.json"};
};

TEST_F(UpToDate, WhenNewerAndMadeWithTheSameSettings) {
    EXPECT_TRUE(up_to_date());
    EXPECT_FALSE(up_to_date("abd"));
    EXPECT_FALSE(up_to_date(""));
}

TEST_F(UpToDate, NotWhenAnyInputIsNewerThanAnyOutput) {
    age(inputs_[1], 10);
    EXPECT_FALSE(up_to_date());
    age(inputs_[1], 75);
    EXPECT_TRUE(up_to_date());
    age(output_.png, 90);
    EXPECT_FALSE(up_to_date());
}

TEST_F(UpToDate, NotWhenAFileIsMissing) {
    for (const fs::path& file : {output_.exr, output_.png, output_.json, inputs_[0]}) {
        const std::string content = read_file(file);
        const fs::file_time_type time = fs::last_write_time(file);
        fs::remove(file);
        EXPECT_FALSE(up_to_date()) << file;
        write_file(file, content);
        fs::last_write_time(file, time);
        EXPECT_TRUE(up_to_date());
    }
}

TEST_F(UpToDate, NotWhenTheRenderWasCutShortOrItsReportIsForeign) {
    write_report("false", "\"abc\"");
    EXPECT_FALSE(up_to_date());
    for (const char* text :
         {"", "{", "[]", "null", "{}", R"({"complete": true})", R"({"settings_hash": "abc"})",
          R"({"complete": 1, "settings_hash": "abc"})", R"({"complete": true, "settings_hash": 7})"}) {
        write_file(output_.json, text);
        EXPECT_FALSE(up_to_date()) << text;
    }
}

TEST(OutputPaths, StandBesideTheExr) {
    const OutputPaths paths = OutputPaths::beside("some.dir/image.v2.exr");
    EXPECT_EQ(paths.exr, "some.dir/image.v2.exr");
    EXPECT_EQ(paths.png, "some.dir/image.v2.png");
    EXPECT_EQ(paths.json, "some.dir/image.v2.json");
}

}  // namespace

}  // namespace etendue::test
