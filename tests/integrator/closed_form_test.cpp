// Closed-form scenes × integrators × samplers. All comparisons together fail with probability 0.01 if everything is
// right (Sidak's correction); seeds are fixed, so that what passes goes on passing until code or seeds change.
#include "integrator/closed_form.h"

#include "support/chi2.h"
#include "support/sanitizers.h"
#include "support/t_test.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

struct ClosedFormRun {
    const ClosedFormCase* scene;
    std::string integrator;
    SampleSequence sequence;
    std::uint32_t seed;
};

void PrintTo(const ClosedFormRun& comparison, std::ostream* out) {
    *out << comparison.scene->name;
}

std::vector<ClosedFormCase> all_closed_forms() {
    std::vector<ClosedFormCase> cases;
    for (const auto& list : {direct_light_cases, environment_cases, furnace_cases, far_from_origin_cases, motion_cases,
                             transparency_cases, body_cases, mixed_light_cases, leaning_normal_cases, shape_cases})
        std::ranges::move(list(), std::back_inserter(cases));
    return cases;
}

std::vector<ClosedFormRun> all_comparisons() {
    static const std::vector<ClosedFormCase> cases = all_closed_forms();
    std::vector<ClosedFormRun> comparisons;
    std::uint32_t seed = 999;
    for (std::size_t number = 0; number < cases.size(); ++number) {
        const ClosedFormCase& scene = cases[number];
        for (const std::string& integrator : scene.integrators)
            for (const SampleSequence sequence : {SampleSequence::Sobol, SampleSequence::Random}) {
                ++seed;
                // All draw their numbers by the same calls: these two stand for walks from the eye and from the light,
                // and every fourth scene for all.
                const bool shows_sequences = (integrator == "path" || integrator == "bdpt") && number % 4 == 0;
                if (sequence == SampleSequence::Sobol || shows_sequences)
                    comparisons.push_back({&scene, integrator, sequence, seed});
            }
    }
    return comparisons;
}

const std::vector<ClosedFormRun>& comparisons() {
    static const std::vector<ClosedFormRun> all = all_comparisons();
    return all;
}

std::string test_name(const testing::TestParamInfo<ClosedFormRun>& info) {
    return info.param.scene->name + "_" + info.param.integrator +
           (info.param.sequence == SampleSequence::Sobol ? "_sobol" : "_random");
}

class ClosedForm : public testing::TestWithParam<ClosedFormRun> {};

/// Renders whose means are estimates, where pixels are none.
constexpr std::uint32_t kSplatRenders = 16;
/// With sanitizers, one sample of so many is taken, which is too few for statistics.
constexpr std::uint32_t kSanitizerShare = 32;

TEST_P(ClosedForm, RadianceIsTheKnownOne) {
    const ClosedFormCase& scene = *GetParam().scene;
    const auto integrator = make_integrator(GetParam().integrator, {.lengths = scene.lengths});
    ASSERT_NE(integrator, nullptr);
    SceneDesc desc = scene.scene;
    std::optional<CosineImage> image;
    if (scene.environment_axis) desc.environment.image = image.emplace(*scene.environment_axis).path();
    const World world = closed_form_world(desc, "Linear Rec.709 (sRGB)");
    const bool makes_splats = integrator->makes_splats();
    // Of light paths sixteen times as many: they light the whole scene, and few come by what is seen.
    const std::uint32_t all_spp = GetParam().integrator == "light" ? 16 * scene.spp : scene.spp;
    const std::uint32_t renders = makes_splats && !kHasSanitizers ? kSplatRenders : 1;
    const std::uint32_t spp = std::max(1u, all_spp / renders / (kHasSanitizers ? kSanitizerShare : 1));
    std::vector<double> pixels;
    std::vector<double> estimates;
    for (std::uint32_t i = 0; i < renders; ++i) {
        // Apart from those of the other comparisons.
        const std::uint32_t seed = GetParam().seed + 100'000 * i;
        double sum = 0.0;
        for (const Rgb& pixel : render_pixels(world, *integrator, GetParam().sequence, spp, seed)) {
            pixels.push_back(static_cast<double>(pixel.g));
            sum += pixels.back();
        }
        estimates.push_back(sum / (kImageSide * kImageSide));
    }
    if constexpr (kHasSanitizers) {
        for (const double pixel : pixels) ASSERT_TRUE(std::isfinite(pixel));
        return;
    }
    if (!makes_splats) estimates = pixels;
    const double tolerance = scene.tolerance * scene.radiance;
    const TTestResult result = t_test(estimates, scene.radiance, tolerance);
    EXPECT_GE(result.p_value, sidak_level(kFamilyLevel, comparisons().size()))
        << "expected " << scene.radiance << ", " << result.str();
    if (!scene.is_exact) return;
    for (const double pixel : pixels) ASSERT_NEAR(pixel, scene.radiance, tolerance);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ClosedForm, testing::ValuesIn(comparisons()), test_name);

}  // namespace
}  // namespace etendue::test
