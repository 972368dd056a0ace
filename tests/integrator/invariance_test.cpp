// Scenes that are moved, turned, scaled or lit in another unit look as before: no reference is needed, and no agreement
// between integrators can hide what fails. Transforms that are far from the origin are tried where files are read,
// since it is the loader that gives such scenes an origin of their own (tests/api/far_from_origin_test.cpp).
//
// Both renders of a pair draw the same numbers, so that their difference is what rounding makes of them: blocks of the
// image are compared by t-tests of these differences. All fail together with probability 0.01 if everything is right.
#include "integrator/agreement_render.h"
#include "support/chi2.h"
#include "support/sanitizers.h"
#include "support/t_test.h"
#include "world/test_scene.h"

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

/// A turn, then a scaling, then a way; and what light is multiplied by.
struct SceneChange {
    std::string name;
    Vec3f euler{0.0f};  ///< radians
    float scale = 1.0f;
    Vec3f way{0.0f};  ///< metres
    float light = 1.0f;

    [[nodiscard]] Mat4f rigid() const {
        Mat4f m;
        m.setEulerAngles(euler);
        for (int i = 0; i < 3; ++i) m[3][i] = way[i];
        return m;
    }
    [[nodiscard]] Mat4f all() const {
        Mat4f m;
        m.setScale(scale);
        return m * rigid();
    }
    /// Returns where the change puts a camera or a lamp, whose axes stay unit vectors.
    [[nodiscard]] Mat4f placed(Mat4f to_world) const {
        for (int i = 0; i < 3; ++i) to_world[3][i] *= scale;
        return to_world * rigid();
    }
};

std::vector<SceneChange> scene_changes() {
    const float right = std::numbers::pi_v<float> / 2.0f;
    const Vec3f odd(0.37f, -1.13f, 0.71f);
    return {{.name = "turned about X", .euler = {right, 0.0f, 0.0f}},
            {.name = "turned about Y", .euler = {0.0f, right, 0.0f}},
            {.name = "upside down", .euler = {0.0f, 0.0f, 2.0f * right}},
            {.name = "turned", .euler = odd},
            {.name = "turned, 10 m away", .euler = odd, .way = {6.0f, -5.0f, 7.0f}},
            {.name = "100 m away", .way = {53.0f, -61.0f, 59.0f}},
            {.name = "in millimetres", .scale = 1000.0f},
            {.name = "in kilometres", .scale = 1e-3f},
            {.name = "dim", .light = 1e-5f},
            {.name = "turned, in inches, bright",
             .euler = odd,
             .scale = 39.37f,
             .way = {-20.0f, 30.0f, 10.0f},
             .light = 1e4f}};
}

constexpr const char* kChangedRooms[] = {"LampPlastic",          "LampRoughGlass",      "SpotConductor",
                                         "VeilMirroredThinLens", "CoarseSmoothPlastic", "BehindPanes"};
constexpr const char* kChangedBy[] = {"path", "bdpt"};

SceneDesc changed(SceneDesc scene, const SceneChange& change) {
    for (InstanceDesc& instance : scene.instances) instance.to_world = instance.to_world * change.all();
    for (CameraDesc& camera : scene.cameras) {
        camera.to_world = change.placed(camera.to_world);
        camera.lens_radius *= change.scale;
        camera.focus_distance *= change.scale;
    }
    for (LightDesc& light : scene.lights) {
        light.to_world = change.placed(light.to_world);
        light.intensity *= change.light;
        if (light.type != LightType::Directional) light.intensity *= change.scale * change.scale;
    }
    for (MaterialDesc& material : scene.materials) material.emissive_strength *= change.light;
    return scene;
}

/// Side of the square blocks that are compared.
constexpr int kPairedBlock = 16;
constexpr std::uint32_t kPairedSeeds = 8;

/// For each block of each seed its mean over all channels.
std::vector<std::vector<double>> block_means(const SceneDesc& scene, const AgreementCase& room,
                                             const Integrator& integrator) {
    static const ThreadPool threads(1);
    const std::atomic<bool> stop{false};
    const World world = compile(scene);
    RenderOptions options = render_options(room);
    options.spp = 2;
    constexpr int kColumns = kAgreementWidth / kPairedBlock;
    std::vector<std::vector<double>> means(std::size_t{kColumns} * (kAgreementHeight / kPairedBlock));
    for (std::uint32_t seed = 0; seed < kPairedSeeds; ++seed) {
        options.seed = seed;
        const std::vector<float> rgba = render(world, integrator, options, threads, stop, {}).film.resolve();
        for (std::vector<double>& block : means) block.push_back(0.0);
        for (int y = 0; y < kAgreementHeight; ++y)
            for (int x = 0; x < kAgreementWidth; ++x) {
                const int number = y * kAgreementWidth + x;
                const int block_number = y / kPairedBlock * kColumns + x / kPairedBlock;
                const auto pixel = static_cast<std::size_t>(number);
                const auto block = static_cast<std::size_t>(block_number);
                for (std::size_t channel = 0; channel < 3; ++channel)
                    means[block].back() +=
                        static_cast<double>(rgba[4 * pixel + channel]) / (3.0 * kPairedBlock * kPairedBlock);
            }
    }
    return means;
}

class Invariance : public testing::TestWithParam<const char*> {};

TEST_P(Invariance, ChangesOfTheSceneChangeTheImageByThatAndNothingElse) {
    const AgreementCase& room = agreement_case(GetParam());
    const SceneDesc scene = agreement_scene(room);
    const std::vector<SceneChange> all = scene_changes();
    for (const char* name : kChangedBy) {
        const auto integrator = make_integrator(name, {.lengths = room.lengths});
        const auto before = block_means(scene, room, *integrator);
        const double level =
            sidak_level(kFamilyLevel, std::size(kChangedRooms) * std::size(kChangedBy) * all.size() * before.size());
        for (const SceneChange& change : all) {
            const auto after = block_means(changed(scene, change), room, *integrator);
            for (std::size_t block = 0; block < before.size(); ++block) {
                std::vector<double> differences;
                double mean = 0.0;
                for (std::size_t seed = 0; seed < kPairedSeeds; ++seed) {
                    differences.push_back(after[block][seed] / static_cast<double>(change.light) - before[block][seed]);
                    mean += before[block][seed] / kPairedSeeds;
                }
                if constexpr (kHasSanitizers) {
                    ASSERT_TRUE(std::isfinite(differences.back()));
                    continue;
                }
                const TTestResult result = t_test(differences, 0.0, 1e-3 * mean);
                EXPECT_GE(result.p_value, level) << change.name << ", " << name << ", block " << block << " of mean "
                                                 << mean << ": " << result.str();
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Rooms, Invariance, testing::ValuesIn(kChangedRooms),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace etendue::test
