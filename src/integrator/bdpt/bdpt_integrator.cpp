#include "integrator/bdpt/bdpt_integrator.h"

#include "integrator/bdpt/bdpt_job.h"
#include "integrator/bdpt/bdpt_wave.h"
#include "integrator/trace_in_waves.h"

#include <fmt/format.h>

namespace etendue {

std::vector<std::string> BdptIntegrator::unreachable_light(const World& world) const {
    std::vector<std::string> sentences;
    if (settings_.strategy && !world.traits().has_bodies && settings_.strategy->edges() > settings_.lengths.max_depth)
        sentences.push_back(fmt::format(
            "the image stays black: strategy {},{} makes paths of {} edges, and the longest that are kept have {}",
            settings_.strategy->s, settings_.strategy->t, settings_.strategy->edges(), settings_.lengths.max_depth));
    if (settings_.strategy == kMerges && !may_merge(world))
        sentences.emplace_back("the image stays black: no vertices merge; 'vcm' with '--merge all' merges everywhere");
    const bool needs_mirrors = settings_.merging.at == MergeAt::SeenByDeltas;
    const int merged_edges = needs_mirrors ? 4 : 2;
    if (settings_.strategy == kMerges && may_merge(world) && merged_edges > settings_.lengths.max_depth)
        sentences.push_back(fmt::format(
            "the image stays black: paths that merge have {} edges at least{}, and the longest that are kept have {}",
            merged_edges,
            needs_mirrors && world.traits().has_bodies ? ", but for those through boundaries that other bodies hide"
                                                       : "",
            settings_.lengths.max_depth));
    if (world.traits().has_delta_lights && world.traits().has_specular_surfaces && !settings_.strategy &&
        settings_.merging.at == MergeAt::Nothing)
        sentences.emplace_back(
            "what point, spot and directional lights send through smooth glass or by way of mirrors cannot be found "
            "where the eye sees it in a mirror or through smooth glass, too; 'vcm' with '--merge sds' finds it");
    return sentences;
}

std::vector<std::string> BdptIntegrator::ineffective_options(const World& world) const {
    std::vector<std::string> sentences;
    if (settings_.cached_connections > 0 && world.traits().has_motion)
        sentences.push_back(
            fmt::format("connections to a cache (cache:{}) have no effect where something moves while the shutter is "
                        "open: each sample has a time of its own, and is connected pairwise",
                        settings_.cached_connections));
    const MergeSettings usual;
    const bool asks_for_radius = settings_.merging.radius != usual.radius || settings_.merging.alpha != usual.alpha;
    // The weight of every other strategy, too, depends on the radius.
    const bool uses_radius = settings_.weighted || settings_.strategy == kMerges;
    if (asks_for_radius && (!may_merge(world) || !uses_radius))
        sentences.emplace_back("--merge-radius and --merge-alpha have no effect: no vertices merge");
    return sentences;
}

bool BdptIntegrator::may_merge(const World& world) const {
    return settings_.merging.at == MergeAt::Everywhere ||
           (settings_.merging.at == MergeAt::SeenByDeltas && world.traits().has_specular_surfaces);
}

std::unique_ptr<IntegratorScratch> BdptIntegrator::make_scratch() const {
    return std::make_unique<BdptWave>();
}

Merging BdptIntegrator::merging(const World& world, const TileJob& job) const {
    return make_merging(world, job.full_width, job.full_height, static_cast<double>(photon_paths(job.window)),
                        job.first_sample, settings_.merging);
}

std::unique_ptr<const LampImages> BdptIntegrator::lamp_images(const World& world, const TileJob& whole,
                                                              const PixelRect& window) const {
    // Of all strategies (0, t) alone make such paths.
    if (!settings_.lamp_images || !meets_lamps(settings_)) return nullptr;
    return find_lamp_images(world, whole, window);
}

void BdptIntegrator::trace_photons(const World& world, const TileJob& job, IntegratorScratch& scratch,
                                   PhotonList& photons, RenderCounters& counters) const {
    if (settings_.strategy.value_or(kMerges) != kMerges) return;  // no vertex would look for photons
    auto& wave = static_cast<BdptWave&>(scratch);
    const std::size_t total = camera_sample_count(job);
    for (std::size_t first = 0; first < total; first += BdptWave::kCapacity)
        wave.trace_photons(world, job, settings_, first, std::min(BdptWave::kCapacity, total - first), photons,
                           counters);
}

void BdptIntegrator::render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                                 RenderCounters& counters) const {
    auto& wave = static_cast<BdptWave&>(scratch);
    wave.start(world, job, settings_);
    trace_in_waves<BdptWave>(world, job, settings_, scratch, tile, counters);
    wave.finish(tile, counters);
}

}  // namespace etendue
