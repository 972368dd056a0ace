#include "compare/comparison_reference.h"

#include "metrics/error_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Adds `weight` times the mean of all images, three or more, but the one of round `left_out`, and its variance.
void add_mean(ImageEstimate& sum, std::span<const ImageF> images, std::size_t left_out, double weight) {
    const auto count = static_cast<double>(images.size() - 1);
    for (std::size_t i = 0; i < sum.mean.pixels.size(); ++i) {
        const auto sum_of = [&](const auto& term) {
            double all = 0.0;
            for (std::size_t round = 0; round < images.size(); ++round)
                if (round != left_out) all += term(static_cast<double>(images[round].pixels[i]));
            return all;
        };
        const double mean = sum_of([](double value) { return value; }) / count;
        const double squares = sum_of([mean](double value) { return (value - mean) * (value - mean); });
        sum.mean.pixels[i] += static_cast<float>(weight * mean);
        sum.variance.pixels[i] += static_cast<float>(weight * weight * squares / (count * (count - 1.0)));
    }
}

std::string weights_text(const std::map<std::string, double>& weights) {
    std::vector<std::string> parts;
    parts.reserve(weights.size());
    for (const auto& [name, weight] : weights) parts.push_back(fmt::format("{} {:.3g}", name, weight));
    return fmt::format("{}", fmt::join(parts, ", "));
}

/// Places of variants.
using Members = std::vector<std::size_t>;

std::string names_text(std::span<const Variant> variants, const Members& members) {
    std::string text;
    for (std::size_t i = 0; i < members.size(); ++i)
        text += fmt::format("{}'{}'", i == 0 ? "" : i + 1 < members.size() ? ", " : " and ", variants[members[i]].name);
    return text;
}

/// Variants that find all of the light they show, by which light that is; most of one kind first. Those whose images
/// cannot be tested are `untested` and in no group.
std::vector<Members> groups_of_light(std::span<const Variant> variants, std::span<const FinishedImages> images,
                                     std::span<const PairReport> pairs, Members& untested) {
    std::vector<Members> groups;
    for (std::size_t v = 0; v < variants.size(); ++v) {
        if (!variants[v].cannot_find.empty()) continue;
        const bool may_lack_light = std::ranges::any_of(
            pairs, [&](const PairReport& pair) { return pair.comparable && pair.black_variant == variants[v].name; });
        if (images[v].of_seeds.size() > 1 && (!images[v].block_size || may_lack_light)) {
            untested.push_back(v);
            continue;
        }
        const auto group = std::ranges::find_if(groups, [&](const Members& members) {
            return different_light(variants[members.front()], variants[v]).empty();
        });
        if (group != groups.end())
            group->push_back(v);
        else
            groups.push_back({v});
    }
    std::ranges::stable_sort(groups, std::ranges::greater{}, &Members::size);
    return groups;
}

/// Why the first of `groups` cannot be pooled; empty if it can.
std::string why_not_pooled(std::span<const Variant> variants, const std::vector<Members>& groups,
                           const Members& untested, std::span<const PairReport> pairs, std::size_t rounds) {
    if (variants.size() < 2) return "one variant alone cannot be pooled";
    if (!untested.empty() && (groups.empty() || groups.front().size() < 2))
        return fmt::format(
            "so few bright pixels make up the image of {}, or parts of it, that no test can say whether it agrees with "
            "another: more --seeds, a larger --size, or a --crop without these pixels help; longer renders may not",
            names_text(variants, untested));
    if (groups.empty() || groups.front().size() < 2)
        return "no two of the variants show the same light and find all of it, and none can be its own reference";
    const Members& members = groups.front();
    if (groups.size() > 1 && groups[1].size() == members.size())
        return "the variants show different light, and as many of them one as another";
    if (rounds < 3) return "pooling a reference needs three seeds or more";
    const auto is_member = [&](const std::string& name) {
        return std::ranges::any_of(members, [&](std::size_t v) { return variants[v].name == name; });
    };
    for (const PairReport& pair : pairs) {
        if (!pair.comparable || !is_member(pair.a) || !is_member(pair.b)) continue;
        if (!pair.agreement->agree())
            return fmt::format("'{}' and '{}' do not make the same image, so none was pooled", pair.a, pair.b);
    }
    return "";
}

/// One over each variance, their sum being 1. What has no variance is known exactly: the others have no weight then.
std::vector<double> pooling_weights(const std::vector<double>& variances) {
    const bool some_are_exact = std::ranges::find(variances, 0.0) != variances.end();
    std::vector<double> weights;
    weights.reserve(variances.size());
    for (const double variance : variances)
        weights.push_back(some_are_exact ? (variance == 0.0 ? 1.0 : 0.0) : 1.0 / variance);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// Notes about variants that `reference` says little about: they show different light than it.
void add_different_light(std::vector<std::string>& notes, const Variant& reference, std::span<const Variant> variants) {
    for (const Variant& variant : variants)
        if (const std::string why = different_light(reference, variant); !why.empty())
            notes.push_back(
                fmt::format("the errors of '{}' are against an image of different light: {}", variant.name, why));
}

std::string made_alone_by(const std::string& integrator, const std::string& measured) {
    return fmt::format(
        "the reference comes from '{}' alone, which {} measured against: an error of that algorithm would not be seen",
        integrator, measured);
}

}  // namespace

Reference::Reference(ImageF image, ReferenceReport report) : report_(std::move(report)) {
    images_.push_back({std::move(image), {}});
}

Reference::Reference(ImageEstimate estimate, ReferenceReport report)
    : variance_(estimate.variance), report_(std::move(report)) {
    report_.noise_rel_mse = relative_variance(estimate);
    images_.push_back(std::move(estimate));
}

Reference::Reference(std::vector<ImageEstimate> of_rounds, ImageF variance, ReferenceReport report)
    : images_(std::move(of_rounds)), variance_(std::move(variance)), report_(std::move(report)) {}

ImageF Reference::whole() const {
    // Each render is in the images of all rounds but its own.
    const ImageF& like = images_.front().mean;
    ImageF mean(like.width, like.height, like.channels);
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        double sum = 0.0;
        for (const ImageEstimate& image : images_) sum += static_cast<double>(image.mean.pixels[i]);
        mean.pixels[i] = static_cast<float>(sum / static_cast<double>(images_.size()));
    }
    return mean;
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
    pool_variance(estimate, block_size);
    return estimate;
}

namespace {

/// Returns whether a test says something of two images.
bool is_tested(const Variant& a, const FinishedImages& of_a, const Variant& b, const FinishedImages& of_b) {
    return different_light(a, b).empty() && of_a.block_size && of_b.block_size;
}

std::size_t count_tested(std::span<const Variant> variants, std::span<const FinishedImages> images) {
    std::size_t count = 0;
    for (std::size_t a = 0; a < variants.size(); ++a)
        for (std::size_t b = a + 1; b < variants.size(); ++b)
            count += is_tested(variants[a], images[a], variants[b], images[b]) ? 1 : 0;
    return count;
}

}  // namespace

std::vector<PairReport> compare_pairs(std::span<const Variant> variants, std::span<const FinishedImages> images) {
    std::vector<PairReport> pairs;
    const double count = static_cast<double>(count_tested(variants, images));
    const double significance = 1.0 - std::pow(1.0 - AgreementOptions{}.significance, 1.0 / std::max(count, 1.0));
    for (std::size_t a = 0; a < variants.size(); ++a)
        for (std::size_t b = a + 1; b < variants.size(); ++b) {
            PairReport pair{.a = variants[a].name,
                            .b = variants[b].name,
                            .different_light = different_light(variants[a], variants[b])};
            const bool same_light = pair.different_light.empty();
            pair.comparable = same_light && variants[a].cannot_find.empty() && variants[b].cannot_find.empty();
            for (const std::size_t v : {a, b})
                if (!variants[v].cannot_find.empty())
                    pair.not_tested = fmt::format("'{}' cannot find all light", variants[v].name);
            if (!same_light) pair.not_tested = pair.different_light;
            if (is_tested(variants[a], images[a], variants[b], images[b])) {
                const int size = std::max(*images[a].block_size, *images[b].block_size);
                pair.agreement_options.block_size = size;
                pair.agreement_options.significance = significance;
                // Light that is found by chance leaves pixels black, without any variance, where chance has found none.
                pair.agreement_options.black_is_certain = !pair.comparable;
                // Of images that are still noisy the test of the whole says more than a fixed difference of means.
                pair.agreement_options.mean_tolerance = std::numeric_limits<double>::infinity();
                BlockAgreement tested = test_agreement(widened_estimate(images[a], size),
                                                       widened_estimate(images[b], size), pair.agreement_options);
                // In the full image's coordinates, as all places of the report.
                tested.worst.x += variants[a].sampling.window.x0;
                tested.worst.y += variants[a].sampling.window.y0;
                if (tested.agree() && tested.black_in_a + tested.black_in_b > 0) {
                    pair.black_variant = variants[tested.black_in_a > tested.black_in_b ? a : b].name;
                    pair.not_tested =
                        fmt::format("'{}' is black in places where it may lack light by chance", pair.black_variant);
                } else {
                    pair.agreement = tested;
                }
            } else if (pair.not_tested.empty()) {
                pair.not_tested = images[a].of_seeds.size() < 2
                                      ? "one seed tells nothing of its noise"
                                      : fmt::format("few bright pixels, or none, make up the image of '{}'",
                                                    variants[images[a].block_size ? b : a].name);
            }
            pairs.push_back(std::move(pair));
        }
    return pairs;
}

std::optional<Reference> pool_reference(std::span<const Variant> variants, std::span<const FinishedImages> images,
                                        std::span<const PairReport> pairs, std::vector<std::string>& notes) {
    const std::size_t rounds = images.front().of_seeds.size();
    Members untested;
    const std::vector<Members> groups = groups_of_light(variants, images, pairs, untested);
    if (const std::string why_not = why_not_pooled(variants, groups, untested, pairs, rounds); !why_not.empty()) {
        notes.push_back(fmt::format(
            "there is no reference, so no errors are given: {}; --reference or --reference-integrator give one",
            why_not));
        return std::nullopt;
    }
    const Members& members = groups.front();
    std::vector<double> variances;
    for (const std::size_t v : members) variances.push_back(images[v].relative_variance);
    const std::vector<double> weights = pooling_weights(variances);
    ReferenceReport report{.kind = "pooled", .noise_rel_mse = 0.0};
    const ImageF& like = images.front().of_seeds.front();
    const ImageF black(like.width, like.height, like.channels);
    std::vector<ImageEstimate> of_rounds(rounds, {black, black});
    ImageF variance = black;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const FinishedImages& member = images[members[i]];
        report.weights[variants[members[i]].name] = weights[i];
        report.noise_rel_mse += weights[i] * weights[i] * variances[i] / static_cast<double>(rounds - 1);
        for (std::size_t round = 0; round < rounds; ++round)
            add_mean(of_rounds[round], member.of_seeds, round, weights[i]);
        const auto squared = static_cast<float>(weights[i] * weights[i]);
        for (std::size_t p = 0; p < variance.pixels.size(); ++p)
            variance.pixels[p] += squared * member.estimate.variance.pixels[p];
    }
    report.text = fmt::format(
        "Pooled from the variants, which no test told apart: each image is measured against the mean of all "
        "renders of other rounds, weighted by one over the variants' mean relative variance ({}).",
        weights_text(report.weights));

    if (!untested.empty())
        notes.push_back(
            fmt::format("the reference has no part of {}: so few bright pixels make up the image, or parts of it, that "
                        "no test can say whether it agrees with the others, against which its errors are measured",
                        names_text(variants, untested)));
    const Variant& first = variants[members.front()];
    const std::string& integrator = first.settings.integrator.type;
    if (std::ranges::all_of(members, [&](std::size_t v) { return variants[v].settings.integrator.type == integrator; }))
        notes.push_back(made_alone_by(integrator, "all variants that it was pooled from are"));
    add_different_light(notes, first, variants);
    return Reference(std::move(of_rounds), std::move(variance), std::move(report));
}

std::vector<std::string> reference_notes(const Variant& reference, std::span<const Variant> variants) {
    std::vector<std::string> notes;
    for (const std::string& missing : reference.cannot_find)
        notes.push_back(fmt::format("the reference lacks light, as '{}' makes it: {}", reference.name, missing));
    for (const Variant& variant : variants)
        if (variant.settings.integrator.type == reference.settings.integrator.type)
            notes.push_back(made_alone_by(reference.name, fmt::format("'{}' is", variant.name)));
    add_different_light(notes, reference, variants);
    return notes;
}

}  // namespace etendue
