#include "texture/texture_cache.h"

#include "core/error.h"
#include "core/parallel.h"
#include "image/image_test_files.h"
#include "support/random.h"
#include "texture/test_images.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr std::uint64_t kBudget = std::uint64_t{16} << 20;

std::vector<std::uint8_t> byte_noise(int width, int height, int channels) {
    Random random(11);
    std::vector<std::uint8_t> values(static_cast<std::size_t>(width * height * channels));
    for (std::uint8_t& value : values) value = static_cast<std::uint8_t>(random.next() * 255.99f);
    return values;
}

TextureFootprint random_footprint(Random& random) {
    const float size = std::exp2(-9.0f * random.next());
    const float turn = 2.0f * kPi * random.next();
    const Vec2f along(std::cos(turn) * size, std::sin(turn) * size);
    return {{along, Vec2f(-along.y, along.x) * random.next()}};
}

/// Largest and mean difference of green between both ways to hold `file` over many footprints.
struct Difference {
    float largest = 0.0f;
    float mean = 0.0f;
};

Difference compare(const std::filesystem::path& file, TextureOptions options) {
    TextureCache cache(kBudget);
    const Texture cached(cache.add(file, options.encoding), options);
    const Texture resident(MipChain(read_image_levels(file), options.encoding), options);
    EXPECT_EQ(cached.width(), resident.width());
    EXPECT_EQ(cached.height(), resident.height());
    Difference result;
    Random random(5);
    constexpr int kLookups = 4000;
    for (int i = 0; i < kLookups; ++i) {
        const float u = 4.0f * random.next() - 2.0f;
        const Vec2f uv(u, 4.0f * random.next() - 2.0f);
        const TextureFootprint footprint = i % 4 == 0 ? TextureFootprint{} : random_footprint(random);
        const Texel a = cached.lookup(uv, footprint);
        const Texel b = resident.lookup(uv, footprint);
        const float difference = std::max(std::abs(a.rgb.g - b.rgb.g), std::abs(a.alpha - b.alpha));
        result.largest = std::max(result.largest, difference);
        result.mean += difference / kLookups;
    }
    EXPECT_EQ(cache.failed_lookups(), 0u) << cache.first_failure();
    return result;
}

// Mip levels of both are rounded to 8 bits, the cache's from level to level, under sRGB to 16-bit floats.
TEST(TextureCache, ReadsAsResidentTexturesDo) {
    const TemporaryFolder folder;
    for (const int channels : {1, 3, 4}) {
        const auto file = write_reference(folder / "a.png", {128, 128, channels, OIIO::TypeDesc::UINT8},
                                          byte_noise(128, 128, channels));
        for (const Encoding encoding : {Encoding::Linear, Encoding::Srgb})
            for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp}) {
                const Difference difference = compare(file, {.wrap_u = wrap, .wrap_v = wrap, .encoding = encoding});
                EXPECT_LT(difference.largest, 2.5f / 255.0f) << channels << " channels";
                EXPECT_LT(difference.mean, 0.5f / 255.0f) << channels << " channels";
            }
        std::filesystem::remove(file);
    }
}

TEST(TextureCache, ReadsEveryFilterAsResidentTexturesDo) {
    const TemporaryFolder folder;
    const auto file = write_reference(folder / "a.png", {256, 64, 3, OIIO::TypeDesc::UINT8}, byte_noise(256, 64, 3));
    for (const MipFilter mip : {MipFilter::None, MipFilter::Nearest, MipFilter::Linear}) {
        // Where a point lies between two texels, rounding decides which is nearest.
        const Difference nearest = compare(file, {.nearest = true, .nearest_minified = true, .mip_filter = mip});
        EXPECT_LT(nearest.mean, 2.0f / 255.0f) << static_cast<int>(mip);
        const Difference linear = compare(file, {.mip_filter = mip});
        EXPECT_LT(linear.largest, 3.0f / 255.0f) << static_cast<int>(mip);
    }
}

TEST(TextureCache, KeepsDeepImagesDeep) {
    const TemporaryFolder folder;
    Random random(2);
    std::vector<float> values(64 * 64 * 3);
    for (float& value : values) value = 4.0f * random.next();
    const auto exr = write_reference(folder / "a.exr", {64, 64, 3, OIIO::TypeDesc::FLOAT}, values);
    EXPECT_LT(compare(exr, {}).largest, 1e-5f);
    const auto half = write_reference(folder / "b.exr", {64, 64, 3, OIIO::TypeDesc::HALF}, values);
    EXPECT_LT(compare(half, {}).largest, 4e-3f);
    std::vector<std::uint16_t> deep(64 * 64);
    for (std::uint16_t& value : deep) value = static_cast<std::uint16_t>(random.next() * 65535.0f);
    const auto png = write_reference(folder / "c.png", {64, 64, 1, OIIO::TypeDesc::UINT16}, deep);
    EXPECT_LT(compare(png, {}).largest, 1e-4f);
    EXPECT_LT(compare(png, {.encoding = Encoding::Srgb}).largest, 2e-3f);
}

// OpenImageIO resamples sizes that do not halve where MipChain weights areas; on what is not noise they hardly differ.
TEST(TextureCache, OddSizesDifferLittle) {
    const TemporaryFolder folder;
    std::vector<std::uint8_t> waves(101 * 77);
    for (std::size_t i = 0; i < waves.size(); ++i)
        waves[i] = static_cast<std::uint8_t>(127.5 + 127.0 * std::sin(0.2 * static_cast<double>(i % 101)) *
                                                         std::cos(0.15 * static_cast<double>(i) / 101.0));
    const auto file = write_reference(folder / "a.png", {101, 77, 1, OIIO::TypeDesc::UINT8}, waves);
    const Difference difference = compare(file, {.wrap_u = Wrap::Mirror, .wrap_v = Wrap::Mirror});
    EXPECT_LT(difference.largest, 0.15f);
    EXPECT_LT(difference.mean, 0.02f);
}

/// A tiled TIFF with mip levels, as texture converters write them (.tx); level i is `100 + i` throughout. Those above
/// 4 GB are `big`: BigTIFF, another header with wider offsets.
std::filesystem::path write_tiled_levels(const std::filesystem::path& path, bool big) {
    const auto output = OIIO::ImageOutput::create("tiff");
    for (int level = 0, size = 128; size > 0; ++level, size /= 2) {
        OIIO::ImageSpec spec(size, size, 3, OIIO::TypeDesc::UINT8);
        spec.tile_width = spec.tile_height = 32;
        // Makes levels of what would else be several images.
        spec.attribute("textureformat", "Plain Texture");
        spec.attribute("tiff:bigtiff", big ? 1 : 0);
        const std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size * size * 3),
                                               static_cast<std::uint8_t>(100 + level));
        const auto mode = level == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage;
        EXPECT_TRUE(output->open(path.string(), spec, mode) &&
                    output->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    }
    EXPECT_TRUE(output->close());
    return path;
}

TEST(TextureCache, BothWaysReadTheFilesOwnLevels) {
    const TemporaryFolder folder;
    for (const bool big : {false, true}) {
        SCOPED_TRACE(big);
        // A suffix that says nothing, or lies: the content decides.
        const auto file = write_tiled_levels(folder / "a.tx", big);
        EXPECT_EQ(read_all(file)[2], static_cast<std::byte>(big ? '+' : '*'));
        EXPECT_LT(compare(file, {}).largest, 1e-5f);
        const MipChain resident(read_image_levels(file), Encoding::Linear);
        for (int level = 0; level < 8; ++level)
            EXPECT_NEAR(resident.sample({0.5f, 0.5f}, static_cast<float>(level), false, {}).rgb.r,
                        static_cast<float>(100 + level) / 255.0f, 1e-6f);
    }
}

TEST(TextureCache, ReadsEmbeddedImages) {
    const TemporaryFolder folder;
    const auto file = write_reference(folder / "a.png", {32, 32, 3, OIIO::TypeDesc::UINT8}, byte_noise(32, 32, 3));
    TextureCache cache(kBudget);
    const CachedImage from_file = cache.add(file, Encoding::Srgb);
    const CachedImage from_memory =
        cache.add(std::make_shared<const std::vector<std::byte>>(read_all(file)), Encoding::Srgb);
    for (const float u : {0.1f, 0.4f, 0.8f})
        EXPECT_EQ(from_memory.sample({u, u}, 1.5f, false, {}).rgb, from_file.sample({u, u}, 1.5f, false, {}).rgb);
}

TEST(TextureCache, HoldsNoMoreThanItsBudget) {
    const TemporaryFolder folder;
    const auto file =
        write_reference(folder / "a.png", {2048, 2048, 4, OIIO::TypeDesc::UINT8}, byte_noise(2048, 2048, 4));
    TextureCache cache(std::uint64_t{10} << 20);
    // 32 MiB as 16-bit floats.
    const CachedImage image = cache.add(file, Encoding::Srgb);
    std::uint64_t most = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const Vec2f uv(static_cast<float>(x) / 32.0f, static_cast<float>(y) / 32.0f);
            EXPECT_GT(image.sample(uv, 0.0f, false, {}).alpha, 0.0f);
            most = std::max(most, cache.bytes());
        }
    EXPECT_GT(most, std::uint64_t{5} << 20);
    EXPECT_LT(most, std::uint64_t{12} << 20);
}

TEST(TextureCache, LookUpsDoNotDependOnWhoMakesThem) {
    const TemporaryFolder folder;
    const auto file = write_reference(folder / "a.png", {512, 512, 3, OIIO::TypeDesc::UINT8}, byte_noise(512, 512, 3));
    const auto read = [&](int thread_count) {
        TextureCache cache(kBudget);
        const Texture texture(cache.add(file, Encoding::Srgb), {.encoding = Encoding::Srgb});
        std::vector<Rgb> values(20000);
        const ThreadPool threads(thread_count);
        threads.parallel_for(200, [&](std::size_t block, int) {
            Random random(static_cast<std::uint32_t>(block));
            for (std::size_t i = 0; i < 100; ++i) {
                const Vec2f uv = random.next_2d();
                values[block * 100 + i] = texture.lookup(uv, random_footprint(random)).rgb;
            }
        });
        return values;
    };
    const std::vector<Rgb> alone = read(1);
    EXPECT_EQ(read(2), alone);
    EXPECT_EQ(read(5), alone);
}

TEST(TextureCache, BrokenHeadersAreErrors) {
    const TemporaryFolder folder;
    TextureCache cache(kBudget);
    EXPECT_THROW(static_cast<void>(cache.add(folder / "missing.png", Encoding::Srgb)), IoError);
    EXPECT_THROW(static_cast<void>(cache.add(std::make_shared<const std::vector<std::byte>>(10), Encoding::Srgb)),
                 IoError);
}

TEST(TextureCache, BrokenPixelsAreCountedAndBlack) {
    const TemporaryFolder folder;
    // No PNG: a cut one makes its library leak (cmake/sanitizer_defaults.cpp).
    const auto file = write_reference(folder / "a.exr", {256, 256, 3, OIIO::TypeDesc::HALF}, byte_noise(256, 256, 3));
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    TextureCache cache(kBudget);
    const CachedImage image = cache.add(file, Encoding::Srgb);
    EXPECT_EQ(image.sample({0.5f, 0.95f}, 0.0f, false, {}).rgb, Rgb());
    EXPECT_EQ(cache.failed_lookups(), 1u);
    EXPECT_NE(cache.first_failure().find("pixels are broken"), std::string::npos) << cache.first_failure();
}

}  // namespace

}  // namespace etendue::test
