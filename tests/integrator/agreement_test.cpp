// Two integrators that can both find all light of a scene make the same image of it: block means agree within their own
// noise, image means within 1%.
//
// All comparisons together fail with probability 0.01 if everything is right (Sidak's correction); seeds are fixed.
#include "integrator/agreement_cases.h"
#include "integrator/agreement_render.h"
#include "integrator/bdpt/render_bdpt.h"
#include "integrator/failure_images.h"
#include "support/chi2.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Returns how many comparisons with the first integrator of its room there are in all rooms.
std::size_t comparison_count() {
    std::size_t count = 0;
    for (const AgreementCase& room : agreement_cases()) count += room.integrators.size() - 1;
    return count;
}

/// A room in which each integrator is compared with the first.
class Agreement : public testing::TestWithParam<std::string> {};

TEST_P(Agreement, MakesTheSameImage) {
    AgreementCase room = agreement_case(GetParam());
    room.spp /= 2;  // with which means are known to 0.7% at worst; the matrix (tests/agreement) takes more
    const World world = agreement_world(room);
    const ThreadPool threads;
    const std::string& reference = room.integrators.front();
    const ImageEstimate first = estimate(world, reference, room, {.first_seed = 100}, threads);
    for (const std::string& integrator : std::span(room.integrators).subspan(1)) {
        const ImageEstimate other = estimate(world, integrator, room, {.first_seed = 200}, threads);
        const BlockAgreement result = test_agreement(
            first, other,
            {.block_size = kAgreementBlock, .significance = sidak_level(kFamilyLevel, comparison_count())});
        if (result.agree()) continue;
        const Disagreement pair{{reference, &first.mean}, {integrator, &other.mean}};
        const std::filesystem::path images = write_failure_images(test_output_directory(), room, world, {&pair, 1});
        ADD_FAILURE() << integrator << ": " << result.str()
                      << "; the images, their difference and the strategies of bdpt are in " << images.string();
    }
}

/// Is given an integrator that renders a crop of a room, and the pixel filter. Only a box filter keeps splats within
/// their pixels.
class CropAgreement : public testing::TestWithParam<std::tuple<const char*, FilterShape>> {};

// All splats of the whole image reach the crop in the one, in the other only what is meant for it: the two differ in
// their numbers, and for bidirectional path tracing in the densities that weigh strategies.
TEST_P(CropAgreement, ACropIsThePartOfTheWhole) {
    constexpr int kCrops = 8;  // of all instances
    const auto& [name, filter] = GetParam();
    AgreementCase whole = agreement_case("LampPlastic");
    whole.window = {-2, 0, kAgreementWidth + 2, kAgreementHeight + 4};
    const World world = agreement_world(whole);
    const ThreadPool threads;
    const auto integrator = make_integrator(name, {.lengths = whole.lengths});
    const PixelRect crops[] = {{18, 20, 50, 44}, {20, 46, 44, 51}};
    for (const PixelRect& crop : crops) {
        AgreementCase cropped = whole;
        cropped.window = crop;
        // The narrow one has few samples.
        cropped.spp = 4 * whole.spp;
        const BlockAgreement result = test_agreement(
            estimate(world, *integrator, whole, {.first_seed = 300, .filter = filter}, threads, crop),
            estimate(world, *integrator, cropped, {.first_seed = 400, .filter = filter}, threads, crop),
            {.block_size = kAgreementBlock, .significance = sidak_level(kFamilyLevel, kCrops), .mean_tolerance = 0.02});
        EXPECT_TRUE(result.agree()) << result.str();
    }
}

/// An integrator that renders a room with Russian roulette and without.
class RouletteAgreement : public testing::TestWithParam<const char*> {};

// It is outside of the densities that weigh strategies, on both subpaths: it may change the noise only.
TEST_P(RouletteAgreement, ChangesNoImage) {
    constexpr int kRenders = 2;  // instances
    AgreementCase room = agreement_case("LampPlastic");
    // Of the light that it decides about, which is little beside the rest.
    room.lengths = {.max_depth = 8, .min_depth = 3};
    room.spp = 128;
    const World world = agreement_world(room);
    const ThreadPool threads;
    const auto integrator = [&](int roulette_depth) {
        PathLengths lengths = room.lengths;
        lengths.roulette_depth = roulette_depth;
        return make_integrator(GetParam(), {.lengths = lengths});
    };
    const BlockAgreement result =
        test_agreement(estimate(world, *integrator(1), room, {.first_seed = 500}, threads, room.window),
                       estimate(world, *integrator(1000), room, {.first_seed = 600}, threads, room.window),
                       {.block_size = kAgreementBlock, .significance = sidak_level(kFamilyLevel, kRenders)});
    EXPECT_TRUE(result.agree()) << result.str();
}

/// Names a room in which `hemisphere` is compared with `naive`.
class EvenDirections : public testing::TestWithParam<const char*> {};

// They may change the noise only.
TEST_P(EvenDirections, ChangeNoImage) {
    constexpr int kRooms = 2;
    AgreementCase room = agreement_case(GetParam());
    room.spp = 256;
    const World world = agreement_world(room);
    const ThreadPool threads;
    const BlockAgreement result =
        test_agreement(estimate(world, "naive", room, {.first_seed = 700}, threads),
                       estimate(world, "hemisphere", room, {.first_seed = 800}, threads),
                       {.block_size = kAgreementBlock, .significance = sidak_level(kFamilyLevel, kRooms)});
    EXPECT_TRUE(result.agree()) << result.str();
}

TEST(MeanError, IsTheLargestOverTheChannels) {
    ImageEstimate e{ImageF(2, 1, 2), ImageF(2, 1, 2)};
    e.mean.pixels = {1.0f, 2.0f, 3.0f, 2.0f};
    e.variance.pixels = {0.0f, 0.04f, 0.16f, 0.05f};
    EXPECT_NEAR(mean_error(e), 0.1, 1e-6);
    e.mean.pixels.assign(4, 0.0f);
    EXPECT_EQ(mean_error(e), 0.0) << "black";
}

INSTANTIATE_TEST_SUITE_P(Splats, CropAgreement,
                         testing::Combine(testing::Values("light", "bdpt"),
                                          testing::Values(FilterShape::Box, FilterShape::BlackmanHarris)),
                         [](const auto& param) {
                             return std::get<0>(param.param) + std::string(std::get<1>(param.param) == FilterShape::Box
                                                                               ? "Box"
                                                                               : "BlackmanHarris");
                         });

INSTANTIATE_TEST_SUITE_P(BothSubpaths, RouletteAgreement, testing::Values("light", "bdpt"),
                         [](const auto& param) { return std::string(param.param); });

INSTANTIATE_TEST_SUITE_P(Rooms, EvenDirections, testing::Values("LampDiffuse", "LampConductor"),
                         [](const auto& room) { return std::string(room.param); });

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, testing::ValuesIn([] {
                             std::vector<std::string> names;
                             for (const AgreementCase& room : agreement_cases()) names.push_back(room.name);
                             return names;
                         }()),
                         [](const auto& room) { return room.param; });

}  // namespace

}  // namespace etendue::test
