#include "live/explorer.h"

#include "core/error.h"
#include "processor/ray_code.h"
#include "program/small_files.h"
#include "render/render.h"
#include "session/usage_error.h"

#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

SettingsOverrides small_image() {
    SettingsOverrides overrides;
    overrides.give("--size", "48x36");
    overrides.give("--integrator", "path");
    return overrides;
}

/// An explorer of a small scene, at work on a thread of its own.
class AtWork {
  public:
    explicit AtWork(Explorer::TakeImage take = {}) {
        write_scene(folder_.path());
        explorer_.emplace(prepare_scene(folder_.path(), small_image()),
                          std::vector<GivenOption>{{"", folder_.path().string()}, {"--size", "48x36"}}, threads_,
                          std::move(take));
        thread_ = std::thread([this] { explorer_->run([this] { return is_ended_.load(); }); });
    }
    ~AtWork() {
        is_ended_ = true;
        thread_.join();
    }

    [[nodiscard]] Explorer& explorer() { return *explorer_; }
    [[nodiscard]] const TestFolder& folder() const { return folder_; }
    [[nodiscard]] const ThreadPool& threads() const { return threads_; }
    /// Waits until an image has at least as many samples per pixel; false if it does not come.
    [[nodiscard]] bool wait_for(std::size_t side, int spp) {
        const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (std::chrono::steady_clock::now() < until) {
            explorer_->wait_for_news(explorer_->serial());
            const auto facts = explorer_->image(side).facts();
            if (facts && facts->spp >= spp) return true;
        }
        return false;
    }

  private:
    TestFolder folder_;
    ThreadPool threads_{2};
    std::optional<Explorer> explorer_;
    std::atomic<bool> is_ended_{false};
    std::thread thread_;
};

/// The picture of the same scene rendered with these settings from the beginning.
std::string picture_of_render(const AtWork& work, SettingsOverrides overrides, int spp) {
    overrides.give("--spp", std::to_string(spp));
    const ColorConfig colors = ColorConfig::from_environment();
    PreparedScene prepared = prepare_scene(work.folder().path(), overrides);
    RenderSettings settings = prepared.scene.settings;
    const std::string space = resolve_colors(settings, colors);
    const World world =
        ray_code().compile_world(std::move(prepared.scene), colors, space, work.threads(), prepared.problems, {});
    const std::atomic<bool> stop{false};
    const RenderResult result =
        render(world, *create_integrator(settings), make_render_options(settings), work.threads(), stop, {});
    LiveImage image(colors);
    OutputFrame frame;
    frame.pixels = rgba_image(result.film);
    frame.working_space = space;
    image.set(std::move(frame));
    return image.png({}).body;
}

TEST(Explorer, ShowsWhatItsCommandRenders) {
    AtWork work;
    Explorer& explorer = work.explorer();
    explorer.move_camera("0.3123456789,0.2,2,0,0,0", true);
    explorer.move_camera("0.3123456789,0.2,2.5,0,0,0", false);
    explorer.choose(1, {.is_shown = true, .integrator = "bdpt", .max_depth = 4, .more = "--heuristic power --seed 7"});
    ASSERT_TRUE(work.wait_for(0, 8) && work.wait_for(1, 8));
    const auto sides = explorer.sides();
    const std::string place = "0.312346,0.2,2.5,0,0,0";
    const std::string scene = "'" + work.folder().path().string() + "'";
    EXPECT_EQ(sides[0].command, "etendue render " + scene +
                                    " --size '48x36' --exposure '0' --integrator 'path' --max-depth '32' "
                                    "--camera-place '" +
                                    place + "'");
    EXPECT_EQ(sides[1].command, "etendue render " + scene +
                                    " --size '48x36' --exposure '0' --integrator 'bdpt' --max-depth '4' "
                                    "--heuristic 'power' --seed '7' --camera-place '" +
                                    place + "'");
    SettingsOverrides first = small_image();
    first.give("--camera-place", place);
    first.give("--max-depth", "32");
    first.give("--exposure", "0");
    SettingsOverrides second = first;
    for (const auto& [option, text] :
         {std::pair("--integrator", "bdpt"), {"--max-depth", "4"}, {"--heuristic", "power"}, {"--seed", "7"}})
        second.give(option, text);
    for (const std::size_t side : {0u, 1u}) {
        // More samples may come between the two questions.
        std::string seen;
        int spp = 0;
        for (int tries = 0; tries < 50; ++tries) {
            spp = explorer.image(side).facts()->spp;
            seen = explorer.image(side).png({}).body;
            if (explorer.image(side).facts()->spp == spp) break;
        }
        EXPECT_TRUE(seen == picture_of_render(work, side == 0 ? first : second, spp)) << side << " after " << spp;
    }
}

TEST(Explorer, GivesBothImagesEqualTime) {
    AtWork work;
    work.explorer().choose(1, {.is_shown = true, .integrator = "bdpt", .max_depth = 8, .more = ""});
    ASSERT_TRUE(work.wait_for(1, 64) && work.wait_for(0, 64));
    const auto sides = work.explorer().sides();
    // A pass takes a fifth of a second at most, in each of two threads.
    EXPECT_LT(std::abs(sides[0].cpu_seconds - sides[1].cpu_seconds), 0.5);
    EXPECT_GT(sides[0].cpu_seconds, 0.0);
}

TEST(Explorer, HandsWholeImagesOverThoughNobodyLooks) {
    std::mutex mutex;
    std::map<std::string, std::pair<int, int>> sizes;
    const AtWork work([&](const std::string& name, const OutputFrame& frame) {
        const std::scoped_lock lock(mutex);
        sizes[name] = {frame.pixels.width, frame.pixels.height};
        return true;
    });
    const auto count = [&] {
        const std::scoped_lock lock(mutex);
        return sizes.size();
    };
    for (int tries = 0; tries < 2000 && count() == 0; ++tries)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const std::scoped_lock lock(mutex);
    ASSERT_FALSE(sizes.empty());
    EXPECT_TRUE(sizes.begin()->first.ends_with(", left: path")) << sizes.begin()->first;
    EXPECT_EQ(sizes.begin()->second, std::pair(48, 36));
}

TEST(Explorer, ShowsAStrategyBesideWhatHasNone) {
    TestFolder folder;
    write_scene(folder.path());
    SettingsOverrides overrides = small_image();
    overrides.give("--integrator", "bdpt");
    overrides.give("--strategy", "1,2");
    const ThreadPool threads(1);
    Explorer explorer(prepare_scene(folder.path(), overrides), {{"", folder.path().string()}}, threads);
    EXPECT_EQ(explorer.sides()[1].choice.integrator, "path");
}

TEST(Explorer, MovesACameraFinelyFarFromTheOrigin) {
    AtWork work;
    const std::string place = "6378137.25,0.5,2.5,6378137,0,0";
    work.explorer().move_camera(place, false);
    ASSERT_TRUE(work.wait_for(0, 1));
    for (int tries = 0; tries < 200 && work.explorer().camera().eye.x < 1.0; ++tries)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_NE(work.explorer().sides()[0].command.find("'" + place + "'"), std::string::npos)
        << work.explorer().sides()[0].command;
}

TEST(Explorer, KnowsWhereItsCameraIsAndWhereItWasAtFirst) {
    AtWork work;
    Explorer& explorer = work.explorer();
    const CameraPlace first = explorer.camera();
    EXPECT_EQ(explorer.own_camera().eye.z, first.eye.z);
    explorer.move_camera("0.5,0.25,7,0,0,0", true);
    EXPECT_NEAR(explorer.camera().eye.z, 7.0, 1e-4) << "what is asked for is told at once";
    ASSERT_TRUE(work.wait_for(0, 1));
    EXPECT_NEAR(explorer.camera().eye.z, 7.0, 1e-4);
    EXPECT_EQ(explorer.own_camera().eye.z, first.eye.z);
}

TEST(Explorer, RefusesWhatItCannotChange) {
    AtWork work;
    Explorer& explorer = work.explorer();
    const auto with = [](const std::string& more) {
        return ExplorerChoice{.is_shown = true, .integrator = "path", .max_depth = 8, .more = more};
    };
    for (const std::string more : {"--size 9x9", "--environment /etc/passwd", "-o x.exr", "scene", "--max-depth 0",
                                   "--max-depth", "--heuristic best", "--integrator bdpt"})
        EXPECT_THROW(explorer.choose(0, with(more)), UsageError) << more;
    EXPECT_THROW(explorer.choose(0, {.integrator = "auto", .max_depth = 8}), UsageError);
    EXPECT_THROW(explorer.choose(0, {.integrator = "best", .max_depth = 8}), SceneError);
    for (const std::string place : {"", "0,0,0", "0,0,0,0,0,0", "0,0,1,0,0,nan", "0,0,0,0,1,0"})
        EXPECT_THROW(explorer.move_camera(place, false), UsageError) << place;
    EXPECT_NO_THROW(explorer.choose(0, with("--light-samples=2 --unweighted")));
}

}  // namespace

}  // namespace etendue::test
