#include "image/image_reader.h"

#include "core/error.h"
#include "image_test_files.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include <gtest/gtest.h>

namespace etendue {

namespace {

std::vector<float> numbers(std::size_t count) {
    std::vector<float> values(count);
    std::iota(values.begin(), values.end(), 1.0f);
    return values;
}

TEST(ImageReader, RowsAreThoseOfTheWholeImage) {
    const TemporaryFolder folder;
    const auto file = write_reference(folder / "a.exr", {5, 7, 3, OIIO::TypeDesc::FLOAT}, numbers(5 * 7 * 3));
    ImageReader reader(file);
    EXPECT_EQ(reader.info().decoded_channels, 3);
    EXPECT_EQ(reader.info().depth, TexelDepth::Float);
    EXPECT_EQ(reader.tile().width, 0);
    ASSERT_EQ(reader.levels().size(), 1u);
    const ImageF whole = read_image_float(file);
    for (int begin = 6; begin >= 0; begin -= 2) {
        const int end = std::min(7, begin + 2);
        std::vector<float> rows(static_cast<std::size_t>(end - begin) * 15);
        reader.read_rows(0, begin, end, rows);
        EXPECT_TRUE(std::equal(rows.begin(), rows.end(), whole.pixels.begin() + begin * 15)) << begin;
    }
}

/// A file of this name, 16 pixels wide and 64 high with an alpha that varies, or its bytes in memory.
class RowsInAnyOrder : public testing::TestWithParam<const char*> {
  protected:
    std::filesystem::path write() const {
        const std::string name = GetParam();
        const int channels = name == "a.jpg" || name == "a.hdr" ? 3 : 4;
        std::vector<float> values(static_cast<std::size_t>(16 * 64 * channels));
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>((i * 37) % 251 + 3) / 255.0f;
        OIIO::ImageSpec spec(16, 64, channels, name == "a.hdr" ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
        spec.attribute("oiio:UnassociatedAlpha", 1);
        return write_reference(folder_ / name, spec, values);
    }
    static void expect_rows(const ImageSource& source) {
        const ImageF whole = read_image_float(source);
        const auto row = static_cast<std::size_t>(whole.channels) * 16;
        ImageReader reader(source);
        for (const int begin : {48, 16, 32, 0, 40, 8}) {
            std::vector<float> rows(8 * row);
            reader.read_rows(0, begin, begin + 8, rows);
            const auto expected = whole.pixels.begin() + static_cast<std::ptrdiff_t>(row) * begin;
            EXPECT_TRUE(std::equal(rows.begin(), rows.end(), expected)) << "from row " << begin;
        }
    }
    TemporaryFolder folder_;
};

// Caches of tiles read again what they had to forget.
TEST_P(RowsInAnyOrder, OfAFileAndInMemory) {
    const std::filesystem::path file = write();
    expect_rows(file);
    const std::vector<std::byte> bytes = read_all(file);
    expect_rows(std::span<const std::byte>(bytes));
}

TEST_P(RowsInAnyOrder, BrokenPixelsStayBroken) {
    std::vector<std::byte> bytes = read_all(write());
    bytes.resize(bytes.size() / 2);
    std::optional<ImageReader> reader;
    try {
        reader.emplace(std::span<const std::byte>(bytes));
    } catch (const IoError&) {
        return;  // already the header says so
    }
    std::vector<float> rows(static_cast<std::size_t>(8 * 16 * reader->info().decoded_channels));
    int failed = 0;
    for (const int begin : {56, 48, 56, 0, 56}) {
        try {
            reader->read_rows(0, begin, begin + 8, rows);
        } catch (const IoError&) {
            ++failed;
        }
    }
    // The library makes up what a JPEG lacks.
    EXPECT_TRUE(failed == 5 || std::string(GetParam()) == "a.jpg") << failed;
}

INSTANTIATE_TEST_SUITE_P(Formats, RowsInAnyOrder,
                         testing::Values("a.png", "a.jpg", "a.tif", "a.hdr", "a.webp", "a.exr"),
                         [](const auto& name) { return std::string(name.param + 2); });

TEST(ImageReader, TilesReachBeyondTheImageWithoutHarm) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(40, 24, 1, OIIO::TypeDesc::FLOAT);
    spec.tile_width = spec.tile_height = 16;
    const auto file = write_reference(folder / "a.exr", spec, numbers(40 * 24));
    ImageReader reader(file);
    ASSERT_EQ(reader.tile().width, 16);
    ASSERT_EQ(reader.tile().height, 16);
    std::vector<float> tile(16 * 16);
    reader.read_tile(0, 32, 16, tile);
    for (int y = 16; y < 24; ++y)
        for (int x = 32; x < 40; ++x)
            EXPECT_EQ(tile[static_cast<std::size_t>((y - 16) * 16 + x - 32)], static_cast<float>(y * 40 + x + 1));
}

// Whoever reads one tile would have to take memory for all of it.
TEST(ImageReader, RefusesTilesThatAreFarLargerThanTheImage) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(16, 16, 1, OIIO::TypeDesc::UINT8);
    spec.tile_width = 16;
    spec.tile_height = 8192;
    const auto file = write_reference(folder / "a.tif", spec, std::vector<std::uint8_t>(256));
    EXPECT_THROW(ImageReader{file}, IoError);
}

TEST(ImageReader, ChannelsArePickedByName) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(2, 2, 5, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"depth.Z", "R", "G", "mask", "B"};
    const auto file = write_reference(folder / "a.exr", spec, numbers(20));
    ImageReader reader(file);
    EXPECT_EQ(reader.info().channels, 5);
    EXPECT_EQ(reader.info().decoded_channels, 3);
    std::vector<float> rows(12);
    reader.read_rows(0, 0, 2, rows);
    EXPECT_EQ(rows, read_image_float(file).pixels);
    EXPECT_EQ(rows[0], 2.0f);
    EXPECT_EQ(rows[2], 5.0f);
}

TEST(ImageReader, BrokenFilesAreErrors) {
    const TemporaryFolder folder;
    EXPECT_THROW(ImageReader(folder / "missing.png"), IoError);
    const auto file = write_reference(folder / "a.exr", {64, 64, 3, OIIO::TypeDesc::FLOAT}, numbers(64 * 64 * 3));
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    std::vector<float> rows(64 * 64 * 3);
    try {
        ImageReader(file).read_rows(0, 0, 64, rows);
        ADD_FAILURE() << "no error";
    } catch (const IoError& error) {
        EXPECT_NE(std::string(error.what()).find("broken"), std::string::npos) << error.what();
    }
}

// An image in memory is decoded in the depth of its file.
TEST(ReadImageLevels, KeepsTheDepth) {
    const TemporaryFolder folder;
    const auto depth_of = [&](const char* name, OIIO::TypeDesc type) {
        return read_image_levels(write_reference(folder / name, {2, 2, 3, type}, std::vector<float>(12, 0.5f)))
            .front()
            .index();
    };
    EXPECT_EQ(depth_of("a.png", OIIO::TypeDesc::UINT8), NativeImage(Image8()).index());
    EXPECT_EQ(depth_of("b.png", OIIO::TypeDesc::UINT16), NativeImage(Image16()).index());
    EXPECT_EQ(depth_of("c.exr", OIIO::TypeDesc::HALF), NativeImage(ImageH()).index());
    EXPECT_EQ(depth_of("d.exr", OIIO::TypeDesc::FLOAT), NativeImage(ImageF()).index());
    EXPECT_EQ(depth_of("e.hdr", OIIO::TypeDesc::FLOAT), NativeImage(ImageF()).index());
}

}  // namespace

}  // namespace etendue
