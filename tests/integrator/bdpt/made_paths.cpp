#include "integrator/bdpt/made_paths.h"

#include "transport/roulette.h"
#include "transport/scattered_cone.h"
#include "transport/strategies.h"
#include "wave/camera_wave.h"
#include "wave/film_repeats.h"
#include "wave/subpath/subpath_wave.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace etendue::test {

namespace {

/// Holds where one ray of a subpath has led.
struct Arrived {
    Subpath subpath;
    WalkedVertex vertex;
    SubpathDensities densities;
};

/// Holds where the rays of a subpath have led, one after the other, and its vertices that can be connected.
struct WalkedSubpath {
    std::vector<Arrived> arrivals;
    std::vector<SubpathVertex> connectible;

    /// Returns the vertices at which the subpath scattered before it came to that of this index, the first one first.
    [[nodiscard]] std::vector<const WalkedVertex*> before(int index) const {
        std::vector<const WalkedVertex*> vertices;
        for (std::size_t i = 0; i + 1 < arrivals.size() && arrivals[i].vertex.index < index; ++i)
            if (arrivals[i + 1].vertex.index > arrivals[i].vertex.index) vertices.push_back(&arrivals[i].vertex);
        return vertices;
    }
    /// Returns the vertices of the subpath up to `last`, one of `connectible`, the first one first.
    [[nodiscard]] std::vector<const WalkedVertex*> up_to(const SubpathVertex& last) const {
        std::vector<const WalkedVertex*> vertices = before(last.index);
        const auto is_last = [&](const Arrived& a) {
            return a.vertex.index == last.index && a.vertex.kind == last.kind && a.vertex.position == last.position;
        };
        vertices.push_back(&std::ranges::find_if(arrivals, is_last)->vertex);
        return vertices;
    }
};

/// Follows `subpath`, and finds out what no arrival tells: where media scattered it, and by which deltas it went on.
WalkedSubpath walk(const SubpathSample& sample, const Subpath& subpath, int roulette_depth) {
    WalkedSubpath walked;
    std::vector<Arrived>& arrivals = walked.arrivals;
    walked.connectible =
        follow_subpath(sample, subpath, roulette_depth,
                       [&](const Subpath& way, const Vertex& vertex, const SubpathDensities& densities) {
                           arrivals.push_back({way, {vertex, way.index}, densities});
                       });
    for (const SubpathVertex& vertex : walked.connectible) {
        if (vertex.kind != Vertex::Kind::Medium) continue;
        const auto next =
            std::ranges::find_if(arrivals, [&](const Arrived& a) { return a.vertex.index > vertex.index; });
        arrivals.insert(next, {subpath, {static_cast<const Vertex&>(vertex), vertex.index}, {}});
    }
    for (std::size_t i = 0; i < arrivals.size(); ++i) {
        WalkedVertex& vertex = arrivals[i].vertex;
        if (i > 0 && arrivals[i - 1].vertex.index == vertex.index)
            vertex.is_reached_directly =
                arrivals[i - 1].vertex.is_reached_directly && arrivals[i - 1].vertex.kind != Vertex::Kind::Boundary;
        if (vertex.kind != Vertex::Kind::Surface) continue;
        const int bounce = static_cast<int>(i) + 1;
        const BsdfSample scattered =
            vertex.sample(sample.pair(subpath.end, bounce, SubpathDimension::Choices).x,
                          sample.pair(subpath.end, bounce, SubpathDimension::Scattering), subpath.mode());
        vertex.is_left_by_delta = scattered.is_delta;
        if (scattered.is_delta) vertex.delta_reverse_ratio = scattered.reverse_ratio;
    }
    return walked;
}

/// Makes the paths of one sample.
class PathsOfSample {
  public:
    PathsOfSample(const SubpathSample& sample, const TileJob& job, const HearPath& hear)
        : sample_(sample), job_(job), hear_(hear) {}

    void make(SparedRays spared) {
        eye_ = walk(sample_, begin_subpath_at_eye(sample_), spared.of_eye);
        for (const Arrived& arrived : eye_.arrivals)
            if (arrived.vertex.index > kDirectlySeen && arrived.vertex.kind != Vertex::Kind::Medium) meet(arrived);
        const std::optional<Subpath> from_light = begin_subpath_at_light(sample_);
        if (!from_light) return;
        for (const SubpathVertex& vertex : eye_.connectible) sample_light(vertex);
        if (!leads_to_camera(sample_, *from_light)) return;
        light_ = walk(sample_, *from_light, spared.of_light);
        const EmissionSample& emission = from_light->emission->sample;
        light_end_ = {.light = from_light->emission->light,
                      .triangle = emission.triangle,
                      .position = emission.position,
                      .direction = emission.direction,
                      .cos_light = emission.cos_theta};
        for (const SubpathVertex& light : light_.connectible) {
            for (const SubpathVertex& eye : eye_.connectible) connect(eye, light);
            connect_to_lens(light);
        }
    }

  private:
    using Vertices = std::vector<const WalkedVertex*>;

    [[nodiscard]] CameraConnection view_of(const Vec3f& position) const {
        return sample_.world().camera().connect(position, sample_.eye.lens, sample_.eye.ray.time);
    }
    /// Tells of the path from `end` over those of `inner` that are from the light, and back over those of `eye`.
    void tell(const PathLightEnd& end, Vertices inner, const Vertices& eye, std::size_t s, double weight) const {
        inner.insert(inner.end(), eye.rbegin(), eye.rend());
        hear_({with_time(end), inner, s, view_of(eye.front()->position)}, weight);
    }
    [[nodiscard]] PathLightEnd with_time(PathLightEnd end) const {
        end.time = sample_.eye.ray.time;
        return end;
    }

    void meet(const Arrived& arrived) const {
        const World& world = sample_.world();
        const WalkedVertex& vertex = arrived.vertex;
        const SurfacePoint& point = vertex.surface;
        std::vector<PathLightEnd> ends;
        if (vertex.kind == Vertex::Kind::Environment) {
            for (const std::uint32_t light : world.environment().met(false))
                if (!is_black(world.environment().radiance(light, -vertex.wo)))
                    ends.push_back({.light = light, .direction = vertex.wo});
        } else if (point.material->emits && !is_black(world.materials().emission(point, vertex.wo))) {
            ends.push_back({.light = world.lights().at(point),
                            .triangle = point.triangle,
                            .position = point.position,
                            .direction = vertex.wo,
                            .cos_light = dot(vertex.wo, point.geometric_normal)});
        }
        if (vertex.kind == Vertex::Kind::Unlit && arrived.subpath.only_deltas)
            ends.push_back({.position = point.position, .direction = vertex.wo});
        const Vertices eye = eye_.before(vertex.index);
        std::size_t met = 0;
        light_met(sample_, arrived.subpath, vertex, arrived.densities, [&](const StrategyLight& light) {
            PathLightEnd end = ends.at(met++);
            end.is_reached_directly = arrived.subpath.is_direct;
            tell(end, {}, eye, 0, light.sums.weight());
        });
    }
    void sample_light(const SubpathVertex& eye) const {
        const StrategyLight found = light_sampled(sample_, eye);
        if (is_black(found.light)) return;
        const auto draw = [&](SubpathDimension which) { return sample_.pair(SubpathEnd::AtEye, eye.index, which); };
        const ChosenLight chosen =
            sample_.world().lights().sample(eye.position,
                                            {draw(SubpathDimension::LightChoice), draw(SubpathDimension::LightTriangle),
                                             draw(SubpathDimension::LightDirection)},
                                            sample_.eye.ray.time);
        const LightSample& light = chosen.sample;
        tell({.light = chosen.light,
              .triangle = light.triangle,
              .position = eye.position + light.wi * (std::isinf(light.distance) ? 0.0f : light.distance),
              .direction = -light.wi,
              .cos_light = light.cos_light},
             {}, eye_.up_to(eye), 1, found.sums.weight());
    }
    void connect(const SubpathVertex& eye, const SubpathVertex& light) const {
        const StrategyLight found = light_connected(sample_, eye, light);
        if (is_black(found.light)) return;
        tell(light_end_, light_.up_to(light), eye_.up_to(eye), static_cast<std::size_t>(light.index) + 1,
             found.sums.weight());
    }
    void connect_to_lens(const SubpathVertex& light) const {
        const std::optional<StrategyOnFilm> found = light_at_lens(sample_, light);
        if (!found || is_black(found->light)) return;
        const Vec2f pixel(found->film.x * static_cast<float>(job_.full_width),
                          found->film.y * static_cast<float>(job_.full_height));
        if (!is_in_view(sample_.world(), job_, pixel)) return;
        const Vec2f lens = sample_.pair(SubpathEnd::AtLight, light.index, SubpathDimension::LightChoice);
        const CameraConnection camera = sample_.world().camera().connect(light.position, lens, sample_.eye.ray.time);
        hear_({with_time(light_end_), light_.up_to(light), static_cast<std::size_t>(light.index) + 1, camera},
              found->sums.weight());
    }

    const SubpathSample& sample_;
    const TileJob& job_;
    const HearPath& hear_;
    WalkedSubpath eye_;
    WalkedSubpath light_;
    PathLightEnd light_end_;
};

}  // namespace

void for_each_path(const World& world, const TileJob& job, const IntegratorSettings& settings, const HearPath& hear) {
    std::vector<CameraSample> samples(camera_sample_count(job));
    std::vector<Ray> rays(samples.size());
    generate_camera_rays(world, job, 0, samples, rays);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const EyeSample eye{
            .ray = rays[i], .cone = {}, .numbers = {job.sequence, samples[i].key}, .lens = samples[i].lens};
        const SubpathSample sample{mis_context(world, job, settings), settings.lengths, eye};
        PathsOfSample(sample, job, hear).make(spared_rays(settings.lengths.roulette_depth));
    }
}

}  // namespace etendue::test
