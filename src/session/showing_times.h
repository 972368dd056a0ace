// When an image that is being rendered may be shown to whoever looks on.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>

namespace etendue {

/// Says when the image may be shown again, so that showing it takes a tenth of the time at most, as long as one looks.
class ShowingTimes {
  public:
    /// Returns true if the image may be shown. Safe to call from rendering threads.
    [[nodiscard]] bool is_due() const { return !is_showing_ && Clock::now() >= next_.load(); }
    /// Called when what is rendered is about to be shown.
    void begin() {
        begun_ = Clock::now();
        is_showing_ = true;
    }
    /// Called when tiles have been finished; of calls after `begin` the first counts. All that came before belongs to
    /// the price of showing, as what a stopped pass has to do again.
    void go_on() {
        if (!is_showing_) return;
        const Clock::duration cost = Clock::now() - begun_;
        next_ = Clock::now() + std::max<Clock::duration>(kLeast, 9 * cost);
        is_showing_ = false;
    }

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kFirst{50};  ///< from the beginning, so that there is something to show
    static constexpr std::chrono::milliseconds kLeast{200};

    Clock::time_point begun_{};
    std::atomic<Clock::time_point> next_{Clock::now() + kFirst};
    std::atomic<bool> is_showing_{false};
};

}  // namespace etendue
