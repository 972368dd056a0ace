#include "compare/comparison_measures.h"

#include "compare/comparison_notes.h"
#include "compare/image_pair.h"
#include "metrics/convergence.h"
#include "metrics/error_metrics.h"
#include "metrics/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr const char* kRelMse = "relmse";
constexpr const char* kTrimmed = "relmse-trimmed";
constexpr const char* kFlip = "flip";
constexpr std::size_t kFoundRegions = 3;

std::string key_of(ErrorMetric metric) {
    return std::string(name_of(metric));
}

std::string title_of(ErrorMetric metric) {
    switch (metric) {
        case ErrorMetric::RelMse:
            return "relMSE";
        case ErrorMetric::RelMseTrimmed:
            return "relMSE, trimmed";
        case ErrorMetric::Mse:
            return "MSE";
        case ErrorMetric::Mae:
            return "MAE";
        case ErrorMetric::Smape:
            break;
    }
    return "SMAPE";
}

/// `region`, of the full image, as pixels of an image of `window`.
PixelRect within(const PixelRect& region, const PixelRect& window) {
    return moved_to(region, region.x0 - window.x0, region.y0 - window.y0);
}

void add(ErrorsByMetric& errors, const ErrorMetrics& measured) {
    for (const ErrorMetric metric : kErrorMetrics) errors[key_of(metric)].values.push_back(measured.value(metric));
}

std::array<double, 3> mean_color(const ImageF& image, const PixelRect& region) {
    std::array<double, 3> sum{};
    for_each_pixel(image, {.region = region}, [&](std::size_t pixel) {
        for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(image.pixels[3 * pixel + c]);
    });
    for (double& value : sum) value /= static_cast<double>(region.area());
    return sum;
}

double luminance(const std::array<double, 3>& rgb, const Rgb& weights) {
    return rgb[0] * static_cast<double>(weights.r) + rgb[1] * static_cast<double>(weights.g) +
           rgb[2] * static_cast<double>(weights.b);
}

PixelRect whole(const ImageF& image) {
    return {0, 0, image.width, image.height};
}

/// Times, rays and what else needs no reference.
VariantReport describe(const Variant& variant, const VariantRenders& renders, const FinishedImages& images) {
    VariantReport report{.name = variant.name, .options = variant.options, .cannot_find = variant.cannot_find};
    const auto count = static_cast<double>(renders.seeds.size());
    double rays = 0.0;
    double samples = 0.0;
    for (const SeedRender& seed : renders.seeds) {
        report.seeds.push_back(seed.seed);
        report.spp = seed.checkpoints.back().spp;
        report.seconds.values.push_back(seed.checkpoints.back().seconds);
        report.cpu_seconds.values.push_back(seed.checkpoints.back().cpu_seconds);
        rays += static_cast<double>(seed.counters.rays.total());
        samples += static_cast<double>(seed.counters.samples);
        report.dropped_samples += seed.counters.dropped;
    }
    report.rays = static_cast<std::uint64_t>(std::llround(rays / count));
    report.samples_per_cpu_second = samples / count / report.cpu_seconds.mean();
    for (const ImageF& image : images.of_seeds) {
        const std::array<double, 3> mean = mean_color(image, whole(image));
        for (std::size_t c = 0; c < 3; ++c) report.mean[c] += mean[c] / count;
    }
    report.variance = images.relative_variance;
    return report;
}

/// The errors of all kept images; seeds have the same ones.
void measure_convergence(VariantReport& report, const VariantRenders& renders, const Reference& reference,
                         const ImageStore& store) {
    for (std::size_t i = 0; i < renders.seeds.front().checkpoints.size(); ++i) {
        ConvergenceStep step{.spp = renders.seeds.front().checkpoints[i].spp};
        for (std::size_t seed = 0; seed < renders.seeds.size(); ++seed) {
            const Snapshot& checkpoint = renders.seeds[seed].checkpoints[i];
            step.seconds.values.push_back(checkpoint.seconds);
            step.cpu_seconds.values.push_back(checkpoint.cpu_seconds);
            add(step.errors, compute_error_metrics(store.get(checkpoint.image), reference.of_round(seed), {},
                                                   reference.variance_of_round(seed)));
        }
        if (reference.report().noise_rel_mse > 0.0) drop_drowned(step.errors);
        report.convergence.push_back(std::move(step));
    }
    report.errors = report.convergence.back().errors;
}

enum class Work { Samples, Seconds, CpuSeconds };

std::vector<ErrorAfter> errors_after(const VariantReport& report, const std::string& metric, Work work) {
    std::vector<ErrorAfter> points;
    for (const ConvergenceStep& step : report.convergence)
        points.push_back({work == Work::Samples   ? static_cast<double>(step.spp)
                          : work == Work::Seconds ? step.seconds.mean()
                                                  : step.cpu_seconds.mean(),
                          step.errors.at(metric).mean()});
    return points;
}

void fit_slopes(VariantReport& report) {
    for (const auto& [metric, values] : report.errors) {
        if (!report.convergence.front().errors.contains(metric)) continue;
        const auto slope = [&, &name = metric](Work work) {
            return log_log_slope(errors_after(report, name, work)).value_or(kUnknown);
        };
        report.slopes[metric] = {slope(Work::Samples), slope(Work::Seconds), slope(Work::CpuSeconds)};
    }
}

/// HDR-FLIP with the same exposures for all images of a comparison.
ImageF flip_map(const ImageF& image, const ImageF& reference, const ExposureRange& exposures,
                const std::string& working_space, const MeasureContext& context) {
    const HdrFlipOptions options{.start_exposure = exposures.start, .stop_exposure = exposures.stop};
    return hdr_flip(to_linear_rec709(image, false, working_space, context.colors),
                    to_linear_rec709(reference, false, working_space, context.colors), options, context.threads)
        .map;
}

/// HDR-FLIP of the finished images, of the first of which there are maps.
void measure_flip(ComparisonReport& report, std::span<const FinishedImages> images, const Reference& reference,
                  const ErrorMaps& maps, const MeasureContext& context) {
    for (std::size_t v = 0; v < images.size(); ++v) {
        std::vector<double>& values = report.variants[v].errors[kFlip].values;
        values.push_back(mean_of(maps.flip[v]));
        for (std::size_t seed = 1; seed < images[v].of_seeds.size(); ++seed)
            values.push_back(mean_of(flip_map(images[v].of_seeds[seed], reference.of_round(seed), maps.exposures,
                                              report.working_space, context)));
    }
}

std::optional<ReachedError> time_to_reach(const VariantReport& one, const VariantReport& other, Work time) {
    const auto reached = work_to_reach(errors_after(one, kRelMse, time), other.errors.at(kRelMse).mean());
    if (!reached) return std::nullopt;
    return ReachedError{reached->work, reached->extrapolated};
}

/// Returns the largest relMSE that the reference's noise can have: the relMSE of the mean of all seeds of one variant
/// against the reference, less that mean's own variance. The variant is the one of least variance among those that find
/// all light. Any other difference between the mean and the reference counts as noise, too.
double noise_bound(std::span<const Variant> variants, std::span<const FinishedImages> images,
                   const Reference& reference) {
    double least_variance = std::numeric_limits<double>::infinity();
    double noise = kUnknown;
    for (std::size_t v = 0; v < images.size(); ++v) {
        if (images[v].of_seeds.size() < 2 || !variants[v].cannot_find.empty()) continue;
        if (!(images[v].relative_variance < least_variance)) continue;
        least_variance = images[v].relative_variance;
        const ImageEstimate& mean = images[v].estimate;
        noise = compute_error_metrics(mean.mean, reference.of_round(0), {}, mean.variance.pixels).rel_mse;
    }
    return std::fmax(0.0, noise);
}

void fill_ratios(PairReport& pair, const ComparisonReport& report, const VariantReport& a, const VariantReport& b) {
    pair.ratios["rays_per_second"] = {.ratio = a.rays_per_second / b.rays_per_second};
    pair.ratios["efficiency"] = {.ratio = a.efficiency / b.efficiency};
    if (a.errors.empty()) return;
    // The reference's noise draws ratios towards 1 or, taken off, leaves little of the errors. All seeds share this
    // noise, so that their scatter does not show it.
    const double least = std::fmin(a.errors.at(kRelMse).mean(), b.errors.at(kRelMse).mean());
    const bool noise_decides = report.reference.is_noisy_for(least);
    for (const auto& [metric, values] : a.errors) {
        RatioInterval& ratio = pair.ratios[metric];
        ratio = ratio_interval(values.log_mean(), b.errors.at(metric).log_mean());
        const bool keeps_noise = report.reference.noise_rel_mse > 0.0 &&
                                 std::ranges::find(kErrorsWithoutNoise, metric) == kErrorsWithoutNoise.end();
        if (noise_decides || keeps_noise) ratio = {.ratio = ratio.ratio};
        for (const VariantReport* const variant : {&a, &b})
            if (const std::string why = heavy_tail(*variant, metric); !why.empty()) {
                ratio = {.ratio = ratio.ratio};
                pair.no_interval[metric] = why;
            }
    }
    for (const char* metric : {kRelMse, kTrimmed}) {
        const std::string with_time = std::string(metric) + "_time";
        const auto cost = [&](const VariantReport& variant) {
            return product(variant.errors.at(metric).log_mean(), report.time_of(variant).log_mean());
        };
        RatioInterval& ratio = pair.ratios[with_time];
        ratio = ratio_interval(cost(a), cost(b));
        if (std::isnan(pair.ratios[metric].low)) ratio = {.ratio = ratio.ratio};
        if (const auto why = pair.no_interval.find(metric); why != pair.no_interval.end())
            pair.no_interval[with_time] = why->second;
    }
    const Work time = report.by_wall ? Work::Seconds : Work::CpuSeconds;
    pair.a_reaches_b = time_to_reach(a, b, time);
    pair.b_reaches_a = time_to_reach(b, a, time);
}

/// Returns the standard errors of the mean colour of `pixels`, for an image like `like` whose values have `variance`.
std::array<double, 3> mean_error_color(std::span<const float> variance, const ImageF& like, const PixelRect& pixels) {
    std::array<double, 3> sums{};
    for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                sums[c] +=
                    static_cast<double>(variance[(static_cast<std::size_t>(y) * static_cast<std::size_t>(like.width) +
                                                  static_cast<std::size_t>(x)) *
                                                     static_cast<std::size_t>(like.channels) +
                                                 c]);
    for (double& sum : sums) sum = std::sqrt(sum) / static_cast<double>(pixels.area());
    return sums;
}

/// Returns the relMSE that the reference's own noise adds to `image` in `pixels`; unknown if this noise is.
double noise_within(const ImageF& image, const Reference& reference, const PixelRect& pixels) {
    if (reference.variance_of_round(0).empty()) return kUnknown;
    const auto rel_mse = [&](std::span<const float> variance) {
        return compute_error_metrics(image, reference.of_round(0), {.region = pixels}, variance).rel_mse;
    };
    return rel_mse({}) - rel_mse(reference.variance_of_round(0));
}

/// Means, and errors if there is a reference.
RegionReport measure_region(const NamedRegion& region, const ComparisonReport& report,
                            std::span<const FinishedImages> images, const std::optional<Reference>& reference,
                            const PixelRect& window, const Rgb& weights) {
    RegionReport result{.name = region.name, .found = region.found, .pixels = region.pixels};
    const PixelRect pixels = within(region.pixels, window);
    if (reference) result.reference_noise = noise_within(images.front().of_seeds.front(), *reference, pixels);
    for (std::size_t v = 0; v < images.size(); ++v) {
        RegionVariant variant{.name = report.variants[v].name};
        for (std::size_t seed = 0; seed < images[v].of_seeds.size(); ++seed) {
            const ImageF& image = images[v].of_seeds[seed];
            const std::array<double, 3> mean = mean_color(image, pixels);
            for (std::size_t c = 0; c < 3; ++c)
                variant.mean[c] += mean[c] / static_cast<double>(images[v].of_seeds.size());
            variant.luminance.values.push_back(luminance(mean, weights));
            if (!reference) continue;
            const ImageF& expected = reference->of_round(seed);
            const double wanted = luminance(mean_color(expected, pixels), weights);
            variant.mean_error.values.push_back(wanted > 0.0 ? variant.luminance.values.back() / wanted - 1.0
                                                             : kUnknown);
            add(variant.errors,
                compute_error_metrics(image, expected, {.region = pixels}, reference->variance_of_round(seed)));
        }
        if (reference && reference->report().noise_rel_mse > 0.0) drop_drowned(variant.errors);
        if (reference && !reference->variance_of_round(0).empty())
            variant.reference_error =
                luminance(mean_error_color(reference->variance_of_round(0), images[v].of_seeds.front(), pixels),
                          weights) /
                luminance(mean_color(reference->of_round(0), pixels), weights);
        if (reference)
            variant.rel_mse_time = variant.errors.at(kRelMse).mean() * report.time_of(report.variants[v]).mean();
        result.variants.push_back(std::move(variant));
    }
    return result;
}

}  // namespace

void trim(ImageF& map) {
    const auto dropped = static_cast<std::ptrdiff_t>(kTrimmedShare * static_cast<double>(map.pixels.size()));
    std::vector<std::size_t> order;
    order.reserve(map.pixels.size());
    for (std::size_t i = 0; i < map.pixels.size(); ++i)
        if (std::isfinite(map.pixels[i])) order.push_back(i);
    if (dropped >= std::ssize(order)) return;
    std::ranges::nth_element(order, order.begin() + dropped, std::ranges::greater{},
                             [&](std::size_t i) { return map.pixels[i]; });
    for (const std::size_t i : std::span(order).first(static_cast<std::size_t>(dropped))) map.pixels[i] = 0.0f;
}

std::vector<PixelRect> whole_blocks(const PixelRect& window) {
    const int side = std::max(8, std::min(window.width(), window.height()) / 6);
    std::vector<PixelRect> blocks;
    for (int y = window.y0; y + side <= window.y1; y += side)
        for (int x = window.x0; x + side <= window.x1; x += side) blocks.push_back({x, y, x + side, y + side});
    return blocks;
}

void drop_drowned(ErrorsByMetric& errors) {
    for (const char* metric : kErrorsWithoutNoise)
        if (SeedValues& measured = errors.at(metric); measured.mean() <= 0.0)
            std::ranges::fill(measured.values, kUnknown);
}

ImageF luminances(const ImageF& image, const Rgb& weights) {
    ImageF result(image.width, image.height, 1);
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < result.pixels.size(); ++i)
        result.pixels[i] = image.pixels[i * channels] * weights.r + image.pixels[i * channels + 1] * weights.g +
                           image.pixels[i * channels + 2] * weights.b;
    return result;
}

ErrorMaps map_errors(std::span<const FinishedImages> images, const Reference& reference,
                     const std::string& working_space, const MeasureContext& context) {
    const ImageF& expected = reference.of_round(0);
    ErrorMaps maps{.exposures = exposures_for(to_linear_rec709(expected, false, working_space, context.colors))};
    for (const FinishedImages& of_variant : images) {
        const ImageF& image = of_variant.of_seeds.front();
        maps.rel_mse.push_back(error_map(ErrorMetric::RelMse, image, expected));
        maps.flip.push_back(flip_map(image, expected, maps.exposures, working_space, context));
    }
    return maps;
}

std::vector<NamedRegion> find_regions(std::span<const ImageF> untrimmed, const PixelRect& window) {
    if (untrimmed.size() < 2) return {};
    std::vector<ImageF> maps(untrimmed.begin(), untrimmed.end());
    for (ImageF& map : maps) trim(map);
    struct Candidate {
        PixelRect pixels;
        double difference;
    };
    std::vector<Candidate> candidates;
    for (const PixelRect& block : whole_blocks(window)) {
        std::vector<double> errors;
        errors.reserve(maps.size());
        for (const ImageF& map : maps) errors.push_back(mean_of(map, {.region = within(block, window)}));
        // They could not be sorted.
        if (!std::ranges::all_of(errors, [](double error) { return std::isfinite(error); })) continue;
        const auto [least, most] = std::ranges::minmax(errors);
        candidates.push_back({block, most - least});
    }
    std::ranges::stable_sort(candidates, std::ranges::greater{}, &Candidate::difference);
    std::vector<NamedRegion> regions;
    for (std::size_t i = 0; i < std::min(kFoundRegions, candidates.size()); ++i)
        regions.push_back({fmt::format("difference {}", i + 1), candidates[i].pixels, true});
    return regions;
}

void measure(ComparisonReport& report, std::span<const Variant> variants, std::span<const VariantRenders> renders,
             std::span<const FinishedImages> images, const std::optional<Reference>& reference, const ErrorMaps& maps,
             std::span<const NamedRegion> regions, const MeasureContext& context) {
    for (std::size_t v = 0; v < variants.size(); ++v) {
        VariantReport& variant = report.variants.emplace_back(describe(variants[v], renders[v], images[v]));
        variant.rays_per_second = static_cast<double>(variant.rays) / report.time_of(variant).mean();
        // Without any variance there is nothing to tell it by.
        if (variant.variance > 0.0) variant.efficiency = 1.0 / (variant.variance * report.time_of(variant).mean());
        if (!reference) continue;
        measure_convergence(variant, renders[v], *reference, context.store);
        fit_slopes(variant);
    }
    if (const std::string note = drowned_errors(report); !note.empty()) report.notes.push_back(note);
    if (reference) {
        for (const ErrorMetric metric : kErrorMetrics)
            report.metrics.push_back({key_of(metric), title_of(metric), formula_of(metric)});
        measure_flip(report, images, *reference, maps, context);
        if (std::isnan(report.reference.noise_rel_mse))
            report.reference.noise_bound = noise_bound(variants, images, *reference);
        report.metrics.push_back({kFlip, "HDR-FLIP", describe_hdr_flip(kFlipPixelsPerDegree, maps.exposures)});
    }
    const Rgb weights = context.colors.luminance_weights(report.working_space);
    for (const NamedRegion& region : regions)
        report.regions.push_back(
            measure_region(region, report, images, reference, variants.front().sampling.window, weights));
    for (PairReport& pair : report.pairs) {
        const auto named = [&](const std::string& name) -> const VariantReport& {
            return *std::ranges::find(report.variants, name, &VariantReport::name);
        };
        fill_ratios(pair, report, named(pair.a), named(pair.b));
    }
}

}  // namespace etendue
