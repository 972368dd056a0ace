#include "film/deep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace etendue {

namespace {

bool overlap(const DeepBin& a, const DeepBin& b) {
    return a.front <= b.back && b.front <= a.back;
}

/// How far two bins of one kind are from each other: by how much the farther end of all that is in both is deeper than
/// the nearer.
float spread(const DeepBin& a, const DeepBin& b) {
    const auto [nearest, farthest] =
        std::minmax({std::abs(a.front), std::abs(a.back), std::abs(b.front), std::abs(b.back)});
    return farthest / nearest;
}

bool belong_together(const DeepBin& a, const DeepBin& b) {
    return overlap(a, b) || spread(a, b) <= 1.0f + DeepBuffer::kTolerance;
}

using Bins = std::vector<DeepBin>;

/// Bins of splats are kept apart from those of samples, by the sign of their depths: how the two take turns depends on
/// how long tiles take, and must not decide what becomes one bin.
bool is_of_splats(const DeepBin& bin) {
    return std::signbit(bin.front);
}

bool is_empty(const DeepBin& bin) {
    return std::ranges::all_of(std::array{bin.alpha, bin.r, bin.g, bin.b, bin.splat_r, bin.splat_g, bin.splat_b},
                               [](double sum) { return sum == 0.0; });
}

void merge_with_next(Bins& bins, std::size_t i) {
    bins[i].add(bins[i + 1]);
    bins.erase(bins.begin() + static_cast<std::ptrdiff_t>(i) + 1);
}

/// Some of the bins of a pixel: those of samples, or of splats.
struct BinRange {
    std::size_t begin = 0;
    std::size_t end = 0;
};

BinRange range_of(const Bins& bins, bool of_splats) {
    const auto first = static_cast<std::size_t>(std::ranges::find_if_not(bins, is_of_splats) - bins.begin());
    return of_splats ? BinRange{0, first} : BinRange{first, bins.size()};
}

/// After bin `i` has grown.
void merge_what_overlaps(Bins& bins, BinRange range, std::size_t i) {
    for (; i + 1 < range.end && overlap(bins[i], bins[i + 1]); --range.end) merge_with_next(bins, i);
    for (; i > range.begin && overlap(bins[i - 1], bins[i]); --i) merge_with_next(bins, i - 1);
}

void insert(Bins& bins, std::size_t at, const DeepBin& bin) {
    // By itself a vector would have room for twice as many as there may be.
    constexpr std::size_t kMost = DeepBuffer::kMostBins;
    if (bins.size() == bins.capacity())
        bins.reserve(std::min(std::max<std::size_t>(1, 2 * bins.size()), bins.size() < kMost ? kMost : 2 * kMost));
    bins.insert(bins.begin() + static_cast<std::ptrdiff_t>(at), bin);
}

/// Inserts `bin` before the bin `at` of a range that is full: of those that there are then, the two that are nearest
/// each other become one.
void insert_and_merge_nearest(Bins& bins, const BinRange& range, std::size_t at, const DeepBin& bin) {
    const auto with_new = [&](std::size_t i) -> const DeepBin& { return i == at ? bin : bins[i < at ? i : i - 1]; };
    std::size_t nearest = range.begin;
    for (std::size_t i = range.begin + 1; i < range.end; ++i)
        if (spread(with_new(i), with_new(i + 1)) < spread(with_new(nearest), with_new(nearest + 1))) nearest = i;
    if (nearest == at) return bins[at].add(bin);
    if (nearest + 1 == at) return bins[nearest].add(bin);
    merge_with_next(bins, nearest < at ? nearest : nearest - 1);
    insert(bins, nearest < at ? at - 1 : at, bin);
}

/// Holds a deep sample as a file does, before what lies in front is taken into account.
struct Part {
    double r, g, b, alpha;
    float front, back;

    void add_light(const Part& other) {
        r += other.r;
        g += other.g;
        b += other.b;
        alpha += other.alpha;
    }
};

/// Moves what has no alpha of its own, or less than none (a filter's negative parts), to the nearest that has; one part
/// is left if none has.
void give_all_alpha(std::vector<Part>& parts) {
    constexpr double kLeast = 1e-6;
    const auto has_alpha = [](const Part& part) { return part.alpha > kLeast; };
    const auto ratio = [](const Part& a, const Part& b) { return std::max(a.front / b.back, b.front / a.back); };
    while (parts.size() > 1) {
        const auto without = std::ranges::find_if_not(parts, has_alpha);
        if (without == parts.end()) return;
        const Part part = *without;
        parts.erase(without);
        // What it goes to may have less than none thereby, and is moved then.
        const auto is_better = [&](const Part& a, const Part& b) {
            if (has_alpha(a) != has_alpha(b)) return has_alpha(a);
            return ratio(a, part) < ratio(b, part);
        };
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < parts.size(); ++i)
            if (is_better(parts[i], parts[nearest])) nearest = i;
        parts[nearest].add_light(part);
    }
}

}  // namespace

void DeepBin::add(const DeepBin& other) {
    front = std::min(front, other.front);
    back = std::max(back, other.back);
    alpha += other.alpha;
    r += other.r;
    g += other.g;
    b += other.b;
    splat_r += other.splat_r;
    splat_g += other.splat_g;
    splat_b += other.splat_b;
}

void DeepBuffer::add(std::size_t pixel, const DeepBin& bin) {
    const bool of_splats = is_of_splats(bin);
    if (is_empty(bin)) return;
    Bins& bins = pixels_[pixel];
    const BinRange range = range_of(bins, of_splats);
    const auto place = [&](std::size_t index) { return bins.begin() + static_cast<std::ptrdiff_t>(index); };
    const auto after = std::lower_bound(place(range.begin), place(range.end), bin.front,
                                        [](const DeepBin& each, float front) { return each.front < front; });
    auto i = static_cast<std::size_t>(after - bins.begin());
    const bool joins_next = i < range.end && belong_together(bins[i], bin);
    const bool joins_last = i > range.begin && belong_together(bins[i - 1], bin);
    if (joins_last && (!joins_next || spread(bins[i - 1], bin) <= spread(bins[i], bin))) {
        bins[--i].add(bin);
    } else if (joins_next) {
        bins[i].add(bin);
    } else {
        return range.end - range.begin < kMostBins ? insert(bins, i, bin)
                                                   : insert_and_merge_nearest(bins, range, i, bin);
    }
    merge_what_overlaps(bins, range, i);
}

std::uint64_t DeepBuffer::bytes() const {
    std::uint64_t sum = pixels_.size() * sizeof(Bins);
    for (const Bins& bins : pixels_) sum += bins.capacity() * sizeof(DeepBin);
    return sum;
}

std::vector<DeepSample> deep_samples(std::span<const DeepBin> bins, double scale, double splat_scale) {
    std::vector<Part> parts;
    for (const DeepBin& bin : bins) {
        const auto [front, back] = std::minmax({std::abs(bin.front), std::abs(bin.back)});
        parts.push_back({bin.r * scale + bin.splat_r * splat_scale, bin.g * scale + bin.splat_g * splat_scale,
                         bin.b * scale + bin.splat_b * splat_scale, bin.alpha * scale, front, back});
    }
    std::ranges::stable_sort(parts, {}, &Part::front);
    give_all_alpha(parts);
    constexpr double kOpaque = 1e-5;  // less than this shows through
    std::vector<DeepSample> samples;
    double through = 1.0;  // what lies in front
    double last_through = 1.0;
    for (const Part& part : parts) {
        const bool is_hidden = through < kOpaque && !samples.empty();
        // What is hidden leaves its light with what hides it, and not its depth: a wall does not reach to the sky.
        if (!is_hidden) {
            samples.push_back({.front = part.front, .back = part.back});
            last_through = std::max(through, kOpaque);
        }
        DeepSample& sample = samples.back();
        sample.r += static_cast<float>(part.r / last_through);
        sample.g += static_cast<float>(part.g / last_through);
        sample.b += static_cast<float>(part.b / last_through);
        sample.alpha =
            static_cast<float>(std::clamp(static_cast<double>(sample.alpha) + part.alpha / last_through, 0.0, 1.0));
        through -= part.alpha;
    }
    return samples;
}

}  // namespace etendue
