#include "wave/subpath/subpath_wave.h"

#include "core/in_place.h"
#include "transport/bodies.h"
#include "transport/roulette.h"
#include "transport/subpath.h"
#include "wave/ray_batch.h"
#include "world/lit_surface.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// Tells `finder` what light the subpath of `state` meets where `ray` ends, at `hit`.
void find_light(LightFinder& finder, const SubpathState& state, const Ray& ray, const Hit& hit,
                const ShadedSubpath& path, bool is_first) {
    if (!hit.valid()) return finder.on_escape(state, ray.direction);
    if (path.point.material->emits && !(is_first && finder.finds_emission(hit)))
        finder.on_emitter(state, path.point, ray.direction, path.arrived);
    if (path.point.material->unlit && !(path.crossing && path.crossing->is_covered)) finder.on_unlit(state, path.point);
}

}  // namespace

void SubpathWave::trace(const SubpathJob& job, int roulette_depth, LightFinder* finder, SampleLight& light,
                        RenderCounters& counters) {
    roulette_depth_ = first_roulette(job.world(), roulette_depth);
    const std::size_t count = job.samples.size();
    states_.assign(count, {});
    rays_.assign(job.camera_rays.begin(), job.camera_rays.end());
    interiors_.clear();
    vertices_.reset(job.job.aovs);
    if (end_ == SubpathEnd::AtEye)
        begin_at_eye(job);
    else
        begin_at_lights(job);
    stamp(job.job.profile, Stage::Generate);
    for (bounce_ = 1; !states_.empty(); ++bounce_) {
        hits_.resize(rays_.size());
        const bool from_camera = end_ == SubpathEnd::AtEye && bounce_ == 1;
        const RayKind kind = end_ == SubpathEnd::AtLight ? RayKind::LightSubpath
                             : from_camera               ? RayKind::Primary
                                                         : RayKind::Bounce;
        if (chooses_surfaces(job.world())) {
            lit_counts_.resize(rays_.size());
            intersect_lit(job.world(), job.job, rays_, hits_, lit_counts_, counters);
            for (std::size_t i = 0; i < states_.size(); ++i) states_[i].throughput *= lit_counts_[i];
        } else {
            intersect_batch(job.world(), job.job, kind, rays_, hits_, counters);
        }
        if (end_ == SubpathEnd::AtEye && (job.world().traits().hides_surfaces || job.world().traits().clips_far))
            for (std::size_t i = 0; i < states_.size(); ++i)
                if (states_[i].index == kDirectlySeen)
                    hits_[i] =
                        hit_seen_by_camera(job.world(), job.job, rays_[i], hits_[i], states_[i].slot, light, counters);
        if (light.counts_rays())
            for (const SubpathState& state : states_) light.count_ray(state.slot);
        if (from_camera && finder != nullptr) finder->on_first_hits(rays_, hits_);
        stamp(job.job.profile, Stage::HitSetup);
        draw_numbers(job);
        stamp(job.job.profile, Stage::Numbers);
        std::size_t kept = 0;
        for (std::size_t first = 0; first < states_.size(); first += kBlockLanes)
            advance_block(job, finder, first, std::min(kBlockLanes, states_.size() - first), kept);
        states_.resize(kept);
        rays_.resize(kept);
    }
    vertices_.finish();
}

std::size_t SubpathWave::bytes() const {
    std::size_t bytes = sizeof *this + vector_bytes(states_, rays_, hits_, lit_counts_, interiors_, emissions_) +
                        keys_.bytes() + vertices_.bytes();
    for (const NumberPairs* numbers :
         {&scattering_, &choices_, &medium_, &light_choice_, &triangle_, &position_, &direction_})
        bytes += numbers->bytes();
    return bytes;
}

void SubpathWave::draw_numbers(const SubpathJob& job) {
    keys_.clear();
    for (const SubpathState& state : states_) keys_.push_back(job.samples[state.slot].key);
    const auto draw = [&](SubpathDimension which, NumberPairs& numbers) {
        if (job.needs(end_, which))
            numbers.draw(job.job.sequence, keys_, subpath_dimension(end_, bounce_, which));
        else
            numbers.draw_none(keys_.size());
    };
    draw(SubpathDimension::Scattering, scattering_);
    draw(SubpathDimension::Choices, choices_);
    if (job.world().traits().has_bodies) draw(SubpathDimension::Medium, medium_);
}

void SubpathWave::advance_block(const SubpathJob& job, LightFinder* finder, std::size_t first, std::size_t count,
                                std::size_t& kept) {
    const World& world = job.world();
    WaveProfile* const profile = job.job.profile;
    surfaces_ = 0;
    world.geometry().fetch_triangles(std::span(hits_).subspan(first, count));
    for (std::size_t k = 0; k < count; ++k) {
        block_[k].lane = surfaces_;
        const std::size_t i = first + k;
        goes_on_[k] = world.traits().has_bodies && hits_[i].has_end() && scatter_in_medium(job, i);
        if (world.traits().replaces_surfaces && finder != nullptr && !goes_on_[k] &&
            states_[i].index == kDirectlySeen && world.materials().is_replaced(hits_[i])) {
            finder->on_replaced_surface(states_[i], rays_[i], world.traits().has_bodies ? interiors_[i] : Interior(),
                                        hits_[i]);
            hits_[i] = {};
        }
        if (!goes_on_[k] && set_up(job, i, block_[k])) on_surface_[surfaces_++] = static_cast<std::uint8_t>(k);
    }
    set_up_plain();
    arrive_at_surfaces(job, first);
    stamp(profile, Stage::HitSetup);
    if (finder != nullptr)
        for (std::size_t k = 0; k < count; ++k)
            if (const std::size_t i = first + k; !goes_on_[k])
                find_light(*finder, states_[i], rays_[i], hits_[i], block_[k], bounce_ == 1);
    stamp(profile, Stage::Emission);
    std::size_t vertices = 0;
    ends_.fill(PathVertex::kNoVertex);
    for (std::size_t s = 0; s < surfaces_; ++s) {
        const std::uint8_t k = on_surface_[s];
        if (make_vertex(job, first, k)) on_surface_[vertices++] = k;
    }
    if (makes_diffuse_ends_) store_diffuse_ends();
    stamp(profile, Stage::Textures);
    sample_bsdfs(first, vertices);
    stamp(profile, Stage::Material);
    for (std::size_t v = 0; v < vertices; ++v) {
        const std::uint8_t k = on_surface_[v];
        goes_on_[k] = block_[k].plain != nullptr ? scatter_at_plain(job, first + k, block_[k])
                                                 : scatter_at_surface(job, first + k, block_[k]);
    }
    keep_survivors(job, first, count, kept);
    stamp(profile, Stage::Roulette);
}

bool SubpathWave::set_up(const SubpathJob& job, std::size_t i, ShadedSubpath& path) {
    const World& world = job.world();
    if (!hits_[i].valid()) {
        end_path(job, i, PathEnding::Escaped);
        return false;
    }
    if (chooses_surfaces(world) && !is_lit(world, hits_[i], rays_[i].direction)) {
        hits_[i] = {};
        end_path(job, i, PathEnding::Absorbed);
        return false;
    }
    path.plain = world.materials().plain_bsdf(hits_[i]);
    if (path.plain != nullptr) {
        path.point.material = world.materials().at(hits_[i]);
        path.crossing.reset();
        lanes_.set_hit(path.lane, world.geometry().hit_triangle(hits_[i]), {hits_[i].u, hits_[i].v});
        lanes_.wo.set(path.lane, -rays_[i].direction);
        lanes_.albedo.set(path.lane, std::get_if<Diffuse>(path.plain)->albedo);
        lanes_.throughput.set(path.lane, states_[i].throughput);
        return true;
    }
    make_in_place(path.point, [&] { return world.geometry().surface_point(hits_[i], rays_[i], RayCone{}); });
    path.crossing.reset();
    if (world.traits().has_bodies) path.crossing = crossing_at(world, path.point, {rays_[i], interiors_[i], hits_[i]});
    return true;
}

void SubpathWave::set_up_plain() {
    const auto is_plain = [&](std::uint8_t k) { return block_[k].plain != nullptr; };
    if (std::ranges::none_of(std::span(on_surface_.data(), surfaces_), is_plain)) return;
    lanes_.set_up_points(surfaces_);
    lanes_.orient(surfaces_, mode_of(end_));
}

void SubpathWave::arrive_at_surfaces(const SubpathJob& job, std::size_t first) {
    for (std::size_t s = 0; s < surfaces_; ++s) {
        const std::size_t i = first + on_surface_[s];
        ShadedSubpath& path = block_[on_surface_[s]];
        const bool is_plain = path.plain != nullptr;
        const Vec3f position = is_plain ? lanes_.position[path.lane] : path.point.position;
        const Vec3f normal = is_plain ? lanes_.geometric_normal[path.lane] : path.point.geometric_normal;
        path.arrived = arrive(job, i, position, static_cast<double>(abs_dot(rays_[i].direction, normal)));
    }
}

SubpathDensities SubpathWave::arrive(const SubpathJob& job, std::size_t i, const Vec3f& position, double cosine,
                                     bool in_dense) const {
    const SubpathState& state = states_[i];
    if (state.index > 1)
        return state.departing.arrive(job.mis.raised, static_cast<double>(length_squared(position - state.from)),
                                      cosine, in_dense);
    if (end_ == SubpathEnd::AtLight)
        return arrive_from_light(job.mis, emissions_[state.slot], state.departing, position, cosine);
    const Vec2f lens = job.samples[state.slot].lens;
    return arrive_from_lens(job.mis, state.departing, job.world().camera().connect(position, lens, rays_[i].time),
                            cosine);
}

void SubpathWave::sample_bsdfs(std::size_t first, std::size_t vertices) {
    bool any_plain = false;
    for (std::size_t v = 0; v < vertices; ++v) {
        ShadedSubpath& path = block_[on_surface_[v]];
        const std::size_t i = first + on_surface_[v];
        if (path.plain == nullptr) {
            path.sample = vertices_[path.vertex].surface->sample(choices_[i].x, scattering_[i], mode_of(end_));
        } else {
            lanes_.u.set(path.lane, scattering_[i]);
            any_plain = true;
        }
    }
    if (any_plain) lanes_.sample(surfaces_, mode_of(end_));
}

bool SubpathWave::scatter(const SubpathJob& job, std::size_t i, const Vec3f& position, const Rgb& weight,
                          bool is_delta) {
    if (job.job.profile != nullptr && end_ == SubpathEnd::AtEye) ++job.job.profile->use().bsdf_samples;
    if (is_black(weight)) {
        end_path(job, i, PathEnding::Absorbed);
        return false;
    }
    SubpathState& state = states_[i];
    state.throughput *= weight;
    state.from = position;
    state.lights_directly = state.only_deltas;
    state.only_deltas = state.only_deltas && is_delta;
    state.is_after_delta = state.is_after_delta || is_delta;
    ++state.index;
    ++state.edges;
    return true;
}

bool SubpathWave::scatter_at_plain(const SubpathJob& job, std::size_t i, const ShadedSubpath& path) {
    const std::size_t lane = path.lane;
    if (!scatter(job, i, lanes_.position[lane], lanes_.next_weight[lane], false)) return false;
    SubpathState& state = states_[i];
    if (vertices_.words().are_followed()) vertices_.follow_words(state, diffuse_event(vertices_[path.vertex].label));
    state.departing =
        depart(job.mis.raised, path.arrived, lanes_.next_pdf[lane], lanes_.reverse_pdf[lane], lanes_.next_cosine[lane]);
    rays_[i].origin = lanes_.next_origin[lane];
    rays_[i].direction = lanes_.next_direction[lane];
    return true;
}

bool SubpathWave::scatter_at_surface(const SubpathJob& job, std::size_t i, const ShadedSubpath& path) {
    const SurfacePoint& point = path.point;
    const BsdfSample& sample = path.sample;
    if (goes_straight_on(*point.material, sample) && !is_black(sample.weight)) {
        pass_straight(i, path);
        return true;
    }
    if (path.ends_here) {
        end_path(job, i, PathEnding::TooLong);
        return false;
    }
    if (!scatter(job, i, point.position, sample.weight, sample.is_delta)) return false;
    SubpathState& state = states_[i];
    Ray& ray = rays_[i];
    PathVertex& vertex = vertices_[path.vertex];
    const Scattering& scattering = *vertex.surface;
    if (vertices_.words().are_followed())
        vertices_.follow_words(state,
                               surface_event(scattering, sample.wi, sample.is_delta, mode_of(end_), vertex.label));
    if (end_ == SubpathEnd::AtEye && sample.is_transmission) state.roulette_scale *= sample.eta * sample.eta;
    const float cosine = abs_dot(sample.wi, point.geometric_normal);
    state.departing = sample.is_delta ? depart_by_delta(job.mis.raised, path.arrived, sample.reverse_ratio, cosine)
                                      : depart(job.mis.raised, path.arrived, sample.pdf_solid_angle,
                                               scattering.reverse_pdf_solid_angle(sample.wi, mode_of(end_)), cosine);
    ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, sample.wi);
    ray.direction = sample.wi;
    if (path.crossing) interiors_[i] = beyond(*path.crossing, point, sample.wi);
    return true;
}

void SubpathWave::pass_straight(std::size_t i, const ShadedSubpath& path) {
    SubpathState& state = states_[i];
    const SurfacePoint& point = path.point;
    state.throughput *= path.sample.weight;
    state.is_direct = vertices_[path.vertex].is_reached_directly;
    rays_[i].origin = offset_origin(point.position, point.geometric_normal, point.clearance, rays_[i].direction);
    if (path.crossing) interiors_[i] = beyond(*path.crossing, point, rays_[i].direction);
}

bool SubpathWave::scatter_in_medium(const SubpathJob& job, std::size_t i) {
    SubpathState& state = states_[i];
    Ray& ray = rays_[i];
    const HomogeneousMedium* medium = job.world().media().within(interiors_[i]);
    if (medium == nullptr) return false;
    const MediumSample sample = medium->sample(state.throughput, hits_[i].t, medium_[i]);
    state.throughput *= sample.weight;
    if (!sample.scatters) return false;
    if (job.job.profile != nullptr && end_ == SubpathEnd::AtEye) ++job.job.profile->use().phase_samples;
    const Vec3f wo = -ray.direction;
    const Vec3f position = ray.origin + ray.direction * sample.distance;
    if (chooses_surfaces(job.world())) state.throughput *= chance_beyond(job.world(), ray, position);
    PathVertex& vertex = vertices_.store(state);
    vertex.position = position;
    vertex.wo = wo;
    vertex.outside = vertex.inside = medium;
    if (job.world().traits().has_clear_bodies) vertices_.keep_interiors({interiors_[i], interiors_[i]});
    vertex.densities = arrive(job, i, vertex.position, 1.0, medium->is_dense);
    vertex.next_edges = state.edges;
    vertices_.list_connectible(state, state.edges, 0.0f, medium->is_dense);
    ray.origin = vertex.position;
    ray.direction = medium->phase.sample(wo, scattering_[i]);
    // Forwards and backwards a phase function has one density.
    const float phase = medium->phase.pdf_solid_angle(wo, ray.direction);
    state.from = vertex.position;
    state.departing = depart(job.mis.raised, vertex.densities, phase, phase, 1.0f);
    state.departing.is_in_dense = medium->is_dense;
    state.lights_directly = state.only_deltas;
    state.only_deltas = false;
    if (vertices_.words().are_followed()) vertices_.follow_words(state, VertexEvent{});
    ++state.index;
    return true;
}

void SubpathWave::end_path(const SubpathJob& job, std::size_t i, PathEnding ending) const {
    if (end_ == SubpathEnd::AtEye)
        count_eye_path_end(job.job, job.samples[states_[i].slot], ending, bounce_);
    else if (job.job.profile != nullptr)
        job.job.profile->end_light_path(ending, bounce_);
}

void SubpathWave::keep_survivors(const SubpathJob& job, std::size_t first, std::size_t count, std::size_t& kept) {
    Column survival;
    for (std::size_t k = 0; k < count; ++k) {
        const SubpathState& state = states_[first + k];
        survival.set(k, max_component(state.throughput) * state.roulette_scale);
    }
    const float most = most_survival(PathKind::Subpath, bounce_);
    const auto chance = [&](const Wide& share) {
        if (bounce_ < roulette_depth_) return Wide(1.0f);
        return end_ == SubpathEnd::AtEye ? eye_path_survival(share, most) : light_path_survival(share, most);
    };
    for (std::size_t k = 0; k < count; k += Wide::kWidth) survival.store(k, chance(survival.load(k)));
    // Without a branch, as in PathWave.
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = first + k;
        const bool survives = choices_[i].y < survival[k];
        if (job.job.profile != nullptr && goes_on_[k] && !survives) end_path(job, i, PathEnding::Roulette);
        if (job.world().traits().has_transparency)
            rays_[i].alpha_key = sample_bits(keys_[i], subpath_dimension(end_, bounce_, SubpathDimension::Alpha));
        states_[kept] = states_[i];
        states_[kept].throughput *= 1.0f / survival[k];
        rays_[kept] = rays_[i];
        if (!interiors_.empty()) interiors_[kept] = interiors_[i];
        kept += goes_on_[k] && survives ? 1 : 0;
    }
}

}  // namespace etendue
