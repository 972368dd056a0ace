#include "integrator/bdpt/bdpt_wave.h"

#include "integrator/aov/first_hits.h"
#include "integrator/connecting_ray.h"
#include "integrator/profile/wave_profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace etendue {

namespace {

/// Of the choice from the cache for the eye vertex of index 0; far from those of subpaths.
constexpr std::uint32_t kCacheDimension = 3u << 29;

/// Paths of one edge, a light that the camera sees, have no strategy but one.
constexpr int kDirectlySeen = 1;

bool is_wanted(const PathLengths& lengths, int edges) {
    return edges >= lengths.min_depth && edges <= lengths.max_depth;
}

bool is_wanted(const BdptOptions& options, const Strategy& strategy) {
    return !options.only || *options.only == strategy;
}

/// True if the weights of a sample's paths are to be compared with the reference: in debug builds those of one sample
/// in 64, because that takes longer than all the rest.
bool is_checked([[maybe_unused]] const CameraSample& sample, const BdptOptions& options) {
#ifdef NDEBUG
    return options.observer != nullptr;
#else
    return options.observer != nullptr || sample.key.index % 64 == 0;
#endif
}

/// False if single precision may have cost the reference, which has nothing but positions, more than a few per cent:
/// where edges are short, as they are in dense media, or graze a surface.
[[maybe_unused]] bool is_told_by_positions(const CompletePath& path) {
    constexpr float kShortest = 0.01f;  // of how far the vertices are from the origin
    constexpr float kSmallestCosine = 0.05f;
    for (std::size_t i = 0; i < path.inner.size(); ++i) {
        const PathVertex& vertex = *path.inner[i];
        const Vec3f next = i + 1 < path.inner.size() ? path.inner[i + 1]->position : path.camera.lens;
        const Vec3f edge = next - vertex.position;
        const float distance = length(edge);
        const float scale = std::max(length(vertex.position), length(next));
        if (!vertex.surface || !(distance > kShortest * scale)) return false;
        if (vertex.cosine(edge / distance) < kSmallestCosine || vertex.cosine(vertex.wo) < kSmallestCosine)
            return false;
    }
    return true;
}

/// The vertices of the subpath that ends in `last`, the last one first.
void append_subpath(const SubpathWave& wave, const PathVertex* last, std::vector<const PathVertex*>& path) {
    for (const PathVertex* v = last; v != nullptr;
         v = v->previous != PathVertex::kNoVertex ? &wave.vertices()[v->previous] : nullptr)
        path.push_back(v);
}

/// Of light that a subpath from the eye meets.
LightKind kind_of_met_light(const SubpathState& state) {
    if (state.index == kDirectlySeen) return LightKind::Seen;
    return state.lights_directly ? LightKind::Direct : LightKind::Indirect;
}

}  // namespace

std::size_t BdptWave::bytes() const {
    return sizeof *this +
           vector_bytes(samples_, camera_rays_, alpha_, shares_, cache_, to_lights_, to_cameras_, between_) +
           found_.bytes() + eye_.bytes() + light_.bytes() + to_light_.bytes() + to_camera_.bytes() +
           light_connections_.bytes() + camera_connections_.bytes() + vertex_connections_.bytes();
}

void BdptWave::trace(const World& world, const TileJob& job, const BdptOptions& options, std::size_t first,
                     std::size_t count, TileBuffer& tile, RenderCounters& counters) {
    samples_.resize(count);
    camera_rays_.resize(count);
    generate_camera_rays(world, job, first, samples_, camera_rays_);
    found_.reset(count, job, counters.brightest.threshold());
    alpha_.assign(count, 1.0f);
    const Context context{{world, job, options.lengths, Raised{options.heuristic}, samples_, camera_rays_}, options};
    // The edges that roulette spares are shared. Of light subpaths there are as many as samples, of which few bring
    // much: the smaller half is enough.
    const int spared_of_light = options.lengths.roulette_depth / 2;
    const int spared_of_eye = options.lengths.roulette_depth - spared_of_light;
    context_ = &context;
    tile_ = &tile;
    eye_.trace(context, spared_of_eye, this, found_, counters);
    context_ = nullptr;
    tile_ = nullptr;
    if (world.has_lights()) {
        light_.trace(context, spared_of_light, nullptr, found_, counters);
        cache_.clear();
        if (options.cached_connections > 0)
            for (const PathVertex& vertex : light_.vertices())
                if (vertex.is_connectible && context.is_shared(vertex)) cache_.push_back(&vertex);
        to_light_.collect(context, SubpathEnd::AtEye, eye_.vertices());
        stamp(job.profile, Stage::Numbers);
        const auto resolve_if_full = [&](Connections& connections) {
            if (connections.is_full()) connections.resolve(world, job, samples_, found_, tile, counters);
        };
        for (std::size_t begin = 0; begin < to_light_.size(); begin += kBlock) {
            const std::size_t end = std::min(begin + kBlock, to_light_.size());
            if (world.has_sampled_lights()) connect_to_lights(context, begin, end);
            resolve_if_full(light_connections_);
            connect_to_vertices(context, begin, end);
            resolve_if_full(vertex_connections_);
        }
        to_camera_.collect(context, SubpathEnd::AtLight, light_.vertices());
        stamp(job.profile, Stage::Numbers);
        for (std::size_t begin = 0; begin < to_camera_.size(); begin += kBlock) {
            connect_to_camera(context, begin, std::min(begin + kBlock, to_camera_.size()));
            resolve_if_full(camera_connections_);
        }
        for (Connections* connections : {&light_connections_, &vertex_connections_, &camera_connections_})
            connections->resolve(world, job, samples_, found_, tile, counters);
    }
    accumulate(job, samples_, found_, alpha_, tile, counters);
    stamp(job.profile, Stage::Film);
}

void BdptWave::check(const SubpathJob& job, const BdptOptions& options, std::size_t s, float weight,
                     const PathLightEnd& end, const PathVertex* light, const PathVertex* eye,
                     const CameraConnection& camera) const {
    std::vector<const PathVertex*> path;
    append_subpath(light_, light, path);
    std::reverse(path.begin(), path.end());
    append_subpath(eye_, eye, path);
    const CompletePath complete{end, path, s, camera};
    const std::vector<double> reference = reference_weights(job, complete);
    if (options.observer != nullptr) options.observer->on_weight(job, complete, static_cast<double>(weight), reference);
    [[maybe_unused]] constexpr double kRounding = 0.05;
    // Lamps beyond what floats hold have no weights, and their samples are dropped.
    assert(!options.weighted || !is_told_by_positions(complete) || !std::isfinite(reference[s]) ||
           std::abs(static_cast<double>(weight) - reference[s]) < kRounding);
}

PathLightEnd BdptWave::light_end(std::uint32_t slot) const {
    const Emission& emission = light_.emissions()[slot];
    return {.light = emission.light,
            .position = emission.sample.position,
            .direction = emission.sample.direction,
            .cos_light = emission.sample.cos_theta};
}

CameraConnection BdptWave::camera_of(const SubpathJob& job, const PathVertex& eye) const {
    const PathVertex* first = &eye;
    while (first->previous != PathVertex::kNoVertex) first = &eye_.vertices()[first->previous];
    return job.world.connect_to_camera(first->position, job.samples[eye.slot].lens, job.camera_rays[eye.slot].time);
}

void BdptWave::on_first_hits(std::span<const Ray> rays, std::span<const Hit> hits) {
    find_first_hits(context_->world, context_->job, samples_, rays, hits, *tile_);
}

void BdptWave::add(const SubpathState& state, const Rgb& light, const StrategySums& sums, const PathLightEnd& end,
                   const AovSet::Source& source) {
    const Context& context = *context_;
    if (context.job.profile != nullptr && state.index > kDirectlySeen) ++context.job.profile->use().bsdf_met_light;
    if (!is_wanted(context.options, {.s = 0, .t = state.index + 1})) return;
    const float share = weight(context.options, sums);
    shares_.clear();
    if (eye_.words().are_followed()) eye_.words().end_at_light(state.words, source, shares_);
    found_.add(state.slot, state.throughput * light * context.wavelength_weight(state.slot, state.is_dispersed) * share,
               kind_of_met_light(state), shares_);
    if (is_checked(samples_[state.slot], context.options) && state.index > kDirectlySeen) {
        const PathVertex& last = eye_.vertices()[state.last_vertex];
        check(context, context.options, 0, share, end, nullptr, &last, camera_of(context, last));
    }
}

void BdptWave::on_emitter(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction,
                          const SubpathDensities& arrived) {
    if (state.edges < context_->lengths.min_depth) return;
    const World& world = context_->world;
    const Rgb emitted = world.emission(point, -direction);
    if (is_black(emitted)) return;
    StrategySums sums;
    const std::uint32_t light = world.light_at(point);
    const float cos_light = -dot(direction, point.geometric_normal);
    if (state.index > kDirectlySeen && light != kNone)
        sums = sums_at_emitter(*context_, state.from, light, direction, cos_light, arrived);
    add(state, emitted, sums,
        {.light = light,
         .position = point.position,
         .direction = -direction,
         .cos_light = cos_light,
         .is_reached_directly = state.is_direct},
        eye_.words().surface_source(point));
}

void BdptWave::on_unlit(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction) {
    // Only what the eye sees directly or in mirrors shows an unlit surface; it lights nothing.
    if (state.only_delta && state.edges >= context_->lengths.min_depth)
        add(state, context_->world.unlit_color(point), {}, {.position = point.position, .direction = -direction},
            eye_.words().surface_source(point));
}

void BdptWave::on_escape(const SubpathState& state, const Vec3f& direction) {
    const World& world = context_->world;
    const bool is_direct = state.index == kDirectlySeen;
    if (is_direct && !(world.has_environment() && world.environment_visible_to_camera())) {
        alpha_[state.slot] = 0.0f;
        return;
    }
    if (!world.has_environment() || state.edges < context_->lengths.min_depth) return;
    StrategySums sums;
    if (!is_direct) sums = sums_at_environment(*context_, state.from, direction, state.departing);
    add(state, world.environment_radiance(direction), sums,
        {.light = world.environment(), .direction = -direction, .is_reached_directly = state.is_direct},
        eye_.words().environment_source());
}

void BdptWave::connect_to_lights(const Context& context, std::size_t first, std::size_t last) {
    WaveProfile* const profile = context.job.profile;
    to_lights_.clear();
    for (std::size_t v = first; v < last; ++v) {
        const PathVertex& vertex = to_light_[v];
        if (!is_wanted(context.lengths, vertex.next_edges) ||
            !is_wanted(context.options, {.s = 1, .t = vertex.index + 1}))
            continue;
        const auto [light, triangle, direction] = to_light_.numbers(v);
        to_lights_.push_back({&vertex, context.world.sample_light(vertex.position, {light, triangle, direction}), {}});
    }
    if (profile != nullptr) profile->use().light_samples += to_lights_.size();
    stamp(profile, Stage::LightSampling);
    for (ToLight& connection : to_lights_)
        if (const LightSample& light = connection.chosen.sample; !is_black(light.radiance))
            connection.scattered = connection.vertex->evaluate_both_ways(light.wi, TransportMode::Radiance);
    stamp(profile, Stage::Material);
    for (const ToLight& connection : to_lights_)
        if (!is_black(connection.scattered.f_cos)) weigh(context, connection);
    stamp(profile, Stage::Mis);
}

void BdptWave::weigh(const Context& context, const ToLight& connection) {
    const World& world = context.world;
    const PathVertex& vertex = *connection.vertex;
    const ChosenLight& chosen = connection.chosen;
    const LightSample& light = chosen.sample;
    const Scattering::TwoWayValue& value = connection.scattered;
    const float share = weight(context.options, sums_of_light_sample(context, vertex, chosen, value));
    if (share == 0.0f) return;
    const float density = light.is_delta ? chosen.probability : light.pdf_solid_angle;
    Ray ray = shadow_ray(vertex.origin(light.wi), light);
    ray.time = context.camera_rays[vertex.slot].time;
    ray.alpha_key = context.connection_key(SubpathEnd::AtEye, vertex.index, vertex.slot);
    shares_.clear();
    if (eye_.words().are_followed())
        eye_.words().end_at_light(vertex.words, vertex.event(light.wi, TransportMode::Radiance),
                                  eye_.words().light_source(world, chosen.light), shares_);
    light_connections_.to_sample(ray, vertex.slot,
                                 vertex.throughput * value.f_cos * light.radiance *
                                     vertex.transmittance(light.wi, light.distance) *
                                     context.wavelength_weight(vertex.slot, vertex.is_dispersed) * (share / density),
                                 vertex.is_seen_directly ? LightKind::Direct : LightKind::Indirect, shares_);
    if (is_checked(samples_[vertex.slot], context.options))
        check(context, context.options, 1, share,
              {.light = chosen.light,
               .position = vertex.position + light.wi * (std::isinf(light.distance) ? 0.0f : light.distance),
               .direction = -light.wi,
               .cos_light = light.cos_light},
              nullptr, &vertex, camera_of(context, vertex));
}

void BdptWave::connect_to_camera(const Context& context, std::size_t first, std::size_t last) {
    WaveProfile* const profile = context.job.profile;
    to_cameras_.clear();
    for (std::size_t v = first; v < last; ++v) {
        const PathVertex& vertex = to_camera_[v];
        if (!is_wanted(context.lengths, vertex.next_edges) ||
            !is_wanted(context.options, {.s = vertex.index + 1, .t = 1}))
            continue;
        const auto [lens] = to_camera_.numbers(v);
        const auto view =
            view_from_camera(context.world, context.job, vertex.position, lens, context.camera_rays[vertex.slot].time);
        if (view) to_cameras_.push_back({&vertex, *view, {}});
    }
    stamp(profile, Stage::Mis);
    for (ToCamera& connection : to_cameras_)
        connection.scattered =
            connection.vertex->evaluate_both_ways(connection.view.direction, TransportMode::Importance);
    stamp(profile, Stage::Material);
    for (const ToCamera& connection : to_cameras_)
        if (!is_black(connection.scattered.f_cos)) weigh(context, connection);
    stamp(profile, Stage::Mis);
}

void BdptWave::weigh(const Context& context, const ToCamera& connection) {
    const PathVertex& vertex = *connection.vertex;
    const CameraView& view = connection.view;
    const Scattering::TwoWayValue& value = connection.scattered;
    const float share = weight(context.options, sums_at_lens(context, vertex, view.direction, view.camera, value));
    Ray ray = connecting_ray(vertex.origin(view.direction), view.camera.lens);
    ray.time = context.camera_rays[vertex.slot].time;
    ray.alpha_key = context.connection_key(SubpathEnd::AtLight, vertex.index, vertex.slot);
    shares_.clear();
    if (light_.words().are_followed())
        light_.words().end_at_camera(light_.words_after(vertex, view.direction), shares_);
    camera_connections_.to_film(
        ray, vertex.slot,
        {.position = view.pixel,
         .value = vertex.throughput * value.f_cos * vertex.transmittance(view.direction, view.distance) *
                  context.wavelength_weight(vertex.slot, vertex.is_dispersed) * (view.camera.importance_area * share),
         .depth = view.depth},
        vertex.index > 1 ? LightKind::Indirect : LightKind::Direct, shares_);
    if (is_checked(samples_[vertex.slot], context.options))
        check(context, context.options, static_cast<std::size_t>(vertex.index) + 1, share, light_end(vertex.slot),
              &vertex, nullptr, view.camera);
}

void BdptWave::connect_to_vertices(const Context& context, std::size_t first, std::size_t last) {
    WaveProfile* const profile = context.job.profile;
    between_.clear();
    for (std::size_t v = first; v < last; ++v) {
        const PathVertex& eye = to_light_[v];
        find_own(context, eye);
        if (context.is_shared(eye)) find_cached(context, eye, context.options.cached_connections);
    }
    stamp(profile, Stage::Mis);
    for (Between& connection : between_) {
        connection.at_eye = connection.eye->evaluate_both_ways(connection.w, TransportMode::Radiance);
        if (!is_black(connection.at_eye.f_cos))
            connection.at_light = connection.light->evaluate_both_ways(-connection.w, TransportMode::Importance);
    }
    stamp(profile, Stage::Material);
    for (const Between& connection : between_)
        if (!is_black(connection.at_light.f_cos)) weigh(context, connection);
    stamp(profile, Stage::Mis);
}

void BdptWave::find_own(const Context& context, const PathVertex& eye) {
    const bool has_cache = context.is_shared(eye);
    for (std::uint32_t i = light_.last_vertex(eye.slot); i != PathVertex::kNoVertex;) {
        const PathVertex& light = light_.vertices()[i];
        if (light.is_connectible && !(has_cache && context.is_shared(light))) find(context, eye, light, 1.0f);
        i = light.previous;
    }
}

void BdptWave::find_cached(const Context& context, const PathVertex& eye, int count) {
    if (cache_.empty()) return;
    const auto size = static_cast<float>(cache_.size());
    const float step = size / static_cast<float>(count);
    const float scale = step / static_cast<float>(samples_.size());
    // One number for all, and equal steps from one to the next: each is as likely as any other to be drawn.
    const SampleKey key = samples_[eye.slot].key;
    const float u = sample_2d(context.job.sequence, key, kCacheDimension + static_cast<std::uint32_t>(eye.index)).x;
    for (int i = 0; i < count; ++i) {
        const auto drawn = static_cast<std::size_t>((static_cast<float>(i) + u) * step);
        find(context, eye, *cache_[std::min(drawn, cache_.size() - 1)], scale);
    }
}

void BdptWave::find(const Context& context, const PathVertex& eye, const PathVertex& light, float scale) {
    if (!is_wanted(context.lengths, eye.next_edges + light.next_edges - 1) ||
        !is_wanted(context.options, {.s = light.index + 1, .t = eye.index + 1}))
        return;
    const Vec3f to_light = light.position - eye.position;
    if (!eye.may_scatter(to_light) || !light.may_scatter(-to_light)) return;
    const float squared = length_squared(to_light);
    if (!(squared > 0.0f)) return;
    const Vec3f w = to_light * (1.0f / std::sqrt(squared));
    // Between different media lies a boundary, which no connection passes.
    if (eye.medium(w) != light.medium(-w)) return;
    between_.push_back({.eye = &eye, .light = &light, .w = w, .squared = squared, .scale = scale});
}

void BdptWave::weigh(const Context& context, const Between& connection) {
    const auto& [eye_vertex, light_vertex, w, squared, scale, at_eye, at_light] = connection;
    const PathVertex& eye = *eye_vertex;
    const PathVertex& light = *light_vertex;
    const float share = weight(context.options, sums_between(context.raised, eye, light, w, squared, at_eye, at_light));
    Ray ray = connecting_ray(eye.origin(w), light.origin(-w));
    ray.time = context.camera_rays[eye.slot].time;
    ray.alpha_key = context.connection_key(SubpathEnd::AtEye, eye.index, eye.slot) +
                    context.connection_key(SubpathEnd::AtLight, light.index, light.slot);
    shares_.clear();
    if (eye_.words().are_followed())
        eye_.words().join(eye_.words_after(eye, w), light_.words(), light_.words_after(light, -w), shares_);
    vertex_connections_.to_sample(
        ray, eye.slot,
        eye.throughput * at_eye.f_cos * at_light.f_cos * light.throughput * eye.transmittance(w, std::sqrt(squared)) *
            context.wavelength_weight(eye.slot, eye.is_dispersed || light.is_dispersed) * (scale * share / squared),
        LightKind::Indirect, shares_);
    if (is_checked(samples_[eye.slot], context.options))
        check(context, context.options, static_cast<std::size_t>(light.index) + 1, share, light_end(light.slot), &light,
              &eye, camera_of(context, eye));
}

}  // namespace etendue
