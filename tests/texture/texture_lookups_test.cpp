#include "texture/texture_lookups.h"

#include "support/random.h"
#include "texture/test_images.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

Image8 noise(Random& random, int width, int height, int channels) {
    Image8 image(width, height, channels);
    for (std::uint8_t& value : image.pixels) value = static_cast<std::uint8_t>(256.0f * random.next());
    return image;
}

/// Textures of all channels, wraps and encodings, of sizes that are no powers of two either.
std::vector<Texture> usual_textures(Random& random) {
    std::vector<Texture> textures;
    for (const int channels : {1, 2, 3, 4})
        for (const Wrap wrap_u : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
            for (const Wrap wrap_v : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
                for (const Encoding encoding : {Encoding::Linear, Encoding::Srgb})
                    textures.push_back(
                        make_texture(noise(random, channels == 2 ? 37 : 64, channels == 3 ? 19 : 32, channels),
                                     {.wrap_u = wrap_u, .wrap_v = wrap_v, .encoding = encoding}));
    // Single texels, rows and columns, and an image without levels.
    textures.push_back(make_texture(noise(random, 1, 1, 3), {}));
    textures.push_back(make_texture(noise(random, 1, 9, 4), {.wrap_u = Wrap::Clamp}));
    textures.push_back(make_texture(noise(random, 9, 1, 1), {.wrap_v = Wrap::Mirror}));
    textures.push_back(Texture::without_levels(noise(random, 12, 10, 3), {}));
    return textures;
}

/// Textures that are looked up one by one.
std::vector<Texture> unusual_textures(Random& random) {
    std::vector<Texture> textures;
    textures.push_back(make_texture(noise(random, 16, 16, 3), {.nearest = true}));
    textures.push_back(make_texture(noise(random, 16, 16, 3), {.nearest_minified = true}));
    textures.push_back(make_texture(noise(random, 16, 16, 3), {.mip_filter = MipFilter::None}));
    textures.push_back(make_texture(noise(random, 16, 16, 3), {.mip_filter = MipFilter::Nearest}));
    ImageF image(8, 8, 3);
    for (float& value : image.pixels) value = 4.0f * random.next();
    textures.push_back(make_texture(std::move(image), {}));
    return textures;
}

struct Query {
    const Texture* texture;
    Vec2f uv;
    TextureFootprint footprint;
};

std::vector<Query> queries(Random& random, const std::vector<Texture>& textures, std::size_t count) {
    std::vector<Query> result;
    for (std::size_t i = 0; i < count; ++i) {
        const auto signed_number = [&] { return 2.0f * random.next() - 1.0f; };
        // From no footprint over less than a texel to more than the image.
        const float size = i % 7 == 0 ? 0.0f : std::exp2(-9.0f + 10.0f * random.next());
        const float width = random.next() * size;
        const float turn = 2.0f * kPi * random.next();
        result.push_back(
            {&textures[i % textures.size()],
             {3.0f * signed_number(), 3.0f * signed_number()},
             {{Vec2f(std::cos(turn), std::sin(turn)) * size, Vec2f(-std::sin(turn), std::cos(turn)) * width}}});
    }
    return result;
}

TEST(TextureLookups, AreThoseOfEachTexture) {
    Random random(7);
    std::vector<Texture> textures = usual_textures(random);
    for (Texture& texture : unusual_textures(random)) textures.push_back(std::move(texture));
    TextureLookups lookups;
    constexpr std::size_t kCount = 30'000;
    const std::vector<Query> asked = queries(random, textures, kCount);
    for (const Query& query : asked) lookups.add(*query.texture, query.uv, query.footprint);
    lookups.finish();
    // Where a rounding decides on a tap more or less, the values differ.
    std::size_t different = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
        const Rgb expected = asked[i].texture->lookup(asked[i].uv, asked[i].footprint).rgb;
        const Rgb found = lookups[i];
        if (max_component(Rgb(std::abs(found.r - expected.r), std::abs(found.g - expected.g),
                              std::abs(found.b - expected.b))) > 2e-5f)
            ++different;
    }
    EXPECT_LE(different, 3u);
}

TEST(TextureLookups, AreTheSameWhateverIsLookedUpBesides) {
    Random random(8);
    const std::vector<Texture> textures = usual_textures(random);
    const std::vector<Query> asked = queries(random, textures, 200);
    TextureLookups together;
    for (const Query& query : asked) together.add(*query.texture, query.uv, query.footprint);
    together.finish();
    TextureLookups alone;
    for (std::size_t i = 0; i < asked.size(); ++i) {
        alone.clear();
        alone.add(*asked[i].texture, asked[i].uv, asked[i].footprint);
        alone.finish();
        EXPECT_EQ(alone[0], together[i]) << i;
    }
}

TEST(TextureLookups, ReadWhatIsNoNumberAsTheTextureDoes) {
    Random random(9);
    const Texture texture = make_texture(noise(random, 16, 16, 3), {});
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const std::vector<Query> asked{{&texture, {kNaN, 0.3f}, {}},
                                   {&texture, {kInfinity, -kInfinity}, {}},
                                   {&texture, {0.3f, 0.4f}, {{{kNaN, 0.0f}, {0.0f, 0.1f}}}},
                                   {&texture, {0.3f, 0.4f}, {{{kInfinity, 0.0f}, {0.0f, 0.1f}}}},
                                   {&texture, {1e30f, 0.4f}, {{{1e20f, 0.0f}, {0.0f, 1e20f}}}}};
    TextureLookups lookups;
    for (const Query& query : asked) lookups.add(*query.texture, query.uv, query.footprint);
    lookups.finish();
    for (std::size_t i = 0; i < asked.size(); ++i) {
        const Rgb expected = asked[i].texture->lookup(asked[i].uv, asked[i].footprint).rgb;
        EXPECT_NEAR(lookups[i].r, expected.r, 1e-6f) << i;
        EXPECT_NEAR(lookups[i].b, expected.b, 1e-6f) << i;
    }
}

}  // namespace

}  // namespace etendue::test
