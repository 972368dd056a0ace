// What images are compared with, and whether they agree among themselves.
#include "app/comparison_measures.h"
#include "metrics/error_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Adds `weight` times the mean of all images but the one of seed `left_out`.
void add_mean(ImageF& sum, std::span<const ImageF> images, std::size_t left_out, double weight) {
    const double scale = weight / static_cast<double>(images.size() - 1);
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
        double value = 0.0;
        for (std::size_t seed = 0; seed < images.size(); ++seed)
            if (seed != left_out) value += static_cast<double>(images[seed].pixels[i]);
        sum.pixels[i] += static_cast<float>(scale * value);
    }
}

std::string weights_text(const std::map<std::string, double>& weights) {
    std::vector<std::string> parts;
    for (const auto& [name, weight] : weights) parts.push_back(fmt::format("{} {:.3g}", name, weight));
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

Reference::Reference(ImageF image, ReferenceReport report) : report_(std::move(report)) {
    images_.push_back(std::move(image));
}

Reference::Reference(std::vector<ImageF> of_seeds, ReferenceReport report)
    : images_(std::move(of_seeds)), report_(std::move(report)) {}

const ImageF& Reference::of_seed(std::size_t seed) const {
    return images_.size() == 1 ? images_.front() : images_[seed];
}

std::vector<FinishedImages> finished_images(std::span<const VariantRenders> renders, const ImageStore& store) {
    std::vector<FinishedImages> all;
    for (const VariantRenders& variant : renders) {
        FinishedImages images;
        for (const SeedRender& seed : variant.seeds)
            images.of_seeds.push_back(store.get(seed.checkpoints.back().image));
        if (images.of_seeds.size() > 1) {
            images.estimate = estimate_image(images.of_seeds);
            images.relative_variance = static_cast<double>(images.of_seeds.size()) * relative_variance(images.estimate);
            images.block_size = testable_block_size(images.of_seeds, AgreementOptions{}.block_size);
        }
        all.push_back(std::move(images));
    }
    return all;
}

ImageEstimate widened_estimate(const FinishedImages& images, int block_size) {
    ImageEstimate estimate = images.estimate;
    widen_for_correlation(estimate, images.of_seeds, block_size);
    return estimate;
}

std::vector<PairReport> compare_pairs(std::span<const Variant> variants, std::span<const FinishedImages> images) {
    std::vector<PairReport> pairs;
    for (std::size_t a = 0; a < variants.size(); ++a)
        for (std::size_t b = a + 1; b < variants.size(); ++b) {
            PairReport pair{.a = variants[a].name,
                            .b = variants[b].name,
                            .comparable = variants[a].cannot_find.empty() && variants[b].cannot_find.empty()};
            if (images[a].block_size && images[b].block_size) {
                const int size = std::max(*images[a].block_size, *images[b].block_size);
                pair.agreement_options.block_size = size;
                // Of images that are still noisy the test of the whole says more than a fixed difference of means.
                pair.agreement_options.mean_tolerance = std::numeric_limits<double>::infinity();
                BlockAgreement tested = test_agreement(widened_estimate(images[a], size),
                                                       widened_estimate(images[b], size), pair.agreement_options);
                // In the full image's coordinates, as all places of the report.
                tested.worst.x += variants[a].sampling.window.x0;
                tested.worst.y += variants[a].sampling.window.y0;
                pair.agreement = tested;
            }
            pairs.push_back(std::move(pair));
        }
    return pairs;
}

std::optional<Reference> pool_reference(std::span<const Variant> variants, std::span<const FinishedImages> images,
                                        std::span<const PairReport> pairs, std::string& why_not) {
    const std::size_t seeds = images.front().of_seeds.size();
    if (seeds < 3) {
        why_not = "pooling a reference needs three seeds or more";
        return std::nullopt;
    }
    for (const PairReport& pair : pairs)
        if (pair.comparable && !pair.agreement) {
            why_not = fmt::format(
                "so few pixels make up the image of '{}' or of '{}' that nothing can be said about "
                "their agreement: give them more time",
                pair.a, pair.b);
            return std::nullopt;
        } else if (pair.comparable && !pair.agreement->agree()) {
            why_not = fmt::format("'{}' and '{}' do not make the same image, so none was pooled", pair.a, pair.b);
            return std::nullopt;
        }
    std::vector<double> weights(variants.size());
    int complete = 0;
    for (std::size_t v = 0; v < variants.size(); ++v) {
        if (!variants[v].cannot_find.empty()) continue;
        ++complete;
        weights[v] = 1.0 / images[v].relative_variance;
    }
    if (complete < 2) {
        why_not = "fewer than two of the variants find all light of the scene, and none can be its own reference";
        return std::nullopt;
    }
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    ReferenceReport report{.kind = "pooled", .noise_rel_mse = 0.0};
    std::vector<ImageF> of_seeds(seeds, ImageF(images[0].estimate.mean.width, images[0].estimate.mean.height, 3));
    for (std::size_t v = 0; v < variants.size(); ++v) {
        if (!(weights[v] > 0.0)) continue;
        const double weight = weights[v] / sum;
        report.weights[variants[v].name] = weight;
        report.noise_rel_mse += weight * weight * images[v].relative_variance / static_cast<double>(seeds - 1);
        for (std::size_t seed = 0; seed < seeds; ++seed) add_mean(of_seeds[seed], images[v].of_seeds, seed, weight);
    }
    report.text = fmt::format(
        "Pooled from the variants after they were found to agree: each image is measured against the mean of all "
        "renders with other seeds, weighted by one over the variants' mean relative variance ({}).",
        weights_text(report.weights));
    return Reference(std::move(of_seeds), std::move(report));
}

}  // namespace etendue
