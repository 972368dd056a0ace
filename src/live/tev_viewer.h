// A growing image for tev, the viewer of high dynamic range images (https://github.com/Tom94/tev), by its protocol.
#pragma once

#include "output/output_frame.h"
#include "process/file_descriptor.h"
#include "session/render_watcher.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace etendue {

/// Says where tev listens.
struct TevAddress {
    std::string host{};
    std::string port{};

    /// Reads "HOST:PORT"; nothing if `text` is not of that form.
    [[nodiscard]] static std::optional<TevAddress> parse(const std::string& text);
};

/// Sends images of renders to tev while it lives, from a thread of its own. If tev cannot be reached, or is closed, it
/// warns once and sends nothing more; no render fails for that.
class TevViewer final : public RenderWatcher {
  public:
    explicit TevViewer(TevAddress address);
    /// Sends what is left to be sent, for ten seconds at most.
    ~TevViewer() override;

    void begin(const std::string& title, const std::filesystem::path& output) override;
    void enter(std::string_view /*phase*/) override {}
    void update(const RenderProgress& /*progress*/) override {}
    [[nodiscard]] bool wants_image() const override;
    void show(const ImageDescription& image) override;
    /// Sends `frame` as the image `name`, unless a newer one of that name comes before it is sent.
    void show(const std::string& name, const OutputFrame& frame);

    /// Returns whether there was no viewer, or it has gone: it gets no more images.
    [[nodiscard]] bool is_lost() const { return is_lost_; }

  private:
    using Clock = std::chrono::steady_clock;

    void run();
    /// Sends `frame` as the image `name`, which is made anew the first time. Throws IoError.
    void send(const std::string& name, const OutputFrame& frame);
    void send_bytes(std::string_view bytes) const;
    /// Waits until `socket` can be written to. Throws IoError if it cannot for some seconds, or the end has come.
    void wait_until_writable(int socket) const;
    [[nodiscard]] FileDescriptor connect() const;

    const TevAddress address_;
    std::atomic<bool> is_idle_{true};
    std::atomic<bool> is_lost_{false};
    std::atomic<Clock::time_point> shown_{};
    std::atomic<Clock::time_point> deadline_{Clock::time_point::max()};  ///< when the thread gives up
    std::mutex mutex_;                                                   ///< guards the next four
    std::condition_variable woken_;
    std::string name_;
    std::deque<std::pair<std::string, std::shared_ptr<const OutputFrame>>> next_;  ///< one image of each name at most
    bool is_ended_ = false;
    FileDescriptor socket_;             ///< socket of the thread, which also has the next member
    std::set<std::string> sent_names_;  ///< names of images that tev has
    std::thread thread_;
};

}  // namespace etendue
