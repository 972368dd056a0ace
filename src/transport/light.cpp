#include "transport/light.h"

#include "transport/bodies.h"
#include "transport/connecting_ray.h"

namespace etendue {

std::optional<LensView> view_from_lens(const World& world, const Vec3f& position, Vec2f lens, float time) {
    LensView view{.camera = world.camera().connect(position, lens, time)};
    if (!(view.camera.importance_area > 0.0f)) return {};
    const Vec3f to_lens = view.camera.lens - position;
    view.distance = length(to_lens);
    view.direction = to_lens * (1.0f / view.distance);
    return view;
}

std::optional<FilmLight> lamp_to_camera(const SubpathSample& sample, const Emission& emission,
                                        const std::function<float(const LensView& view, float cosine)>& weigh) {
    const World& world = sample.world();
    const Vec2f lens = sample.pair(SubpathEnd::AtLight, 0, SubpathDimension::LightChoice);
    const float time = sample.eye.ray.time;
    const auto view = view_from_lens(world, emission.sample.position, lens, time);
    if (!view) return {};
    const SurfaceEmission emitted = world.emitters().surface_emission(emission, view->direction);
    if (is_black(emitted.radiance)) return {};
    const float share = weigh(*view, emitted.cosine);
    if (share == 0.0f) return {};
    Ray ray = connecting_ray(world.emitters().origin(emission, view->direction), view->camera.lens);
    ray.time = time;
    ray.alpha_key = sample.connection_key(SubpathEnd::AtLight, 0);
    const Interior interior = interior_at_light(world, emission, view->direction);
    return FilmLight{view->camera.film, emitted.radiance *
                                            transmittance(world, interior, ray, view->distance, RayEnds::ToCamera) *
                                            (emitted.cosine * view->camera.importance_area * share /
                                             (emission.sample.pdf_position_area * emission.probability)) *
                                            visibility(world, ray, nullptr, RayEnds::ToCamera)};
}

FilmLight vertex_to_camera(const SubpathSample& sample, const SubpathVertex& vertex, const LensView& view,
                           const Rgb& scattered, float weight) {
    const World& world = sample.world();
    Ray ray = connecting_ray(vertex.origin_towards(view.direction), view.camera.lens);
    ray.time = sample.eye.ray.time;
    ray.alpha_key = sample.connection_key(SubpathEnd::AtLight, vertex.index);
    return {view.camera.film,
            vertex.throughput * scattered * sample.wavelength_weight(vertex.is_dispersed) *
                transmittance(world, vertex.interior_towards(view.direction), ray, view.distance, RayEnds::ToCamera) *
                (view.camera.importance_area * weight) * visibility(world, ray, nullptr, RayEnds::ToCamera)};
}

std::vector<FilmLight> light_on_film(const World& world, const EyeSample& eye, const IntegratorSettings& settings) {
    const PathLengths& lengths = settings.lengths;
    const SubpathSample sample{{.world = world, .aims = settings.aimed_emission}, lengths, eye};
    const std::optional<Subpath> subpath = begin_subpath_at_light(sample);
    if (!subpath) return {};
    std::vector<FilmLight> found;
    const auto keep = [&](const FilmLight& light) {
        if (!is_black(light.value)) found.push_back(light);
    };
    if (lengths.is_long_enough(1))
        if (const auto lamp = lamp_to_camera(sample, *subpath->emission, [](const LensView&, float) { return 1.0f; }))
            keep(*lamp);
    if (lengths.max_depth < edges_to_connect(world) || is_black(subpath->emission->weight)) return found;
    for (const SubpathVertex& vertex : follow_subpath(sample, *subpath, lengths.roulette_depth)) {
        if (!vertex.lights_camera() || !lengths.is_long_enough(vertex.next_edges)) continue;
        const Vec2f lens = sample.pair(SubpathEnd::AtLight, vertex.index, SubpathDimension::LightChoice);
        const auto view = view_from_lens(world, vertex.position, lens, eye.ray.time);
        if (!view) continue;
        const Rgb scattered = vertex.evaluate(view->direction, TransportMode::Importance).f_cos;
        keep(vertex_to_camera(sample, vertex, *view, scattered, 1.0f));
    }
    return found;
}

}  // namespace etendue
