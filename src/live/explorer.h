// A scene to look around in: one or two integrators render it again and again from wherever the camera is.
#pragma once

#include "core/parallel.h"
#include "image/image_module.h"
#include "live/live_image.h"
#include "output/output_frame.h"
#include "picture/render_setup.h"
#include "render/progressive_render.h"
#include "scene/scene_desc.h"
#include "session/given_options.h"
#include "session/prepared_scene.h"
#include "session/settings_overrides.h"
#include "world/world.h"

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace etendue {

/// Asks for one of the two images.
struct ExplorerChoice {
    bool is_shown = true;
    std::string integrator{};
    int max_depth = 0;   ///< in edges
    std::string more{};  ///< further options of `render` that decide what a sample is, as on its command line
};

/// Says how one of the two images is.
struct ExplorerSide {
    ExplorerChoice choice{};
    double cpu_seconds = 0.0;
    std::uint64_t rays = 0;
    std::string command{};  ///< the command line that renders this image
};

/// Renders a scene for a page. `run` works on the calling thread; all other functions are for other threads.
class Explorer {
  public:
    /// Gets images of full size under a name of the scene, side and integrator, twice a second of each side.
    using TakeImage = std::function<bool(const std::string& name, const OutputFrame& frame)>;

    /// Compiles the scene. `given` are the options of the command line, which commands to copy repeat. `take`, which
    /// may be empty, is called by `run`, which then renders also while nobody looks. Throws what `compile_world` does,
    /// and SceneError for settings that cannot be.
    Explorer(PreparedScene prepared, const std::vector<GivenOption>& given, const ThreadPool& threads,
             TakeImage take = {});

    /// Renders until `end` returns true: whichever image has had less processor time goes on. Nothing is rendered
    /// once all samples are taken, nor while nobody looks.
    void run(const StopPredicate& end);

    /// Puts the camera at `place`, the text of --camera-place. While it `moves`, images are as small as it takes to
    /// keep up with it. Throws UsageError for a place that cannot be.
    void move_camera(const std::string& place, bool moves);
    /// Puts the integrator and settings of one image in place of those before. Throws UsageError or SceneError, which
    /// say what is wrong with them.
    void choose(std::size_t side, const ExplorerChoice& choice);

    /// Returns an image.
    [[nodiscard]] const LiveImage& image(std::size_t side) const { return sides_.at(side).image; }
    [[nodiscard]] std::array<ExplorerSide, 2> sides() const;
    /// Returns where the camera stands, or is about to: eye, target and up.
    [[nodiscard]] CameraPlace camera() const;
    /// Returns where the camera stood at first.
    [[nodiscard]] const CameraPlace& own_camera() const { return own_camera_; }
    /// Returns a number that grows with every image and every change.
    [[nodiscard]] std::uint64_t serial() const;
    /// Waits until that number is more than `serial`, or a time has passed. Tells that somebody looks.
    void wait_for_news(std::uint64_t serial);
    [[nodiscard]] const std::string& name() const { return scene_.name; }
    /// Returns the width and height of the whole image, in pixels.
    [[nodiscard]] std::pair<int, int> size() const;
    [[nodiscard]] const ColorConfig& colors() const { return colors_; }

  private:
    using Clock = std::chrono::steady_clock;

    struct Side {
        explicit Side(const ColorConfig& colors) : image(colors) {}

        ExplorerChoice choice{};
        RenderSettings settings{};
        std::unique_ptr<const Integrator> integrator{};
        std::optional<ProgressiveRender> rendering{};
        int shrink = 0;                    ///< `rendering` is so many times smaller than the image; 0: it has not begun
        double seconds_per_sample = 1e-6;  ///< on the clock, as far as is known
        double cpu_seconds = 0.0;
        std::uint64_t rays = 0;
        LiveImage image;
        Clock::time_point taken{};  ///< when the image was last handed to `take_`
    };

    /// Holds what pages ask for until it is done.
    struct Wishes {
        std::optional<CameraPlace> camera{};
        std::array<std::optional<std::pair<ExplorerChoice, RenderSettings>>, 2> sides{};

        [[nodiscard]] bool are_there() const { return camera || sides[0] || sides[1]; }
    };

    [[nodiscard]] RenderSettings settings_of(const ExplorerChoice& choice) const;
    [[nodiscard]] bool is_watched() const { return is_taken_ || Clock::now() - looked_at_.load() < kWatchedFor; }
    /// Returns true while a drag goes on; one whose end is never told, as its page is closed, ends after a second.
    [[nodiscard]] bool does_camera_move() const { return Clock::now() - moved_at_.load() < std::chrono::seconds(1); }
    void fulfil(Wishes wishes);
    void restart(Side& side);
    /// Returns the side that goes on, or null if there is nothing to do.
    [[nodiscard]] Side* next_side();
    void begin(Side& side, int shrink);
    void advance(Side& side, const StopPredicate& end);
    void publish(Side& side);
    /// Hands `frame` to `take_` if it is time for that.
    void hand_over(Side& side, const OutputFrame& frame);
    void count_news();

    std::future<void> image_module_ = load_image_module_early();  ///< while what makes pictures is loaded
    const ThreadPool& threads_;
    ColorConfig colors_ = ColorConfig::from_environment();
    std::vector<GivenOption> given_;
    TakeImage take_;
    std::atomic<bool> is_taken_ = false;   ///< `take_` still shows images
    SceneDesc scene_;                      ///< cameras, settings and names; the rest is in the world
    std::optional<std::string> replaced_;  ///< the name of a material that is a shadow catcher or a holdout, if any is
    double distance_ = 1.0;                ///< from the scene's own camera to what it turns around, metres
    std::optional<World> world_;
    std::array<Side, 2> sides_{Side(colors_), Side(colors_)};

    mutable std::mutex mutex_;  ///< guards wishes, choices, counts and the camera of `scene_`
    std::condition_variable news_;
    Wishes wishes_;
    std::atomic<bool> has_wishes_{false};
    std::atomic<Clock::time_point> moved_at_{};  ///< while a drag goes on: when the camera last moved
    std::atomic<Clock::time_point> looked_at_{};
    std::uint64_t serial_ = 1;
    CameraPlace own_camera_{};  ///< where the camera stands at first; does not change
};

}  // namespace etendue
