#include "render/render.h"

#include "render/tiles.h"

#include <chrono>
#include <mutex>

#include <sys/resource.h>

namespace etendue {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Counts finished tiles and tells the callback now and then.
class ProgressReporter {
  public:
    ProgressReporter(const ProgressCallback& callback, std::uint64_t total_samples, Clock::time_point start)
        : callback_(callback), total_samples_(total_samples), start_(start) {}

    void tile_done(std::uint64_t samples, std::uint64_t rays) {
        if (!callback_) return;
        const std::scoped_lock lock(mutex_);
        samples_ += samples;
        rays_ += rays;
        const double now = seconds_since(start_);
        if (now - last_report_ < 0.1) return;
        last_report_ = now;
        report(now);
    }
    void finish() {
        if (!callback_) return;
        const std::scoped_lock lock(mutex_);
        report(seconds_since(start_));
    }

  private:
    void report(double now) {
        callback_({static_cast<double>(samples_) / static_cast<double>(total_samples_), now, samples_, rays_});
    }

    const ProgressCallback& callback_;
    const std::uint64_t total_samples_;
    const Clock::time_point start_;
    std::mutex mutex_;
    std::uint64_t samples_ = 0;
    std::uint64_t rays_ = 0;
    double last_report_ = 0.0;
};

}  // namespace

const char* halt_reason_name(HaltReason reason) {
    switch (reason) {
        case HaltReason::SamplesDone:
            return "samples done";
        case HaltReason::TimeLimit:
            return "time limit";
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

double process_cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

RenderResult render(const World& world, const Integrator& integrator, const RenderOptions& options,
                    const ThreadPool& threads, const std::atomic<bool>& stop, const ProgressCallback& progress) {
    ProgressiveRender rendering(world, integrator, options, threads);
    const Clock::time_point start = Clock::now();
    const double cpu_start = process_cpu_seconds();
    ProgressReporter reporter(progress, options.window.area() * static_cast<std::uint64_t>(options.spp), start);
    HaltReason halt_reason = HaltReason::SamplesDone;
    while (rendering.spp_done() < options.spp) {
        std::uint32_t count = pass_size(rendering.spp_done(), options.spp);
        if (options.time_limit_seconds > 0.0) {
            const double seconds = seconds_since(start);
            if (seconds >= options.time_limit_seconds) {
                halt_reason = HaltReason::TimeLimit;
                break;
            }
            count = fit_pass(count, rendering.spp_done(), seconds, options.time_limit_seconds);
        }
        const bool done = rendering.add_samples(
            count, stop, [&](std::uint64_t samples, std::uint64_t rays) { reporter.tile_done(samples, rays); });
        if (!done) {
            halt_reason = HaltReason::Interrupted;
            break;
        }
    }
    reporter.finish();
    return {.counters = rendering.counters(),
            .halt_reason = halt_reason,
            .spp_done = rendering.spp_done(),
            .wall_seconds = seconds_since(start),
            .cpu_seconds = process_cpu_seconds() - cpu_start,
            .film = rendering.take_film()};
}

}  // namespace etendue
