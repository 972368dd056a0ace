#include "wave/aov/sample_light.h"

#include <algorithm>

namespace etendue {

void SampleLight::reset(std::size_t samples, const TileJob& job, float brightest) {
    aovs_ = job.aovs;
    layer_count_ = aovs_ != nullptr ? aovs_->layout.light - aovs_->buckets.count : 0;
    speller_ = aovs_ != nullptr ? aovs_->speller : nullptr;
    radiance_.assign(samples, Rgb());
    layers_.assign(samples * layer_count_, Rgb());
    rays_.assign(aovs_ != nullptr && aovs_->layout.has_ray_counts ? samples : 0, 0);
    bright_.clear();
    limit_ = job.clamp_indirect;
    brightest_ = brightest;
    watched_ = speller_ != nullptr ? -std::numeric_limits<float>::infinity() : std::min(limit_, brightest_);
    splat_scale_ = static_cast<float>(static_cast<double>(job.full_width) * static_cast<double>(job.full_height) /
                                      static_cast<double>(job.window.area()));
}

Rgb SampleLight::watch(const BrightLight& light, LightKind kind, std::span<const ExpressionShare> shares) {
    if (!is_finite(light.value)) return light.value;
    if (speller_ != nullptr) {
        SpelledContribution contribution{{}, light.value, light.position, kind};
        if (!shares.empty()) contribution.path = speller_->path(static_cast<std::size_t>(shares.front().expressions));
        speller_->record(contribution);
    }
    const float most = max_component(light.value);
    // A lamp in view is as bright in every sample, and no firefly.
    if (most >= brightest_ && kind != LightKind::Seen) bright_.push_back(light);
    return kind == LightKind::Indirect && most > limit_ ? light.value * (limit_ / most) : light.value;
}

void SampleLight::add_watched(std::uint32_t slot, const Rgb& light, LightKind kind,
                              std::span<const ExpressionShare> shares) {
    const Rgb kept = watch({slot, light, {}}, kind, shares);
    if (speller_ != nullptr) shares = {};
    add_unwatched(slot, kept, shares);
    if (aovs_ != nullptr && aovs_->removed_light) layers_[slot * layer_count_ + *aovs_->removed_light] += light - kept;
}

void SampleLight::add_splat(std::uint32_t slot, std::uint32_t sample, const Splat& splat, LightKind kind,
                            std::span<const ExpressionShare> shares, std::vector<Splat>& splats) {
    const auto leave = [&](const Rgb& value, std::size_t layer) {
        splats.push_back({.position = splat.position,
                          .value = value,
                          .layer = static_cast<std::uint32_t>(SplatFilm::kFirstLayer + layer)});
    };
    Rgb value = splat.value;
    const Rgb as_sample = splat.value * splat_scale_;
    if (!(max_component(as_sample) < watched_)) {
        const Rgb kept = watch({slot, as_sample, splat.position}, kind, shares);
        if (speller_ != nullptr) shares = {};
        if (max_component(kept) < max_component(as_sample)) {
            value = kept * (1.0f / splat_scale_);
            if (aovs_ != nullptr && aovs_->removed_light) leave(splat.value - value, *aovs_->removed_light);
        }
    }
    splats.push_back({.position = splat.position, .value = value, .depth = splat.depth});
    for (const ExpressionShare& part : shares)
        for (ExpressionMask left = part.expressions; left != 0; left &= left - 1)
            leave(value * part.share, static_cast<std::size_t>(std::countr_zero(left)));
    if (aovs_ != nullptr && aovs_->buckets.count > 0)
        leave(value, aovs_->buckets.first_light + aovs_->buckets.of(sample));
}

}  // namespace etendue
