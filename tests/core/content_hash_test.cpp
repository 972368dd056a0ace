#include "core/content_hash.h"

#include "core/error.h"
#include "core/write_file.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace etendue {

namespace {

ContentHash::Digest hash_of(const std::string& text, std::size_t part) {
    ContentHash hash;
    for (std::size_t i = 0; i < text.size(); i += part)
        hash.add(std::as_bytes(std::span(text).subspan(i).first(std::min(part, text.size() - i))));
    return hash.digest();
}

// The first is published: https://github.com/Cyan4973/xxHash, tests of XXH128 without a seed.
TEST(ContentHash, IsXxh3) {
    EXPECT_EQ(hex(ContentHash().digest()), "99aa06d3014798d86001c324468d497f");
}

TEST(ContentHash, DoesNotDependOnThePieces) {
    const std::string text(5000, 'x');
    EXPECT_EQ(hash_of(text, 1), hash_of(text, 5000));
    EXPECT_EQ(hash_of(text, 333), hash_of(text, 5000));
    EXPECT_NE(hash_of(text, 1), hash_of(text + "x", 1));
}

TEST(HashFile, IsThatOfTheBytes) {
    const TemporaryFolder folder;
    const std::string text(3u << 20, 'y');
    write_text(folder / "file", text);
    EXPECT_EQ(hash_file(folder / "file"), hash_of(text, text.size()));
    EXPECT_THROW((void)hash_file(folder / "missing"), IoError);
}

TEST(RegularFile, IsAllThatIsRead) {
    const TemporaryFolder folder;
    write_text(folder / "file", "text");
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    std::string word;
    EXPECT_TRUE(open_regular_file(folder / "file") >> word);
    EXPECT_EQ(word, "text");
    for (const std::filesystem::path& other : {folder / "pipe", std::filesystem::path("/dev/zero")}) {
        EXPECT_FALSE(open_regular_file(other)) << other;
        EXPECT_THROW(require_regular_file(other), IoError) << other;
        EXPECT_THROW((void)hash_file(other), IoError) << other;
    }
    EXPECT_FALSE(open_regular_file(folder / "missing"));
    EXPECT_NO_THROW(require_regular_file(folder / "missing"));
}

}  // namespace

}  // namespace etendue
