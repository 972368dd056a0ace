#include "integrator/subpath/connections.h"

namespace etendue {

void Connections::to_sample(const Ray& ray, std::uint32_t slot, const Rgb& contribution) {
    rays_.push_back(ray);
    pending_.push_back({.value = contribution, .slot = slot});
}

void Connections::to_film(const Ray& ray, std::uint32_t slot, const Splat& splat) {
    rays_.push_back(ray);
    pending_.push_back({.value = splat.value, .position = splat.position, .slot = slot, .is_splat = true});
}

void Connections::resolve(const World& world, std::span<const CameraSample> samples, std::span<Rgb> radiance,
                          TileBuffer& tile, RenderCounters& counters) {
    if (rays_.empty()) return;
    occluded_.resize(rays_.size());
    world.occluded(rays_, occluded_);
    counters.shadow_rays += rays_.size();
    for (std::size_t i = 0; i < pending_.size(); ++i) {
        if (occluded_[i] != 0) continue;
        const Pending& pending = pending_[i];
        if (!pending.is_splat)
            radiance[pending.slot] += pending.value;
        else if (is_finite(pending.value) && min_component(pending.value) >= 0.0f)
            tile.splats().push_back({pending.position, pending.value});
        else
            counters.drop({static_cast<int>(pending.position.x), static_cast<int>(pending.position.y),
                           samples[pending.slot].key.index});
    }
    rays_.clear();
    pending_.clear();
}

}  // namespace etendue
