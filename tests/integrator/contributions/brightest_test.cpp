// The list of the brightest contributions is what one finds by looking at all of them.
#include "integrator/contributions/spelled_render.h"
#include "render/brightest_paths.h"
#include "render/checkpoint.h"
#include "render/whole_image.h"
#include "world/test_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr std::uint32_t kBrightestSeed = 3;
constexpr std::size_t kCount = 12;

class Brightest : public testing::TestWithParam<RoomRun> {
  protected:
    AgreementCase room_ = [] {
        AgreementCase room = agreement_case(GetParam().name);
        room.spp = 5;
        return room;
    }();
    World world_ = agreement_world(room_);
    std::unique_ptr<const Integrator> integrator_ =
        make_integrator(GetParam().integrator, {.lengths = room_.lengths, .lamp_images = false});

    [[nodiscard]] RenderOptions options() const {
        RenderOptions result = render_options(room_);
        result.seed = kBrightestSeed;
        result.brightest = kCount;
        return result;
    }
    [[nodiscard]] std::vector<BrightSample> list(int threads) const {
        const std::atomic<bool> stop{false};
        RenderResult result = render(world_, *integrator_, options(), ThreadPool(threads), stop, {});
        find_brightest_paths(world_, *integrator_, options(), result);
        const auto samples = result.counters.brightest.samples();
        return {samples.begin(), samples.end()};
    }
};

struct Found {
    float brightness = 0.0f;
    std::uint32_t sample = 0;
    SpelledPath path;
};

/// By pixel, column and row.
using FoundByPixel = std::map<std::pair<int, int>, Found>;

TEST_P(Brightest, AreTheBrightestOfAllContributions) {
    const PixelRect window = room_.window;
    FoundByPixel all;
    spell_all(world_, GetParam().integrator, room_, kBrightestSeed,
              [&](const SpelledContribution& found, int x, int y, std::uint32_t sample) {
                  if (found.kind == LightKind::Seen) return;
                  if (found.position) {
                      x = std::clamp(static_cast<int>(std::floor(found.position->x)), window.x0, window.x1 - 1);
                      y = std::clamp(static_cast<int>(std::floor(found.position->y)), window.y0, window.y1 - 1);
                  }
                  Found& best = all[{x, y}];
                  if (max_component(found.value) > best.brightness)
                      best = {max_component(found.value), sample, *found.path};
              });
    std::vector<std::pair<std::pair<int, int>, Found>> expected(all.begin(), all.end());
    std::ranges::stable_sort(expected, std::ranges::greater(), [](const auto& e) { return e.second.brightness; });

    const std::vector<BrightSample> found = list(2);
    ASSERT_EQ(found.size(), kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
        const Found& best = all[{found[i].x, found[i].y}];
        EXPECT_NEAR(found[i].brightness(), expected[i].second.brightness, 1e-4f * expected[i].second.brightness);
        EXPECT_NEAR(found[i].brightness(), best.brightness, 1e-4f * best.brightness);
        EXPECT_EQ(found[i].sample, best.sample);
        EXPECT_EQ(std::string(found[i].word.data()), best.path.word);
        EXPECT_EQ(found[i].s, best.path.s);
        EXPECT_EQ(found[i].t, best.path.t);
        EXPECT_EQ(found[i].edges, best.path.edges);
    }
}

TEST_P(Brightest, AreTheSameForEveryNumberOfThreads) {
    const std::vector<BrightSample> one = list(1);
    for (const int threads : {2, 3}) {
        const std::vector<BrightSample> more = list(threads);
        ASSERT_EQ(more.size(), one.size());
        for (std::size_t i = 0; i < one.size(); ++i) {
            EXPECT_EQ(more[i].x, one[i].x);
            EXPECT_EQ(more[i].y, one[i].y);
            EXPECT_EQ(more[i].sample, one[i].sample);
            EXPECT_EQ(more[i].value, one[i].value);
            EXPECT_EQ(more[i].word, one[i].word);
        }
    }
}

TEST_P(Brightest, AreCarriedByCheckpoints) {
    const ThreadPool threads(2);
    const std::atomic<bool> stop{false};
    RenderOptions first = options();
    first.spp = 2;
    RenderResult begun = render(world_, *integrator_, first, threads, stop, {});
    // Those of an interrupted render have their paths already.
    find_brightest_paths(world_, *integrator_, first, begun);
    const std::filesystem::path file = testing::TempDir() + "brightest-" + GetParam().integrator + GetParam().name;
    write_checkpoint(file, {}, "", begun);
    Checkpoint kept = read_checkpoint(file);
    std::filesystem::remove(file);
    RenderResult gone_on = render(world_, *integrator_, options(), threads, stop, {}, {}, std::move(kept.state));
    find_brightest_paths(world_, *integrator_, options(), gone_on);
    const std::vector<BrightSample> whole = list(1);
    const auto found = gone_on.counters.brightest.samples();
    ASSERT_EQ(found.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        EXPECT_EQ(found[i].value, whole[i].value);
        EXPECT_EQ(found[i].sample, whole[i].sample);
        EXPECT_EQ(found[i].word, whole[i].word);
    }
}

TEST_P(Brightest, HavePathsThatAreExpressions) {
    for (const BrightSample& sample : list(2)) {
        const std::string word = sample.word.data();
        const auto aovs = std::make_shared<AovSet>(expression_layers(room_, {word}));
        const Film film = render_layers(world_, GetParam().integrator, room_, aovs, kBrightestSeed).film;
        const std::vector<float> layer = film.resolve_light(0);
        const std::size_t pixel =
            static_cast<std::size_t>(sample.y - room_.window.y0) * static_cast<std::size_t>(room_.window.width()) +
            static_cast<std::size_t>(sample.x - room_.window.x0);
        EXPECT_GT(layer[3 * pixel] + layer[3 * pixel + 1] + layer[3 * pixel + 2], 0.0f) << word;
    }
}

INSTANTIATE_TEST_SUITE_P(Rooms, Brightest,
                         testing::Values(RoomRun{"CausticCrop", "path"}, RoomRun{"CausticCrop", "light"},
                                         RoomRun{"CausticCrop", "bdpt"}, RoomRun{"SmoothGlass", "path"},
                                         RoomRun{"SmoothGlass", "bdpt"}, RoomRun{"LampInFog", "bdpt"},
                                         RoomRun{"PointPlastic", "bdpt"}),
                         [](const auto& each) { return each.param.integrator + "_" + each.param.name; });

/// A glass ball on a floor under a lamp of 16 cm.
World small_lamp_over_glass() {
    SceneDesc scene = empty_scene();
    MaterialDesc glass;
    glass.override_model = DielectricDesc{1.5f, 0.0f};
    add_object(scene, sphere({0.0f, -0.2f, -3.0f}, 0.35f, 24), add_material(scene, glass));
    add_object(scene, quad({0, -0.6f, -3}, {1.2f, 0, 0}, {0, 0, -1.2f}), add_material(scene, diffuse(Rgb(0.7f))));
    add_object(scene, quad({0, 1.1f, -3}, {0.08f, 0, 0}, {0, 0, 0.08f}), add_material(scene, emissive(Rgb(200.0f))));
    return compile(std::move(scene));
}

TEST(BrightestPaths, SayWhichStrategyIsToBlame) {
    const World world = small_lamp_over_glass();
    RenderOptions options = whole_image(48, 36, 64);
    options.brightest = 1;
    const auto brightest = [&](const char* name) {
        const auto integrator = make_integrator(name, {.lamp_images = false});
        const std::atomic<bool> stop{false};
        RenderResult result = render(world, *integrator, options, ThreadPool(2), stop, {});
        find_brightest_paths(world, *integrator, options, result);
        return result.counters.brightest.samples().front();
    };
    // Eye paths meet the lamp by chance, by way of the glass; paths from the lamp come through it often.
    const BrightSample by_path = brightest("path");
    EXPECT_EQ(by_path.s, 0);
    const auto word = [](const BrightSample& sample) { return std::string(sample.word.data()); };
    EXPECT_NE(word(by_path).find("D S"), std::string::npos) << word(by_path);
    EXPECT_GE(by_path.edges, 3);
    // What is left to bidirectional path tracing is the lamp in the glass.
    EXPECT_EQ(word(brightest("bdpt")).substr(0, 5), "C S O");
    EXPECT_LT(brightest("light").brightness(), 0.1f * by_path.brightness());
    EXPECT_EQ(brightest("light").t, 1);
}

/// Samples that merge share their wavelength with all others: those are traced again with the same.
TEST(BrightestPaths, AreFoundWhereSubpathsMergeButForTheMerged) {
    SceneDesc scene = empty_scene();
    DielectricDesc prism{1.5f, 0.0f};
    prism.volume.dispersion = 4.0f;
    MaterialDesc glass;
    glass.override_model = prism;
    add_object(scene, sphere({0.0f, -0.2f, -3.0f}, 0.35f, 24), add_material(scene, glass));
    add_object(scene, quad({0, -0.6f, -3}, {1.2f, 0, 0}, {0, 0, -1.2f}), add_material(scene, diffuse(Rgb(0.7f))));
    add_object(scene, quad({0, 1.1f, -3}, {0.08f, 0, 0}, {0, 0, 0.08f}), add_material(scene, emissive(Rgb(200.0f))));
    const World world = compile(std::move(scene));
    RenderOptions options = whole_image(48, 36, 16);
    options.brightest = 64;
    const auto integrator = make_integrator("vcm", {.lamp_images = false});
    const std::atomic<bool> stop{false};
    RenderResult result = render(world, *integrator, options, ThreadPool(2), stop, {});
    find_brightest_paths(world, *integrator, options, result);
    std::size_t found = 0;
    for (const BrightSample& sample : result.counters.brightest.samples()) found += sample.has_path() ? 1 : 0;
    EXPECT_GT(found, 40u) << "the merged are few";
}

BrightSample bright(int x, int y, float value, std::uint32_t sample = 0) {
    return {.x = x, .y = y, .sample = sample, .value = Rgb(value)};
}

TEST(BrightestSamples, KeepOneOfAPixelInAnyOrder) {
    const std::vector<BrightSample> all{bright(1, 1, 3.0f), bright(2, 1, 5.0f), bright(1, 1, 9.0f),
                                        bright(3, 1, 5.0f), bright(4, 1, 1.0f), bright(2, 1, 2.0f)};
    std::vector<std::size_t> order{0, 1, 2, 3, 4, 5};
    do {
        BrightestSamples list;
        BrightestSamples other;
        list.expect(3, 0.0f);
        other.expect(3, 0.0f);
        for (std::size_t i = 0; i < order.size(); ++i) (i % 2 == 0 ? list : other).offer(all[order[i]]);
        list.add(other);
        ASSERT_EQ(list.samples().size(), 3u);
        EXPECT_EQ(list.samples()[0].x, 1);
        EXPECT_EQ(list.samples()[0].brightness(), 9.0f);
        EXPECT_EQ(list.samples()[1].x, 2);
        EXPECT_EQ(list.samples()[2].x, 3);
        EXPECT_EQ(list.threshold(), 5.0f);
    } while (std::ranges::next_permutation(order).found);
}

TEST(BrightestSamples, HaveNoPlaceIfNoneIsAskedFor) {
    BrightestSamples list;
    EXPECT_EQ(list.threshold(), std::numeric_limits<float>::infinity());
    list.offer(bright(1, 1, 3.0f));
    EXPECT_TRUE(list.samples().empty());
}

}  // namespace

}  // namespace etendue::test
