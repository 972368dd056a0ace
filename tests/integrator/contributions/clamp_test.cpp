// The limit of indirect contributions: what it takes away, and what it leaves alone.
#include "integrator/contributions/spelled_render.h"
#include "wave/aov/sample_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <ostream>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr float kNoLimit = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kClampSeed = 3;

std::vector<RoomRun> rooms() {
    std::vector<RoomRun> result;
    for (const char* name : {"LampPlastic", "LampRoughGlass", "CausticCrop", "SmoothGlass", "SmoothCoat", "LampInFog"})
        for (const std::string& integrator : agreement_case(name).integrators) result.push_back({name, integrator});
    result.push_back({"SmoothGlass", "naive"});
    return result;
}

class ClampIndirect : public testing::TestWithParam<RoomRun> {
  protected:
    AgreementCase room_ = [] {
        AgreementCase room = agreement_case(GetParam().name);
        room.spp = 8;
        return room;
    }();
    World world_ = agreement_world(room_);

    [[nodiscard]] Film render(float limit, const std::shared_ptr<const AovSet>& aovs = nullptr) const {
        const ThreadPool threads;
        const std::atomic<bool> stop{false};
        RenderOptions options = render_options(room_);
        options.seed = kClampSeed;
        options.aovs = aovs;
        options.clamp_indirect = limit;
        const auto integrator =
            make_integrator(GetParam().integrator, {.lengths = room_.lengths, .lamp_images = false});
        return etendue::render(world_, *integrator, options, threads, stop, {}).film;
    }
    /// Direct light, all other light, and what was taken away.
    [[nodiscard]] std::shared_ptr<const AovSet> layers() const {
        AovSet aovs = expression_layers(room_, {"C S* .? L", "!C S* .? L"});
        aovs.removed_light = aovs.layout.light++;
        return std::make_shared<AovSet>(aovs);
    }
};

std::vector<float> rgb(const Film& film) {
    const std::vector<float> rgba = film.resolve();
    std::vector<float> image;
    for (std::size_t i = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) image.push_back(rgba[i]);
    return image;
}

TEST_P(ClampIndirect, ALimitThatNothingReachesChangesNoBit) {
    EXPECT_EQ(render(kNoLimit).resolve(), render(1e30f).resolve());
}

TEST_P(ClampIndirect, LeavesDirectLightAloneAndTakesFromTheRest) {
    constexpr float kLimit = 0.05f;
    const Film whole = render(kNoLimit, layers());
    const Film limited = render(kLimit, layers());
    EXPECT_EQ(whole.resolve_light(0), limited.resolve_light(0));
    EXPECT_EQ(whole.resolve(), render(kNoLimit).resolve());

    const std::vector<float> before = rgb(whole);
    const std::vector<float> after = rgb(limited);
    const std::vector<float> direct = limited.resolve_light(0);
    const std::vector<float> indirect = limited.resolve_light(1);
    const std::vector<float> removed = limited.resolve_light(2);
    const float scale = *std::ranges::max_element(before);
    double taken = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_LE(after[i], before[i] + 1e-5f * scale);
        EXPECT_NEAR(after[i] + removed[i], before[i], 1e-5f * scale);
        EXPECT_NEAR(direct[i] + indirect[i], after[i], 1e-5f * scale);
        taken += static_cast<double>(removed[i]);
    }
    EXPECT_GT(taken, 0.0);
}

TEST_P(ClampIndirect, SumsWhatEveryContributionIsLimitedTo) {
    constexpr float kLimit = 0.05f;
    double expected = 0.0;
    double unlimited = 0.0;
    spell_all(world_, GetParam().integrator, room_, kClampSeed,
              [&](const SpelledContribution& found, int, int, std::uint32_t) {
                  if (found.position) return;
                  const float most = max_component(found.value);
                  const float scale = found.kind == LightKind::Indirect && most > kLimit ? kLimit / most : 1.0f;
                  expected += static_cast<double>(found.value.g * scale);
                  unlimited += static_cast<double>(found.value.g);
              });
    const auto sum = [](const Film& film) {
        double total = 0.0;
        for (const PixelSum& pixel : film.sums()) total += pixel.g;
        return total;
    };
    EXPECT_NEAR(sum(render(kLimit)), expected, 1e-4 * unlimited);
    EXPECT_NEAR(sum(render(kNoLimit)), unlimited, 1e-4 * unlimited);
}

TEST_P(ClampIndirect, IsOfThePathsThatTheDocumentationSays) {
    const std::regex direct("C( S)*( .)? [OBL]");
    const std::regex seen("C [OBL]");
    std::size_t indirect = 0;
    std::size_t all = 0;
    spell_all(world_, GetParam().integrator, room_, kClampSeed,
              [&](const SpelledContribution& found, int, int, std::uint32_t) {
                  ASSERT_TRUE(found.path);
                  const bool is_indirect = found.kind == LightKind::Indirect;
                  EXPECT_EQ(is_indirect, !std::regex_match(found.path->word, direct)) << found.path->word;
                  EXPECT_EQ(found.kind == LightKind::Seen, std::regex_match(found.path->word, seen));
                  indirect += is_indirect ? 1 : 0;
                  ++all;
              });
    EXPECT_GT(indirect, 0u);
    EXPECT_LT(indirect, all);
}

INSTANTIATE_TEST_SUITE_P(Rooms, ClampIndirect, testing::ValuesIn(rooms()),
                         [](const auto& each) { return each.param.integrator + "_" + each.param.name; });

/// One sample of a job of which the window is a quarter of the image.
class LimitedSample : public testing::Test {
  protected:
    LimitedSample() { light_.reset(1, job_, kNoLimit); }

    PixelFilter filter_{FilterShape::Box};
    TileJob job_{{0, 0, 1, 1}, {0, 0, 4, 4}, 8, 8, 0, 1, 0, SampleSequence::Sobol, &filter_, nullptr, 2.0f};
    SampleLight light_;
};

TEST_F(LimitedSample, KeepsTheHueOfWhatIsTooBright) {
    light_.add(0, {8.0f, 4.0f, 1.0f}, LightKind::Indirect);
    EXPECT_EQ(light_.radiance(0), Rgb(2.0f, 1.0f, 0.25f));
    light_.add(0, {8.0f, 4.0f, 1.0f}, LightKind::Direct);
    EXPECT_EQ(light_.radiance(0), Rgb(10.0f, 5.0f, 1.25f));
    light_.add(0, {2.0f, 1.0f, 1.0f}, LightKind::Indirect);
    EXPECT_EQ(light_.radiance(0), Rgb(12.0f, 6.0f, 2.25f));
}

TEST_F(LimitedSample, TakesSplatsForWhatTheyAddToTheWindow) {
    // With a light path for each pixel of the window only, each stands for four of the whole image.
    std::vector<Splat> splats;
    light_.add_splat(0, 0, {{1.0f, 1.0f}, Rgb(0.5f)}, LightKind::Indirect, {}, splats);
    light_.add_splat(0, 0, {{1.0f, 1.0f}, Rgb(1.0f)}, LightKind::Indirect, {}, splats);
    light_.add_splat(0, 0, {{1.0f, 1.0f}, Rgb(1.0f)}, LightKind::Direct, {}, splats);
    ASSERT_EQ(splats.size(), 3u);
    EXPECT_EQ(splats[0].value, Rgb(0.5f));
    EXPECT_EQ(splats[1].value, Rgb(0.5f));
    EXPECT_EQ(splats[2].value, Rgb(1.0f));
}

}  // namespace

}  // namespace etendue::test
