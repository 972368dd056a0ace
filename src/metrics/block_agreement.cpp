#include "metrics/block_agreement.h"

#include "core/pixel_rect.h"
#include "metrics/error_metrics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

std::vector<PixelRect> blocks(const ImageF& image, int block_size) {
    std::vector<PixelRect> result;
    for (int y = 0; y < image.height; y += block_size)
        for (int x = 0; x < image.width; x += block_size)
            result.push_back({x, y, std::min(x + block_size, image.width), std::min(y + block_size, image.height)});
    return result;
}

/// The blocks, then the whole image if it is more than one block.
std::vector<PixelRect> regions(const ImageF& image, int block_size) {
    std::vector<PixelRect> result = blocks(image, block_size);
    if (result.size() > 1) result.push_back({0, 0, image.width, image.height});
    return result;
}

struct Moments {
    double mean = 0.0;
    double variance = 0.0;  ///< variance of `mean`
};

Moments moments(const ImageEstimate& image, const PixelRect& region, int channel) {
    Moments sum;
    const auto c = static_cast<std::size_t>(channel);
    for (int y = region.y0; y < region.y1; ++y) {
        for (int x = region.x0; x < region.x1; ++x) {
            sum.mean += static_cast<double>(image.mean.pixel(x, y)[c]);
            sum.variance += static_cast<double>(image.variance.pixel(x, y)[c]);
        }
    }
    const auto pixels = static_cast<double>(region.area());
    return {sum.mean / pixels, sum.variance / (pixels * pixels)};
}

double mean_of(const ImageF& image, const PixelRect& region, int channel) {
    double sum = 0.0;
    for (int y = region.y0; y < region.y1; ++y)
        for (int x = region.x0; x < region.x1; ++x)
            sum += static_cast<double>(image.pixel(x, y)[static_cast<std::size_t>(channel)]);
    return sum / static_cast<double>(region.area());
}

/// Returns the variance of the mean of the region's means in all renders, from how much these differ.
double variance_of_means(std::span<const ImageF> renders, const PixelRect& region, int channel) {
    const auto count = static_cast<double>(renders.size());
    double sum = 0.0;
    double squares = 0.0;
    for (const ImageF& render : renders) sum += mean_of(render, region, channel);
    for (const ImageF& render : renders) {
        const double deviation = mean_of(render, region, channel) - sum / count;
        squares += deviation * deviation;
    }
    return squares / (count - 1.0) / count;
}

/// Counts how many equal numbers above zero would have the same sum and the same sum of squares (Kish 1965).
class EffectiveCount {
  public:
    void add(double value) {
        sum_ += value;
        squares_ += value * value;
    }
    /// Returns whether the numbers count as at least `count`; true of zeros only, too.
    [[nodiscard]] bool is_at_least(double count) const { return sum_ * sum_ >= count * squares_; }

  private:
    double sum_ = 0.0;
    double squares_ = 0.0;
};

/// Is the least number of values whose mean has a variance that is known well enough.
constexpr double kMany = 100.0;

/// Returns false if few of the values of a region make up its mean; or, unless the region `is_whole`, the variance of
/// that.
bool has_many_values(std::span<const ImageF> renders, const PixelRect& region, int channel, bool is_whole) {
    constexpr double kMost = 0.25;  // of all
    constexpr double kManyDeviations = 4.0;
    constexpr double kMostDeviations = 0.01;  // of all
    const auto c = static_cast<std::size_t>(channel);
    const auto count = static_cast<double>(renders.size());
    EffectiveCount values;
    EffectiveCount deviations;
    for (int y = region.y0; y < region.y1; ++y)
        for (int x = region.x0; x < region.x1; ++x) {
            double sum = 0.0;
            for (const ImageF& render : renders) sum += static_cast<double>(render.pixel(x, y)[c]);
            for (const ImageF& render : renders) {
                const auto value = static_cast<double>(render.pixel(x, y)[c]);
                values.add(value);
                deviations.add((value - sum / count) * (value - sum / count));
            }
        }
    const double all = static_cast<double>(region.area()) * count;
    return values.is_at_least(std::min(kMany, kMost * all)) &&
           (is_whole || deviations.is_at_least(std::min(kManyDeviations, kMostDeviations * all)));
}

void require_estimates(const ImageEstimate& a, const ImageEstimate& b) {
    require_same_shape(a.mean, b.mean, "images");
    require_same_shape(a.mean, a.variance, "an image and its variance");
    require_same_shape(b.mean, b.variance, "an image and its variance");
}

BlockDifference compare(const ImageEstimate& a, const ImageEstimate& b, const PixelRect& region, int channel,
                        double tolerance) {
    const Moments of_a = moments(a, region, channel);
    const Moments of_b = moments(b, region, channel);
    BlockDifference result{region.x0, region.y0, region.width(), region.height(), channel, of_a.mean, of_b.mean};
    result.error = std::sqrt(of_a.variance + of_b.variance);
    const double difference = of_a.mean - of_b.mean;
    const double excess = std::abs(difference) - tolerance * std::max(std::abs(of_a.mean), std::abs(of_b.mean));
    // Written so that what is not a number does not pass.
    if (excess <= 0.0) return result;
    result.z = std::copysign(excess / result.error, difference);
    if (std::isnan(result.z)) result.z = std::numeric_limits<double>::infinity();
    return result;
}

/// Largest relative difference of the means of the whole images over the channels; NaN if one is not a number.
double mean_difference(const ImageEstimate& a, const ImageEstimate& b) {
    const PixelRect whole{0, 0, a.mean.width, a.mean.height};
    double largest = 0.0;
    for (int channel = 0; channel < a.mean.channels; ++channel) {
        const double mean_a = moments(a, whole, channel).mean;
        const double mean_b = moments(b, whole, channel).mean;
        const double difference = std::abs(mean_a - mean_b);
        if (difference == 0.0) continue;
        const double relative = difference / std::max(std::abs(mean_a), std::abs(mean_b));
        if (!(relative <= largest)) largest = relative;
    }
    return largest;
}

/// 0 where both means are 0.
double relative_error(const BlockDifference& difference) {
    const double mean = std::max(std::abs(difference.mean_a), std::abs(difference.mean_b));
    return mean > 0.0 ? difference.error / mean : 0.0;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

ImageEstimate estimate_image(std::span<const ImageF> renders) {
    if (renders.size() < 2) throw std::invalid_argument("a variance needs at least two renders");
    const ImageF& first = renders.front();
    for (const ImageF& render : renders) require_same_shape(render, first, "independent renders");
    ImageEstimate result{ImageF(first.width, first.height, first.channels),
                         ImageF(first.width, first.height, first.channels)};
    const auto count = static_cast<double>(renders.size());
    for (std::size_t i = 0; i < first.pixels.size(); ++i) {
        double sum = 0.0;
        for (const ImageF& render : renders) sum += static_cast<double>(render.pixels[i]);
        const double mean = sum / count;
        double squares = 0.0;
        for (const ImageF& render : renders) {
            const double deviation = static_cast<double>(render.pixels[i]) - mean;
            squares += deviation * deviation;
        }
        result.mean.pixels[i] = static_cast<float>(mean);
        result.variance.pixels[i] = static_cast<float>(squares / (count - 1.0) / count);
    }
    return result;
}

void pool_variance(ImageEstimate& estimate, int block_size) {
    const ImageF own = estimate.variance;
    for (const PixelRect& block : blocks(own, block_size)) {
        const PixelRect around{std::max(block.x0 - block_size, 0), std::max(block.y0 - block_size, 0),
                               std::min(block.x1 + block_size, own.width), std::min(block.y1 + block_size, own.height)};
        for (int channel = 0; channel < own.channels; ++channel) {
            const double of_block = mean_of(own, block, channel);
            const double of_neighbours = mean_of(own, around, channel);
            if (!(of_neighbours > of_block)) continue;
            for (int y = block.y0; y < block.y1; ++y)
                for (int x = block.x0; x < block.x1; ++x)
                    estimate.variance.pixel(x, y)[static_cast<std::size_t>(channel)] =
                        static_cast<float>(of_neighbours);
        }
    }
}

std::optional<int> testable_block_size(std::span<const ImageF> renders, int least) {
    const ImageF& first = renders.front();
    const auto is_black = [](const ImageF& render) {
        return std::ranges::all_of(render.pixels, [](float value) { return value == 0.0f; });
    };
    if (static_cast<double>(static_cast<std::size_t>(first.width) * static_cast<std::size_t>(first.height) *
                            renders.size()) < kMany ||
        std::ranges::all_of(renders, is_black))
        return std::nullopt;
    for (int size = least;; size *= 2) {
        const bool is_whole = size >= std::max(first.width, first.height);
        const bool all = std::ranges::all_of(blocks(first, size), [&](const PixelRect& block) {
            for (int channel = 0; channel < first.channels; ++channel)
                if (!has_many_values(renders, block, channel, is_whole)) return false;
            return true;
        });
        if (all) return size;
        if (is_whole) return std::nullopt;
    }
}

double relative_variance(const ImageEstimate& estimate, int block_size) {
    double sum = 0.0;
    for (const PixelRect& block : blocks(estimate.mean, block_size))
        for (int channel = 0; channel < estimate.mean.channels; ++channel) {
            const double mean = mean_of(estimate.mean, block, channel);
            const double variance = mean_of(estimate.variance, block, channel);
            sum += variance * static_cast<double>(block.area()) / (mean * mean + kMetricEpsilon);
        }
    return sum / static_cast<double>(estimate.mean.pixels.size());
}

double widen_for_correlation(ImageEstimate& estimate, std::span<const ImageF> renders, int block_size) {
    if (renders.size() < 2) throw std::invalid_argument("a variance needs at least two renders");
    for (const ImageF& render : renders) require_same_shape(render, estimate.mean, "renders and their estimate");
    double sum = 0.0;
    double count = 0.0;
    for (const PixelRect& block : blocks(estimate.mean, block_size))
        for (int channel = 0; channel < estimate.mean.channels; ++channel) {
            const double independent = moments(estimate, block, channel).variance;
            if (!(independent > 0.0)) continue;
            sum += variance_of_means(renders, block, channel) / independent;
            count += 1.0;
        }
    const double factor = count > 0.0 ? std::max(1.0, sum / count) : 1.0;
    for (float& variance : estimate.variance.pixels) variance *= static_cast<float>(factor);
    return factor;
}

ImageF agreement_map(const ImageEstimate& a, const ImageEstimate& b, const AgreementOptions& options) {
    require_estimates(a, b);
    ImageF map(a.mean.width, a.mean.height, 1);
    for (const PixelRect& block : blocks(a.mean, options.block_size)) {
        double largest = 0.0;
        for (int channel = 0; channel < a.mean.channels; ++channel)
            largest = std::max(largest, std::abs(compare(a, b, block, channel, options.block_tolerance).z));
        for (int y = block.y0; y < block.y1; ++y)
            for (int x = block.x0; x < block.x1; ++x) map.pixel(x, y)[0] = static_cast<float>(largest);
    }
    return map;
}

double smallest_difference(double error, double significance, std::size_t tests) {
    // The critical value of a two-sided test of twice 1 - kPower is the one-sided quantile of kPower.
    return error * (critical_z(significance, tests) + critical_z(2.0 * (1.0 - kPower), 1));
}

double critical_z(double significance, std::size_t tests) {
    // Of one test: 1 - (1 - significance)^(1 / tests).
    const double p = -std::expm1(std::log1p(-significance) / static_cast<double>(tests));
    double low = 0.0;
    double high = 40.0;  // erfc underflows before
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (std::erfc(middle / std::numbers::sqrt2) > p ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

BlockAgreement test_agreement(const ImageEstimate& a, const ImageEstimate& b, const AgreementOptions& options) {
    require_estimates(a, b);
    BlockAgreement result;
    std::vector<double> block_errors;
    const std::vector<PixelRect> all = regions(a.mean, options.block_size);
    result.tests = all.size() * static_cast<std::size_t>(a.mean.channels);
    const double critical = critical_z(options.significance, result.tests);
    bool has_worst = false;
    for (const PixelRect& region : all) {
        const bool has_black_blocks = result.black_in_a + result.black_in_b > 0 && &region == &all.back();
        for (int channel = 0; channel < a.mean.channels; ++channel) {
            const BlockDifference difference = compare(a, b, region, channel, options.block_tolerance);
            block_errors.push_back(relative_error(difference));
            if (!options.black_is_certain && std::abs(difference.z) > critical) {
                if (difference.mean_a == 0.0) ++result.black_in_a;
                if (difference.mean_b == 0.0) ++result.black_in_b;
                if (difference.mean_a == 0.0 || difference.mean_b == 0.0 || has_black_blocks) continue;
            }
            if (!has_worst || std::abs(difference.z) > std::abs(result.worst.z)) result.worst = difference;
            has_worst = true;
        }
    }
    const double p = std::erfc(std::abs(result.worst.z) / std::numbers::sqrt2);
    // 1 - (1 - p)^n without losing small p.
    result.p_value = p < 1.0 ? -std::expm1(static_cast<double>(result.tests) * std::log1p(-p)) : 1.0;
    result.blocks_agree = result.p_value >= options.significance;
    result.mean_difference = mean_difference(a, b);
    // The last ones are of the whole image, which may be the only block.
    const auto channels = static_cast<std::size_t>(a.mean.channels);
    result.mean_error = *std::max_element(block_errors.end() - a.mean.channels, block_errors.end());
    result.whole_image_only = result.tests == channels;
    if (!result.whole_image_only) block_errors.resize(result.tests - channels);
    result.block_error = median(std::move(block_errors));
    result.means_agree = result.mean_difference <= options.mean_tolerance;
    return result;
}

std::string BlockAgreement::str() const {
    return fmt::format(
        "{} tests of {} {}: the worst is of {}x{} pixels at ({}, {}), channel {}: {:.6g} against {:.6g}, z = {:.2f}, "
        "p = {:.3g} for all tests together; the means of the whole images differ by {:.3f}%{}",
        tests, whole_image_only ? "the whole image" : "blocks", blocks_agree ? "agree" : "disagree", worst.width,
        worst.height, worst.x, worst.y, worst.channel, worst.mean_a, worst.mean_b, worst.z, p_value,
        100.0 * mean_difference, means_agree ? "" : ", which is too much");
}

}  // namespace etendue
