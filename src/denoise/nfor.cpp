#include "denoise/nfor.h"

#include "denoise/least_squares.h"
#include "denoise/nl_means.h"
#include "denoise/regression.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace etendue {

namespace {

/// Filter features: kFeatureFilter before the regression, kLastFeatureFilter their mean before the last one.
constexpr NlMeansSettings kFeatureFilter{5, 3, 0.5f};
constexpr NlMeansSettings kLastFeatureFilter{2, 3, 0.5f};
/// Filters the map of squared errors and the choice between bandwidths.
constexpr NlMeansSettings kErrorFilter{9, 1, 1.0f};
/// The bandwidths k that are tried everywhere, the narrowest first.
constexpr std::array<float, 2> kBandwidths{0.5f, 1.0f};
/// Counts what is chosen among, pixel by pixel: an image filtered with each bandwidth, and the one that is not
/// filtered.
constexpr std::size_t kCandidates = kBandwidths.size() + 1;
/// Sets the least light that squared errors are relative to, as a share of the image's mean: in darker places, errors
/// are not counted relative to the light that there is.
constexpr float kRelativeErrorFloor = 0.1f;

bool stopped(const NforSettings& settings) {
    return settings.stop != nullptr && *settings.stop;
}

/// Holds both halves, denoised with one bandwidth.
struct Filtered {
    Planes a;
    Planes b;
};

/// Returns what weights come from: log(1 + |u| / m) with the sign of u, m the mean of |u| over the image; and the
/// variance of that. In linear light the variance of one pixel that a lamp's edge crosses is so large that no wall
/// beside it differs from the lamp; and the paper's images are of lower contrast than a lamp and its room.
Halves compressed(const Halves& light, float mean) {
    const auto compress = [mean](const Planes& planes) {
        return make_planes(planes.width(), planes.height(), planes.count(), [&](int plane, int x, int y) {
            const float u = planes.row(plane, y)[x];
            return std::copysign(std::log1p(std::abs(u) / mean), u);
        });
    };
    Halves halves{light.share, compress(light.a), compress(light.b), {}};
    halves.variance = estimated_variance(halves.a, halves.b, light.share);
    return halves;
}

/// Returns the mean of |u| over all pixels and planes; 1 if all are 0.
float mean_of(const Planes& planes) {
    double sum = 0.0;
    for (int plane = 0; plane < planes.count(); ++plane)
        for (int y = 0; y < planes.height(); ++y)
            for (int x = 0; x < planes.width(); ++x) sum += double(std::abs(planes.row(plane, y)[x]));
    const double mean = sum / (double(planes.width()) * double(planes.height()) * double(planes.count()));
    return mean > 0.0 ? static_cast<float>(mean) : 1.0f;
}

Filtered regress(const Halves& light, const Halves& guide, const PreparedFeatures& features, int radius, float k,
                 const ThreadPool& threads) {
    const NlMeansSettings settings{radius, kLargestPatchRadius, k};
    const NlMeansGuide guide_a{guide.a, guide.variance, guide.variance_scale_a()};
    const NlMeansGuide guide_b{guide.b, guide.variance, guide.variance_scale_b()};
    return {collaborative_regression({light.a, guide_b, features.b}, settings, threads),
            collaborative_regression({light.b, guide_a, features.a}, settings, threads)};
}

/// Section 5.3. With F_a and F_b the filtered halves, E[(F_a - b)²] = MSE(F_a) + Var(b), if F_a and b were independent,
/// and the same with a and b exchanged. Averaged with the shares of the samples that is the squared bias and twice the
/// variance of s F_a + (1 - s) F_b, of which (F_a - F_b)² s (1 - s) takes one away. The sum over the channels: one
/// choice for all of them leaves no coloured edges.
Planes squared_error(const Halves& light, const Filtered& filtered) {
    const float s = light.share;
    return make_planes(light.a.width(), light.a.height(), 1, [&](int, int x, int y) {
        float error = 0.0f;
        for (int plane = 0; plane < light.a.count(); ++plane) {
            const float a = light.a.row(plane, y)[x];
            const float b = light.b.row(plane, y)[x];
            const float fa = filtered.a.row(plane, y)[x];
            const float fb = filtered.b.row(plane, y)[x];
            const float variance = light.variance.row(plane, y)[x];
            const float error_a = (fa - b) * (fa - b) - variance * light.variance_scale_b();
            const float error_b = (fb - a) * (fb - a) - variance * light.variance_scale_a();
            error += s * error_a + (1.0f - s) * error_b - (fa - fb) * (fa - fb) * s * (1.0f - s);
        }
        return error;
    });
}

/// Returns the factor that makes squared errors relative: 1 / Σ (v / ε + 1)², the sum over the channels. Without it,
/// the error of a lamp's edge, a million times that of a wall, would choose for all walls around. v is the lesser of
/// the narrowest filter's light and the mean of 3 × 3 pixels of the input: where a filter has spread a lamp over its
/// wall, its error counts as on a wall.
Planes error_scale(const Planes& input, const Planes& narrowest) {
    const Planes box = box_filtered(input, 1);
    const float floor = kRelativeErrorFloor * mean_of(input);
    return make_planes(input.width(), input.height(), 1, [&](int, int x, int y) {
        const auto square_of = [&](const Planes& planes) {
            float sum = 0.0f;
            for (int plane = 0; plane < planes.count(); ++plane) {
                const float value = std::abs(planes.row(plane, y)[x]) / floor + 1.0f;
                sum += value * value;
            }
            return sum;
        };
        return 1.0f / std::min(square_of(box), square_of(narrowest));
    });
}

/// How much of each candidate each pixel is to be, in [0, 1]; the sum of them is 1. Of which the estimated relative
/// error is least, smoothed. The input, filtered by nothing, is a candidate like the others, and its `squared_error` is
/// its variance: so no pixel is filtered where that is expected to make it worse.
std::array<Planes, kCandidates> candidate_shares(const Halves& light, const Halves& compressed_light,
                                                 const std::array<Filtered, kCandidates>& candidates,
                                                 const ThreadPool& threads) {
    const Planes mean = mean_of_all(compressed_light.a, compressed_light.b, light.share);
    const NlMeansGuide guide{mean, compressed_light.variance};
    const Planes scale = error_scale(mean_of_all(light.a, light.b, light.share),
                                     mean_of_all(candidates[0].a, candidates[0].b, light.share));
    std::array<Planes, kCandidates> errors;
    for (std::size_t i = 0; i < kCandidates; ++i) {
        const Planes relative = combined(squared_error(light, candidates[i]), scale,
                                         [](float error, float factor) { return error * factor; });
        errors[i] = nl_means(relative, guide, kErrorFilter, threads);
    }
    std::array<Planes, kCandidates> shares;
    for (std::size_t i = 0; i < kCandidates; ++i) {
        const Planes is_best = make_planes(mean.width(), mean.height(), 1, [&](int, int x, int y) {
            const auto error_of = [&](const Planes& error) { return error.row(0, y)[x]; };
            return std::ranges::min_element(errors, {}, error_of) - errors.begin() == std::ptrdiff_t(i) ? 1.0f : 0.0f;
        });
        shares[i] = nl_means(is_best, guide, kErrorFilter, threads);
    }
    return shares;
}

/// The sum of the candidates, one half of each, times their shares.
Planes mixed(const std::array<Filtered, kCandidates>& candidates, Planes Filtered::*half,
             const std::array<Planes, kCandidates>& shares) {
    const Planes& first = candidates[0].*half;
    return make_planes(first.width(), first.height(), first.count(), [&](int plane, int x, int y) {
        float sum = 0.0f;
        for (std::size_t i = 0; i < kCandidates; ++i)
            sum += shares[i].row(0, y)[x] * (candidates[i].*half).row(plane, y)[x];
        return sum;
    });
}

/// `filtered`, and `input` as far as it is not to be filtered.
Planes guarded(const Planes& filtered, const Planes& input, const Planes& share_of_input) {
    return make_planes(filtered.width(), filtered.height(), filtered.count(), [&](int plane, int x, int y) {
        const float t = share_of_input.row(0, y)[x];
        return (1.0f - t) * filtered.row(plane, y)[x] + t * input.row(plane, y)[x];
    });
}

float least_value(const Planes& planes, int plane) {
    float least = std::numeric_limits<float>::max();
    for (int y = 0; y < planes.height(); ++y)
        least = std::min(least, *std::min_element(planes.row(plane, y), planes.row(plane, y) + planes.width()));
    return least;
}

void clamp_below(Planes& planes, const Planes& input) {
    for (int plane = 0; plane < planes.count(); ++plane) {
        const float least = std::min(0.0f, least_value(input, plane));
        for (int y = 0; y < planes.height(); ++y)
            std::for_each_n(planes.row(plane, y), planes.width(), [least](float& v) { v = std::max(v, least); });
    }
}

/// Returns the factor that makes a feature's deviations over the image 1 on average over its channels; 0 if it has
/// none.
float scale_of(const Planes& planes) {
    const double pixels = double(planes.width()) * double(planes.height());
    double variance = 0.0;
    for (int plane = 0; plane < planes.count(); ++plane) {
        double sum = 0.0;
        double squares = 0.0;
        for (int y = 0; y < planes.height(); ++y) {
            for (int x = 0; x < planes.width(); ++x) sum += double(planes.row(plane, y)[x]);
        }
        const double mean = sum / pixels;
        for (int y = 0; y < planes.height(); ++y) {
            for (int x = 0; x < planes.width(); ++x) {
                const double difference = double(planes.row(plane, y)[x]) - mean;
                squares += difference * difference;
            }
        }
        variance += squares / pixels;
    }
    const double deviation = std::sqrt(variance / planes.count());
    return deviation > 0.0 ? static_cast<float>(1.0 / deviation) : 0.0f;
}

/// Copies `planes` times `scale` to the planes of `to` from `first` on.
void put(const Planes& planes, float scale, int first, Planes& to) {
    for (int plane = 0; plane < planes.count(); ++plane)
        for (int y = 0; y < planes.height(); ++y)
            std::transform(planes.row(plane, y), planes.row(plane, y) + planes.width(), to.row(first + plane, y),
                           [scale](float v) { return scale * v; });
}

}  // namespace

PreparedFeatures prepare_features(const std::vector<Halves>& features, int width, int height,
                                  const NforSettings& settings, const ThreadPool& threads) {
    int count = 0;
    for (const Halves& feature : features) count += feature.a.count();
    PreparedFeatures prepared{Planes(width, height, count), Planes(width, height, count), Planes(width, height, count)};
    int first = 0;
    for (const Halves& feature : features) {
        if (stopped(settings)) break;
        const NlMeansGuide guide_a{feature.a, feature.variance, feature.variance_scale_a()};
        const NlMeansGuide guide_b{feature.b, feature.variance, feature.variance_scale_b()};
        const Planes a = nl_means(feature.a, guide_b, kFeatureFilter, threads);
        const Planes b = nl_means(feature.b, guide_a, kFeatureFilter, threads);
        const Planes mean = mean_of_all(a, b, feature.share);
        const Planes variance = estimated_variance(a, b, feature.share);
        const float scale = scale_of(mean);
        put(a, scale, first, prepared.a);
        put(b, scale, first, prepared.b);
        put(nl_means(mean, {mean, variance}, kLastFeatureFilter, threads), scale, first, prepared.both);
        first += feature.a.count();
    }
    for (Planes* planes : {&prepared.a, &prepared.b, &prepared.both}) planes->extend();
    return prepared;
}

Planes denoise_nfor(const Halves& light, const PreparedFeatures& features, const NforSettings& settings,
                    const ThreadPool& threads) {
    const Planes input = mean_of_all(light.a, light.b, light.share);
    const float brightness = mean_of(input);
    const Halves guide = compressed(light, brightness);
    std::array<Filtered, kCandidates> candidates;
    for (std::size_t i = 0; i < kBandwidths.size() && !stopped(settings); ++i)
        candidates[i] = regress(light, guide, features, settings.radius, kBandwidths[i], threads);
    if (stopped(settings)) return {};
    candidates.back() = {light.a, light.b};
    const std::array<Planes, kCandidates> shares = candidate_shares(light, guide, candidates, threads);
    const Halves mixture{
        light.share, mixed(candidates, &Filtered::a, shares), mixed(candidates, &Filtered::b, shares), {}};
    candidates = {};
    // Section 5.4: what noise is left is known from the difference of the halves, and is taken from their mean.
    const Halves last_guide = compressed(mixture, brightness);
    if (stopped(settings)) return {};
    const Planes target = mean_of_all(mixture.a, mixture.b, light.share);
    const Planes last_mean = mean_of_all(last_guide.a, last_guide.b, light.share);
    Planes denoised = collaborative_regression({target, {last_mean, last_guide.variance}, features.both},
                                               {settings.radius, kLargestPatchRadius, 1.0f}, threads);
    // The last regression must not spread what was left as it is, either.
    denoised = guarded(denoised, input, shares.back());
    clamp_below(denoised, input);
    return denoised;
}

}  // namespace etendue
