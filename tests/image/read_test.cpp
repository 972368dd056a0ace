#include "image/read.h"

#include "core/error.h"
#include "core/write_file.h"
#include "image/layers.h"
#include "image/read_channels.h"
#include "image/write.h"
#include "image_test_files.h"
#include "support/sanitizers.h"

#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <new>
#include <random>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace etendue {

namespace {

std::string error_of(const ImageSource& source) {
    try {
        (void)read_image_float(source);
    } catch (const IoError& error) {
        return error.what();
    }
    return "";
}

// Every pixel of a small picture differs, so that swapped axes or channels show.
template <typename T>
std::vector<T> ramp(std::size_t count, double scale) {
    std::vector<T> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<T>(static_cast<double>(i + 1) * scale);
    return values;
}

TEST(ReadImage, Png8ReadsBackExactlyAtEveryChannelCount) {
    const TemporaryFolder folder;
    for (const int channels : {1, 2, 3, 4}) {
        const auto values = ramp<std::uint8_t>(std::size_t{15} * static_cast<std::size_t>(channels), 4.0);
        const auto path = write_reference(folder / "a.png", {5, 3, channels, OIIO::TypeDesc::UINT8}, values);
        const Image8 image = read_image_8bit(path);
        EXPECT_EQ(image.width, 5);
        EXPECT_EQ(image.height, 3);
        EXPECT_EQ(image.channels, channels);
        EXPECT_EQ(image.pixels, values) << channels << " channels";
        const ImageF floats = read_image_float(path);
        for (std::size_t i = 0; i < values.size(); ++i) {
            EXPECT_FLOAT_EQ(floats.pixels[i], static_cast<float>(values[i]) / 255.0f);
        }
    }
}

TEST(ReadImage, Png16ReadsAsFloatAndRoundsTo8) {
    const TemporaryFolder folder;
    const std::vector<std::uint16_t> values{0, 65535, 32768, 257 * 100 + 120, 257 * 100 + 140, 1};
    const auto path = write_reference(folder / "a.png", {2, 1, 3, OIIO::TypeDesc::UINT16}, values);
    const ImageF image = read_image_float(path);
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_FLOAT_EQ(image.pixels[i], static_cast<float>(values[i]) / 65535.0f);
    }
    EXPECT_EQ(read_image_8bit(path).pixels, (std::vector<std::uint8_t>{0, 255, 128, 100, 101, 0}));
}

TEST(ReadImage, PngColourIsNotMultipliedByAlpha) {
    const TemporaryFolder folder;
    const std::vector<std::uint8_t> values{200, 100, 50, 0, 200, 100, 50, 128};
    const auto path = write_reference(folder / "a.png", {2, 1, 4, OIIO::TypeDesc::UINT8}, values);
    EXPECT_EQ(read_image_8bit(path).pixels, values);
    EXPECT_EQ(read_image_8bit(read_all(path)).pixels, values);
}

TEST(ReadImage, JpegReadsNearlyBack) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(16, 16, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("CompressionQuality", 100);
    std::vector<std::uint8_t> values;
    for (int i = 0; i < 16 * 16; ++i) values.insert(values.end(), {200, 100, std::uint8_t(i / 2)});
    const auto path = write_reference(folder / "a.jpg", spec, values);
    const Image8 image = read_image_8bit(path);
    ASSERT_EQ(image.pixels.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(image.pixels[i], values[i], 6) << i;
    EXPECT_EQ(read_image_info(path).format, "jpeg");
}

TEST(ReadImage, RadianceHdrReadsNearlyBack) {
    const TemporaryFolder folder;
    const auto values = ramp<float>(32 * 4 * 3, 0.5);
    const auto path = write_reference(folder / "a.hdr", {32, 4, 3, OIIO::TypeDesc::FLOAT}, values);
    const ImageF image = read_image_float(path);
    ASSERT_EQ(image.pixels.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float brightest = std::max({values[i / 3 * 3], values[i / 3 * 3 + 1], values[i / 3 * 3 + 2]});
        EXPECT_NEAR(image.pixels[i], values[i], brightest / 128.0f);
    }
    EXPECT_TRUE(read_image_info(path).is_float);
}

TEST(ReadImage, ExrChannelsAreTakenByName) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(2, 1, 6, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"A", "B", "Z", "G", "diffuse.R", "R"};
    const std::vector<float> values{0.5f, 3.0f, 9.0f, 2.0f, 8.0f, 1.0f, 0.25f, 6.0f, 9.0f, 5.0f, 8.0f, 4.0f};
    const auto path = write_reference(folder / "a.exr", spec, values);
    const ImageF image = read_image_float(path);
    EXPECT_EQ(image.channels, 4);
    EXPECT_EQ(image.pixels, (std::vector<float>{1.0f, 2.0f, 3.0f, 0.5f, 4.0f, 5.0f, 6.0f, 0.25f}));
}

TEST(ReadImage, HeadersSayColorSpaceAndWindows) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(2, 1, 3, OIIO::TypeDesc::FLOAT);
    const std::array<float, 8> primaries{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), primaries.data());
    spec.x = -3;
    spec.y = 20;
    spec.full_x = -10;
    spec.full_y = 5;
    spec.full_width = 64;
    spec.full_height = 48;
    const ImageInfo exr = read_image_info(write_reference(folder / "a.exr", spec, ramp<float>(6, 1.0)));
    EXPECT_EQ(exr.color_space, "Linear");
    EXPECT_EQ(exr.chromaticities, primaries);
    EXPECT_EQ(exr.data_window, (PixelRect{-3, 20, -1, 21}));
    EXPECT_EQ(exr.display_window, (PixelRect{-10, 5, 54, 53}));
    const ImageInfo png = read_image_info(
        write_reference(folder / "a.png", {5, 3, 3, OIIO::TypeDesc::UINT8}, ramp<std::uint8_t>(45, 4.0)));
    EXPECT_EQ(png.color_space, "sRGB");
    EXPECT_FALSE(png.chromaticities.has_value());
    EXPECT_EQ(png.data_window, (PixelRect{0, 0, 5, 3}));
    EXPECT_EQ(png.display_window, png.data_window);
}

constexpr std::array kFileOfEveryFormat{"a.png", "a.jpg", "a.exr", "a.hdr", "a.tif", "big.tif"};

/// Three channels, floats if that is what the format of `name` is for; "big.tif" is a BigTIFF.
OIIO::ImageSpec spec_of_sample(const std::string& name, int width, int height) {
    const bool is_float = name.ends_with(".exr") || name.ends_with(".hdr");
    OIIO::ImageSpec spec(width, height, 3, is_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    spec.attribute("tiff:bigtiff", name == "big.tif" ? 1 : 0);
    return spec;
}

TEST(ReadImage, MemoryAndFileAgreeInEveryFormat) {
    const TemporaryFolder folder;
    for (const char* name : kFileOfEveryFormat) {
        const OIIO::ImageSpec spec = spec_of_sample(name, 16, 8);
        const bool is_float = spec.format == OIIO::TypeDesc::FLOAT;
        const auto path = write_reference(folder / name, spec, ramp<float>(16 * 8 * 3, 0.002));
        const auto bytes = read_all(path);
        EXPECT_EQ(read_image_float(path).pixels, read_image_float(bytes).pixels) << name;
        const ImageInfo info = read_image_info(bytes);
        EXPECT_EQ(info.width, 16) << name;
        EXPECT_EQ(info.height, 8) << name;
        EXPECT_EQ(info.channels, 3) << name;
        EXPECT_EQ(info.is_float, is_float) << name;
        EXPECT_EQ(info.bits_per_channel, is_float ? (std::string(name) == "a.hdr" ? info.bits_per_channel : 32) : 8);
    }
}

TEST(ReadImage, TheNameDoesNotMatter) {
    const TemporaryFolder folder;
    const std::vector<std::uint8_t> values{1, 2, 3};
    const auto path = write_reference(folder / "a.png", {1, 1, 3, OIIO::TypeDesc::UINT8}, values);
    std::filesystem::rename(path, folder / "a.jpg");
    EXPECT_EQ(read_image_info(folder / "a.jpg").format, "png");
    EXPECT_EQ(read_image_8bit(folder / "a.jpg").pixels, values);
}

TEST(ReadImage, SaysWhyAFileCannotBeRead) {
    const TemporaryFolder folder;
    EXPECT_NE(error_of(folder / "none.png").find("does not exist"), std::string::npos);
    EXPECT_NE(error_of(folder / "").find("not a regular file"), std::string::npos);
    EXPECT_NE(error_of("/dev/zero").find("not a regular file"), std::string::npos);
    write_text(folder / "empty.png", "");
    EXPECT_NE(error_of(folder / "empty.png").find("empty"), std::string::npos);
    write_text(folder / "text.png", "this is no image");
    EXPECT_NE(error_of(folder / "text.png").find("known format"), std::string::npos);
    EXPECT_NE(error_of(std::span<const std::byte>()).find("empty"), std::string::npos);
}

// A PNG whose header says `width` x `height`, with the checksum of the header put right.
std::vector<std::byte> png_that_claims(std::uint32_t width, std::uint32_t height) {
    std::vector<std::uint8_t> bytes{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R'};
    for (const std::uint32_t side : {width, height}) {
        for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(side >> shift));
    }
    for (const int value : {8, 2, 0, 0, 0}) bytes.push_back(static_cast<std::uint8_t>(value));
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = 12; i < bytes.size(); ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    }
    crc = ~crc;
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(crc >> shift));
    for (const std::uint8_t value :
         std::initializer_list<std::uint8_t>{0, 0, 0, 0, 'I', 'D', 'A', 'T', 53, 175, 6, 30}) {
        bytes.push_back(static_cast<std::uint8_t>(value));
    }
    const auto view = std::as_bytes(std::span(bytes));
    return {view.begin(), view.end()};
}

TEST(ReadImage, RefusesAbsurdSizes) {
    const std::string sides = error_of(png_that_claims(70000, 1));
    EXPECT_NE(sides.find("70000 x 1"), std::string::npos) << sides;
    const std::string area = error_of(png_that_claims(60000, 60000));
    EXPECT_NE(area.find("60000 x 60000"), std::string::npos) << area;
    EXPECT_THROW((void)read_image_info(png_that_claims(60000, 60000)), IoError);
}

TEST(ReadImage, RefusesMoreThanTheBytesCanHold) {
    const std::string message = error_of(png_that_claims(16000, 16000));
    EXPECT_NE(message.find("cannot hold"), std::string::npos) << message;
}

// A palette of one bit, as it lies in a file of Khronos' LightsPunctualLamp: 512 x 512 pixels in 126 bytes.
TEST(ReadImage, AcceptsPackedPixels) {
    constexpr std::array<std::uint8_t, 126> kPng{
        137, 80,  78,  71,  13,  10,  26,  10, 0,   0,   0,  13,  73, 72, 68,  82,  0,   0,   2,  0,  0,
        0,   2,   0,   1,   3,   0,   0,   0,  206, 182, 70, 185, 0,  0,  0,   3,   80,  76,  84, 69, 128,
        128, 255, 80,  206, 81,  156, 0,   0,  0,   54,  73, 68,  65, 84, 120, 218, 237, 193, 1,  1,  0,
        0,   0,   130, 32,  255, 175, 110, 72, 64,  1,   0,  0,   0,  0,  0,   0,   0,   0,   0,  0,  0,
        0,   0,   0,   0,   0,   0,   0,   0,  0,   0,   0,  0,   0,  0,  0,   0,   0,   0,   0,  0,  124,
        27,  130, 0,   0,   1,   99,  117, 80, 164, 0,   0,  0,   0,  73, 69,  78,  68,  174, 66, 96, 130};
    const auto view = std::as_bytes(std::span(kPng));
    const ImageInfo info = read_image_info(view);
    EXPECT_EQ(info.width, 512);
    EXPECT_EQ(info.height, 512);
    const ImageF image = read_image_float(view);
    EXPECT_NEAR(image.pixel(511, 511)[0], 0.5f, 0.01f);
}

TEST(ReadImage, AcceptsTheMostCompressibleImages) {
    const TemporaryFolder folder;
    const std::vector<float> black(2048 * 1024 * 3);
    for (const char* name : {"a.png", "a.jpg", "a.tif"}) {
        const auto path = write_reference(folder / name, {2048, 1024, 3, OIIO::TypeDesc::UINT8}, black);
        EXPECT_EQ(error_of(path), "") << name;
    }
    EXPECT_EQ(error_of(write_reference(folder / "a.hdr", {2048, 1024, 3, OIIO::TypeDesc::FLOAT}, black)), "");
    for (const char* compression : {"zip", "piz", "rle", "b44a", "dwab"}) {
        OIIO::ImageSpec spec(2048, 1024, 3, OIIO::TypeDesc::HALF);
        spec.attribute("compression", compression);
        EXPECT_EQ(error_of(write_reference(folder / "a.exr", spec, black)), "") << compression;
    }
}

TEST(ReadImage, RefusesStripsThatDoNotInflate) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(64, 64, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("compression", "zip");
    spec.attribute("tiff:RowsPerStrip", 16);
    std::vector<float> noise(64 * 64 * 3);
    std::mt19937 random(3);
    for (float& value : noise) value = std::uniform_real_distribution<float>()(random);
    auto bytes = read_all(write_reference(folder / "a.tif", spec, noise));
    EXPECT_EQ(error_of(std::span(bytes)), "");
    for (const std::size_t third : {1, 2}) {
        auto bad = bytes;
        for (std::size_t i = 0; i < 40; i += 4) bad[bad.size() * third / 3 + i] ^= std::byte{0xff};
        EXPECT_NE(error_of(std::span(bad)), "") << third;
    }
}

// Cut and damaged files of every format: an error or some pixels, never a crash, whatever the sanitizers watch.
TEST(ReadImage, SurvivesDamage) {
    const TemporaryFolder folder;
    std::mt19937 random(7);
    for (const char* name : kFileOfEveryFormat) {
        const OIIO::ImageSpec spec = spec_of_sample(name, 24, 16);
        const auto bytes = read_all(write_reference(folder / name, spec, ramp<float>(24 * 16 * 3, 0.0007)));
        for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 31) {
            (void)error_of(std::span(bytes).first(length));
        }
        for (int round = 0; round < 40; ++round) {
            auto damaged = bytes;
            for (int i = 0; i < 3; ++i) damaged[random() % damaged.size()] = static_cast<std::byte>(random() % 256);
            (void)error_of(damaged);
        }
    }
}

/// While it lives, this process gets no more than `bytes` more memory, as under 'ulimit -v'.
class MemoryLimit {
  public:
    explicit MemoryLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_AS, &old_);
        std::ifstream statm("/proc/self/statm");
        rlim_t pages = 0;
        statm >> pages;
        const rlimit limit{pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + bytes, old_.rlim_max};
        EXPECT_EQ(::setrlimit(RLIMIT_AS, &limit), 0);
    }
    ~MemoryLimit() { ::setrlimit(RLIMIT_AS, &old_); }
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;

  private:
    rlimit old_{};
};

TEST(ReadImage, ALackOfMemoryIsNoFaultOfTheImage) {
    if (test::kHasSanitizers) GTEST_SKIP() << "sanitizers take more address space than can be limited";
    const TemporaryFolder folder;
    // 144 MiB of floats, which are never part of what has been freed before, as the 64 MiB of a thread's heap are.
    constexpr int kWidth = 2048, kHeight = 6144;
    constexpr std::size_t kValues = std::size_t{kWidth} * kHeight * 3;
    const auto png = write_reference(folder / "a.png", {kWidth, kHeight, 3, OIIO::TypeDesc::UINT8},
                                     std::vector<std::uint8_t>(kValues));
    const auto exr =
        write_reference(folder / "a.exr", {kWidth, kHeight, 3, OIIO::TypeDesc::FLOAT}, std::vector<float>(kValues));
    (void)read_image_float(png);
    (void)read_image_levels(exr);
    const LayeredImage layers = read_layers(exr);
    const MemoryLimit limit(rlim_t{16} << 20);
    EXPECT_THROW((void)read_image_float(png), std::bad_alloc);
    EXPECT_THROW((void)read_image_float(exr), std::bad_alloc);
    EXPECT_THROW((void)read_image_levels(exr), std::bad_alloc);
    EXPECT_THROW((void)read_channels(exr), std::bad_alloc);
    EXPECT_THROW((void)read_layer(exr, layers.layers.front()), std::bad_alloc);
}

TEST(ReadImage, AHalfPngIsAnError) {
    const TemporaryFolder folder;
    const auto path =
        write_reference(folder / "a.png", {64, 64, 3, OIIO::TypeDesc::UINT8}, ramp<float>(64 * 64 * 3, 8e-5));
    auto bytes = read_all(path);
    bytes.resize(bytes.size() / 2);
    EXPECT_NE(error_of(bytes), "");
}

}  // namespace

}  // namespace etendue
