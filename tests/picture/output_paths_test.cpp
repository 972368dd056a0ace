#include "picture/output_paths.h"

#include "core/error.h"
#include "program/small_files.h"

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

std::string refusal_to_write(const std::filesystem::path& file) {
    try {
        require_writable(file);
        return "";
    } catch (const IoError& error) {
        return error.what();
    }
}

TEST(RequireWritable, SaysWhatIsWrongWithAPathThatLeadsNowhere) {
    const TestFolder folder;
    const std::filesystem::path root = std::filesystem::absolute(folder.path());
    const std::string too_long = (root / std::string(300, 'a')).string();
    EXPECT_EQ(refusal_to_write(too_long), "cannot write " + too_long + ": File name too long");
    const std::string below = too_long + "/a.exr";
    EXPECT_EQ(refusal_to_write(below), "cannot write " + below + ": File name too long");
    std::filesystem::create_symlink("loop", root / "loop");
    const std::string loop = (root / "loop").string();
    EXPECT_EQ(refusal_to_write(loop), "cannot write " + loop + ": Too many levels of symbolic links");
    EXPECT_EQ(refusal_to_write(root / "a.exr"), "");
}

}  // namespace

}  // namespace etendue::test
