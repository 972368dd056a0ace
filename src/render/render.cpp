#include "render/render.h"

#include "core/process_time.h"
#include "film/error_estimate.h"
#include "render/adaptive_pass.h"
#include "render/tiles.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>
#include <vector>

namespace etendue {

namespace {

using Clock = std::chrono::steady_clock;

/// Counts finished tiles and tells the callback now and then.
class ProgressReporter {
  public:
    /// `before` was rendered earlier.
    ProgressReporter(const ProgressCallback& callback, const RenderOptions& options, const RenderState& before)
        : callback_(callback),
          total_samples_(static_cast<double>(options.window.area()) * options.spp),
          time_limit_(options.time_limit_seconds),
          seconds_before_(before.wall_seconds),
          samples_(before.counters.samples),
          rays_(before.counters.rays.total()) {}

    void tile_done(std::uint64_t samples, std::uint64_t rays) {
        if (!callback_) return;
        const std::scoped_lock lock(mutex_);
        samples_ += samples;
        rays_ += rays;
        if (seconds_since(last_report_) < 0.1) return;
        last_report_ = Clock::now();
        report(false);
    }
    void finish(bool is_complete) {
        if (!callback_) return;
        const std::scoped_lock lock(mutex_);
        report(is_complete);
    }

  private:
    void report(bool is_complete) {
        const double seconds = seconds_before_ + seconds_since(start_);
        double fraction = static_cast<double>(samples_) / total_samples_;
        if (time_limit_ > 0.0) fraction = std::max(fraction, seconds / time_limit_);
        // What is gone on with may have more samples than are asked for now.
        callback_({is_complete ? 1.0 : std::min(1.0, fraction), seconds, samples_, rays_});
    }

    const ProgressCallback& callback_;
    const double total_samples_;
    const double time_limit_;
    const double seconds_before_;
    const Clock::time_point start_ = Clock::now();
    std::mutex mutex_;
    std::uint64_t samples_;
    std::uint64_t rays_;
    Clock::time_point last_report_ = start_;
};

/// Nothing as long as there are too few samples, or if every other pass is not kept.
std::optional<ErrorEstimate> error_of(const RenderState& state, const ThreadPool& threads) {
    // Estimates from a few samples would end renders by luck.
    constexpr std::uint32_t kFewest = 16;
    const std::uint32_t other = state.spp_done - state.every_other_spp;
    if (!state.every_other_pass || state.pass_size > 0 || state.every_other_spp < kFewest || other < kFewest)
        return std::nullopt;
    return estimate_errors(state.film, *state.every_other_pass, threads);
}

/// Why no other pass is to begin after `now`, whose error that is, if so.
std::optional<HaltReason> reached_limit(const RenderState& now, const std::optional<ErrorEstimate>& error,
                                        const RenderOptions& options) {
    if (error && error->relative_error() <= options.relative_error) return HaltReason::ErrorReached;
    if (options.time_limit_seconds > 0.0 && now.wall_seconds >= options.time_limit_seconds)
        return HaltReason::TimeLimit;
    return std::nullopt;
}

/// `wanted` samples of `pixels` pixels, or as many as fit before the limit of time.
std::uint32_t fitting(std::uint32_t wanted, std::size_t pixels, const RenderState& now, const RenderOptions& options) {
    if (options.time_limit_seconds <= 0.0) return wanted;
    const std::uint64_t done = now.counters.samples / pixels;
    return fit_pass(wanted, static_cast<std::uint32_t>(std::min<std::uint64_t>(done, ~std::uint32_t{0})),
                    now.wall_seconds, options.time_limit_seconds);
}

/// Holds the next thing to do between passes: a pass, or the end of the render.
struct NextStep {
    std::optional<HaltReason> halt{};       ///< why no other pass begins; none if one does
    std::uint32_t count = 0;                ///< samples per pixel of the next pass
    std::vector<std::uint8_t> is_active{};  ///< 1 for pixels that take part in the next pass; empty for all
};

NextStep next_step(const RenderState& now, const RenderOptions& options, const ThreadPool& threads) {
    std::optional<ErrorEstimate> error;
    // Samples that merge are added one by one: a pause between two of them must decide nothing.
    const bool is_due = !now.adaptive.is_uniform() || begins_pass(now.next_sample());
    if (options.relative_error > 0.0 && is_due) error = error_of(now, threads);
    if (const auto limit = reached_limit(now, error, options)) return {.halt = limit};
    const bool is_begun = !now.adaptive.is_uniform();
    if (!error || !options.adaptive || (now.spp_done < options.min_spp && !is_begun)) {
        const std::uint32_t count = pass_size(now.next_sample(), now.first_sample + options.spp);
        return {.count = fitting(count, options.window.area(), now, options)};
    }
    // A render that is gone on with may have been adaptive from fewer samples on.
    AdaptivePass pass = now.spp_done < options.min_spp
                            ? pass_up_to(now.adaptive, std::min(options.min_spp, options.spp))
                            : plan_adaptive_pass(now, *error, options.relative_error, options.spp, threads);
    if (pass.active == 0) return {.halt = HaltReason::SamplesDone};
    return {.count = fitting(pass.count, pass.active, now, options), .is_active = std::move(pass.is_active)};
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
    const std::optional<ErrorEstimate> error = error_of(state, ThreadPool(1));
    return error ? std::optional(error->relative_error()) : std::nullopt;
}

RenderResult render(const World& world, const Integrator& integrator, const RenderOptions& options,
                    const ThreadPool& threads, const std::atomic<bool>& stop, const ProgressCallback& progress,
                    const RenderPause& pause, RenderState state) {
    ProgressReporter reporter(progress, options, state);
    ProgressiveRender rendering(world, integrator, options, threads, std::move(state));
    const RenderState& now = rendering.state();
    const StopPredicate is_wanted = [&] {
        return stop.load(std::memory_order_relaxed) || (pause.is_due && pause.is_due());
    };
    const TileCallback tile_done = [&](std::uint64_t samples, std::uint64_t rays) {
        reporter.tile_done(samples, rays);
    };
    HaltReason halt_reason = HaltReason::SamplesDone;
    // A pass that is under way is finished, whatever the limits say: no pixel is left with fewer samples than others.
    while (now.spp_done < options.spp || now.pass_size > 0) {
        if (stop.load()) {
            halt_reason = HaltReason::Interrupted;
            break;
        }
        if (pause.is_due && pause.is_due()) pause.act(now);
        NextStep next;
        if (now.pass_size == 0) next = next_step(now, options, threads);
        if (next.halt) {
            halt_reason = *next.halt;
            break;
        }
        if (next.is_active.empty())
            rendering.add_samples(next.count, is_wanted, tile_done);
        else
            rendering.add_samples_to(std::move(next.is_active), next.count, is_wanted, tile_done);
    }
    reporter.finish(halt_reason != HaltReason::Interrupted);
    return {rendering.take_state(), halt_reason};
}

RenderResult render(const World& world, const Integrator& integrator, const RenderOptions& options,
                    const ThreadPool& threads, const std::atomic<bool>& stop, const ProgressCallback& progress) {
    return render(world, integrator, options, threads, stop, progress, {}, {.film = make_film(options)});
}

}  // namespace etendue
