#include "film/median_of_means.h"

#include <algorithm>
#include <cstddef>

namespace etendue {

namespace {

/// The light paths of each bucket: one for each of its samples.
std::vector<double> light_paths_of(const Film& film, const BucketLayers& buckets) {
    std::vector<double> paths(buckets.count, 0.0);
    if (film.splats() == nullptr) return paths;
    const LayerBuffer& layers = film.layers();
    const std::size_t first = layers.layout().value_sums() + buckets.first_value + buckets.count;
    double all = 0.0;
    for (std::size_t p = 0; p < film.window().area(); ++p)
        for (std::size_t b = 0; b < buckets.count; ++b) {
            paths[b] += layers.sums(p)[first + b];
            all += layers.sums(p)[first + b];
        }
    // Samples that were dropped had a light path, too.
    const double scale = all > 0.0 ? static_cast<double>(film.splats()->light_paths()) / all : 0.0;
    for (double& count : paths) count *= scale;
    return paths;
}

/// The means of one row of pixels, bucket by bucket.
class RowOfMeans {
  public:
    RowOfMeans(const Film& film, const BucketLayers& buckets)
        : film_(film),
          buckets_(buckets),
          light_paths_(light_paths_of(film, buckets)),
          means_(buckets.count, std::vector<float>(3 * static_cast<std::size_t>(film.window().width()))) {}

    void fill(int y) {
        const PixelRect& window = film_.window();
        const auto width = static_cast<std::size_t>(window.width());
        first_pixel_ = static_cast<std::size_t>(y - window.y0) * width;
        for (std::size_t b = 0; b < buckets_.count; ++b) {
            for (std::size_t x = 0; x < width; ++x) {
                const std::span<const double> sums = film_.layers().sums(first_pixel_ + x);
                const double scale = scale_of(sums[first_value() + b], samples(x, b));
                for (std::size_t c = 0; c < 3; ++c)
                    means_[b][3 * x + c] = static_cast<float>(sums[3 * (buckets_.first_light + b) + c] * scale);
            }
            if (film_.splats() != nullptr)
                film_.splats()->add_to(means_[b], 3, {window.x0, y, window.x1, y + 1},
                                       SplatFilm::kFirstLayer + buckets_.first_light + b, light_paths_[b]);
        }
    }
    [[nodiscard]] bool has_samples(std::size_t x, std::size_t bucket) const { return samples(x, bucket) > 0.0; }
    [[nodiscard]] float mean(std::size_t x, std::size_t bucket, std::size_t channel) const {
        return means_[bucket][3 * x + channel];
    }

  private:
    [[nodiscard]] std::size_t first_value() const {
        return film_.layers().layout().value_sums() + buckets_.first_value;
    }
    [[nodiscard]] double samples(std::size_t x, std::size_t bucket) const {
        return film_.layers().sums(first_pixel_ + x)[first_value() + buckets_.count + bucket];
    }

    const Film& film_;
    const BucketLayers& buckets_;
    std::vector<double> light_paths_;
    std::vector<std::vector<float>> means_;
    std::size_t first_pixel_ = 0;
};

}  // namespace

float median(std::span<float> values) {
    if (values.empty()) return 0.0f;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5f * (*middle + *std::max_element(values.begin(), middle));
}

std::vector<float> median_of_means(const Film& film, const BucketLayers& buckets) {
    std::vector<float> image = film.resolve();
    RowOfMeans row(film, buckets);
    std::vector<float> means;
    float* pixel = image.data();
    for (int y = film.window().y0; y < film.window().y1; ++y) {
        row.fill(y);
        for (std::size_t x = 0; x < static_cast<std::size_t>(film.window().width()); ++x, pixel += 4)
            for (std::size_t channel = 0; channel < 3; ++channel) {
                means.clear();
                for (std::size_t b = 0; b < buckets.count; ++b)
                    if (row.has_samples(x, b)) means.push_back(row.mean(x, b, channel));
                pixel[channel] = median(means);
            }
    }
    return image;
}

}  // namespace etendue
