#include "texture/cube_map.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace etendue {
namespace {

constexpr int kSide = 8;

/// Face f has red f, green the column's centre and blue the row's, both from 0 to 1.
CubeMap numbered() {
    std::array<ImageF, 6> faces;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        faces[f] = ImageF(kSide, kSide, 3);
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const auto pixel = faces[f].pixel(x, y);
                pixel[0] = static_cast<float>(f);
                pixel[1] = (static_cast<float>(x) + 0.5f) / kSide;
                pixel[2] = (static_cast<float>(y) + 0.5f) / kSide;
            }
    }
    return CubeMap(std::move(faces));
}

TEST(CubeMap, EachAxisHasItsFace) {
    const CubeMap cube = numbered();
    const Vec3f axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (std::size_t f = 0; f < 6; ++f) {
        const Rgb value = cube.lookup(axes[f] * 3.0f);
        EXPECT_EQ(value.r, static_cast<float>(f));
        EXPECT_NEAR(value.g, 0.5f, 1e-6f);
        EXPECT_NEAR(value.b, 0.5f, 1e-6f);
    }
    EXPECT_EQ(cube.side(), kSide);
}

// Who stands inside and looks along an axis has the right of the image at their right, and its top above.
TEST(CubeMap, FacesAreSeenFromInside) {
    struct View {
        Vec3f forward, up;
    };
    const View views[] = {{{1, 0, 0}, {0, 1, 0}},  {{-1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {0, 0, -1}},
                          {{0, -1, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 1, 0}},  {{0, 0, -1}, {0, 1, 0}}};
    const CubeMap cube = numbered();
    for (std::size_t f = 0; f < 6; ++f) {
        const auto& [forward, up] = views[f];
        const Vec3f right = cross(forward, up);
        for (const float x : {-0.7f, 0.2f, 0.8f})
            for (const float y : {-0.6f, 0.1f, 0.7f}) {
                const Rgb value = cube.lookup(normalize(forward + right * x + up * y));
                EXPECT_EQ(value.r, static_cast<float>(f));
                EXPECT_NEAR(value.g, 0.5f + 0.5f * x, 1e-5f);
                EXPECT_NEAR(value.b, 0.5f - 0.5f * y, 1e-5f);
            }
    }
}

TEST(CubeMap, CornersAreDefined) {
    const CubeMap cube = numbered();
    for (const float x : {-1.0f, 1.0f})
        for (const float y : {-1.0f, 1.0f})
            for (const float z : {-1.0f, 1.0f}) EXPECT_TRUE(is_finite(cube.lookup({x, y, z})));
}

}  // namespace
}  // namespace etendue
