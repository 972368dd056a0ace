#include "image/byte_source.h"

#include "core/write_file.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(ByteSource, ReadsOfAFileWhatIsInIt) {
    const TemporaryFolder folder;
    std::mt19937 random(3);
    std::string text(20'000, '\0');
    for (char& c : text) c = static_cast<char>(random() % 256);
    write_text(folder / "a", text);
    const ByteSource file = byte_source(folder / "a");
    const ByteSource memory = byte_source(std::as_bytes(std::span(text)));
    std::uint64_t offset = 0;
    for (int i = 0; i < 2000; ++i) {
        // Near the last place, as headers are read, or anywhere, also behind the end.
        offset = i % 3 == 0 ? random() % 25'000 : offset + random() % 10;
        std::vector<std::uint8_t> bytes(i % 50 == 0 ? 9000 : random() % 40);
        std::vector<std::uint8_t> expected = bytes;
        const std::size_t count = file(offset, bytes);
        ASSERT_EQ(count, memory(offset, expected)) << offset;
        ASSERT_TRUE(std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count), expected.begin()));
    }
    std::vector<std::uint8_t> bytes(8);
    EXPECT_EQ(file(~std::uint64_t{0}, bytes), 0u);
    EXPECT_EQ(byte_source(folder / "none")(0, bytes), 0u);
}

}  // namespace

}  // namespace etendue
