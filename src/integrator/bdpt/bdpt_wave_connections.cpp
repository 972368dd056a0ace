// All connections between the subpaths of a wave, the camera and lights.
#include "integrator/bdpt/bdpt_wave.h"
#include "transport/connecting_ray.h"
#include "wave/profile/wave_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace etendue {

namespace {

/// Numbers the dimension of the choice from the cache for the eye vertex of index 0, far from the dimensions of
/// subpaths.
constexpr std::uint32_t kCacheDimension = 3u << 29;

}  // namespace

void BdptWave::choose_lights(const BdptJob& job, std::size_t first, std::size_t last) {
    receivers_.clear();
    choosing_.clear();
    lit_.clear();
    for (std::size_t v = first; v < last; ++v) {
        const ConnectibleVertex& vertex = to_light_[v];
        if (!job.lengths.keeps(vertex.next_edges) || !job.wants({.s = 1, .t = vertex.index + 1})) continue;
        const DiffuseEnd& end = eye_.vertices().diffuse_end(vertex);
        receivers_.push_back(end.exists() ? end.position : eye_.vertices().whole(vertex).position);
        choosing_.push_back(to_light_.numbers(v)[0]);
        lit_.push_back(v);
    }
    choices_.resize(lit_.size());
    job.world().lights().choose(receivers_, choosing_, choices_);
}

void BdptWave::connect_to_lights(const BdptJob& job, std::size_t first, std::size_t last) {
    const World& world = job.world();
    WaveProfile* const profile = job.job.profile;
    choose_lights(job, first, last);
    std::array<const MeshLight*, kBlockLanes> meshes;
    std::array<Vec3f, kBlockLanes> points;
    std::array<Vec2f, kBlockLanes> u_triangle;
    std::array<Vec2f, kBlockLanes> u_direction;
    for (std::size_t i = 0; i < lit_.size(); ++i) {
        const bool is_wide = eye_.vertices().diffuse_end(to_light_[lit_[i]]).exists();
        meshes[i] = is_wide ? world.lights().even_mesh(choices_[i].light) : nullptr;
        points[i] = receivers_[i].position;
        const auto [light, triangle, direction] = to_light_.numbers(lit_[i]);
        u_triangle[i] = triangle;
        u_direction[i] = direction;
    }
    std::array<MeshLight::TriangleChoice, kBlockLanes> triangles;
    MeshLight::choose_triangles(std::span(meshes).first(lit_.size()), points, u_triangle, u_direction, triangles);
    to_lights_.clear();
    wide_to_lights_.clear();
    to_light_lanes_.front.clear();
    for (std::size_t i = 0; i < lit_.size(); ++i) {
        const ConnectibleVertex& vertex = to_light_[lit_[i]];
        const auto [light, triangle, direction] = to_light_.numbers(lit_[i]);
        const LightTree::Choice& choice = choices_[i];
        const MeshLight* mesh = meshes[i];
        if (mesh == nullptr) {
            to_lights_.push_back({&vertex,
                                  world.lights().sample(choice, points[i], {light, triangle, direction},
                                                        job.camera_rays[vertex.slot].time),
                                  {}});
            continue;
        }
        const std::size_t lane = wide_to_lights_.size();
        const MeshLight::TriangleChoice& on_light = triangles[i];
        wide_to_lights_.push_back(i);
        to_light_lanes_.set_sample(lane, vertex.slot, vertex.is_seen_directly);
        to_light_lanes_.eye.set(lane, eye_.vertices().diffuse_end(vertex));
        to_light_lanes_.front.set(lane, *mesh, on_light);
        to_light_lanes_.u.set(lane, on_light.u);
        to_light_lanes_.radiance.set(lane, mesh->radiance());
        to_light_lanes_.probability.set(lane, choice.probability);
        to_light_lanes_.choice_ratio.set(
            lane, world.emitters().probability(choice.light) / (choice.probability * on_light.gain));
    }
    if (profile != nullptr) profile->use().light_samples += lit_.size();
    stamp(profile, Stage::LightSampling);
    for (ToLight& connection : to_lights_)
        if (const LightSample& light = connection.chosen.sample; !is_black(light.radiance))
            connection.scattered =
                eye_.vertices().whole(*connection.vertex).evaluate_both_ways(light.wi, TransportMode::Radiance);
    stamp(profile, Stage::Material);
    for (const ToLight& connection : to_lights_)
        if (!is_black(connection.scattered.f_cos)) weigh(job, connection);
    weigh_wide_to_lights(job);
    stamp(profile, Stage::Mis);
}

void BdptWave::weigh(const BdptJob& job, const ToLight& connection) {
    const PathVertex& vertex = eye_.vertices().whole(*connection.vertex);
    const ChosenLight& chosen = connection.chosen;
    const LightSample& light = chosen.sample;
    const Scattering::TwoWayValue& value = connection.scattered;
    const float share = job.weight(sums_of_light_sample(job.mis, vertex, chosen, value));
    if (share == 0.0f) return;
    const Ray ray = job.timed(shadow_ray(vertex.origin(light.wi), light), vertex.slot);
    queue(job, *connection.vertex, chosen.light, light.wi, ray,
          vertex.throughput * value.f_cos * light.radiance *
              eye_.vertices().transmittance(job.world(), vertex, ray, light.distance) *
              job.wavelength_weight(vertex.slot, vertex.is_dispersed) * (share / chosen.density()),
          light_connections_);
}

void BdptWave::weigh_wide_to_lights(const BdptJob& job) {
    to_light_lanes_.connect(wide_to_lights_.size(), job.rule(), job.world().emitters().aim(job.mis.aims));
    if (!asks_for_each(job)) return queue_wide(to_light_lanes_, wide_to_lights_.size(), wide_light_connections_);
    for (std::size_t lane = 0; lane < wide_to_lights_.size(); ++lane) {
        const std::size_t i = wide_to_lights_[lane];
        const ConnectibleVertex& vertex = to_light_[lit_[i]];
        if (const Rgb brought = to_light_lanes_.contribution[lane]; !is_black(brought))
            queue(job, vertex, choices_[i].light, to_light_lanes_.wi[lane],
                  job.timed(to_light_lanes_.ray(lane), vertex.slot), brought, wide_light_connections_);
    }
}

void BdptWave::queue(const BdptJob& job, const ConnectibleVertex& vertex, std::uint32_t light, const Vec3f& wi, Ray ray,
                     const Rgb& brought, ShadowRayQueue& connections) {
    ray.alpha_key = job.connection_key(SubpathEnd::AtEye, vertex.index, vertex.slot);
    shares_.clear();
    if (PathWords& words = eye_.vertices().words(); words.are_followed()) {
        const PathVertex& whole = eye_.vertices().whole(vertex);
        words.end_at_light(whole.words, whole.event(wi, TransportMode::Radiance),
                           words.light_source(job.world(), light), shares_);
    }
    connections.to_sample(ray, vertex.slot, brought, vertex.is_seen_directly ? LightKind::Direct : LightKind::Indirect,
                          shares_);
}

void BdptWave::connect_to_camera(const BdptJob& job, std::size_t first, std::size_t last) {
    WaveProfile* const profile = job.job.profile;
    to_cameras_.clear();
    wide_to_cameras_.clear();
    for (std::size_t v = first; v < last; ++v) {
        const ConnectibleVertex& vertex = to_camera_[v];
        if (!job.lengths.keeps(vertex.next_edges) || !job.wants({.s = vertex.index + 1, .t = 1})) continue;
        const auto [lens] = to_camera_.numbers(v);
        const DiffuseEnd& end = light_.vertices().diffuse_end(vertex);
        if (!end.exists() && !light_.vertices().whole(vertex).lights_camera) continue;
        const Vec3f& position = end.exists() ? end.position : light_.vertices().whole(vertex).position;
        const auto view = view_from_camera(job.world(), job.job, position, lens, job.camera_rays[vertex.slot].time);
        if (!view) continue;
        if (!end.exists()) {
            to_cameras_.push_back({&vertex, *view, {}});
            continue;
        }
        const std::size_t lane = wide_to_cameras_.size();
        wide_to_cameras_.push_back({&vertex, *view, {}});
        to_camera_lanes_.set_sample(lane, vertex.slot, vertex.index <= 1);
        to_camera_lanes_.light.set(lane, end);
        to_camera_lanes_.lens.set(lane, view->camera.lens);
        to_camera_lanes_.w.set(lane, view->direction);
        to_camera_lanes_.importance.set(lane, view->camera.importance_area);
    }
    stamp(profile, Stage::Mis);
    for (ToCamera& connection : to_cameras_)
        connection.scattered = light_.vertices()
                                   .whole(*connection.vertex)
                                   .evaluate_both_ways(connection.view.direction, TransportMode::Importance);
    stamp(profile, Stage::Material);
    for (const ToCamera& connection : to_cameras_)
        if (!is_black(connection.scattered.f_cos)) weigh(job, connection);
    weigh_wide_to_camera(job);
    stamp(profile, Stage::Mis);
}

void BdptWave::weigh(const BdptJob& job, const ToCamera& connection) {
    const PathVertex& vertex = light_.vertices().whole(*connection.vertex);
    const CameraView& view = connection.view;
    const Scattering::TwoWayValue& value = connection.scattered;
    const float share = job.weight(sums_at_lens(job.mis, vertex, view.direction, view.camera, value));
    const Ray ray = job.timed(connecting_ray(vertex.origin(view.direction), view.camera.lens), vertex.slot);
    queue(job, *connection.vertex, view, ray,
          vertex.throughput * value.f_cos *
              light_.vertices().transmittance(job.world(), vertex, ray, view.distance, RayEnds::ToCamera) *
              job.wavelength_weight(vertex.slot, vertex.is_dispersed) * (view.camera.importance_area * share),
          camera_connections_);
}

void BdptWave::weigh_wide_to_camera(const BdptJob& job) {
    to_camera_lanes_.connect(wide_to_cameras_.size(), job.rule(), static_cast<float>(job.mis.samples_per_light_path));
    if (!asks_for_each(job))
        return to_camera_lanes_.for_each_wide(
            wide_to_cameras_.size(), [&](const WideShadowRays& connections, WideMask which, std::size_t first) {
                wide_camera_connections_.to_film(connections, which, [&](std::size_t lane) {
                    const CameraView& view = wide_to_cameras_[first + lane].view;
                    return SplatPlace{view.pixel, view.depth};
                });
            });
    for (std::size_t lane = 0; lane < wide_to_cameras_.size(); ++lane) {
        const auto& [vertex, view, scattered] = wide_to_cameras_[lane];
        if (const Rgb brought = to_camera_lanes_.contribution[lane]; !is_black(brought))
            queue(job, *vertex, view, job.timed(to_camera_lanes_.ray(lane), vertex->slot), brought,
                  wide_camera_connections_);
    }
}

void BdptWave::queue(const BdptJob& job, const ConnectibleVertex& vertex, const CameraView& view, Ray ray,
                     const Rgb& brought, ShadowRayQueue& connections) {
    ray.alpha_key = job.connection_key(SubpathEnd::AtLight, vertex.index, vertex.slot);
    shares_.clear();
    if (light_.vertices().words().are_followed())
        light_.vertices().words().end_at_camera(
            light_.vertices().words_after(light_.vertices().whole(vertex), view.direction), shares_);
    connections.to_film(ray, vertex.slot, {.position = view.pixel, .value = brought, .depth = view.depth},
                        vertex.index > 1 ? LightKind::Indirect : LightKind::Direct, shares_);
}

void BdptWave::connect_to_vertices(const BdptJob& job, std::size_t first, std::size_t last, TileBuffer& tile,
                                   RenderCounters& counters) {
    for (std::size_t v = first; v < last; ++v) {
        const ConnectibleVertex& eye = to_light_[v];
        const bool has_cache = job.is_shared(eye);
        const DiffuseEnd& eye_end = eye_.vertices().diffuse_end(eye);
        for (const LightVertices::Candidate& own : light_vertices_.own(eye.slot)) {
            // A subpath in a dense body may have thousands of vertices: all pairs would take too much memory.
            if (between_.size() >= kMostBetween) {
                weigh_between(job);
                resolve_full(job, {&vertex_connections_, &wide_vertex_connections_}, tile, counters);
            }
            if (!(has_cache && own.is_shared)) find(job, eye, eye_end, own.vertex, 1.0f);
        }
        if (has_cache) find_cached(job, eye, job.settings.cached_connections);
    }
    weigh_wide_between(job);
    weigh_between(job);
    resolve_full(job, {&vertex_connections_, &wide_vertex_connections_}, tile, counters);
}

void BdptWave::weigh_between(const BdptJob& job) {
    WaveProfile* const profile = job.job.profile;
    stamp(profile, Stage::Mis);
    for (Between& connection : between_) {
        connection.at_eye =
            eye_.vertices().whole(*connection.eye).evaluate_both_ways(connection.w, TransportMode::Radiance);
        if (!is_black(connection.at_eye.f_cos))
            connection.at_light =
                light_.vertices().whole(*connection.light).evaluate_both_ways(-connection.w, TransportMode::Importance);
    }
    stamp(profile, Stage::Material);
    for (const Between& connection : between_)
        if (!is_black(connection.at_light.f_cos)) weigh(job, connection);
    between_.clear();
    stamp(profile, Stage::Mis);
}

void BdptWave::find_cached(const BdptJob& job, const ConnectibleVertex& eye, int count) {
    const std::span<const LightVertices::Candidate> cache = light_vertices_.cache();
    if (cache.empty()) return;
    const auto size = static_cast<float>(cache.size());
    const float step = size / static_cast<float>(count);
    const float scale = step / static_cast<float>(samples_.size());
    // One number for all, and equal steps from one to the next: each is as likely as any other to be drawn.
    const SampleKey key = samples_[eye.slot].key;
    const float u = sample_2d(job.job.sequence, key, kCacheDimension + static_cast<std::uint32_t>(eye.index)).x;
    const DiffuseEnd& eye_end = eye_.vertices().diffuse_end(eye);
    for (int i = 0; i < count; ++i) {
        const auto drawn = static_cast<std::size_t>((static_cast<float>(i) + u) * step);
        find(job, eye, eye_end, cache[std::min(drawn, cache.size() - 1)].vertex, scale);
    }
}

void BdptWave::find(const BdptJob& job, const ConnectibleVertex& eye, const DiffuseEnd& eye_end,
                    const ConnectibleVertex& light, float scale) {
    if ((eye.is_in_dense && light.is_in_dense) || !job.lengths.keeps(eye.next_edges + light.next_edges - 1) ||
        !job.wants({.s = light.index + 1, .t = eye.index + 1}))
        return;
    const DiffuseEnd& light_end = light_.vertices().diffuse_end(light);
    if (!eye_end.exists() || !light_end.exists()) return find_singly(job, eye, light, scale);
    // About every other one faces away, in no order that a branch could be foretold by.
    const Vec3f w = light_end.position - eye_end.position;
    wide_between_[wide_between_count_] = {&eye, &light, &eye_end, &light_end, scale};
    wide_between_count_ += static_cast<std::size_t>(dot(w, eye_end.geometric_normal) > 0.0f) &
                           static_cast<std::size_t>(dot(w, light_end.geometric_normal) < 0.0f);
    if (wide_between_count_ == wide_between_.size()) weigh_wide_between(job);
}

void BdptWave::find_singly(const BdptJob& job, const ConnectibleVertex& eye_vertex,
                           const ConnectibleVertex& light_vertex, float scale) {
    const PathVertex& eye = eye_.vertices().whole(eye_vertex);
    const PathVertex& light = light_.vertices().whole(light_vertex);
    const Vec3f to_light = light.position - eye.position;
    if (!eye.may_scatter(to_light) || !light.may_scatter(-to_light)) return;
    const float squared = length_squared(to_light);
    if (!(squared > 0.0f)) return;
    const Vec3f w = to_light * (1.0f / std::sqrt(squared));
    // Between different media lies a boundary, and connections pass none but clear ones.
    if (!job.world().traits().has_clear_bodies && eye.medium(w) != light.medium(-w)) return;
    between_.push_back({.eye = &eye_vertex, .light = &light_vertex, .w = w, .squared = squared, .scale = scale});
}

void BdptWave::weigh(const BdptJob& job, const Between& connection) {
    const auto& [eye_vertex, light_vertex, w, squared, scale, at_eye, at_light] = connection;
    const PathVertex& eye = eye_.vertices().whole(*eye_vertex);
    const PathVertex& light = light_.vertices().whole(*light_vertex);
    const float share = job.weight(sums_between(job.mis.raised, eye, light, w, squared, at_eye, at_light));
    const Ray ray = job.timed(connecting_ray(eye.origin(w), light.origin(-w)), eye.slot);
    queue(job, *eye_vertex, *light_vertex, ray,
          eye.throughput * at_eye.f_cos * at_light.f_cos * light.throughput *
              eye_.vertices().transmittance(job.world(), eye, ray, std::sqrt(squared)) *
              job.wavelength_weight(eye.slot, eye.is_dispersed || light.is_dispersed) * (scale * share / squared),
          vertex_connections_);
}

void BdptWave::weigh_wide_between(const BdptJob& job) {
    const std::size_t count = std::exchange(wide_between_count_, 0);
    for (std::size_t lane = 0; lane < count; ++lane) {
        const WideBetween& connection = wide_between_[lane];
        between_lanes_.set_sample(lane, connection.eye->slot, false);
        between_lanes_.eye.set(lane, *connection.eye_end);
        between_lanes_.light.set(lane, *connection.light_end);
        between_lanes_.merged.set(lane, connection.light->is_after_delta ? connection.eye->merged : 0.0f);
        between_lanes_.scale.set(lane, connection.scale);
    }
    between_lanes_.connect(count, job.rule());
    if (!asks_for_each(job)) return queue_wide(between_lanes_, count, wide_vertex_connections_);
    for (std::size_t lane = 0; lane < count; ++lane)
        if (const Rgb brought = between_lanes_.contribution[lane]; !is_black(brought))
            queue(job, *wide_between_[lane].eye, *wide_between_[lane].light,
                  job.timed(between_lanes_.ray(lane), wide_between_[lane].eye->slot), brought,
                  wide_vertex_connections_);
}

bool BdptWave::asks_for_each(const BdptJob& job) {
    return eye_.vertices().words().are_followed() || job.world().traits().has_motion ||
           job.world().traits().has_transparency;
}

void BdptWave::queue_wide(const ConnectionColumns& lanes, std::size_t count, ShadowRayQueue& connections) {
    lanes.for_each_wide(count, [&](const WideShadowRays& wide, WideMask which, std::size_t /*first*/) {
        connections.to_sample(wide, which);
    });
}

void BdptWave::queue(const BdptJob& job, const ConnectibleVertex& eye, const ConnectibleVertex& light, Ray ray,
                     const Rgb& brought, ShadowRayQueue& connections) {
    ray.alpha_key = job.connection_key(SubpathEnd::AtEye, eye.index, eye.slot) +
                    job.connection_key(SubpathEnd::AtLight, light.index, light.slot);
    shares_.clear();
    if (eye_.vertices().words().are_followed()) {
        const PathVertex& at_eye = eye_.vertices().whole(eye);
        const PathVertex& at_light = light_.vertices().whole(light);
        const Vec3f w = normalize(at_light.position - at_eye.position);
        eye_.vertices().words().join(eye_.vertices().words_after(at_eye, w), light_.vertices().words(),
                                     light_.vertices().words_after(at_light, -w), shares_);
    }
    connections.to_sample(ray, eye.slot, brought, LightKind::Indirect, shares_);
}

}  // namespace etendue
