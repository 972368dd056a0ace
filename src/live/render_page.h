// The page of a render that runs.
#pragma once

#include "color/color_config.h"
#include "live/live_image.h"
#include "live/live_server.h"
#include "session/render_watcher.h"

#include <atomic>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace etendue {

/// Shows renders to a browser while it lives: of several, the one that runs. Its buttons do what signals do.
class RenderPage final : public RenderWatcher {
  public:
    /// Listens on `port`, or on a free one if that is 0, and says where on stderr. Throws IoError if it cannot.
    explicit RenderPage(int port);
    /// Waits for a second if a page is open: it, and any other, asks again in that time and sees the end.
    ~RenderPage() override;

    void begin(const std::string& title, const std::filesystem::path& output) override;
    void enter(std::string_view phase) override;
    void update(const RenderProgress& progress) override;
    [[nodiscard]] bool wants_image() const override;
    void show(const ImageDescription& image) override;

    /// Returns the address of the page.
    [[nodiscard]] const std::string& url() const { return server_.url(); }

  private:
    using Clock = std::chrono::steady_clock;

    /// Says how the render is, as JSON. `mutex_` must be held.
    [[nodiscard]] std::string status() const;
    [[nodiscard]] LiveAnswer answer(const LiveRequest& request);
    [[nodiscard]] bool is_watched() const;

    ColorConfig colors_ = ColorConfig::from_environment();
    LiveImage image_{colors_};
    std::atomic<Clock::time_point> looked_at_{};  ///< when a page last asked for the state
    mutable std::mutex mutex_;
    std::string title_;
    std::filesystem::path output_;
    std::string phase_ = "load";
    RenderProgress progress_;
    int spp_requested_ = 0;
    std::optional<double> error_;
    LiveServer server_;  ///< last: it answers from the others
};

/// Prints the line that tells where a page is.
void announce_page(const std::string& url);

}  // namespace etendue
