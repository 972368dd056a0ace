// Two integrators that can both find all light of a scene make the same image of it: block means agree within their own
// noise, image means within 1%.
//
// All comparisons together fail with probability 0.01 if everything is right (Sidak's correction); seeds are fixed.
#include "integrator/agreement_cases.h"
#include "metrics/block_agreement.h"
#include "render/render.h"
#include "support/chi2.h"

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

ImageEstimate estimate(const World& world, const std::string& name, const AgreementCase& agreement,
                       std::uint32_t first_seed) {
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
        const auto integrator = make_integrator(name, agreement.lengths);
        const std::vector<float> rgba = render(world, *integrator, options, threads, stop, {}).film.resolve();
        ImageF image(agreement.window.width(), agreement.window.height(), 3);
        for (std::size_t p = 0; p < agreement.window.area(); ++p)
            for (std::size_t c = 0; c < 3; ++c) image.pixels[3 * p + c] = rgba[4 * p + c];
        renders.push_back(std::move(image));
    }
    return estimate_image(renders);
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

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, testing::ValuesIn(pairs()),
                         [](const auto& pair) { return pair.param.integrator + "_" + pair.param.agreement->name; });

}  // namespace

}  // namespace etendue::test
