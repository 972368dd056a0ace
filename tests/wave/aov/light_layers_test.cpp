// Layers of light path expressions: those that take each path once add up to the image, and each is the same whoever
// finds its paths.
#include "integrator/agreement_render.h"
#include "lightpath/usual_expressions.h"
#include "support/chi2.h"
#include "wave/aov/layered_render.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

std::vector<RoomRun> rooms_of_all_kinds() {
    std::vector<RoomRun> rooms;
    for (const char* name : {"LampPlastic", "LampLayers", "LampRoughGlass", "LampPrism", "LampWax", "SheetAndLeaf",
                             "VisibleEnvironment", "SunRoughGlass", "SmoothCoat", "SmoothGlass", "LampInFog"})
        for (const std::string& integrator : agreement_case(name).integrators) rooms.push_back({name, integrator});
    // These do not find all light of the rooms, but tell apart what they find.
    for (const char* name : {"LampPlastic", "LampRoughGlass", "VisibleEnvironment", "LampInFog"})
        for (const char* integrator : {"direct", "naive"})
            if (std::ranges::find(agreement_case(name).integrators, integrator) ==
                std::ranges::end(agreement_case(name).integrators))
                rooms.push_back({name, integrator});
    rooms.push_back({"SmoothGlass", "vcm"});
    return rooms;
}

class LightLayers : public testing::TestWithParam<RoomRun> {
  protected:
    AgreementCase room_ = [] {
        AgreementCase room = agreement_case(GetParam().name);
        room.spp = 8;
        return room;
    }();
    World world_ = agreement_world(room_);

    [[nodiscard]] RenderResult render(const std::vector<std::string>& expressions) const {
        return render_layers(world_, GetParam().integrator, room_,
                             std::make_shared<AovSet>(expression_layers(room_, expressions)), 3);
    }
};

/// Largest difference between the sum of all layers and the image, relative to the image's largest value.
double largest_gap(const Film& film) {
    const std::vector<float> image = film.resolve();
    std::vector<double> sum(image.size() / 4 * 3, 0.0);
    for (std::size_t layer = 0; layer < film.layers().layout().light; ++layer) {
        const std::vector<float> part = film.resolve_light(layer);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(part[i]);
    }
    double largest = 0.0;
    double gap = 0.0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
        const auto value = static_cast<double>(image[i / 3 * 4 + i % 3]);
        largest = std::max(largest, value);
        gap = std::max(gap, std::abs(sum[i] - value));
    }
    return gap / largest;
}

TEST_P(LightLayers, ThoseThatTakeEveryPathOnceAddUpToTheImage) {
    std::vector<std::string> passes;
    for (const UsualExpression& usual : partition_expressions()) passes.emplace_back(usual.expression);
    EXPECT_LT(largest_gap(render(passes).film), 1e-5);
    EXPECT_LT(largest_gap(render({"C .* L"}).film), 1e-5);
    EXPECT_LT(largest_gap(render({"C D S+ L", "!L S+ D E"}).film), 1e-5);
    EXPECT_LT(largest_gap(render({"C [^DG]* L", "C .* [DG] L", "C .* [DG] [SV]+ L"}).film), 1e-5);
}

TEST_P(LightLayers, LeaveTheImageAsItIs) {
    const std::vector<float> with = render({"C D .* L", "C S L"}).film.resolve();
    const std::vector<float> without = render_layers(world_, GetParam().integrator, room_, nullptr, 3).film.resolve();
    EXPECT_EQ(with, without);
}

INSTANTIATE_TEST_SUITE_P(Rooms, LightLayers, testing::ValuesIn(rooms_of_all_kinds()),
                         [](const auto& each) { return each.param.integrator + "_" + each.param.name; });

/// A room in which the light of some paths is looked at.
struct Shares {
    const char* room;
    std::vector<std::string> expressions;
};

void PrintTo(const Shares& shares, std::ostream* out) {
    *out << shares.room;
}

std::vector<Shares> all_shares() {
    return {{"LampPlastic", {"C <RD> L", "C G L", "C D D L", "C D G L", "C G .+ L"}},
            {"LampLayers", {"C <RD> L", "C G L"}},
            {"LampRoughGlass", {"C D T+ L", "C T T D L", "C D R L"}},
            {"SheetAndLeaf", {"C .* <TD> .* L"}},
            {"CausticCrop", {"L S+ D E"}},
            {"SunRoughGlass", {"C D .+ L"}},
            {"VisibleEnvironment", {"C D B"}},
            {"LampPrism", {"C D T+ L"}}};
}
constexpr std::size_t kShareCount = 15;  // expressions of all rooms

/// Who is compared with path tracing.
constexpr const char* kOthers[] = {"light", "bdpt"};
/// All comparisons together fail with this probability if everything is right.
constexpr double kFalsePositives = 0.01;
/// Pixels; the tests' own blocks may have to be larger.
constexpr int kSmallestBlock = 8;
/// Of image means, which blocks as large as the image test, too: only what no noise explains.
constexpr double kMeanTolerance = 0.1;

class LightLayersAgree : public testing::TestWithParam<Shares> {
  protected:
    /// Returns the light layers, each seed by seed.
    [[nodiscard]] static std::vector<std::vector<ImageF>> renders(const World& world, const std::string& integrator,
                                                                  const AgreementCase& room,
                                                                  const std::vector<std::string>& expressions,
                                                                  std::uint32_t first_seed) {
        constexpr std::uint32_t kSeeds = 8;
        const auto aovs = std::make_shared<AovSet>(expression_layers(room, expressions));
        std::vector<std::vector<ImageF>> images(expressions.size());
        for (std::uint32_t seed = first_seed; seed < first_seed + kSeeds; ++seed) {
            const Film film = render_layers(world, integrator, room, aovs, seed).film;
            for (std::size_t layer = 0; layer < images.size(); ++layer) {
                ImageF image(room.window.width(), room.window.height(), 3);
                image.pixels = film.resolve_light(layer);
                images[layer].push_back(std::move(image));
            }
        }
        return images;
    }
    /// Light of a few paths is found by chance: blocks that have met little of it do not know how unsure they are.
    [[nodiscard]] static ImageEstimate estimate(const std::vector<ImageF>& images, int block_size) {
        ImageEstimate result = estimate_image(images);
        pool_variance(result, block_size);
        return result;
    }
};

TEST_P(LightLayersAgree, WhoeverFindsTheirPaths) {
    const auto& [room_name, expressions] = GetParam();
    // Half of its samples: these take the longest of all unit tests, and blocks grow until they know their noise.
    AgreementCase room = agreement_case(room_name);
    room.spp /= 2;
    const World world = agreement_world(room);
    const auto first = renders(world, "path", room, expressions, 300);
    std::uint32_t seed = 400;
    for (const char* name : kOthers) {
        const auto other = renders(world, name, room, expressions, seed);
        for (std::size_t layer = 0; layer < expressions.size(); ++layer) {
            const auto block = testable_block_size(first[layer], kSmallestBlock);
            const auto other_block = testable_block_size(other[layer], kSmallestBlock);
            ASSERT_TRUE(block && other_block) << name << ", " << expressions[layer] << ": too little light for a test";
            const int size = std::max(*block, *other_block);
            const BlockAgreement result =
                test_agreement(estimate(first[layer], size), estimate(other[layer], size),
                               {.block_size = size,
                                .significance = sidak_level(kFalsePositives, std::size(kOthers) * kShareCount),
                                .mean_tolerance = kMeanTolerance});
            EXPECT_TRUE(result.agree()) << name << ", " << expressions[layer] << ": " << result.str();
        }
        seed += 100;
    }
}

INSTANTIATE_TEST_SUITE_P(Shares, LightLayersAgree, testing::ValuesIn(all_shares()),
                         [](const auto& each) { return std::string(each.param.room); });

}  // namespace

}  // namespace etendue::test
