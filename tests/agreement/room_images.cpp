#include "agreement/matrix_room.h"
#include "core/vec.h"
#include "image/write.h"
#include "world/test_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>

namespace etendue::test {

namespace {

/// An image whose pixel (x, y) is `value` of its centre in [0, 1]².
template <typename Value>
ImageF image_of(int width, int height, const Value& value) {
    ImageF image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::array<float, 3> rgb = value((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                                   (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
            std::copy(rgb.begin(), rgb.end(), image.pixel(x, y).begin());
        }
    return image;
}

/// Waves that turn normals by up to half a radian, more one way than the other.
std::array<float, 3> wavy_normal(float u, float v) {
    const Vec3f n = normalize(Vec3f(0.4f * std::sin(8.0f * kPi * u) + 0.1f, 0.4f * std::cos(4.0f * kPi * v), 1.0f));
    return {0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z};
}

/// Dark and bright patches of different colours.
std::array<float, 3> patches(float u, float v) {
    return {0.5f + 0.5f * u, v < 0.75f ? 1.0f : 0.5f, 0.75f + 0.25f * std::sin(6.0f * kPi * u)};
}

/// A bright patch in a sky that is lighter above.
std::array<float, 3> sky(float u, float v) {
    const float du = u - 0.3f;
    const float dv = v - 0.3f;
    const float sun = 4.0f * std::exp(-60.0f * (du * du + dv * dv));
    return {0.4f + sun, 0.5f + 0.8f * sun, 0.9f - 0.5f * v + 0.5f * sun};
}

}  // namespace

RoomImages::RoomImages() : directory_(temporary_file("agreement")) {
    std::filesystem::create_directories(directory_);
    write_image(normals(), image_of(kTextureSize, kTextureSize, wavy_normal), {.depth = PixelDepth::UInt8});
    write_image(emission(), image_of(kTextureSize, kTextureSize, patches), {.depth = PixelDepth::UInt8});
    write_image(environment(), image_of(32, 16, sky), {.depth = PixelDepth::Float});
}

RoomImages::~RoomImages() {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
}

}  // namespace etendue::test
