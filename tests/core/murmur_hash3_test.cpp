#include "core/murmur_hash3.h"

#include <string>

#include <gtest/gtest.h>

namespace etendue {
namespace {

// Of the answers that are passed around for MurmurHash3_x86_32 (en.wikipedia.org/wiki/MurmurHash, "Tests", and the
// ones that many implementations carry, of StackOverflow 14747343), with seeds and with rests of one to three bytes.
TEST(MurmurHash3, GivesThePublishedAnswers) {
    EXPECT_EQ(murmur_hash3_32("", 0), 0u);
    EXPECT_EQ(murmur_hash3_32("", 1), 0x514e28b7u);
    EXPECT_EQ(murmur_hash3_32("", 0xffffffffu), 0x81f16f39u);
    EXPECT_EQ(murmur_hash3_32("test", 0), 0xba6bd213u);
    EXPECT_EQ(murmur_hash3_32("test", 0x9747b28cu), 0x704b81dcu);
    EXPECT_EQ(murmur_hash3_32("Hello, world!", 0), 0xc0363e43u);
    EXPECT_EQ(murmur_hash3_32("Hello, world!", 0x9747b28cu), 0x24884cbau);
    EXPECT_EQ(murmur_hash3_32("The quick brown fox jumps over the lazy dog", 0), 0x2e4ff723u);
    EXPECT_EQ(murmur_hash3_32("The quick brown fox jumps over the lazy dog", 0x9747b28cu), 0x2fa826cdu);
    EXPECT_EQ(murmur_hash3_32("a", 0x9747b28cu), 0x7fa09ea6u);
    EXPECT_EQ(murmur_hash3_32("aa", 0x9747b28cu), 0x5d211726u);
    EXPECT_EQ(murmur_hash3_32("aaa", 0x9747b28cu), 0x283e0130u);
    EXPECT_EQ(murmur_hash3_32("aaaa", 0x9747b28cu), 0x5a97808au);
    EXPECT_EQ(murmur_hash3_32(std::string_view("\0\0\0\0", 4), 0), 0x2362f9deu);
    EXPECT_EQ(murmur_hash3_32("\xff\xff\xff\xff", 0), 0x76293b50u);
}

}  // namespace
}  // namespace etendue
