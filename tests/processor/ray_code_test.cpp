// The copies of what works per ray: what one of them has compiled, every other one can render, and all of them see the
// light that the code of the tests sees.
#include "processor/ray_code.h"

#include "color/color_config.h"
#include "core/error.h"
#include "core/parallel.h"
#include "render/whole_image.h"
#include "world/test_scene.h"

#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// A floor under more lamps than a node of the tree of lights has children.
SceneDesc lamps_over_floor() {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, -0.6f, -3}, {1.2f, 0, 0}, {0, 0, -1.2f}), add_material(scene, diffuse(Rgb(0.7f))));
    const Handle<MaterialDesc> lamp = add_material(scene, emissive(Rgb(40.0f)));
    constexpr int kLamps = 40;
    for (int i = 0; i < kLamps; ++i) {
        const float x = -1.0f + 2.0f * static_cast<float>(i) / static_cast<float>(kLamps - 1);
        add_object(scene, quad({x, 0.6f, -3.0f + 0.3f * x}, {0.01f, 0, 0}, {0, 0, 0.02f}), lamp);
    }
    return scene;
}

World compile_by(const RayCode& code, SceneDesc scene) {
    const ThreadPool threads(2);
    const ColorConfig colors = ColorConfig::from_environment();
    ProblemList problems;
    return code.compile_world(std::move(scene), colors, "ACEScg", threads, problems, {});
}

double mean_of(const World& world, const Integrator& integrator) {
    const ThreadPool threads(2);
    const std::atomic<bool> stop{false};
    const std::vector<float> pixels =
        render(world, integrator, whole_image(48, 32, 64), threads, stop, {}).film.resolve();
    double sum = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        if (i % 4 != 3) sum += static_cast<double>(pixels[i]);  // not alpha
    return sum / (0.75 * static_cast<double>(pixels.size()));
}

// Samples are the same, and where rounding takes none of them another way, so are images to some 1e-6. One sample of
// the 98,304 that goes another way changes the mean by some 1e-5. The seed is fixed: it fails always or never.
constexpr double kMostDifference = 3e-4;

TEST(RayCode, OfEverySetRendersWhatEveryOtherCompiles) {
    for (const char* const integrator : {"path", "bdpt", "light", "whitted"}) {
        const double expected = mean_of(compile_by(*ray_codes().front(), lamps_over_floor()),
                                        *ray_codes().front()->make_integrator(integrator, {}));
        ASSERT_GT(expected, 0.01);
        for (const RayCode* const compiling : ray_codes())
            for (const RayCode* const rendering : ray_codes())
                EXPECT_NEAR(
                    mean_of(compile_by(*compiling, lamps_over_floor()), *rendering->make_integrator(integrator, {})),
                    expected, kMostDifference * expected)
                    << integrator << ", compiled by " << instruction_set_name(compiling->instruction_set)
                    << ", rendered by " << instruction_set_name(rendering->instruction_set);
    }
}

TEST(RayCode, ThrowsWhatTheProgramCatches) {
    for (const RayCode* const code : ray_codes())
        EXPECT_THROW(static_cast<void>(compile_by(*code, SceneDesc{})), SceneError)
            << instruction_set_name(code->instruction_set);
}

TEST(RayCode, KnowsNoIntegratorsThatAreNone) {
    for (const RayCode* const code : ray_codes()) EXPECT_EQ(code->make_integrator("photon-map", {}), nullptr);
}

TEST(RayCode, IsChosenOnce) {
    EXPECT_EQ(&ray_code(), &ray_code());
}

}  // namespace

}  // namespace etendue::test
