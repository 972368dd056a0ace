#include "render/render.h"

#include "core/process_time.h"
#include "film/error_estimate.h"
#include "render/tiles.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>

namespace etendue {

namespace {

using Clock = std::chrono::steady_clock;

/// Counts finished tiles and tells the callback now and then.
class ProgressReporter {
  public:
    /// `before` was rendered earlier.
    ProgressReporter(const ProgressCallback& callback, std::uint64_t total_samples, const RenderState& before)
        : callback_(callback),
          total_samples_(total_samples),
          seconds_before_(before.wall_seconds),
          samples_(before.counters.samples),
          rays_(before.counters.rays()) {}

    void tile_done(std::uint64_t samples, std::uint64_t rays) {
        if (!callback_) return;
        const std::scoped_lock lock(mutex_);
        samples_ += samples;
        rays_ += rays;
        if (seconds_since(last_report_) < 0.1) return;
        last_report_ = Clock::now();
        report();
    }
    void finish() {
        if (!callback_) return;
        const std::scoped_lock lock(mutex_);
        report();
    }

  private:
    void report() {
        // What is gone on with may have more samples than are asked for now.
        callback_({std::min(1.0, static_cast<double>(samples_) / static_cast<double>(total_samples_)),
                   seconds_before_ + seconds_since(start_), samples_, rays_});
    }

    const ProgressCallback& callback_;
    const std::uint64_t total_samples_;
    const double seconds_before_;
    const Clock::time_point start_ = Clock::now();
    std::mutex mutex_;
    std::uint64_t samples_;
    std::uint64_t rays_;
    Clock::time_point last_report_ = start_;
};

/// Why no other pass is to begin after `now`, if so.
std::optional<HaltReason> reached_limit(const RenderState& now, const RenderOptions& options) {
    if (options.relative_error > 0.0) {
        const std::optional<double> error = relative_error(now);
        if (error && *error <= options.relative_error) return HaltReason::ErrorReached;
    }
    if (options.time_limit_seconds > 0.0 && now.wall_seconds >= options.time_limit_seconds)
        return HaltReason::TimeLimit;
    return std::nullopt;
}

/// Samples of the pass that begins after `now`.
std::uint32_t next_pass(const RenderState& now, const RenderOptions& options) {
    const std::uint32_t count = pass_size(now.next_sample(), now.first_sample + options.spp);
    if (options.time_limit_seconds <= 0.0) return count;
    return fit_pass(count, now.spp_done, now.wall_seconds, options.time_limit_seconds);
}

}  // namespace

const char* halt_reason_name(HaltReason reason) {
    switch (reason) {
        case HaltReason::SamplesDone:
            return "samples done";
        case HaltReason::TimeLimit:
            return "time limit";
        case HaltReason::ErrorReached:
            return "error reached";
        case HaltReason::Interrupted:
            return "interrupted";
    }
    return "unknown";
}

ImageF rgba_image(const Film& film) {
    ImageF image;
    image.width = film.window().width();
    image.height = film.window().height();
    image.channels = 4;
    image.pixels = film.resolve();
    return image;
}

std::optional<double> relative_error(const RenderState& state) {
    // Estimates from a few samples would end renders by luck.
    constexpr std::uint32_t kFewest = 16;
    const std::uint32_t other = state.spp_done - state.every_other_spp;
    if (!state.every_other_pass || state.pass_size > 0 || state.every_other_spp < kFewest || other < kFewest)
        return std::nullopt;
    return estimate_relative_error(state.film, *state.every_other_pass,
                                   static_cast<double>(state.every_other_spp) / static_cast<double>(state.spp_done));
}

RenderResult render(const World& world, const Integrator& integrator, const RenderOptions& options,
                    const ThreadPool& threads, const std::atomic<bool>& stop, const ProgressCallback& progress,
                    const RenderPause& pause, RenderState state) {
    ProgressReporter reporter(progress, options.window.area() * static_cast<std::uint64_t>(options.spp), state);
    ProgressiveRender rendering(world, integrator, options, threads, std::move(state));
    const RenderState& now = rendering.state();
    const StopPredicate is_wanted = [&] {
        return stop.load(std::memory_order_relaxed) || (pause.is_due && pause.is_due());
    };
    HaltReason halt_reason = HaltReason::SamplesDone;
    // A pass that is under way is finished, whatever the limits say: no pixel is left with fewer samples than others.
    while (now.spp_done < options.spp || now.pass_size > 0) {
        if (stop.load()) {
            halt_reason = HaltReason::Interrupted;
            break;
        }
        if (pause.is_due && pause.is_due()) pause.act(now);
        std::uint32_t count = 0;
        if (now.pass_size == 0) {
            if (const std::optional<HaltReason> limit = reached_limit(now, options)) {
                halt_reason = *limit;
                break;
            }
            count = next_pass(now, options);
        }
        rendering.add_samples(count, is_wanted,
                              [&](std::uint64_t samples, std::uint64_t rays) { reporter.tile_done(samples, rays); });
    }
    reporter.finish();
    return {rendering.take_state(), halt_reason};
}

RenderResult render(const World& world, const Integrator& integrator, const RenderOptions& options,
                    const ThreadPool& threads, const std::atomic<bool>& stop, const ProgressCallback& progress) {
    return render(world, integrator, options, threads, stop, progress, {}, {.film = make_film(options)});
}

}  // namespace etendue
