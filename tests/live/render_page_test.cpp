#include "live/render_page.h"

#include "program/small_files.h"
#include "session/image_job.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Takes every image that it can get, or none but the last.
class Onlooker final : public RenderWatcher {
  public:
    explicit Onlooker(bool is_curious) : is_curious_(is_curious) {}

    void begin(const std::string& /*title*/, const std::filesystem::path& /*output*/) override {}
    void enter(std::string_view phase) override { phases_.emplace_back(phase); }
    void update(const RenderProgress& /*progress*/) override {}
    [[nodiscard]] bool wants_image() const override { return is_curious_; }
    void show(const ImageDescription& image) override {
        ++shown_;
        last_ = image.frame;
    }

    [[nodiscard]] int shown() const { return shown_; }
    [[nodiscard]] const OutputFrame& last() const { return last_; }
    [[nodiscard]] const std::vector<std::string>& phases() const { return phases_; }

  private:
    bool is_curious_;
    int shown_ = 0;
    OutputFrame last_;
    std::vector<std::string> phases_;
};

/// Renders for `onlooker`; what it saw last is what was written. Takes long enough for it to look on the way.
void render_for(Onlooker& onlooker, const TestFolder& folder, const std::string& integrator) {
    const std::string spp = integrator == "path" ? "512" : "128";
    SceneRenderRequest request;
    request.force = true;
    request.quiet = true;
    request.watchers = {&onlooker};
    for (const auto& [option, text] : {std::pair("--integrator", integrator), std::pair("--size", std::string("64x64")),
                                       std::pair("--spp", spp), std::pair("--aov", std::string("depth"))})
        request.overrides.give(option, text);
    const ThreadPool threads(2);
    (void)run_job({folder.path(), folder / "a.exr", "a", std::nullopt}, request, threads);
}

TEST(RenderWatchers, ChangeNoBitOfTheImageHoweverOftenTheyLook) {
    const TestFolder folder;
    write_scene(folder.path());
    for (const std::string integrator : {"path", "bdpt", "vcm"}) {
        SCOPED_TRACE(integrator);
        Onlooker none(false);
        render_for(none, folder, integrator);
        EXPECT_EQ(none.shown(), 1) << "nobody asked but for the end";
        Onlooker curious(true);
        render_for(curious, folder, integrator);
        EXPECT_GT(curious.shown(), 1);
        EXPECT_EQ(curious.phases(), (std::vector<std::string>{"load", "build", "render", "write", "finished"}));
        ASSERT_EQ(curious.last().layers.size(), 1u);
        EXPECT_EQ(curious.last().pixels.pixels, none.last().pixels.pixels);
        EXPECT_EQ(curious.last().layers[0].pixels.pixels, none.last().layers[0].pixels.pixels);
    }
}

}  // namespace

}  // namespace etendue::test
