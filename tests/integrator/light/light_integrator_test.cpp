// What single light paths bring to the film, in scenes where it is known.
#include "bsdf/spectral_response.h"
#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

std::vector<Rgb> rendered(const SceneDesc& scene, const std::string& integrator, std::uint32_t spp) {
    return render_pixels(scene, *make_integrator(integrator, {}), SampleSequence::Sobol, spp, 1,
                         "Linear Rec.709 (sRGB)");
}

Rgb sum_of(const std::vector<Rgb>& pixels) {
    Rgb sum;
    for (const Rgb& pixel : pixels) sum += pixel;
    return sum;
}

// What falls beyond one edge of the film falls into the pixels at the other, as far as the filter reaches: without
// that, a tenth of their light would be missing. Of 65,536 light paths each sees a lamp around, and five deviations of
// the mean of 32 pixels are below 4%.
TEST(LightIntegrator, APanoramaHasNoSeam) {
    SceneDesc scene;
    add(scene, sphere({0.0f, 0.0f, 0.0f}, 1.0f, 3, Facing::Inwards), emitter(1.0f));
    look(scene, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f});
    scene.cameras[0].type = CameraType::Equirectangular;
    const std::vector<Rgb> pixels = render_pixels(scene, *make_integrator("light", {}), SampleSequence::Sobol, 256, 1,
                                                  "Linear Rec.709 (sRGB)", FilterShape::BlackmanHarris);
    Rgb at_seam;
    for (std::size_t row = 0; row < kImageSide; ++row)
        at_seam += (pixels[row * kImageSide] + pixels[(row + 1) * kImageSide - 1]) * (0.5f / kImageSide);
    EXPECT_NEAR(at_seam.g, 1.0f, 0.04f);
}

/// A body that reflects nothing, of which a quarter of the light passes one metre.
MaterialDesc absorbing_air() {
    MaterialDesc m;
    m.metallic = 0.0f;
    m.roughness = 0.0f;
    m.transmission = 1.0f;
    m.ior = 1.0f;
    m.volume = {.closed = true, .attenuation_color = Rgb(0.25f), .attenuation_distance = 1.0f};
    return m;
}

// All of the lamp is in the parallel view and faces it, so that every light path leaves the same splat.
TEST(LightIntegrator, ALampIsSeenThroughTheBodyThatItLiesIn) {
    SceneDesc scene;
    add(scene, sphere({0.0f, 0.0f, 0.0f}, 10.0f, 2, Facing::Outwards), absorbing_air());
    add(scene, parallelogram({0.1f, -0.2f, -2.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.5f, 0.0f}), emitter(3.0f));
    look(scene, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, 1.0f);
    const double mean = static_cast<double>(sum_of(rendered(scene, "light", 4)).g) / (kImageSide * kImageSide);
    constexpr double kShareOfView = 1.0 * 0.5 / (2.0 * 2.0);
    EXPECT_NEAR(mean, 3.0 * kShareOfView * std::pow(0.25, 2.0), 1e-5);
}

/// Where light of a wavelength leaves the slab below, metres from where it enters.
double shift_in_slab(float ior, float dispersion, float nm) {
    const double sine = std::sin(kPiD / 3.0) / static_cast<double>(dispersed_ior(ior, dispersion, nm));
    return sine / std::sqrt(1.0 - sine * sine);
}

// A white beam falls at 60 degrees on a smooth slab of glass, 1 m thick, which shifts each wavelength by another length
// before it lights the floor: the centroid of a channel lies where its wavelengths do in the mean. Of 32,768 light
// paths five deviations are less than 4% of the distance from red to blue and of the light.
TEST(LightIntegrator, ASmoothPrismShiftsEveryWavelengthByItsOwnIndex) {
    constexpr float kIor = 1.6f;
    constexpr float kDispersion = 4.0f;
    SceneDesc scene;
    MaterialDesc glass;
    glass.override_model = DielectricDesc{kIor, 0.0f, {.closed = true, .dispersion = kDispersion}};
    // Its sides do not matter, but a body must be closed.
    add(scene, box({-1.0f, 1.0f, -1.0f}, {0.9f, 2.0f, 1.0f}), glass);
    const float to_floor = std::sqrt(3.0f);
    const float middle = to_floor + static_cast<float>(shift_in_slab(kIor, kDispersion, 550.0f));
    add(scene, quad_facing_up({middle, 0.0f, 0.0f}, 2.0f), diffuse(kAlbedo));
    const Vec3f beam(0.5f * std::sqrt(3.0f), -0.5f, 0.0f);
    LightDesc& spot = add_light(scene, LightType::Spot, 1e5f, Vec3f(0.0f, 2.0f, 0.0f) - beam, beam);
    spot.outer_cone_angle = 0.005f;
    // Up in the image is +X.
    constexpr float kHalf = 0.15f;
    look(scene, {middle, 3.0f, 0.0f}, {0.0f, -1.0f, 0.0f}, kHalf);

    const SpectralResponse response;
    Rgb weights;
    Rgb shifts;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i) {
        const Wavelength w = response.sample((static_cast<float>(i) + 0.5f) / kSteps);
        weights += w.weight;
        shifts += w.weight * static_cast<float>(shift_in_slab(kIor, kDispersion, w.nm));
    }
    const double expected = static_cast<double>(shifts.r / weights.r - shifts.b / weights.b);
    ASSERT_GT(std::abs(expected), 0.02);

    for (const std::string integrator : {"light", "bdpt"}) {
        const std::vector<Rgb> pixels = rendered(scene, integrator, 128);
        const Rgb sum = sum_of(pixels);
        ASSERT_GT(sum.g, 0.0f) << integrator;
        EXPECT_NEAR(sum.r / sum.g, 1.0f, 0.04f) << integrator;
        EXPECT_NEAR(sum.b / sum.g, 1.0f, 0.04f) << integrator;
        Rgb places;
        for (std::size_t p = 0; p < pixels.size(); ++p) {
            const std::size_t row = p / kImageSide;
            places += pixels[p] * (kHalf * (1.0f - 2.0f * (static_cast<float>(row) + 0.5f) / kImageSide));
        }
        EXPECT_NEAR(static_cast<double>(places.r / sum.r - places.b / sum.b), expected, 0.04 * std::abs(expected))
            << integrator;
    }
}

}  // namespace

}  // namespace etendue::test
