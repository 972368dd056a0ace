#include "transport/oracle_comparison.h"

#include "film/splat_film.h"
#include "transport/bidirectional.h"
#include "transport/light.h"
#include "transport/path.h"
#include "transport/roulette.h"
#include "transport/scattered_cone.h"
#include "transport/subpath.h"
#include "wave/camera_wave.h"
#include "wave/photons.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace etendue::test {

namespace {

/// Relative difference that rounding makes. Most samples differ by less than 1e-6; what small roughness and short
/// distances amplify comes up to here.
constexpr float kRounding = 1e-4f;
/// Radiance, W/(m² sr), below which samples count as black: scenes have some of 0.01 to 100.
constexpr float kBlack = 1e-7f;

/// Holds what the samples of all pixels find that have one index.
struct FoundLight {
    std::vector<Rgb> radiance;  ///< by pixel, row by row
    std::vector<Splat> splats;
    std::vector<Photon> photons;
};

IntegratorSettings settings_of(const OracleRun& run) {
    return {.lengths = run.lengths, .light_samples = run.light_samples, .heuristic = run.heuristic};
}

/// Says with what a sample with this key merges.
BidirectionalSetup setup_of(const TileJob& job, SampleKey key) {
    BidirectionalSetup setup{.merging = job.merging, .shared = shared_key(job, key)};
    if (job.photons != nullptr) setup.photons = &job.photons->map();
    return setup;
}

/// Returns what `sample` finds, and adds to `on_film` what its light path brings there.
Rgb scalar_light(const World& world, const OracleRun& run, const TileJob& job, const EyeSample& sample,
                 std::vector<FilmLight>& on_film) {
    const auto add = [&](const std::vector<FilmLight>& found) {
        on_film.insert(on_film.end(), found.begin(), found.end());
    };
    IntegratorSettings settings = settings_of(run);
    if (run.integrator == "light") {
        add(light_on_film(world, sample, settings));
        return {};
    }
    if (run.integrator == "bdpt" || run.integrator == "vcm") {
        const BidirectionalLight found =
            bidirectional_light(world, sample, settings_of(run), setup_of(job, sample.numbers.key));
        add(found.on_film);
        return found.radiance;
    }
    if (run.integrator == "naive" || run.integrator == "hemisphere") settings.light_samples = 0;
    settings.even_directions = run.integrator == "hemisphere";
    if (run.integrator == "direct") settings.lengths.max_depth = std::min(settings.lengths.max_depth, 2);
    return path_radiance(world, sample, settings);
}

/// Returns the photons that the light subpath of `eye` leaves where subpaths merge.
std::vector<Photon> photons_of_sample(const World& world, const OracleRun& run, const TileJob& job,
                                      const EyeSample& eye) {
    const IntegratorSettings settings = settings_of(run);
    const SubpathSample sample{
        {.world = world, .raised = Raised{settings.heuristic}, .merging = job.merging, .aims = settings.aimed_emission},
        settings.lengths,
        eye,
        shared_key(job, eye.numbers.key)};
    const std::optional<Subpath> from_light = begin_subpath_at_light(sample);
    std::vector<Photon> photons;
    if (!from_light || !leads_to_camera(sample, *from_light)) return photons;
    for (const SubpathVertex& vertex :
         follow_subpath(sample, *from_light, spared_rays(settings.lengths.roulette_depth).of_light))
        if (vertex.merging.merges) photons.push_back(make_photon(vertex, vertex.surface.geometric_normal));
    return photons;
}

bool differ(const Rgb& a, const Rgb& b) {
    const auto apart = [](float x, float y) {
        return !(std::abs(x - y) <= kRounding * std::max(std::abs(x), std::abs(y)) + kBlack);
    };
    return apart(a.r, b.r) || apart(a.g, b.g) || apart(a.b, b.b);
}

FoundLight wide_samples(const World& world, const Integrator& integrator, const TileJob& job) {
    const auto scratch = integrator.make_scratch();
    TileBuffer tile;
    tile.reset(job.rect);
    RenderCounters counters;
    integrator.render_tile(world, job, *scratch, tile, counters);
    if (counters.dropped > 0) throw std::runtime_error("samples were dropped");
    FoundLight found;
    for (std::size_t i = 0; i < job.rect.area(); ++i) {
        const PixelSum& sum = tile.pixel(i);
        found.radiance.emplace_back(static_cast<float>(sum.r), static_cast<float>(sum.g), static_cast<float>(sum.b));
    }
    found.splats = tile.splats();
    return found;
}

FoundLight scalar_samples(const World& world, const OracleRun& run, const TileJob& job) {
    std::vector<CameraSample> samples(job.rect.area());
    std::vector<Ray> rays(samples.size());
    generate_camera_rays(world, job, 0, samples, rays);
    FoundLight found{std::vector<Rgb>(samples.size()), {}, {}};
    std::vector<FilmLight> on_film;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const EyeSample sample{.ray = rays[i],
                               .cone = camera_cone(world, job.full_width, job.full_height, rays[i]),
                               .numbers = {job.sequence, samples[i].key},
                               .lens = samples[i].lens};
        found.radiance[samples[i].pixel] = scalar_light(world, run, job, sample, on_film);
        if (!job.merging.merges()) continue;
        const auto photons = photons_of_sample(world, run, job, sample);
        found.photons.insert(found.photons.end(), photons.begin(), photons.end());
    }
    for (const FilmLight& light : on_film) {
        const Vec2f position(light.film.x * static_cast<float>(job.full_width),
                             light.film.y * static_cast<float>(job.full_height));
        if (reaches(job.window, *job.filter, position))
            found.splats.push_back({.position = position, .value = light.value});
    }
    return found;
}

/// Returns how many of `splats` have no partner in `others`, which are in any order.
std::size_t splats_alone(const std::vector<Splat>& splats, const std::vector<Splat>& others) {
    constexpr float kNear = 1e-3f;  // pixels
    std::vector<Splat> left = others;
    const auto by_row = [](const Splat& a, const Splat& b) { return a.position.y < b.position.y; };
    std::ranges::sort(left, by_row);
    std::vector<bool> is_taken(left.size(), false);
    std::size_t alone = 0;
    for (const Splat& splat : splats) {
        const Splat above{.position = {0.0f, splat.position.y - kNear}, .value = {}};
        const auto first = std::lower_bound(left.begin(), left.end(), above, by_row);
        bool is_found = false;
        for (auto other = first; !is_found && other != left.end() && other->position.y <= splat.position.y + kNear;
             ++other) {
            const auto place = static_cast<std::size_t>(other - left.begin());
            is_found = !is_taken[place] && std::abs(other->position.x - splat.position.x) <= kNear &&
                       !differ(other->value, splat.value);
            if (is_found) is_taken[place] = true;
        }
        alone += is_found ? 0 : 1;
    }
    return alone;
}

bool differ(const Photon& a, const Photon& b) {
    constexpr float kNear = 1e-3f;
    const auto apart = [](float x, float y) {
        return !(std::abs(x - y) <= kNear * std::max(std::abs(x), std::abs(y)));
    };
    return length(a.position - b.position) > kNear || length(a.direction - b.direction) > kNear ||
           differ(a.throughput, b.throughput) || apart(a.a, b.a) || apart(a.b, b.b) || a.edges != b.edges ||
           a.is_dispersed != b.is_dispersed ||
           std::abs(a.normal.cosine(a.direction) - b.normal.cosine(a.direction)) > 0.02f;
}

/// Returns how many of `photons` have no partner in `others`, which are in any order.
std::size_t photons_alone(const std::vector<Photon>& photons, std::vector<Photon> others) {
    constexpr float kNear = 1e-3f;  // metres
    const auto by_x = [](const Photon& a, const Photon& b) { return a.position.x < b.position.x; };
    std::ranges::sort(others, by_x);
    std::size_t alone = 0;
    for (const Photon& photon : photons) {
        const Photon before{.position{photon.position.x - kNear, 0.0f, 0.0f}};
        auto other = std::lower_bound(others.begin(), others.end(), before, by_x);
        while (other != others.end() && other->position.x <= photon.position.x + kNear && differ(*other, photon))
            ++other;
        alone += other == others.end() || other->position.x > photon.position.x + kNear ? 1 : 0;
    }
    return alone;
}

/// Returns the photons of all samples of `job`.
PhotonList wide_photons(const World& world, const Integrator& integrator, const TileJob& job) {
    PhotonList photons;
    RenderCounters counters;
    integrator.trace_photons(world, job, *integrator.make_scratch(), photons, counters);
    return photons;
}

}  // namespace

OracleComparison compare_with_oracle(const World& world, const OracleRun& run) {
    // A box reaches no other pixel: lamps in view, which a wider filter estimates from the samples of several pixels,
    // are met by their own paths. Its weight is 1, so that the sum of a pixel with one sample is what that has found.
    const PixelFilter filter(FilterShape::Box);
    const auto integrator = make_integrator(run.integrator, {.lengths = run.lengths,
                                                             .light_samples = run.light_samples,
                                                             .heuristic = run.heuristic,
                                                             .merging = {.at = run.merge}});
    const PixelRect all{0, 0, run.width, run.height};
    OracleComparison result;
    for (std::uint32_t index = 0; index < run.samples; ++index) {
        TileJob job{all, all, run.width, run.height, index, 1, 7, run.sequence, &filter};
        job.merging = integrator->merging(world, job);
        std::optional<SharedPhotons> shared;
        std::vector<Photon> photons;
        if (job.merging.merges()) {
            PhotonList list = wide_photons(world, *integrator, job);
            photons = list.photons;
            job.photons = &shared.emplace(std::span(&list, 1), job.merging.radius, ThreadPool(1));
        }
        const FoundLight wide = wide_samples(world, *integrator, job);
        const FoundLight scalar = scalar_samples(world, run, job);
        result.photons += photons.size();
        result.photons_alone +=
            std::max(photons_alone(photons, scalar.photons), photons_alone(scalar.photons, photons));
        result.splats += wide.splats.size();
        result.splats_alone +=
            std::max(splats_alone(wide.splats, scalar.splats), splats_alone(scalar.splats, wide.splats));
        for (std::size_t i = 0; i < wide.radiance.size(); ++i) {
            const Rgb& a = wide.radiance[i];
            const Rgb& b = scalar.radiance[i];
            ++result.samples;
            result.lit += max_component(a) > kBlack ? 1 : 0;
            if (!differ(a, b)) continue;
            if (result.differing++ > 0) continue;
            const auto width = static_cast<std::size_t>(run.width);
            result.first = fmt::format("sample {} of pixel ({}, {}): ({}, {}, {}), not ({}, {}, {})", index, i % width,
                                       i / width, a.r, a.g, a.b, b.r, b.g, b.b);
        }
    }
    return result;
}

std::ostream& operator<<(std::ostream& out, const OracleRun& run) {
    out << run.integrator;
    if (run.heuristic == Heuristic::Power) out << ", power heuristic";
    if (run.merge == MergeAt::Everywhere) out << ", merged everywhere";
    if (run.light_samples > 1) out << ", " << run.light_samples << " light samples";
    return out << (run.sequence == SampleSequence::Random ? ", random" : "");
}

std::ostream& operator<<(std::ostream& out, const OracleComparison& comparison) {
    return out << comparison.differing << " of " << comparison.samples << " samples differ, " << comparison.lit
               << " find light; " << comparison.splats_alone << " of " << comparison.splats << " splats and "
               << comparison.photons_alone << " of " << comparison.photons
               << " photons have no partner; the first sample is " << comparison.first;
}

}  // namespace etendue::test
