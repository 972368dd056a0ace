// OpenEXR files whose headers claim what would take gigabytes.
#include "core/error.h"
#include "core/refused_input.h"
#include "image/layers.h"
#include "image/read.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace etendue {

namespace {

std::string u32(std::uint32_t value) {
    std::string bytes;
    for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i));
    return bytes;
}

/// An attribute that says to have `claimed` bytes.
std::string attribute(const std::string& name, const std::string& type, const std::string& value,
                      std::uint32_t claimed) {
    return name + '\0' + type + '\0' + u32(claimed) + value;
}
std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return attribute(name, type, value, static_cast<std::uint32_t>(value.size()));
}

std::string channel(const std::string& name) {
    return name + '\0' + u32(1) + std::string(4, '\0') + u32(1) + u32(1);
}

/// What a header says of an image of 4 x 4 black pixels without compression, unless it is told otherwise.
struct Header {
    std::string channels = channel("B") + channel("G") + channel("R");
    std::uint32_t right = 3;
    std::uint32_t bottom = 3;
    char compression = 0;
    std::string more{};

    [[nodiscard]] std::string text() const {
        const std::string window = u32(0) + u32(0) + u32(right) + u32(bottom);
        return attribute("channels", "chlist", channels + '\0') +
               attribute("compression", "compression", std::string(1, compression)) +
               attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) +
               attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
               attribute("pixelAspectRatio", "float", std::string("\0\0\x80\x3f", 4)) +
               attribute("screenWindowCenter", "v2f", std::string(8, '\0')) +
               attribute("screenWindowWidth", "float", std::string("\0\0\x80\x3f", 4)) + more + '\0';
    }
};

std::string file_of(const std::string& headers, char flags = 0) {
    std::string file = std::string("\x76\x2f\x31\x01\x02", 5) + flags + std::string(2, '\0') + headers;
    const std::size_t first_line = file.size() + 4 * 8;
    for (std::uint32_t line = 0; line < 4; ++line)
        file += u32(static_cast<std::uint32_t>(first_line) + line * 32) + u32(0);
    for (std::uint32_t line = 0; line < 4; ++line) file += u32(line) + u32(24) + std::string(24, '\0');
    return file;
}

std::string refusal(const std::string& file) {
    try {
        (void)read_image_float(std::as_bytes(std::span(file)));
    } catch (const IoError& error) {
        return error.what();
    }
    return "";
}

std::int64_t most_memory() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return std::int64_t{usage.ru_maxrss} << 10;
}

TEST(ExrClaims, AreBelievedWhereTheyCanBeTrue) {
    EXPECT_EQ(refusal(file_of(Header{}.text())), "");
    EXPECT_EQ(refusal(file_of(Header{.more = attribute("comment", "string", "hello")}.text())), "");
    EXPECT_EQ(refusal(file_of(Header{.more = attribute("s", "stringvector", u32(2) + "ab" + u32(0))}.text())), "");
}

TEST(ExrClaims, AreRefusedBeforeMemoryIsTaken) {
    const std::string tiles = attribute("tiles", "tiledesc", u32(1u << 30) + u32(1u << 30) + '\0');
    const std::string small_tiles = attribute("tiles", "tiledesc", u32(1) + u32(1) + '\0');
    const std::string no_tiles = attribute("tiles", "tiledesc", u32(0) + u32(0) + '\0');
    const std::string part = attribute("name", "string", "a") + attribute("type", "string", "scanlineimage");
    std::string many;
    for (int i = 0; i < 10'000; ++i) many += channel("c" + std::to_string(i));
    constexpr std::uint32_t kHuge = 0x7ffffff0;
    constexpr char kMultiPart = 0x10;
    constexpr char kTiled = 0x02;
    constexpr char kDwab = 9;
    const std::vector<std::string> files{
        file_of(Header{.more = attribute("owner", "string", "", kHuge)}.text()),
        file_of(Header{.more = attribute("blob", "mine", "", kHuge)}.text()),
        file_of(Header{.more = attribute("f", "floatvector", "", 1u << 31)}.text()),
        file_of(Header{.more = attribute("s", "stringvector", u32(kHuge))}.text()),
        file_of(Header{.more = attribute("preview", "preview", u32(30000) + u32(30000))}.text()),
        file_of(Header{.more = attribute("m", "idmanifest", u32(kHuge) + "x")}.text()),
        file_of(Header{.bottom = kHuge}.text()),
        file_of(Header{.right = (1u << 30), .compression = kDwab}.text()),
        file_of(Header{.channels = many, .right = 60000, .compression = kDwab}.text()),
        file_of(Header{.more = tiles}.text(), kTiled),
        file_of(Header{.more = no_tiles}.text(), kTiled),
        file_of(Header{.right = 65000, .bottom = 65000, .more = small_tiles}.text(), kTiled),
        file_of(Header{.more = part + attribute("chunkCount", "int", u32(kHuge))}.text() + '\0', kMultiPart),
        file_of(Header{.more = part + attribute("chunkCount", "int", u32(0xffffffff))}.text() + '\0', kMultiPart),
        file_of(Header{.more = part + attribute("chunkCount", "int", u32(4))}.text() +
                    Header{.bottom = kHuge, .more = part + attribute("chunkCount", "int", u32(4))}.text() + '\0',
                kMultiPart),
        file_of(Header{.channels = "R"}.text()),
    };
    const std::int64_t before = most_memory();
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "etendue-exr-claims.exr";
    for (std::size_t i = 0; i < files.size(); ++i) {
        EXPECT_NE(refusal(files[i]), "") << i;
        std::ofstream(path, std::ios::binary) << files[i];
        EXPECT_THROW((void)read_layers(path), IoError) << i;
        EXPECT_THROW((void)read_image_info(path), IoError) << i;
    }
    std::filesystem::remove(path);
    EXPECT_LT(most_memory() - before, std::int64_t{100} << 20);
}

TEST(ExrClaims, AreNoMoreThanAnyProgramWrites) {
    constexpr char kMultiPart = 0x10;
    const auto attributes = [](int count) {
        std::string all;
        for (int i = 0; i < count; ++i) all += attribute("a" + std::to_string(i), "string", "x");
        return all;
    };
    const auto parts = [](int count, const std::string& more) {
        std::string all;
        for (int i = 0; i < count; ++i)
            all += Header{.more = attribute("name", "string", std::to_string(i)) +
                                  attribute("type", "string", "scanlineimage") +
                                  attribute("chunkCount", "int", u32(4)) + more}
                       .text();
        return all + '\0';
    };
    std::string channels;
    for (int i = 0; i < 70'000; ++i) channels += channel("c" + std::to_string(i));
    const std::string texts = attribute("s", "stringvector", std::string(std::size_t{4} * 70'000, '\0'));
    const auto expect_refusal = [](const std::string& file, const std::string& message) {
        EXPECT_EQ(refusal(file), message);
        EXPECT_THROW((void)read_image_info(std::as_bytes(std::span(file))), RefusedInput) << message;
    };
    EXPECT_EQ(refusal(file_of(Header{.more = attributes(4000)}.text())), "");
    expect_refusal(file_of(Header{.more = attributes(60'000)}.text()), "it has more than 4096 attributes in one part");
    expect_refusal(file_of(parts(20, attributes(4000)), kMultiPart),
                   "it has more than 65536 attributes and texts in them");
    expect_refusal(file_of(Header{.more = texts}.text()), "it has more than 65536 attributes and texts in them");
    expect_refusal(file_of(Header{.channels = channels}.text()), "it has more than 65536 channels");
    expect_refusal(file_of(parts(4097, ""), kMultiPart), "it has more than 4096 parts");
}

TEST(ExrClaims, EndWithTheFile) {
    const std::string file = file_of(Header{}.text());
    const std::size_t headers = 8 + Header{}.text().size();
    for (std::size_t length = 8; length < headers; length += 7)
        EXPECT_NE(refusal(file.substr(0, length)), "") << length;
}

}  // namespace

}  // namespace etendue
