#include "loader/gltf/meshopt_attributes.h"

#include "core/error.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

namespace etendue {
namespace {

using Bytes = std::vector<unsigned char>;

/// A stream of version 1: `blocks`, and its tail with the element before the first.
Bytes stream(const Bytes& blocks, const Bytes& baseline, const Bytes& modes) {
    Bytes bytes{0xa1};
    bytes.insert(bytes.end(), blocks.begin(), blocks.end());
    if (const std::size_t tail = baseline.size() + modes.size(); tail < 24) bytes.resize(bytes.size() + 24 - tail);
    bytes.insert(bytes.end(), baseline.begin(), baseline.end());
    bytes.insert(bytes.end(), modes.begin(), modes.end());
    return bytes;
}

Bytes column(const Bytes& elements, std::size_t stride, std::size_t byte) {
    Bytes values;
    for (std::size_t i = byte; i < elements.size(); i += stride) values.push_back(elements[i]);
    return values;
}

// The first byte has the example of the extension's text; the others do not change.
TEST(MeshoptAttributes, DecodeTheExampleOfTheSpecification) {
    const Bytes bytes =
        stream({0xa8, 0x03, 0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5}, {10, 20, 30, 40}, {0});
    ASSERT_TRUE(is_meshopt_attributes_v1(bytes));
    const Bytes decoded = decode_meshopt_attributes_v1(bytes, 16, 4);
    Bytes expected;
    int value = 10;
    for (const int delta : {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0})
        expected.push_back(static_cast<unsigned char>(value += delta));
    EXPECT_EQ(column(decoded, 4, 0), expected);
    EXPECT_EQ(column(decoded, 4, 1), Bytes(16, 20));
    EXPECT_EQ(column(decoded, 4, 3), Bytes(16, 40));
}

TEST(MeshoptAttributes, PackEachNumberOfBitsInItsOwnOrder) {
    // One bit, the least significant first: elements 0, 2 and 15 are whole bytes. Two bits, the most significant first:
    // element 1 is. Then whole bytes of mode 1, and literal ones, of 16 elements each.
    Bytes blocks{0xd0, 0x01, 0x05, 0x80, 2, 4, 6, 0x02, 0x30, 0, 0, 0x02, 8, 0x03};
    for (unsigned char i = 0; i < 16; ++i) blocks.push_back(2);
    for (unsigned char i = 0; i < 16; ++i) blocks.push_back(i == 3 ? 1 : 0);
    const Bytes decoded = decode_meshopt_attributes_v1(stream(blocks, {0, 0, 0, 100}, {0}), 16, 4);
    EXPECT_EQ(column(decoded, 4, 0), (Bytes{1, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 6}));
    EXPECT_EQ(column(decoded, 4, 1), (Bytes{0, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5}));
    EXPECT_EQ(column(decoded, 4, 2), (Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}));
    EXPECT_EQ(column(decoded, 4, 3), (Bytes{100, 100, 100, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99}));
}

TEST(MeshoptAttributes, AddNumbersOfTwoBytesAndTurnThoseOfFour) {
    // Two elements of two channels; all is literal, byte by byte of both elements.
    const std::uint32_t turned = std::rotl(0x00ff00ffu, 5);
    const auto byte_of = [](std::uint32_t value, int b) { return static_cast<unsigned char>(value >> (8 * b)); };
    Bytes blocks{0xff, 0xff, /* +300, -1 */ 0x58, 0x01, 0x02, 0x00, /* 0, +1 */ 0x00, 0x02, 0x00, 0x00};
    for (int b = 0; b < 4; ++b) {
        blocks.push_back(byte_of(turned, b));
        blocks.push_back(0);
    }
    const Bytes decoded =
        decode_meshopt_attributes_v1(stream(blocks, {200, 0, 5, 0, 0x11, 0x22, 0x33, 0x44}, {1, 0x52}), 2, 8);
    const auto half = [&](std::size_t at) { return decoded[at] + 256 * decoded[at + 1]; };
    EXPECT_EQ(half(0), 500);
    EXPECT_EQ(half(8), 499);
    EXPECT_EQ(half(2), 5);
    EXPECT_EQ(half(10), 6);
    std::uint32_t number = 0;
    std::memcpy(&number, &decoded[4], 4);
    EXPECT_EQ(number, 0x44332211u ^ 0x00ff00ffu);
    std::memcpy(&number, &decoded[12], 4);
    EXPECT_EQ(number, 0x44332211u ^ 0x00ff00ffu) << "the last is the next one's beginning";
}

TEST(MeshoptAttributes, GoOnFromBlockToBlock) {
    // 300 elements are blocks of 256 and 44; the first of each adds 1 to the first byte.
    Bytes blocks;
    for (const std::size_t count : {256u, 44u}) {
        blocks.insert(blocks.end(), {0xab, 2});
        blocks.insert(blocks.end(), count - 1, 0);
    }
    const Bytes decoded = decode_meshopt_attributes_v1(stream(blocks, {7, 8, 9, 10}, {0}), 300, 4);
    ASSERT_EQ(decoded.size(), 1200u);
    for (std::size_t i = 0; i < 300; ++i) ASSERT_EQ(decoded[4 * i], i < 256 ? 8 : 9) << i;
    EXPECT_EQ(column(decoded, 4, 2), Bytes(300, 9));
}

TEST(MeshoptAttributes, RefuseWhatIsDamaged) {
    const Bytes good =
        stream({0xa8, 0x03, 0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5}, {10, 20, 30, 40}, {0});
    for (std::size_t length = 0; length < good.size(); ++length) {
        const Bytes cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length));
        EXPECT_THROW((void)decode_meshopt_attributes_v1(cut, 16, 4), IoError) << length;
    }
    Bytes longer = good;
    longer.insert(longer.begin() + 5, 0);
    EXPECT_THROW((void)decode_meshopt_attributes_v1(longer, 16, 4), IoError) << "bytes are left over";
    for (const int mode : {3, 4, 0x10, 0x21}) {
        Bytes bad = good;
        bad.back() = static_cast<unsigned char>(mode);
        EXPECT_THROW((void)decode_meshopt_attributes_v1(bad, 16, 4), IoError) << mode;
    }
    for (std::size_t i = 0; i < good.size(); ++i)
        for (int value = 0; value < 256; value += 5) {
            Bytes bad = good;
            bad[i] = static_cast<unsigned char>(value);
            try {
                EXPECT_EQ(decode_meshopt_attributes_v1(bad, 16, 4).size(), 64u);
            } catch (const IoError&) {
            }
        }
}

TEST(MeshoptColors, AreDecodedWithTheBitsThatTheyHave) {
    // K = 8, then 4: Y, Co, Cg and alpha below its highest bit.
    Bytes bytes{100, 20, 0xf6, 0x80 | 0x55, 7, 1, 0xfe, 8 | 5};
    decode_meshopt_colors(bytes, 4);
    EXPECT_EQ(bytes, (Bytes{130, 90, 90, 0xab, 170, 85, 136, 187}));

    std::vector<std::uint16_t> words{1000, 24, 0xfff0, 0x400 | 0x200};  // K = 11
    Bytes wide(8);
    std::memcpy(wide.data(), words.data(), 8);
    decode_meshopt_colors(wide, 8);
    std::memcpy(words.data(), wide.data(), 8);
    const auto scaled = [](double value) { return static_cast<std::uint16_t>(std::lround(value * 65535.0 / 2047.0)); };
    EXPECT_NEAR(words[0], scaled(1040.0), 1);
    EXPECT_NEAR(words[1], scaled(984.0), 1);
    EXPECT_NEAR(words[2], scaled(992.0), 1);
    EXPECT_NEAR(words[3], scaled(1024.0), 1);
}

}  // namespace
}  // namespace etendue
