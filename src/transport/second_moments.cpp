#include "transport/second_moments.h"

#include "transport/roulette.h"
#include "transport/strategies.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace etendue {

namespace {

/// Bounds the share of an integrator in the strategies from below: it finds paths of less in no render.
constexpr double kLeastShare = 1e-9;

double mean(const Rgb& light) {
    return (static_cast<double>(light.r) + static_cast<double>(light.g) + static_cast<double>(light.b)) / 3.0;
}

/// Returns `found` by `vcm`, which the others find `of_path` and `of_bdpt` times as densely as its own strategy does.
ComparedLight compared(const StrategyLight& found, double of_path, double of_bdpt) {
    const double light = mean(found.weighted());
    if (!std::isfinite(light)) return {};
    ComparedLight result{.light = light};
    const PerIntegrator<double> ratios{of_path, of_bdpt, 1.0 / found.sums.weight()};
    for (std::size_t i = 0; i < kComparedCount; ++i) {
        const double share = std::min(found.sums.weight() * ratios[i], 1.0);
        if (share > kLeastShare)
            result.moments[i] = light * light / share;
        else
            result.missed[i] = light;
    }
    return result;
}

/// Bounds the vertices of a subpath that are looked at: walks in media may have hundreds, all of which are connected.
constexpr std::size_t kMostVertices = 8;

/// Returns where a photon of ComparedSample::Photons stands among all: in place of words, which these have none of.
auto& place_of(auto& photon) {
    return photon.first_word;
}

double in_media(const std::vector<SubpathVertex>& vertices) {
    return static_cast<double>(std::ranges::count(vertices, Vertex::Kind::Medium, &SubpathVertex::kind));
}

template <typename T>
void cut_short(std::vector<T>& vertices) {
    if (vertices.size() > kMostVertices) vertices.erase(vertices.begin() + kMostVertices, vertices.end());
}

/// Returns by how much all strategies of `bdpt` together make a path more densely than one that compares itself with
/// the others by `sums`.
double all_of(const StrategySums& sums) {
    return 1.0 + sums.fewer_from_light + sums.fewer_from_eye;
}

}  // namespace

void ComparedSample::LightOfPath::add(const StrategyLight& found, double of_path) {
    constexpr double kLeastShareOfPath = 0.1;
    if (found.sums.weight() * of_path < kLeastShareOfPath) return;
    const double light = mean(found.light) / of_path;
    sum += light;
    squares += light * light;
}

void ComparedLight::add(const ComparedLight& other) {
    light += other.light;
    for (std::size_t i = 0; i < kComparedCount; ++i) {
        moments[i] += other.moments[i];
        missed[i] += other.missed[i];
    }
}

void SampleWork::add(const SampleWork& other) {
    eye_rays += other.eye_rays;
    light_samples += other.light_samples;
    light_rays += other.light_rays;
    connections += other.connections;
    merges += other.merges;
}

ComparedSample::ComparedSample(const World& world, const EyeSample& eye, const IntegratorSettings& settings,
                               const BidirectionalSetup& setup)
    : eye_(eye),
      lengths_(settings.lengths),
      lamp_images_(settings.lamp_images),
      with_all_{
          {world, Raised{Heuristic::Balance}, setup.samples_per_light_path, setup.merging, settings.aimed_emission},
          lengths_,
          eye_,
          setup.shared},
      without_merges_(with_all_),
      of_path_(with_all_) {
    without_merges_.mis.merging = of_path_.mis.merging = {};
    of_path_.counts_path_tracing_alone = true;
    of_path_tracing_ = follow_light(of_path_);
    unmerged_ = follow_light(without_merges_);
    all_ = setup.merging.merges() ? follow_light(with_all_) : unmerged_;
}

std::vector<SubpathVertex> ComparedSample::follow_light(const SubpathSample& sample) {
    std::vector<SubpathVertex> vertices;
    light_rays_ = 0.0;
    const std::optional<Subpath> from_light = begin_subpath_at_light(sample);
    if (from_light && leads_to_camera(sample, *from_light))
        vertices = follow_subpath(sample, *from_light, spared_rays(lengths_.roulette_depth).of_light,
                                  [&](const Subpath&, const Vertex&, const SubpathDensities&) { light_rays_ += 1.0; });
    // Rays that end in a medium arrive at nothing.
    light_rays_ += in_media(vertices);
    light_vertices_ = static_cast<double>(vertices.size());
    cut_short(vertices);
    return vertices;
}

ComparedSample::EyeSubpath ComparedSample::follow_eye(const SubpathSample& sample) const {
    EyeSubpath eye;
    eye.vertices = follow_subpath(sample, begin_subpath_at_eye(sample), spared_rays(lengths_.roulette_depth).of_eye,
                                  [&](const Subpath& subpath, const Vertex& vertex, const SubpathDensities& arrived) {
                                      eye.met.push_back({subpath, vertex, arrived});
                                  });
    eye.rays = static_cast<double>(eye.met.size()) + in_media(eye.vertices);
    eye.connectable = static_cast<double>(eye.vertices.size());
    cut_short(eye.met);
    cut_short(eye.vertices);
    return eye;
}

void ComparedSample::Photons::append(const Photons& others) {
    const auto before = static_cast<std::uint32_t>(all.size());
    for (Photon photon : others.all) {
        place_of(photon) += before;
        all.push_back(photon);
    }
    unmerged.insert(unmerged.end(), others.unmerged.begin(), others.unmerged.end());
    of_path_tracing.insert(of_path_tracing.end(), others.of_path_tracing.begin(), others.of_path_tracing.end());
}

void ComparedSample::append_photons(Photons& photons) const {
    for (std::size_t i = 0; i < all_.size(); ++i) {
        const SubpathVertex& vertex = all_[i];
        if (!vertex.merging.merges) continue;
        photons.all.push_back(make_photon(vertex, vertex.surface.geometric_normal));
        place_of(photons.all.back()) = static_cast<std::uint32_t>(photons.all.size() - 1);
        photons.unmerged.push_back(unmerged_[i].densities);
        photons.of_path_tracing.push_back(of_path_tracing_[i].densities);
    }
}

void ComparedSample::compare_met(const EyeSubpaths& eye, ComparedLight& sum, LightOfPath& by_path) const {
    for (std::size_t i = 0; i < eye.all.met.size(); ++i) {
        const Met& met = eye.all.met[i];
        const Material* const material = met.vertex.surface.material;
        const bool is_lamp = material != nullptr && material->emits;
        if (met.subpath.index == kDirectlySeen || (lamp_images_ && is_lamp && met.subpath.only_deltas)) continue;
        std::vector<StrategyLight> found;
        light_met(with_all_, met.subpath, met.vertex, met.arrived,
                  [&](const StrategyLight& light) { found.push_back(light); });
        if (found.empty()) continue;
        std::vector<double> of_bdpt;
        std::vector<double> of_path;
        const Met& other = eye.unmerged.met[i];
        light_met(without_merges_, other.subpath, other.vertex, other.arrived,
                  [&](const StrategyLight& light) { of_bdpt.push_back(all_of(light.sums)); });
        // Path tracing has no strategy with s > 1: only `a`, which stands for s = 1, counts.
        Subpath sampled = other.subpath;
        sampled.departing.d = 0.0;
        light_met(without_merges_, sampled, other.vertex, {.a = other.arrived.a},
                  [&](const StrategyLight& light) { of_path.push_back(all_of(light.sums)); });
        for (std::size_t k = 0; k < found.size(); ++k) {
            sum.add(compared(found[k], of_path[k], of_bdpt[k]));
            by_path.add(found[k], of_path[k]);
        }
    }
}

void ComparedSample::compare_sampled(const EyeSubpaths& eye, ComparedLight& sum, LightOfPath& by_path) const {
    for (std::size_t i = 0; i < eye.all.vertices.size(); ++i) {
        const StrategyLight found = light_sampled(with_all_, eye.all.vertices[i]);
        if (is_black(found.weighted())) continue;
        const StrategySums sums = light_sampled(without_merges_, eye.unmerged.vertices[i]).sums;
        sum.add(compared(found, 1.0 + sums.fewer_from_light, all_of(sums)));
        by_path.add(found, 1.0 + sums.fewer_from_light);
    }
}

void ComparedSample::compare_connected(const EyeSubpaths& eye, ComparedLight& sum) const {
    for (std::size_t i = 0; i < eye.all.vertices.size(); ++i)
        for (std::size_t j = 0; j < all_.size(); ++j) {
            const StrategyLight found = light_connected(with_all_, eye.all.vertices[i], all_[j]);
            if (is_black(found.weighted())) continue;
            sum.add(compared(
                found, light_connected(of_path_, eye.unmerged.vertices[i], of_path_tracing_[j]).sums.fewer_from_light,
                all_of(light_connected(without_merges_, eye.unmerged.vertices[i], unmerged_[j]).sums)));
        }
}

void ComparedSample::compare_merged(const EyeSubpaths& eye, const PhotonMap& map, const Photons& photons,
                                    SampleWork& work, ComparedLight& sum) const {
    for (std::size_t i = 0; i < eye.all.vertices.size(); ++i) {
        const SubpathVertex& at = eye.all.vertices[i];
        if (!at.merging.merges) continue;
        SubpathVertex no_others = eye.unmerged.vertices[i];
        no_others.densities = {};
        const double within = with_all_.mis.merging.expected_within(with_all_.mis.merging.radius(at.position));
        light_merged(with_all_, at, map, [&](const Photon& photon, const StrategyLight& light) {
            work.merges += 1.0;
            const auto scattered = at.evaluate_both_ways(photon.direction, TransportMode::Radiance);
            const auto others = [&](const SubpathVertex& vertex, const SubpathDensities& of_photon) {
                Photon with = photon;
                with.a = static_cast<float>(of_photon.a);
                with.b = static_cast<float>(of_photon.b);
                return others_of_merge(with_all_.mis, vertex, with, scattered, within);
            };
            sum.add(compared(light, others(no_others, photons.of_path_tracing[place_of(photon)]),
                             others(eye.unmerged.vertices[i], photons.unmerged[place_of(photon)])));
        });
    }
}

ComparedLight ComparedSample::compare(const PhotonMap& map, const Photons& photons, SampleWork& work,
                                      const HearLight& hear) const {
    EyeSubpaths eye;
    eye.unmerged = follow_eye(without_merges_);
    eye.all = with_all_.mis.merging.merges() ? follow_eye(with_all_) : eye.unmerged;
    work.add({.eye_rays = eye.all.rays,
              .light_samples = eye.all.connectable,
              .light_rays = light_rays_,
              .connections = (eye.all.connectable + 1.0) * light_vertices_});

    ComparedLight sum;
    LightOfPath by_path;
    compare_met(eye, sum, by_path);
    compare_sampled(eye, sum, by_path);
    sum.moments.front() += by_path.sum * by_path.sum - by_path.squares;
    compare_connected(eye, sum);
    // The light of all strategies varies together, too; so do the photons of a vertex, of which path tracing and
    // bidirectional path tracing would find one at a time.
    const double squares = sum.moments.back();
    sum.moments[1] += sum.light * sum.light - squares;
    compare_merged(eye, map, photons, work, sum);
    sum.moments.back() = sum.light * sum.light;

    for (std::size_t j = 0; j < all_.size(); ++j) {
        const auto found = light_at_lens(with_all_, all_[j]);
        if (!found || is_black(found->weighted())) continue;
        hear(compared(*found, light_at_lens(of_path_, of_path_tracing_[j])->sums.fewer_from_light,
                      all_of(light_at_lens(without_merges_, unmerged_[j])->sums)),
             found->film);
    }
    return sum;
}

}  // namespace etendue
