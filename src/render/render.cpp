#include "render/render.h"

#include "render/tiles.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include <sys/resource.h>

namespace etendue {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What one thread keeps between tiles.
struct Worker {
    std::unique_ptr<IntegratorScratch> scratch;
    TileBuffer tile;
    RenderCounters counters;
};

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
    RenderResult result{.film = Film(options.full_width, options.full_height, options.window), .counters = {}};
    const std::vector<PixelRect> tiles = make_tiles(options.window);
    const bool makes_splats = integrator.makes_splats();
    std::vector<std::vector<Splat>> splats;  // of each tile of a group
    std::vector<Worker> workers(static_cast<std::size_t>(threads.thread_count()));
    for (Worker& worker : workers) worker.scratch = integrator.make_scratch();

    const Clock::time_point start = Clock::now();
    const double cpu_start = process_cpu_seconds();
    ProgressReporter reporter(progress, options.window.area() * static_cast<std::uint64_t>(options.spp), start);

    while (result.spp_done < options.spp) {
        std::uint32_t count = pass_size(result.spp_done, options.spp);
        if (options.time_limit_seconds > 0.0) {
            const double seconds = seconds_since(start);
            if (seconds >= options.time_limit_seconds) {
                result.halt_reason = HaltReason::TimeLimit;
                break;
            }
            count = fit_pass(count, result.spp_done, seconds, options.time_limit_seconds);
        }
        // Splats are added in the order of the tiles, whatever the order in which these are rendered.
        const std::size_t group_size = makes_splats ? splat_group_size(count) : tiles.size();
        for (std::size_t first = 0; first < tiles.size() && !stop.load(); first += group_size) {
            const std::size_t group = std::min(group_size, tiles.size() - first);
            const std::vector<std::size_t> order = make_order(group, options.tile_order_seed);
            if (makes_splats) splats.resize(group);
            std::atomic<std::uint64_t> light_paths = 0;
            threads.parallel_for(group, [&](std::size_t index, int slot) {
                if (stop.load(std::memory_order_relaxed)) return;
                Worker& worker = workers[static_cast<std::size_t>(slot)];
                const TileJob job{tiles[first + order[index]],
                                  options.window,
                                  options.full_width,
                                  options.full_height,
                                  result.spp_done,
                                  count,
                                  options.seed,
                                  options.sequence,
                                  &options.filter};
                const std::uint64_t rays_before = worker.counters.rays();
                worker.tile.reset(job.rect);
                integrator.render_tile(world, job, *worker.scratch, worker.tile, worker.counters);
                result.film.add(worker.tile);
                const std::uint64_t samples = job.rect.area() * count;
                if (makes_splats) {
                    splats[order[index]].swap(worker.tile.splats());
                    light_paths += samples;
                }
                reporter.tile_done(samples, worker.counters.rays() - rays_before);
            });
            if (makes_splats) result.film.add_splats(splats, light_paths, options.filter, threads);
            for (std::vector<Splat>& list : splats) list.clear();
        }
        if (stop.load()) {
            result.halt_reason = HaltReason::Interrupted;
            break;
        }
        result.spp_done += count;
    }
    reporter.finish();
    for (const Worker& worker : workers) result.counters.add(worker.counters);
    result.wall_seconds = seconds_since(start);
    result.cpu_seconds = process_cpu_seconds() - cpu_start;
    return result;
}

}  // namespace etendue
