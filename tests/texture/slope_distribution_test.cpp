// Spreads of slopes against sums over the texels of normal maps.
#include "texture/slope_distribution.h"

#include "image/image_test_files.h"
#include "support/random.h"
#include "texture/test_images.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr TextureOptions kUsual{};

/// A normal map of 8 bits whose texel (x, y) has the slope `slope(x, y)`, but for rounding.
Image8 normal_map(int width, int height, const std::function<Vec2f(int, int)>& slope) {
    Image8 image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec2f s = slope(x, y);
            const Vec3f n = normalize(Vec3f(s.x, s.y, 1.0f));
            const auto pixel = image.pixel(x, y);
            for (std::size_t c = 0; c < 3; ++c)
                pixel[c] = static_cast<std::uint8_t>(std::lround(127.5f + 127.5f * n[static_cast<int>(c)]));
        }
    return image;
}

/// The slope that a texel of such a map holds after rounding.
Vec2f stored_slope(const Image8& image, int x, int y) {
    const auto pixel = image.pixel(x, y);
    const auto component = [&](std::size_t c) { return static_cast<float>(pixel[c]) / 127.5f - 1.0f; };
    return {component(0) / component(2), component(1) / component(2)};
}

Texture slopes_of(const Image8& image, const TextureOptions& options = kUsual) {
    MipChain chain = make_chain(image, Encoding::Linear);
    chain.keep_slopes(!options.nearest);
    return {std::move(chain), options};
}

/// A round footprint of this diameter, in texture coordinates.
TextureFootprint around(float diameter) {
    return {{Vec2f(diameter, 0.0f), Vec2f(0.0f, diameter)}};
}

void expect_near(const SlopeCovariance& covariance, const SlopeCovariance& expected, float tolerance) {
    EXPECT_NEAR(covariance.xx, expected.xx, tolerance);
    EXPECT_NEAR(covariance.xy, expected.xy, tolerance);
    EXPECT_NEAR(covariance.yy, expected.yy, tolerance);
}

// Half of the slopes are (a, b), half are (-a, -b): their covariance is a², ab, b², at every mip level. Between texels
// that differ, interpolation leaves a third along each axis: the mean of (1 - 2t)². Normals are interpolated rather
// than slopes, and covariances stored in 16-bit floats.
TEST(SlopeDistribution, OfTwoSlopesIsTheSquareOfHalfTheirDifference) {
    const Vec2f slope(0.4f, -0.2f);
    const auto expect_share = [&](const Image8& image, bool nearest, float share) {
        const Vec2f stored = stored_slope(image, 0, 0);
        const Texture texture = slopes_of(image, {.nearest = nearest});
        for (const float texels : {2.0f, 2.7f, 4.0f, 7.0f})
            expect_near(texture.slope_covariance({0.3f, 0.6f}, around(texels / 64.0f)),
                        {share * stored.x * stored.x, share * stored.x * stored.y, share * stored.y * stored.y}, 1e-3f);
    };
    const Image8 checkered = normal_map(64, 64, [&](int x, int y) { return (x + y) % 2 == 0 ? slope : -slope; });
    expect_share(checkered, true, 1.0f);
    expect_share(checkered, false, 1.0f / 9.0f);
    const Image8 striped = normal_map(64, 64, [&](int x, int) { return x % 2 == 0 ? slope : -slope; });
    expect_share(striped, true, 1.0f);
    expect_share(striped, false, 1.0f / 3.0f);
}

TEST(SlopeDistribution, IsZeroWhereTheMapIsMagnified) {
    const Image8 image = normal_map(32, 32, [](int x, int) { return Vec2f(x % 2 == 0 ? 0.5f : -0.5f, 0.0f); });
    const Texture texture = slopes_of(image);
    for (const float texels : {0.0f, 0.3f, 0.999f}) {
        const SlopeCovariance covariance = texture.slope_covariance({0.31f, 0.6f}, around(texels / 32.0f));
        EXPECT_EQ(covariance.xx, 0.0f);
        EXPECT_EQ(covariance.yy, 0.0f);
    }
    // It grows from nothing.
    EXPECT_LT(texture.slope_covariance({0.31f, 0.6f}, around(1.01f / 32.0f)).xx, 0.01f);
    EXPECT_GT(texture.slope_covariance({0.31f, 0.6f}, around(1.5f / 32.0f)).xx, 0.03f);
}

TEST(SlopeDistribution, OfAFlatMapIsExactlyZero) {
    for (const std::array<std::uint8_t, 3>& texel :
         {std::array<std::uint8_t, 3>{128, 128, 255}, {127, 127, 255}, {200, 90, 220}, {255, 128, 128}}) {
        for (const int width : {64, 37}) {
            Image8 image(width, 23, 3);
            for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = texel[i % 3];
            const Texture texture = slopes_of(image);
            for (const float diameter : {0.05f, 0.2f, 1.0f, 3.0f}) {
                const TextureFootprint footprint{{Vec2f(diameter, 0.0f), Vec2f(0.0f, 0.3f * diameter)}};
                EXPECT_LT(texture.slope_covariance({0.4f, 0.7f}, footprint).trace(), 1e-9f);
            }
        }
    }
}

// What the coarsest level holds is what sums over all texels give, also where sides do not halve evenly.
TEST(SlopeDistribution, OfTheWholeMapIsThatOfItsTexels) {
    for (const auto [width, height] : {std::array{64, 64}, std::array{61, 35}}) {
        Random random(9);
        const Image8 image = normal_map(width, height, [&](int x, int) {
            return Vec2f(0.6f * random.next() - 0.2f, 0.01f * static_cast<float>(x) - 0.3f * random.next());
        });
        double m[5]{};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const Vec2f s = stored_slope(image, x, y);
                const double terms[5] = {s.x, s.y, s.x * s.x, s.x * s.y, s.y * s.y};
                for (int i = 0; i < 5; ++i) m[i] += terms[i] / (width * height);
            }
        const SlopeCovariance expected{static_cast<float>(m[2] - m[0] * m[0]), static_cast<float>(m[3] - m[0] * m[1]),
                                       static_cast<float>(m[4] - m[1] * m[1])};
        expect_near(slopes_of(image, {.nearest = true}).slope_covariance({0.5f, 0.5f}, around(9.0f)), expected, 2e-4f);
    }
}

// The same where the map is interpolated: against 64 look-ups in each texel.
TEST(SlopeDistribution, OfTheWholeMapIsThatOfLookUpsInIt) {
    Random random(10);
    const Image8 image =
        normal_map(32, 16, [&](int, int) { return Vec2f(0.6f * random.next() - 0.3f, 0.5f * random.next() - 0.1f); });
    const Texture texture = slopes_of(image, {.wrap_u = Wrap::Clamp, .wrap_v = Wrap::Clamp});
    double m[5]{};
    for (int y = 0; y < 8 * 16; ++y)
        for (int x = 0; x < 8 * 32; ++x) {
            const Vec2f uv((static_cast<float>(x) + 0.5f) / 256.0f, (static_cast<float>(y) + 0.5f) / 128.0f);
            const SlopeMoments terms = moments_of(slope_of(texture.lookup(uv).rgb));
            for (std::size_t i = 0; i < terms.size(); ++i) m[i] += static_cast<double>(terms[i]) / (8 * 16 * 8 * 32);
        }
    const SlopeCovariance expected{static_cast<float>(m[2] - m[0] * m[0]), static_cast<float>(m[3] - m[0] * m[1]),
                                   static_cast<float>(m[4] - m[1] * m[1])};
    expect_near(texture.slope_covariance({0.5f, 0.5f}, around(9.0f)), expected, 3e-4f);
}

// A mixture of mixtures is that of all parts, whatever the order.
TEST(SlopeDistribution, MixesAsItsMomentsDo) {
    Random random(4);
    const auto any = [&] {
        const Vec2f mean(random.next(), random.next());
        const float xx = random.next();
        const float yy = random.next();
        return SlopeDistribution{mean, {xx, 0.5f * std::sqrt(xx * yy), yy}};
    };
    for (int i = 0; i < 100; ++i) {
        const SlopeDistribution a = any();
        const SlopeDistribution b = any();
        const float t = random.next();
        const SlopeDistribution mixed = mix(a, b, t);
        const auto raw = [&](const SlopeDistribution& d) {
            return SlopeMoments{d.mean.x, d.mean.y, d.covariance.xx + d.mean.x * d.mean.x,
                                d.covariance.xy + d.mean.x * d.mean.y, d.covariance.yy + d.mean.y * d.mean.y};
        };
        SlopeMoments sum;
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] = (1.0f - t) * raw(a)[c] + t * raw(b)[c];
        expect_near(mixed.covariance, distribution_of(sum).covariance, 1e-5f);
        EXPECT_NEAR(mixed.mean.x, sum[0], 1e-6f);
    }
}

// Taps along a thin footprint see different slopes, each within a texel: what differs between them counts.
TEST(SlopeDistribution, OfThinFootprintsIsThatAlongThem) {
    const Image8 image = normal_map(64, 64, [](int x, int) { return Vec2f(x % 4 < 2 ? 0.4f : -0.4f, 0.0f); });
    const Texture texture = slopes_of(image);
    const TextureFootprint across{{Vec2f(8.0f / 64.0f, 0.0f), Vec2f(0.0f, 0.5f / 64.0f)}};
    const TextureFootprint along{{Vec2f(0.0f, 8.0f / 64.0f), Vec2f(0.5f / 64.0f, 0.0f)}};
    EXPECT_GT(texture.slope_covariance({0.5f, 0.5f}, across).xx, 0.07f);
    EXPECT_LT(texture.slope_covariance({0.5f + 1.0f / 64.0f, 0.5f}, along).xx, 1e-6f);
}

TEST(SlopeDistribution, SamplersThatForbidMipLevelsForbidIt) {
    const Image8 image = normal_map(32, 32, [](int x, int) { return Vec2f(x % 2 == 0 ? 0.5f : -0.5f, 0.0f); });
    EXPECT_TRUE(
        slopes_of(image, {.mip_filter = MipFilter::None}).slope_covariance({0.3f, 0.3f}, around(0.5f)).is_zero());
    EXPECT_GT(slopes_of(image, {.mip_filter = MipFilter::Nearest}).slope_covariance({0.3f, 0.3f}, around(0.5f)).xx,
              0.07f);
}

TEST(SlopeDistribution, NormalsThatAreNoneAreFlatAndSteepOnesBounded) {
    EXPECT_EQ(slope_of({0.9f, 0.5f, 0.4f}), Vec2f(0.0f, 0.0f));
    EXPECT_EQ(slope_of({0.5f, 0.5f, 0.5f}), Vec2f(0.0f, 0.0f));
    const Vec2f steep = slope_of({0.99f, 0.2f, 0.51f});
    EXPECT_NEAR(std::hypot(steep.x, steep.y), kSteepestSlope, 1e-5f);
    EXPECT_NEAR(steep.y / steep.x, -0.6f / 0.98f, 1e-5f);
}

// The cache averages moments as floats. In memory mean slopes are those of mean normals, which 8 bits round by 0.004:
// where two that are 0.4 apart are mixed, that is up to 2 * 0.4 * 0.008 / 4 = 0.0016. Of a map that is interpolated the
// cache knows the means, too, where those in memory are of texels.
TEST(SlopeDistribution, IsTheSameThroughTheCache) {
    const TemporaryFolder folder;
    Random random(6);
    const Image8 image = normal_map(128, 128, [&](int x, int y) {
        return Vec2f(0.3f * std::sin(0.4f * static_cast<float>(x)),
                     0.4f * random.next() + 0.002f * static_cast<float>(y));
    });
    const auto by_rows = write_reference(folder / "a.png", {128, 128, 3, OIIO::TypeDesc::UINT8}, image.pixels);
    OIIO::ImageSpec tiled(128, 128, 3, OIIO::TypeDesc::UINT8);
    tiled.tile_width = tiled.tile_height = 32;
    const auto by_tiles = write_reference(folder / "a.tif", tiled, image.pixels);
    for (const bool nearest : {true, false})
        for (const std::filesystem::path& file : {by_rows, by_tiles}) {
            const TextureOptions options{.nearest = nearest};
            const Texture resident = slopes_of(image, options);
            TextureCache cache(std::uint64_t{16} << 20);
            const Texture cached(cache.add_normal_map(file, !nearest), options);
            for (int i = 0; i < 500; ++i) {
                const Vec2f uv = random.next_2d();
                const TextureFootprint footprint = around(std::exp2(-7.5f * random.next()));
                expect_near(cached.slope_covariance(uv, footprint), resident.slope_covariance(uv, footprint),
                            nearest ? 2e-3f : 4e-3f);
            }
            EXPECT_EQ(cache.failed_lookups(), 0u) << cache.first_failure();
        }
}

}  // namespace

}  // namespace etendue::test
