#include "texture/texel_pair.h"

#include "core/wide.h"
#include "texture/wrap.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

template <typename T>
TexelPair<T> pair(float coordinate, int size, Wrap wrap) {
    const auto mask = [](bool set) { return T(set ? 1.0f : 0.0f) > T(0.0f); };
    return texel_pair(T(coordinate), T(static_cast<float>(size)),
                      WrapMode<T>{mask(wrap == Wrap::Clamp), mask(wrap == Wrap::Mirror)});
}

TEST(TexelPair, IsTheTwoTexelsThatTheWrapSays) {
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
        for (const int size : {1, 2, 3, 8, 13, 4096})
            for (int step = -600; step <= 600; ++step) {
                const float coordinate = static_cast<float>(step) / 128.0f;
                const TexelPair<float> found = pair<float>(coordinate, size, wrap);
                const float x = reduce_coordinate(coordinate, wrap) * static_cast<float>(size) - 0.5f;
                const int left = static_cast<int>(std::floor(x));
                ASSERT_EQ(found.first, static_cast<float>(wrap_index(left, size, wrap)))
                    << coordinate << " of " << size;
                ASSERT_EQ(found.second, static_cast<float>(wrap_index(left + 1, size, wrap)))
                    << coordinate << " of " << size;
                ASSERT_NEAR(found.fraction, x - std::floor(x), 1e-3f);
                const TexelPair<Wide> wide = pair<Wide>(coordinate, size, wrap);
                ASSERT_EQ(wide.first[0], found.first);
                ASSERT_EQ(wide.second[0], found.second);
                ASSERT_EQ(wide.fraction[0], found.fraction);
            }
}

TEST(TexelPair, IsWithinTheImageWhateverTheCoordinate) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp})
        for (const float coordinate : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN(), 3e38f, -3e38f,
                                       -1e-9f, 1e-9f, 1.0f, -1.0f, 2.0f, 0.99999994f, 1.9999999f})
            for (const int size : {1, 2, 5, 65535, 65536}) {
                const TexelPair<Wide> found = pair<Wide>(coordinate, size, wrap);
                for (const float texel : {found.first[0], found.second[0]}) {
                    EXPECT_GE(texel, 0.0f) << coordinate;
                    EXPECT_LT(texel, static_cast<float>(size)) << coordinate;
                }
                EXPECT_GE(found.fraction[0], 0.0f);
                EXPECT_LE(found.fraction[0], 1.0f);
            }
}

}  // namespace

}  // namespace etendue::test
