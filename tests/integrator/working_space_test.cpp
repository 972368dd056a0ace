// The working space must not show where it need not: for one bounce of white light, reflectance times light commutes
// with the change of primaries.
#include "color/color_config.h"
#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

/// A red wall, lit and seen from the front.
SceneDesc red_wall() {
    SceneDesc scene;
    MaterialDesc red;
    red.override_model = DiffuseDesc{{0.7f, 0.08f, 0.05f}};
    add(scene, parallelogram({0.0f, 0.0f, 0.0f}, {4.0f, 0.0f, 0.0f}, {0.0f, 4.0f, 0.0f}), red);
    look(scene, {0.0f, 0.0f, 2.0f}, {0.0f, 0.0f, -1.0f}, 0.5f);
    add_light(scene, LightType::Directional, 2.0f, {0.0f, 5.0f, 0.0f}, {0.0f, -0.6f, -0.8f});
    return scene;
}

std::vector<Rgb> displayed(const SceneDesc& scene, const std::string& space, const std::string& view) {
    const auto integrator = make_integrator("direct", {});
    std::vector<Rgb> pixels = render_pixels(scene, *integrator, SampleSequence::Sobol, 4, 1, space);
    const ColorConfig colors = ColorConfig::built_in();
    const ColorTransform to_display = colors.display_transform(space, colors.default_display(), view, 0.0f);
    for (Rgb& pixel : pixels) pixel = to_display(pixel);
    return pixels;
}

void expect_same_display(const SceneDesc& scene) {
    const ColorConfig colors = ColorConfig::built_in();
    for (const std::string& view : colors.views(colors.default_display())) {
        if (view == "Raw") continue;  // shows the working space's own numbers
        const std::vector<Rgb> wide = displayed(scene, "ACEScg", view);
        const std::vector<Rgb> narrow = displayed(scene, "Linear Rec.709 (sRGB)", view);
        ASSERT_GT(narrow.front().r, 2.0f * narrow.front().g) << view << ": the wall should be red";
        for (std::size_t i = 0; i < wide.size(); ++i) {
            ASSERT_NEAR(wide[i].r, narrow[i].r, 5e-4f) << view;
            ASSERT_NEAR(wide[i].g, narrow[i].g, 5e-4f) << view;
            ASSERT_NEAR(wide[i].b, narrow[i].b, 5e-4f) << view;
        }
    }
}

TEST(WorkingSpace, DoesNotShowInDirectLightOnARedWall) {
    expect_same_display(red_wall());
}

TEST(WorkingSpace, DoesNotShowInRedLightOnAGreyWall) {
    SceneDesc scene = red_wall();
    scene.materials.front() = diffuse(0.5f);
    scene.lights.front().color = {1.0f, 0.1f, 0.05f};
    expect_same_display(scene);
}

TEST(WorkingSpace, RadianceIsTheKnownOneInEachChannel) {
    const auto integrator = make_integrator("path", {});
    const std::vector<Rgb> pixels =
        render_pixels(red_wall(), *integrator, SampleSequence::Sobol, 4, 1, "Linear Rec.709 (sRGB)");
    const float irradiance = 2.0f * 0.8f;
    for (const Rgb& pixel : pixels) {
        ASSERT_NEAR(pixel.r, 0.7f * irradiance * kInvPi, 1e-5f);
        ASSERT_NEAR(pixel.g, 0.08f * irradiance * kInvPi, 1e-5f);
        ASSERT_NEAR(pixel.b, 0.05f * irradiance * kInvPi, 1e-5f);
    }
}

}  // namespace
}  // namespace etendue::test
