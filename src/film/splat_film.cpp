#include "film/splat_film.h"

#include "film/reach.h"
#include "film/splat_bands.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace etendue {

namespace {

float centre(int pixel) {
    return static_cast<float>(pixel) + 0.5f;
}

}  // namespace

bool reaches(const PixelRect& window, const PixelFilter& filter, const Vec2f& position) {
    const float r = filter.radius();
    return position.x >= centre(window.x0) - r && position.x < centre(window.x1 - 1) + r &&
           position.y >= centre(window.y0) - r && position.y < centre(window.y1 - 1) + r;
}

void find_reached_pixels(const PixelRect& window, const PixelFilter& filter, const Vec2f& position,
                         std::vector<ReachedPixel>& reached) {
    reached.clear();
    const Reach rows(position.y, filter.radius(), window.y0, window.y1);
    if (rows.begin >= rows.end) return;  // of bands of an image, most do not see it
    const Reach columns(position.x, filter.radius(), window.x0, window.x1);
    for (int y = rows.begin; y < rows.end; ++y)
        for (int x = columns.begin; x < columns.end; ++x)
            reached.push_back(
                {x, y, filter.evaluate(centre(y) - position.y) * filter.evaluate(centre(x) - position.x)});
}

SplatFilm::SplatFilm(int full_width, int full_height, const PixelRect& window, const PixelFilter& filter,
                     std::size_t light_layers, bool has_moments)
    : full_width_(full_width),
      full_height_(full_height),
      window_(window),
      filter_(filter),
      moment_layer_(has_moments ? kFirstLayer + light_layers : kBeauty),
      pixels_(window.area() * (kFirstLayer + light_layers + (has_moments ? 1 : 0))) {}

std::size_t SplatFilm::index(int x, int y, std::size_t layer) const {
    return layer * window_.area() +
           static_cast<std::size_t>(y - window_.y0) * static_cast<std::size_t>(window_.width()) +
           static_cast<std::size_t>(x - window_.x0);
}

double SplatFilm::scale(double light_paths) const {
    return light_paths > 0.0 ? static_cast<double>(full_width_) * static_cast<double>(full_height_) / light_paths : 0.0;
}

std::array<double, 3> SplatFilm::mean(int x, int y) const {
    const SplatSum& sum = pixels_[index(x, y, kBeauty)];
    const double all = scale();
    return {sum.r * all, sum.g * all, sum.b * all};
}

void SplatFilm::add(std::span<const std::vector<Splat>> lists, std::uint64_t light_paths, const ThreadPool& threads) {
    light_paths_ += light_paths;
    const SplatBands bands(lists, window_, filter_.radius(), threads);
    threads.parallel_for(bands.count(), [&](std::size_t band, int) {
        const PixelRect pixels = bands.pixels(band);
        std::vector<float> along_x;
        bands.for_each(band, [&](const Splat& splat) { add_splat(splat, pixels.y0, pixels.y1, along_x); });
    });
}

void SplatFilm::add_splat(const Splat& splat, int y0, int y1, std::vector<float>& along_x) {
    const Reach columns(splat.position.x, filter_.radius(), window_.x0, window_.x1);
    const Reach rows(splat.position.y, filter_.radius(), y0, y1);
    if (columns.begin >= columns.end) return;
    along_x.clear();
    for (int x = columns.begin; x < columns.end; ++x) along_x.push_back(filter_.evaluate(centre(x) - splat.position.x));
    for (int y = rows.begin; y < rows.end; ++y) {
        const float along_y = filter_.evaluate(centre(y) - splat.position.y);
        SplatSum* sum = &pixels_[index(columns.begin, y, splat.layer)];
        SplatSum* square = splat.layer == kBeauty && moment_layer_ != kBeauty
                               ? &pixels_[index(columns.begin, y, moment_layer_)]
                               : nullptr;
        for (const float x_weight : along_x) {
            const auto weight = static_cast<double>(along_y * x_weight);
            const double r = weight * static_cast<double>(splat.value.r);
            const double g = weight * static_cast<double>(splat.value.g);
            const double b = weight * static_cast<double>(splat.value.b);
            sum->r += r;
            sum->g += g;
            sum->b += b;
            ++sum;
            if (square == nullptr) continue;
            square->r += r * r;
            square->g += g * g;
            square->b += b * b;
            ++square;
        }
    }
}

void SplatFilm::add(const SplatFilm& other) {
    assert(other.pixels_.size() == pixels_.size());
    light_paths_ += other.light_paths_;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        pixels_[i].r += other.pixels_[i].r;
        pixels_[i].g += other.pixels_[i].g;
        pixels_[i].b += other.pixels_[i].b;
    }
}

SplatFilm SplatFilm::as_half(const SplatFilm& part, double stretch) const {
    assert(part.pixels_.size() == pixels_.size());
    SplatFilm half = *this;
    half.light_paths_ = light_paths_ / 2;
    const auto paths = static_cast<double>(half.light_paths_);
    const double of_all = light_paths_ > 0 ? paths / static_cast<double>(light_paths_) : 0.0;
    const double of_some = part.light_paths_ > 0 ? paths / static_cast<double>(part.light_paths_) : 0.0;
    const auto even = [&](double all, double some) { return all * of_all + stretch * (some * of_some - all * of_all); };
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const SplatSum& all = pixels_[i];
        const SplatSum& some = part.pixels_[i];
        half.pixels_[i] = {even(all.r, some.r), even(all.g, some.g), even(all.b, some.b)};
    }
    return half;
}

void SplatFilm::restore(std::vector<SplatSum> sums, std::uint64_t light_paths) {
    assert(sums.size() == pixels_.size());
    pixels_ = std::move(sums);
    light_paths_ = light_paths;
}

void SplatFilm::add_to(std::span<float> image, std::size_t channels, const PixelRect& window, std::size_t layer,
                       double light_paths) const {
    const double all = scale(light_paths);
    float* pixel = image.data();
    for (int y = window.y0; y < window.y1; ++y) {
        const SplatSum* sum = &pixels_[index(window.x0, y, layer)];
        for (int x = window.x0; x < window.x1; ++x, ++sum, pixel += channels) {
            pixel[0] += static_cast<float>(sum->r * all);
            pixel[1] += static_cast<float>(sum->g * all);
            pixel[2] += static_cast<float>(sum->b * all);
        }
    }
}

void SplatFilm::add_variance_to(std::span<float> variance, const PixelRect& window) const {
    assert(moment_layer_ != kBeauty);
    const double all = scale(static_cast<double>(light_paths_));
    const double share = light_paths_ > 0 ? 1.0 / static_cast<double>(light_paths_) : 0.0;
    float* pixel = variance.data();
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x, pixel += 3) {
            const SplatSum& sum = pixels_[index(x, y, kBeauty)];
            const SplatSum& square = pixels_[index(x, y, moment_layer_)];
            const auto of = [&](double total, double squares) {
                return static_cast<float>(std::max(0.0, squares - total * total * share) * all * all);
            };
            pixel[0] += of(sum.r, square.r);
            pixel[1] += of(sum.g, square.g);
            pixel[2] += of(sum.b, square.b);
        }
}

}  // namespace etendue
