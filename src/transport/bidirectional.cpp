#include "transport/bidirectional.h"

#include "transport/roulette.h"
#include "transport/strategies.h"

namespace etendue {

BidirectionalLight bidirectional_light(const World& world, const EyeSample& eye_sample,
                                       const IntegratorSettings& settings, const BidirectionalSetup& setup) {
    const SubpathSample sample{
        {world, Raised{settings.heuristic}, setup.samples_per_light_path, setup.merging, settings.aimed_emission},
        settings.lengths,
        eye_sample,
        setup.shared};
    const SparedRays spared = spared_rays(settings.lengths.roulette_depth);

    BidirectionalLight found;
    const auto keep = [&](const StrategyLight& light) { found.radiance += light.weighted(); };
    const auto show = [&](const std::optional<StrategyOnFilm>& light) {
        if (light && !is_black(light->weighted())) found.on_film.push_back({light->film, light->weighted()});
    };
    const auto eye = follow_subpath(sample, begin_subpath_at_eye(sample), spared.of_eye,
                                    [&](const Subpath& subpath, const Vertex& vertex, const SubpathDensities& arrived) {
                                        light_met(sample, subpath, vertex, arrived, keep);
                                    });
    if (setup.photons != nullptr)
        for (const SubpathVertex& vertex : eye)
            if (vertex.merging.merges)
                light_merged(sample, vertex, *setup.photons,
                             [&](const Photon&, const StrategyLight& merged) { keep(merged); });
    const std::optional<Subpath> from_light = begin_subpath_at_light(sample);
    if (!from_light) return found;
    for (const SubpathVertex& vertex : eye) keep(light_sampled(sample, vertex));
    show(lamp_at_lens(sample, *from_light->emission));
    if (!leads_to_camera(sample, *from_light)) return found;

    const auto light = follow_subpath(sample, *from_light, spared.of_light);
    for (const SubpathVertex& at_eye : eye)
        for (const SubpathVertex& at_light : light) keep(light_connected(sample, at_eye, at_light));
    for (const SubpathVertex& vertex : light) show(light_at_lens(sample, vertex));
    return found;
}

}  // namespace etendue
