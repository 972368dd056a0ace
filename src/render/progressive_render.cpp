#include "render/progressive_render.h"

#include "core/process_time.h"
#include "core/vector_bytes.h"
#include "render/render_profile.h"
#include "render/tiles.h"
#include "wave/camera_wave.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <utility>

namespace etendue {

namespace {

using Clock = std::chrono::steady_clock;

Film empty_film(const SamplingOptions& options, const LayerLayout& layout) {
    return {options.full_width, options.full_height, options.window,
            options.splat_window.empty() ? options.window : options.splat_window, layout};
}

/// Times a tile for the profile, if there is one.
class TileTimer {
  public:
    /// Begins, and lets `job` write its stages into the profile. `profile` may be null.
    TileTimer(RenderProfile* profile, TileJob& job, int slot)
        : profile_(profile), time_{.rect = job.rect, .slot = slot, .first_sample = job.first_sample} {
        if (profile == nullptr) return;
        stages_ = job.profile = &profile->wave(slot);
        stages_->clock().skip();
        time_.start = profile->now();
        time_.cpu_seconds = -thread_cpu_seconds();
    }

    /// Ends once the tile is in the film.
    void end(std::uint64_t samples) {
        if (profile_ == nullptr) return;
        stages_->clock().stamp(Stage::Film);
        time_.samples = samples;
        time_.end = profile_->now();
        time_.cpu_seconds += thread_cpu_seconds();
        profile_->add_tile(time_);
    }

  private:
    RenderProfile* profile_;
    WaveProfile* stages_ = nullptr;
    TileTime time_;
};

}  // namespace

Film make_film(const SamplingOptions& options) {
    return empty_film(options, options.aovs ? options.aovs->layout : LayerLayout{});
}

Film make_second_film(const SamplingOptions& options) {
    return empty_film(options, options.aovs ? options.aovs->layout.without_lists() : LayerLayout{});
}

ProgressiveRender::ProgressiveRender(const World& world, const Integrator& integrator, const SamplingOptions& options,
                                     const ThreadPool& threads)
    : ProgressiveRender(world, integrator, options, threads, {.film = make_film(options)}) {}

ProgressiveRender::ProgressiveRender(const World& world, const Integrator& integrator, const SamplingOptions& options,
                                     const ThreadPool& threads, RenderState state)
    : world_(world),
      integrator_(integrator),
      options_(options),
      threads_(threads),
      state_(std::move(state)),
      tiles_(make_tiles(options.window)),
      workers_(static_cast<std::size_t>(threads.thread_count())) {
    // Samples of pixels, and of images that they show, fall as far beside the window as the filter reaches.
    const int beyond = static_cast<int>(std::ceil(options.filter.radius())) + 1;
    const PixelRect& window = options.window;
    lamp_images_ =
        integrator.lamp_images(world, make_job({0, 0, options.full_width, options.full_height}),
                               {window.x0 - beyond, window.y0 - beyond, window.x1 + beyond, window.y1 + beyond});
}

std::size_t ProgressiveRender::scratch_bytes() const {
    std::size_t bytes = 0;
    for (const Worker& worker : workers_) bytes += worker.scratch ? worker.scratch->bytes() : 0;
    return bytes;
}

std::size_t ProgressiveRender::tile_bytes() const {
    std::size_t bytes =
        vector_bytes(tiles_, splats_) + (photons_ ? photons_->bytes() : 0) + (lamp_images_ ? lamp_images_->bytes() : 0);
    for (const Worker& worker : workers_) bytes += worker.tile.bytes();
    for (const std::vector<Splat>& list : splats_) bytes += vector_bytes(list);
    return bytes;
}

bool ProgressiveRender::add_samples(std::uint32_t count, const StopPredicate& stop, const TileCallback& tile_done) {
    if (state_.pass_size > 0) return go_on(stop, tile_done);
    // Samples that merge have photons of their own index.
    const bool merges = integrator_.merging(world_, make_job(options_.window)).merges();
    const std::uint32_t size = merges ? 1 : count;
    for (std::uint32_t done = 0; done < count; done += size) {
        begin_pass(size);
        if (!go_on(stop, tile_done)) return false;
    }
    return true;
}

bool ProgressiveRender::add_samples_to(std::vector<std::uint8_t> is_active, std::uint32_t count,
                                       const StopPredicate& stop, const TileCallback& tile_done) {
    if (state_.pass_size == 0) {
        begin_pass(count);
        AdaptiveState& adaptive = state_.adaptive;
        if (adaptive.is_uniform()) adaptive.samples.assign(options_.window.area(), state_.spp_done);
        adaptive.is_active = std::move(is_active);
    }
    return go_on(stop, tile_done);
}

void ProgressiveRender::begin_pass(std::uint32_t count) {
    state_.pass_size = count;
    state_.tiles_done.assign(tiles_.size(), 0);
}

void ProgressiveRender::finish_pass() {
    AdaptiveState& adaptive = state_.adaptive;
    const std::uint32_t count = std::exchange(state_.pass_size, 0);
    state_.tiles_done.clear();
    if (adaptive.is_uniform()) {
        state_.spp_done += count;
        return;
    }
    // Without a choice of pixels, all were active.
    for (std::size_t p = 0; p < adaptive.samples.size(); ++p)
        if (adaptive.is_active.empty() || adaptive.is_active[p] != 0) adaptive.samples[p] += count;
    adaptive.is_active.clear();
    ++adaptive.passes;
    state_.spp_done = std::ranges::min(adaptive.samples);
}

bool ProgressiveRender::go_on(const StopPredicate& stop, const TileCallback& tile_done) {
    const auto start = Clock::now();
    const double cpu_start = process_cpu_seconds();
    trace_photons();
    // Splats are added in the order of the tiles, whatever the order in which these are rendered.
    for (std::size_t first = 0; first < tiles_.size() && !stop();) {
        const std::size_t left = tiles_.size() - first;
        const std::size_t size = integrator_.makes_splats() ? std::min(left, splat_group_size()) : left;
        const auto group_start = Clock::now();
        render_group(first, size, stop, tile_done);
        seconds_per_tile_ = seconds_since(group_start) / static_cast<double>(size);
        first += size;
    }
    for (Worker& worker : workers_) state_.counters.add(std::exchange(worker.counters, {}));
    state_.wall_seconds += seconds_since(start);
    state_.cpu_seconds += process_cpu_seconds() - cpu_start;
    if (std::ranges::find(state_.tiles_done, 0) != state_.tiles_done.end()) return false;
    // A pass that was stopped has traced them again, and counts them once.
    if (photons_) state_.counters.add(photon_counters_);
    if (state_.adaptive.is_uniform() && second_film() != nullptr) state_.every_other_spp += state_.pass_size;
    finish_pass();
    return true;
}

TileJob ProgressiveRender::make_job(const PixelRect& rect) const {
    return {.rect = rect,
            .window = state_.film.splat_window(),
            .full_width = options_.full_width,
            .full_height = options_.full_height,
            .first_sample = state_.next_sample(),
            .sample_count = state_.pass_size,
            .seed = options_.seed,
            .sequence = options_.sequence,
            .filter = &options_.filter,
            .aovs = options_.aovs.get(),
            .clamp_indirect = options_.clamp_indirect,
            .lamp_images = lamp_images_.get()};
}

void ProgressiveRender::trace_photons() {
    photons_.reset();
    const PixelRect& window = state_.film.splat_window();
    const Merging merging = integrator_.merging(world_, make_job(window));
    if (!merging.merges()) return;
    const std::vector<PixelRect> tiles = make_tiles(window);
    std::vector<PhotonList> lists(tiles.size());
    std::vector<RenderCounters> counters(workers_.size());
    threads_.parallel_for(tiles.size(), [&](std::size_t index, int slot) {
        Worker& worker = workers_[static_cast<std::size_t>(slot)];
        if (!worker.scratch) worker.scratch = integrator_.make_scratch();
        TileJob job = make_job(tiles[index]);
        job.merging = merging;
        if (options_.profile) {
            job.profile = &options_.profile->wave(slot);
            job.profile->clock().skip();
        }
        const std::vector<PixelJob> pixels = photon_pixels(window, tiles[index], job.first_sample);
        if (pixels.empty()) return;
        job.pixels = pixels;
        integrator_.trace_photons(world_, job, *worker.scratch, lists[index], counters[static_cast<std::size_t>(slot)]);
    });
    photon_counters_ = {};
    for (const RenderCounters& of_slot : counters) photon_counters_.add(of_slot);
    photons_.emplace(lists, merging.radius, threads_);
}

Film* ProgressiveRender::second_film() {
    const bool is_odd = state_.adaptive.is_uniform() ? is_odd_pass(state_.next_sample())
                                                     : state_.adaptive.passes % 2 == 0;  // after one that was even
    return state_.every_other_pass && is_odd ? &*state_.every_other_pass : nullptr;
}

void ProgressiveRender::choose_pixels(const PixelRect& rect, Worker& worker) const {
    const AdaptiveState& adaptive = state_.adaptive;
    const PixelRect& window = options_.window;
    worker.pixels.clear();
    worker.every_other_pixels.clear();
    if (adaptive.is_uniform()) return;
    std::uint32_t in_tile = 0;
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x, ++in_tile) {
            const std::size_t p = static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(window.width()) +
                                  static_cast<std::size_t>(x - window.x0);
            if (!adaptive.is_active.empty() && adaptive.is_active[p] == 0) continue;
            worker.pixels.push_back({in_tile, state_.first_sample + adaptive.samples[p]});
            // Whichever part has fewer, by counts that no other tile changes and no stop of the pass.
            if (state_.every_other_pass &&
                2 * state_.every_other_pass->sample_count(x, y) < state_.film.sample_count(x, y))
                worker.every_other_pixels.push_back(in_tile);
        }
}

void ProgressiveRender::add_tile(const Worker& worker, Film* second) {
    state_.film.add(worker.tile);
    if (!worker.every_other_pixels.empty())
        state_.every_other_pass->add(worker.tile, worker.every_other_pixels);
    else if (second != nullptr && state_.adaptive.is_uniform())
        second->add(worker.tile);
}

std::size_t ProgressiveRender::splat_group_size() const {
    constexpr double kSeconds = 1.0;
    constexpr double kTilesPerThread = 4.0;  // so that few threads wait for the last tile
    const double soon = seconds_per_tile_ > 0.0 ? kSeconds / seconds_per_tile_ : 0.0;
    const double busy = kTilesPerThread * threads_.thread_count();
    return std::min(static_cast<std::size_t>(std::max(soon, busy)), largest_splat_group(state_.pass_size));
}

void ProgressiveRender::render_group(std::size_t first, std::size_t size, const StopPredicate& stop,
                                     const TileCallback& tile_done) {
    const bool makes_splats = integrator_.makes_splats();
    const std::vector<std::size_t> order = make_order(size, options_.tile_order_seed);
    Film* const second = second_film();
    if (makes_splats) splats_.resize(size);
    std::atomic<std::uint64_t> light_paths = 0;
    const BrightestSamples& brightest = state_.counters.brightest;
    const float brightest_floor = brightest.capacity() > 0 ? brightest.threshold() : 0.0f;
    threads_.parallel_for(size, [&](std::size_t index, int slot) {
        std::uint8_t& is_done = state_.tiles_done[first + order[index]];
        // Splats of a tile after one that is missing would come too early.
        if (is_done != 0 || (!makes_splats && stop())) return;
        const NodeBinding::Stay stay = threads_.stay_on_node(slot);
        Worker& worker = workers_[static_cast<std::size_t>(slot)];
        if (!worker.scratch) worker.scratch = integrator_.make_scratch();  // here, so as to lie on the slot's node
        choose_pixels(tiles_[first + order[index]], worker);
        if (!state_.adaptive.is_uniform() && worker.pixels.empty()) {
            is_done = 1;
            return;
        }
        TileJob job = make_job(tiles_[first + order[index]]);
        job.pixels = worker.pixels;
        if (photons_) {
            job.merging = integrator_.merging(world_, job);
            job.photons = &*photons_;
        }
        worker.counters.brightest.expect(options_.brightest, brightest_floor);
        TileTimer timer(options_.profile, job, slot);
        const std::uint64_t rays_before = worker.counters.rays.total();
        worker.tile.reset(job.rect, state_.film.layers().layout());
        integrator_.render_tile(world_, job, *worker.scratch, worker.tile, worker.counters);
        add_tile(worker, second);
        is_done = 1;
        const std::uint64_t samples = camera_sample_count(job);
        timer.end(samples);
        if (makes_splats) {
            splats_[order[index]].swap(worker.tile.splats());
            light_paths += samples;
        }
        if (tile_done) tile_done(samples, worker.counters.rays.total() - rays_before);
    });
    const auto splats_start = Clock::now();
    if (makes_splats)
        for (Film* film : {&state_.film, second})
            if (film != nullptr) film->add_splats(splats_, light_paths, options_.filter, threads_);
    if (makes_splats && options_.profile != nullptr)
        options_.profile->add_splatting(seconds_since(splats_start) * threads_.thread_count());
    for (std::vector<Splat>& list : splats_) list.clear();
}

}  // namespace etendue
