// Two integrators that can both find all light of a scene make the same image of it: block means agree within their own
// noise, image means within 1%.
//
// All comparisons together fail with probability 0.01 if everything is right (Sidak's correction); seeds are fixed.
#include "integrator/agreement_cases.h"
#include "metrics/block_agreement.h"
#include "render/render.h"
#include "support/chi2.h"

#include <algorithm>
#include <atomic>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr std::uint32_t kSeeds = 6;

/// A scene and an integrator to compare with `path`.
struct AgreementPair {
    const AgreementCase* agreement;
    std::string integrator;
};

void PrintTo(const AgreementPair& pair, std::ostream* out) {
    *out << pair.integrator << " " << pair.agreement->name;
}

const std::vector<AgreementPair>& pairs() {
    static const std::vector<AgreementPair> all = [] {
        std::vector<AgreementPair> result;
        for (const AgreementCase& agreement : agreement_cases())
            for (const std::string& integrator : agreement.integrators) result.push_back({&agreement, integrator});
        return result;
    }();
    return all;
}

/// Of the pixels of `part`, which lies within the window that is rendered.
ImageEstimate estimate(const World& world, const std::string& name, const AgreementCase& agreement,
                       std::uint32_t first_seed, const PixelRect& part) {
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    std::vector<ImageF> renders;
    for (std::uint32_t i = 0; i < kSeeds; ++i) {
        RenderOptions options;
        options.full_width = kAgreementWidth;
        options.full_height = kAgreementHeight;
        options.window = agreement.window;
        options.spp = agreement.spp;
        options.seed = first_seed + i;
        // A splat falls into one pixel, so that those of a block are independent, as the test assumes.
        options.filter = PixelFilter(FilterShape::Box);
        const auto integrator = make_integrator(name, {.lengths = agreement.lengths});
        const std::vector<float> rgba = render(world, *integrator, options, threads, stop, {}).film.resolve();
        ImageF image(part.width(), part.height(), 3);
        for (int y = part.y0; y < part.y1; ++y)
            for (int x = part.x0; x < part.x1; ++x) {
                const int row = y - agreement.window.y0;
                const auto p = static_cast<std::size_t>(row * agreement.window.width() + x - agreement.window.x0);
                std::copy_n(&rgba[4 * p], 3, image.pixel(x - part.x0, y - part.y0).begin());
            }
        renders.push_back(std::move(image));
    }
    return estimate_image(renders);
}

ImageEstimate estimate(const World& world, const std::string& name, const AgreementCase& agreement,
                       std::uint32_t first_seed) {
    return estimate(world, name, agreement, first_seed, agreement.window);
}

class Agreement : public testing::TestWithParam<AgreementPair> {};

TEST_P(Agreement, MakesTheImageOfPathTracing) {
    const auto& [agreement, integrator] = GetParam();
    const World world = agreement_world(*agreement);
    const ImageEstimate path = estimate(world, "path", *agreement, 100);
    const ImageEstimate other = estimate(world, integrator, *agreement, 200);
    const BlockAgreement result =
        test_agreement(path, other, {.block_size = 8, .significance = sidak_level(kFamilyLevel, pairs().size())});
    EXPECT_TRUE(result.agree()) << result.str();
}

/// A crop, of `pairs`' rooms, and who renders it.
class CropAgreement : public testing::TestWithParam<const char*> {};

// All splats of the whole image reach the crop in the one, in the other only what is meant for it: the two differ in
// their numbers, and for bidirectional path tracing in the densities that weigh strategies.
TEST_P(CropAgreement, ACropIsThePartOfTheWhole) {
    constexpr int kCrops = 4;  // of both instances
    AgreementCase whole{"Room", {}};
    for (const AgreementCase& agreement : agreement_cases())
        if (agreement.name == "LampPlastic") whole = agreement;
    ASSERT_TRUE(whole.make);
    const World world = agreement_world(whole);
    const PixelRect crops[] = {{18, 20, 50, 44}, {40, 0, 42, 48}};
    for (const PixelRect& crop : crops) {
        AgreementCase cropped = whole;
        cropped.window = crop;
        // The narrow one has few samples.
        cropped.spp = 4 * whole.spp;
        const BlockAgreement result = test_agreement(
            estimate(world, GetParam(), whole, 300, crop), estimate(world, GetParam(), cropped, 400),
            {.block_size = 8, .significance = sidak_level(kFamilyLevel, kCrops), .mean_tolerance = 0.02});
        EXPECT_TRUE(result.agree()) << result.str();
    }
}

INSTANTIATE_TEST_SUITE_P(Splats, CropAgreement, testing::Values("light", "bdpt"),
                         [](const auto& param) { return std::string(param.param); });

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, testing::ValuesIn(pairs()),
                         [](const auto& pair) { return pair.param.integrator + "_" + pair.param.agreement->name; });

}  // namespace

}  // namespace etendue::test
