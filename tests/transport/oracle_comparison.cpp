#include "transport/oracle_comparison.h"

#include "integrator/camera_wave.h"
#include "transport/path.h"
#include "transport/scattered_cone.h"
#include "transport/whitted.h"

#include <algorithm>
#include <cmath>
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

Rgb scalar_radiance(const World& world, const OracleRun& run, const EyeSample& sample) {
    PathOptions options{.lengths = run.lengths, .light_samples = run.light_samples};
    if (run.integrator == "path") return path_radiance(world, sample, options);
    if (run.integrator == "whitted") return whitted_radiance(world, sample, run.lengths);
    if (run.integrator == "naive") options.sample_lights = false;
    if (run.integrator == "direct") options.lengths.max_depth = std::min(options.lengths.max_depth, 2);
    return path_radiance(world, sample, options);
}

bool differ(const Rgb& a, const Rgb& b) {
    const auto apart = [](float x, float y) {
        return !(std::abs(x - y) <= kRounding * std::max(std::abs(x), std::abs(y)) + kBlack);
    };
    return apart(a.r, b.r) || apart(a.g, b.g) || apart(a.b, b.b);
}

/// Returns what one sample of each pixel finds, that of this index; row by row.
std::vector<Rgb> wide_samples(const World& world, const Integrator& integrator, const TileJob& job) {
    const auto scratch = integrator.make_scratch();
    TileBuffer tile;
    tile.reset(job.rect);
    RenderCounters counters;
    integrator.render_tile(world, job, *scratch, tile, counters);
    if (counters.dropped > 0) throw std::runtime_error("samples were dropped");
    std::vector<Rgb> found;
    for (std::size_t i = 0; i < job.rect.area(); ++i) {
        const PixelSum& sum = tile.pixel(i);
        found.emplace_back(static_cast<float>(sum.r), static_cast<float>(sum.g), static_cast<float>(sum.b));
    }
    return found;
}

std::vector<Rgb> scalar_samples(const World& world, const OracleRun& run, const TileJob& job) {
    std::vector<CameraSample> samples(job.rect.area());
    std::vector<Ray> rays(samples.size());
    generate_camera_rays(world, job, 0, samples, rays);
    std::vector<Rgb> found(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i)
        found[samples[i].pixel] = scalar_radiance(world, run,
                                                  {.ray = rays[i],
                                                   .cone = camera_cone(world, job.full_width, job.full_height, rays[i]),
                                                   .numbers = {job.sequence, samples[i].key}});
    return found;
}

}  // namespace

OracleComparison compare_with_oracle(const World& world, const OracleRun& run) {
    // A box reaches no other pixel: lamps in view, which a wider filter estimates from the samples of several pixels,
    // are met by their own paths. Its weight is 1, so that the sum of a pixel with one sample is what that has found.
    const PixelFilter filter(FilterShape::Box);
    const auto integrator =
        make_integrator(run.integrator, {.lengths = run.lengths, .light_samples = run.light_samples});
    const PixelRect all{0, 0, run.width, run.height};
    OracleComparison result;
    for (std::uint32_t index = 0; index < run.samples; ++index) {
        const TileJob job{all, all, run.width, run.height, index, 1, 7, run.sequence, &filter};
        const std::vector<Rgb> wide = wide_samples(world, *integrator, job);
        const std::vector<Rgb> scalar = scalar_samples(world, run, job);
        for (std::size_t i = 0; i < wide.size(); ++i) {
            ++result.samples;
            result.lit += max_component(wide[i]) > kBlack ? 1 : 0;
            if (!differ(wide[i], scalar[i])) continue;
            if (result.differing++ > 0) continue;
            const auto width = static_cast<std::size_t>(run.width);
            result.first =
                fmt::format("sample {} of pixel ({}, {}): ({}, {}, {}), not ({}, {}, {})", index, i % width, i / width,
                            wide[i].r, wide[i].g, wide[i].b, scalar[i].r, scalar[i].g, scalar[i].b);
        }
    }
    return result;
}

std::ostream& operator<<(std::ostream& out, const OracleRun& run) {
    out << run.integrator;
    if (run.light_samples > 1) out << ", " << run.light_samples << " light samples";
    return out << (run.sequence == SampleSequence::Random ? ", random" : "");
}

std::ostream& operator<<(std::ostream& out, const OracleComparison& comparison) {
    return out << comparison.differing << " of " << comparison.samples << " samples differ, " << comparison.lit
               << " find light; the first is " << comparison.first;
}

}  // namespace etendue::test
