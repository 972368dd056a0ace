#include "film/film.h"

#include "film/splat_bands.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

namespace etendue {

namespace {

/// sqrt(s / (1 - s)) for the share `part` / `whole`; 0 if it is none or all.
double stretch_to_half(std::uint64_t part, std::uint64_t whole) {
    if (part == 0 || part >= whole) return 0.0;
    return std::sqrt(static_cast<double>(part) / static_cast<double>(whole - part));
}

}  // namespace

Film::Film(int full_width, int full_height, const PixelRect& window, const PixelRect& splat_window,
           const LayerLayout& layout)
    : full_width_(full_width),
      full_height_(full_height),
      window_(window),
      splat_window_(splat_window),
      pixels_(window.area()),
      layers_(layout, window.area()) {}

std::size_t Film::index(int x, int y) const {
    return static_cast<std::size_t>(y - window_.y0) * static_cast<std::size_t>(window_.width()) +
           static_cast<std::size_t>(x - window_.x0);
}

void Film::add(const TileBuffer& tile) {
    const PixelRect& rect = tile.rect();
    std::size_t source = 0;
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x, ++source) {
            const std::size_t target = index(x, y);
            pixels_[target].add(tile.pixel(source));
            layers_.add(target, tile.layers(), source);
        }
}

void Film::add(const TileBuffer& tile, std::span<const std::uint32_t> chosen) {
    const PixelRect& rect = tile.rect();
    const auto width = static_cast<std::uint32_t>(rect.width());
    for (const std::uint32_t source : chosen) {
        const std::size_t target =
            index(rect.x0 + static_cast<int>(source % width), rect.y0 + static_cast<int>(source / width));
        pixels_[target].add(tile.pixel(source));
        layers_.add(target, tile.layers(), source);
    }
}

void Film::add_splats(std::span<const std::vector<Splat>> lists, std::uint64_t light_paths, const PixelFilter& filter,
                      const ThreadPool& threads) {
    if (!splats_)
        splats_.emplace(full_width_, full_height_, splat_window_, filter, layers_.layout().light,
                        layers_.layout().has_moments);
    splats_->add(lists, light_paths, threads);
    if (layers_.layout().is_deep) add_deep_splats(lists, filter, threads);
}

void Film::add_deep_splats(std::span<const std::vector<Splat>> lists, const PixelFilter& filter,
                           const ThreadPool& threads) {
    const SplatBands bands(lists, window_, filter.radius(), threads);
    threads.parallel_for(bands.count(), [&](std::size_t band, int) {
        const PixelRect pixels = bands.pixels(band);
        std::vector<ReachedPixel> reached_pixels;
        bands.for_each(band, [&](const Splat& splat) {
            if (splat.layer != SplatFilm::kBeauty) return;
            find_reached_pixels(pixels, filter, splat.position, reached_pixels);
            for (const ReachedPixel& reached : reached_pixels) {
                const auto part = [&](float value) {
                    return static_cast<double>(reached.weight) * static_cast<double>(value);
                };
                layers_.deep().add(index(reached.x, reached.y), {.front = -splat.depth,
                                                                 .back = -splat.depth,
                                                                 .splat_r = part(splat.value.r),
                                                                 .splat_g = part(splat.value.g),
                                                                 .splat_b = part(splat.value.b)});
            }
        });
    });
}

void Film::add(const Film& other) {
    const PixelRect& rect = other.window_;
    assert(intersection(rect, window_) == rect && other.splat_window_ == splat_window_ &&
           other.layers_.layout().without_lists() == layers_.layout().without_lists());
    std::size_t source = 0;
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x, ++source) {
            const std::size_t target = index(x, y);
            pixels_[target].add(other.pixels_[source]);
            layers_.add(target, other.layers_, source);
        }
    if (!other.splats_) return;
    if (splats_)
        splats_->add(*other.splats_);
    else
        splats_ = other.splats_;
}

Film Film::as_half(const Film& part) const {
    assert(part.window_ == window_ && part.layers_.layout().without_lists() == layers_.layout().without_lists());
    Film half = part;
    const LayerLayout& layout = layers_.layout();
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const PixelSum& all = pixels_[i];
        const PixelSum& some = part.pixels_[i];
        const double stretch = stretch_to_half(some.samples, all.samples);
        const auto samples = all.samples / 2;
        const auto count = static_cast<double>(samples);
        const double all_scale = count * all.scale();
        const double some_scale = count * some.scale();
        const auto even = [&](double of_all, double of_some) {
            return of_all * all_scale + stretch * (of_some * some_scale - of_all * all_scale);
        };
        half.pixels_[i] = {
            even(all.r, some.r), even(all.g, some.g), even(all.b, some.b), even(all.alpha, some.alpha), count, samples};
        const std::span<double> sums = half.layers_.sums(i);
        for (std::size_t k = 0; k < layout.ray_sum(); ++k) sums[k] = even(layers_.sums(i)[k], part.layers_.sums(i)[k]);
        if (layout.has_ray_counts && some.samples > 0)
            sums[layout.ray_sum()] *= count / static_cast<double>(some.samples);
    }
    if (splats_ && part.splats_)
        half.splats_ = splats_->as_half(*part.splats_, stretch_to_half(part.light_paths(), light_paths()));
    return half;
}

void Film::restore(std::vector<PixelSum> sums, LayerBuffer layers, std::optional<SplatFilm> splats) {
    assert(sums.size() == pixels_.size() && layers.layout() == layers_.layout());
    pixels_ = std::move(sums);
    layers_ = std::move(layers);
    splats_ = std::move(splats);
}

std::vector<float> Film::resolve() const {
    std::vector<float> image;
    image.reserve(pixels_.size() * 4);
    for (const PixelSum& p : pixels_) {
        const double scale = p.scale();
        for (const double sum : {p.r, p.g, p.b, p.alpha}) image.push_back(static_cast<float>(sum * scale));
    }
    if (splats_) splats_->add_to(image, 4, window_, SplatFilm::kBeauty);
    return image;
}

std::uint64_t Film::sample_count() const {
    std::uint64_t count = 0;
    for (const PixelSum& p : pixels_) count += p.samples;
    return count;
}

std::array<double, 3> Film::eye_mean(int x, int y) const {
    const PixelSum& p = pixels_[index(x, y)];
    const double scale = p.scale();
    return {p.r * scale, p.g * scale, p.b * scale};
}

std::array<double, 3> Film::light_mean(int x, int y) const {
    return splats_ ? splats_->mean(x, y) : std::array<double, 3>{};
}

std::vector<float> Film::resolve_sums(std::size_t first, std::size_t count) const {
    std::vector<float> means;
    means.reserve(pixels_.size() * count);
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        const double scale = pixels_[p].scale();
        for (const double sum : layers_.sums(p).subspan(first, count)) means.push_back(static_cast<float>(sum * scale));
    }
    return means;
}

std::vector<float> Film::resolve_light(std::size_t layer) const {
    std::vector<float> means = resolve_sums(3 * layer, 3);
    if (splats_) splats_->add_to(means, 3, window_, SplatFilm::kFirstLayer + layer);
    return means;
}

std::vector<float> Film::resolve_values(std::size_t first, std::size_t count) const {
    return resolve_sums(layers_.layout().value_sums() + first, count);
}

std::vector<float> Film::resolve_nearest(std::size_t first, std::size_t count, float background) const {
    std::vector<float> values;
    values.reserve(pixels_.size() * count);
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        const bool has_hit = layers_.has_nearest(p);
        for (const float value : layers_.nearest(p).subspan(first, count))
            values.push_back(has_hit ? value : background);
    }
    return values;
}

std::vector<float> Film::resolve_variance() const {
    assert(layers_.layout().has_moments);
    const std::size_t first = layers_.layout().moment_sums();
    std::vector<float> variance;
    variance.reserve(pixels_.size() * 3);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const PixelSum& p = pixels_[i];
        const double scale = p.scale();
        // Of samples that are as far from the mean of all as from their own, one is too many.
        const auto count = static_cast<double>(p.samples);
        const double unbiased = p.samples > 1 ? count / (count - 1.0) : 0.0;
        const std::span<const double> moments = layers_.sums(i).subspan(first, LayerLayout::kMomentSums);
        const double sums[3] = {p.r, p.g, p.b};
        for (std::size_t c = 0; c < 3; ++c) {
            const double mean = sums[c] * scale;
            const double squares = moments[c] - 2.0 * mean * moments[3 + c] + mean * mean * moments[6];
            variance.push_back(static_cast<float>(std::max(0.0, squares) * scale * scale * unbiased));
        }
    }
    if (splats_) splats_->add_variance_to(variance, window_);
    return variance;
}

std::vector<float> Film::resolve_ray_counts() const {
    assert(layers_.layout().has_ray_counts);
    std::vector<float> rays;
    rays.reserve(pixels_.size());
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        const auto samples = static_cast<double>(std::max<std::uint64_t>(1, pixels_[p].samples));
        rays.push_back(static_cast<float>(layers_.sums(p)[layers_.layout().ray_sum()] / samples));
    }
    return rays;
}

std::vector<float> Film::resolve_sample_counts() const {
    std::vector<float> counts;
    counts.reserve(pixels_.size());
    for (const PixelSum& p : pixels_) counts.push_back(static_cast<float>(p.samples));
    return counts;
}

std::vector<std::vector<DeepSample>> Film::resolve_deep() const {
    assert(layers_.layout().is_deep);
    std::vector<std::vector<DeepSample>> image;
    image.reserve(pixels_.size());
    const double splat_scale = splats_ ? splats_->scale() : 0.0;
    for (std::size_t p = 0; p < pixels_.size(); ++p)
        image.push_back(deep_samples(layers_.deep().bins(p), pixels_[p].scale(), splat_scale));
    return image;
}

std::vector<float> Film::resolve_matte(std::size_t matte, std::size_t ranks) const {
    assert(matte < layers_.layout().mattes);
    std::vector<float> values(pixels_.size() * ranks * 2, 0.0f);
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        const double scale = pixels_[p].scale();
        const std::vector<MatteShare> shares = layers_.mattes().ranked(p, matte);
        for (std::size_t rank = 0; rank < std::min(ranks, shares.size()); ++rank) {
            float* const value = &values[(p * ranks + rank) * 2];
            value[0] = std::bit_cast<float>(shares[rank].id);
            value[1] = static_cast<float>(shares[rank].weight * scale);
        }
    }
    return values;
}

}  // namespace etendue
