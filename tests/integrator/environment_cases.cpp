#include "image/write.h"
#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include <unistd.h>

namespace etendue::test {

namespace {

/// Writes a latitude-longitude image of max(0, direction · axis) and returns its path. It lives as long as the program.
std::filesystem::path cosine_image(const std::string& name, const Vec3f& axis) {
    constexpr int kWidth = 256;
    constexpr int kHeight = 128;
    ImageF image(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y) {
        const float theta = kPi * (static_cast<float>(y) + 0.5f) / kHeight;
        for (int x = 0; x < kWidth; ++x) {
            const float phi = 2.0f * kPi * ((static_cast<float>(x) + 0.5f) / kWidth - 0.5f);
            const Vec3f direction(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
            std::ranges::fill(image.pixel(x, y), std::max(0.0f, dot(direction, axis)));
        }
    }
    const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                       ("etendue_closed_form_" + std::to_string(getpid()) + "_" + name + ".exr");
    write_image(path, image, {.depth = PixelDepth::Float});
    return path;
}

}  // namespace

std::vector<ClosedFormCase> environment_cases() {
    std::vector<ClosedFormCase> cases;
    SceneDesc convex;
    set_environment(convex);
    convex.environment.color = Rgb(0.5f);
    convex.environment.scale = 1.4f;
    add(convex, sphere({0.0f, 0.0f, 0.0f}, 1.0f, 2, Facing::Outwards), diffuse(0.6f));
    look(convex, {0.0f, 0.0f, 3.0f}, {0.0f, 0.0f, -1.0f}, 0.6f);
    cases.push_back({"environment_on_convex_body", convex, 0.6 * 0.7});

    SceneDesc seen = convex;
    seen.cameras.clear();
    look(seen, {0.0f, 0.0f, 3.0f}, {0.0f, 0.0f, 1.0f});
    cases.push_back({.name = "environment_seen", .scene = seen, .radiance = 0.7, .is_exact = true});

    // The integral of the squared cosine over the hemisphere is 2 pi / 3. The image's bilinear cells cost 1e-4.
    constexpr double kRadiance = 0.6 * 2.0 / 3.0;
    SceneDesc above;
    set_environment(above, cosine_image("above", {0.0f, 1.0f, 0.0f}));
    add(above, quad_facing_up({0.0f, 0.0f, 0.0f}, 10.0f), diffuse(0.6f));
    look(above, {0.1f, 1.0f, 0.2f}, {0.0f, -1.0f, 0.0f});
    cases.push_back({"environment_cosine_lobe", above, kRadiance, 5e-4});

    // A quarter turn counter-clockwise, seen from above, takes -Z to -X.
    SceneDesc turned;
    set_environment(turned, cosine_image("ahead", {0.0f, 0.0f, -1.0f}));
    turned.environment.rotation = 0.5f * kPi;
    add(turned, quad({0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 10.0f}, {0.0f, 10.0f, 0.0f}), diffuse(0.6f));
    look(turned, {-1.0f, 0.1f, 0.2f}, {1.0f, 0.0f, 0.0f});
    cases.push_back({"environment_turned", turned, kRadiance, 5e-4});
    return cases;
}

}  // namespace etendue::test
