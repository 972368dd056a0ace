#include "integrator/connections.h"

#include "integrator/profile/wave_profile.h"
#include "integrator/ray_batch.h"

namespace etendue {

Connections::Pending& Connections::push(const Ray& ray, std::span<const ExpressionShare> shares) {
    rays_.push_back(ray);
    if (!shares.empty()) shares_.insert(shares_.end(), shares.begin(), shares.end());
    Pending& pending = pending_.emplace_back();
    pending.end_of_shares = static_cast<std::uint32_t>(shares_.size());
    return pending;
}

void Connections::to_sample(const Ray& ray, std::uint32_t slot, const Rgb& contribution, LightKind kind,
                            std::span<const ExpressionShare> shares) {
    Pending& pending = push(ray, shares);
    pending.value = contribution;
    pending.slot = slot;
    pending.kind = kind;
}

void Connections::to_film(const Ray& ray, std::uint32_t slot, const Splat& splat, LightKind kind,
                          std::span<const ExpressionShare> shares) {
    Pending& pending = push(ray, shares);
    pending.value = splat.value;
    pending.position = splat.position;
    pending.depth = splat.depth;
    pending.slot = slot;
    pending.is_splat = true;
    pending.kind = kind;
}

void Connections::resolve(const World& world, const TileJob& job, std::span<const CameraSample> samples,
                          SampleLight& light, TileBuffer& tile, RenderCounters& counters) {
    if (rays_.empty()) return;
    occluded_.resize(rays_.size());
    occluded_batch(world, job, kind_, rays_, occluded_, counters);
    const std::span<const ExpressionShare> all_shares(shares_);
    for (std::size_t i = 0, first = 0; i < pending_.size(); ++i) {
        const Pending& pending = pending_[i];
        const auto shares = all_shares.subspan(first, pending.end_of_shares - first);
        first = pending.end_of_shares;
        light.count_ray(pending.slot);
        if (occluded_[i] != 0) continue;
        if (!pending.is_splat)
            light.add(pending.slot, pending.value, pending.kind, shares);
        else if (is_finite(pending.value) && min_component(pending.value) >= 0.0f)
            light.add_splat(pending.slot, samples[pending.slot].key.index,
                            {.position = pending.position, .value = pending.value, .depth = pending.depth},
                            pending.kind, shares, tile.splats());
        else
            counters.drop(located(job, samples[pending.slot]));
    }
    rays_.clear();
    pending_.clear();
    shares_.clear();
    stamp(job.profile, Stage::Splat);
}

}  // namespace etendue
