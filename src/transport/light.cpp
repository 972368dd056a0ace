#include "transport/light.h"

#include "transport/strategies.h"

namespace etendue {

std::optional<LensView> view_from_lens(const World& world, const Vec3f& position, Vec2f lens, float time) {
    LensView view{.camera = world.camera().connect(position, lens, time)};
    if (!(view.camera.importance_area > 0.0f)) return {};
    const Vec3f to_lens = view.camera.lens - position;
    view.distance = length(to_lens);
    view.direction = to_lens * (1.0f / view.distance);
    return view;
}

std::vector<FilmLight> light_on_film(const World& world, const EyeSample& eye, const IntegratorSettings& settings) {
    const PathLengths& lengths = settings.lengths;
    const SubpathSample sample{{.world = world, .aims = settings.aimed_emission}, lengths, eye};
    const std::optional<Subpath> subpath = begin_subpath_at_light(sample);
    if (!subpath) return {};
    std::vector<FilmLight> found;
    const auto show = [&](const std::optional<StrategyOnFilm>& light) {
        if (light && !is_black(light->light)) found.push_back({light->film, light->light});
    };
    show(lamp_at_lens(sample, *subpath->emission));
    if (lengths.max_depth < edges_to_connect(world) || is_black(subpath->emission->weight)) return found;
    for (const SubpathVertex& vertex : follow_subpath(sample, *subpath, lengths.roulette_depth))
        show(light_at_lens(sample, vertex));
    return found;
}

}  // namespace etendue
