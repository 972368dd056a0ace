#include "film/film.h"

#include <cassert>
#include <utility>

namespace etendue {

Film::Film(int full_width, int full_height, const PixelRect& window, const PixelRect& splat_window)
    : full_width_(full_width),
      full_height_(full_height),
      window_(window),
      splat_window_(splat_window),
      pixels_(window.area()) {}

PixelSum* Film::row(int x, int y) {
    return pixels_.data() + static_cast<std::size_t>(y - window_.y0) * static_cast<std::size_t>(window_.width()) +
           static_cast<std::size_t>(x - window_.x0);
}

void Film::add(const TileBuffer& tile) {
    const PixelRect& rect = tile.rect();
    std::size_t source = 0;
    for (int y = rect.y0; y < rect.y1; ++y) {
        PixelSum* target = row(rect.x0, y);
        for (int x = rect.x0; x < rect.x1; ++x, ++source, ++target) target->add(tile.pixel(source));
    }
}

void Film::add_splats(std::span<const std::vector<Splat>> lists, std::uint64_t light_paths, const PixelFilter& filter,
                      const ThreadPool& threads) {
    if (!splats_) splats_.emplace(full_width_, full_height_, splat_window_, filter);
    splats_->add(lists, light_paths, threads);
}

void Film::add(const Film& other) {
    const PixelRect& rect = other.window_;
    assert(intersection(rect, window_) == rect && other.splat_window_ == splat_window_);
    const PixelSum* source = other.pixels_.data();
    for (int y = rect.y0; y < rect.y1; ++y) {
        PixelSum* target = row(rect.x0, y);
        for (int x = rect.x0; x < rect.x1; ++x, ++source, ++target) target->add(*source);
    }
    if (!other.splats_) return;
    if (splats_)
        splats_->add(*other.splats_);
    else
        splats_ = other.splats_;
}

void Film::restore(std::vector<PixelSum> sums, std::optional<SplatFilm> splats) {
    assert(sums.size() == pixels_.size());
    pixels_ = std::move(sums);
    splats_ = std::move(splats);
}

std::vector<float> Film::resolve() const {
    std::vector<float> image;
    image.reserve(pixels_.size() * 4);
    for (const PixelSum& p : pixels_) {
        // Dividing by the weights keeps even regions even. Where a filter with negative parts has by chance left little
        // weight (a few samples), their number, which is the weight's mean, stands in.
        const auto count = static_cast<double>(p.samples);
        const double weight = p.weight > 0.5 * count ? p.weight : count;
        const double scale = weight > 0.0 ? 1.0 / weight : 0.0;
        for (const double sum : {p.r, p.g, p.b, p.alpha}) image.push_back(static_cast<float>(sum * scale));
    }
    if (splats_) splats_->add_to(image, window_);
    return image;
}

std::uint64_t Film::sample_count() const {
    std::uint64_t count = 0;
    for (const PixelSum& p : pixels_) count += p.samples;
    return count;
}

}  // namespace etendue
