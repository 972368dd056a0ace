#include "core/byte_size.h"

#include <gtest/gtest.h>

namespace etendue {

namespace {

TEST(ByteSize, UnitsArePowersOf1024) {
    EXPECT_EQ(parse_byte_size("0M"), 0u);
    EXPECT_EQ(parse_byte_size("1K"), 1024u);
    EXPECT_EQ(parse_byte_size("512M"), 536870912u);
    EXPECT_EQ(parse_byte_size("8G"), 8589934592u);
    EXPECT_EQ(parse_byte_size("8GB"), 8589934592u);
    EXPECT_EQ(parse_byte_size("8GiB"), 8589934592u);
    EXPECT_EQ(parse_byte_size("999999T"), 999999ull << 40);
}

TEST(ByteSize, EverythingElseIsRefused) {
    for (const char* bad : {"", "K", "8", "8k", "8GBB", "8GiBB", "8i", "B", "iB", " 8G", "8 G", "8G ", "+8G", "-8G",
                            "1.5G", "1e3M", "0x8G", "1000000M", "99999999999999999999G"})
        EXPECT_FALSE(parse_byte_size(bad)) << bad;
}

TEST(ByteSize, WhatIsWrittenIsReadAgain) {
    EXPECT_EQ(to_byte_size((std::uint64_t{64} << 20) + 5), "64M");
    EXPECT_EQ(to_byte_size(std::uint64_t{999999} << 20), "999999M");
    EXPECT_EQ(to_byte_size(std::uint64_t{1000000} << 20), "976G");
    EXPECT_EQ(to_byte_size(std::uint64_t{999999} << 40), "999999T");
}

TEST(ByteSize, TheMachineHasMemory) {
    EXPECT_GT(physical_memory(), std::uint64_t{64} << 20);
}

}  // namespace

}  // namespace etendue
