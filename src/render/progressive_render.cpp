#include "render/progressive_render.h"

#include "render/tiles.h"

#include <algorithm>

namespace etendue {

ProgressiveRender::ProgressiveRender(const World& world, const Integrator& integrator, const SamplingOptions& options,
                                     const ThreadPool& threads)
    : world_(world),
      integrator_(integrator),
      options_(options),
      threads_(threads),
      film_(options.full_width, options.full_height, options.window),
      tiles_(make_tiles(options.window)),
      workers_(static_cast<std::size_t>(threads.thread_count())) {
    for (Worker& worker : workers_) worker.scratch = integrator.make_scratch();
}

bool ProgressiveRender::add_samples(std::uint32_t count, const std::atomic<bool>& stop, const TileCallback& tile_done) {
    // Splats are added in the order of the tiles, whatever the order in which these are rendered.
    const std::size_t group_size = integrator_.makes_splats() ? splat_group_size(count) : tiles_.size();
    for (std::size_t first = 0; first < tiles_.size() && !stop.load(); first += group_size)
        render_group(first, std::min(group_size, tiles_.size() - first), count, stop, tile_done);
    if (stop.load()) return false;
    spp_done_ += count;
    return true;
}

void ProgressiveRender::render_group(std::size_t first, std::size_t size, std::uint32_t count,
                                     const std::atomic<bool>& stop, const TileCallback& tile_done) {
    const bool makes_splats = integrator_.makes_splats();
    const std::vector<std::size_t> order = make_order(size, options_.tile_order_seed);
    if (makes_splats) splats_.resize(size);
    std::atomic<std::uint64_t> light_paths = 0;
    threads_.parallel_for(size, [&](std::size_t index, int slot) {
        if (stop.load(std::memory_order_relaxed)) return;
        Worker& worker = workers_[static_cast<std::size_t>(slot)];
        const TileJob job{tiles_[first + order[index]],
                          options_.window,
                          options_.full_width,
                          options_.full_height,
                          spp_done_,
                          count,
                          options_.seed,
                          options_.sequence,
                          &options_.filter};
        const std::uint64_t rays_before = worker.counters.rays();
        worker.tile.reset(job.rect);
        integrator_.render_tile(world_, job, *worker.scratch, worker.tile, worker.counters);
        film_.add(worker.tile);
        const std::uint64_t samples = job.rect.area() * count;
        if (makes_splats) {
            splats_[order[index]].swap(worker.tile.splats());
            light_paths += samples;
        }
        if (tile_done) tile_done(samples, worker.counters.rays() - rays_before);
    });
    if (makes_splats) film_.add_splats(splats_, light_paths, options_.filter, threads_);
    for (std::vector<Splat>& list : splats_) list.clear();
}

RenderCounters ProgressiveRender::counters() const {
    RenderCounters sum;
    for (const Worker& worker : workers_) sum.add(worker.counters);
    return sum;
}

}  // namespace etendue
