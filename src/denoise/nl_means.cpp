#include "denoise/nl_means.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace etendue {

namespace {

/// Only keeps two equal pixels without variance from being 0/0; in the units of the squared values.
constexpr float kTinyVariance = 1e-30f;
/// So that one pixel's distance cannot drown all others of a patch in rounding; exp(-kFarthest) is no weight at all.
constexpr float kFarthest = 1e4f;
/// exp(-x) beyond this is less than a float's rounding in a sum of weights that has a 1 in it.
constexpr float kNoWeight = 20.0f;

/// Rows of a window are a multiple of this, for vector instructions.
constexpr int kRowMultiple = 4;
constexpr int kPaddedTile = kDenoiseTileSide + 2 * kLargestPatchRadius;

int rounded_up(int value, int multiple) {
    return (value + multiple - 1) / multiple * multiple;
}

}  // namespace

WindowWeights::WindowWeights(const NlMeansSettings& settings)
    : settings_(settings),
      row_stride_(rounded_up(2 * settings.radius + 1, kRowMultiple)),
      weights_(window_size() * kDenoiseTileSide * kDenoiseTileSide),
      distances_(std::size_t{kPaddedTile} * kPaddedTile),
      row_sums_(std::size_t{kPaddedTile} * kPaddedTile) {}

std::span<const float> WindowWeights::window(int x, int y) const {
    const int pixel = (y - tile_.y0) * kDenoiseTileSide + (x - tile_.x0);
    return std::span(weights_).subspan(static_cast<std::size_t>(pixel) * window_size(), window_size());
}

void WindowWeights::compute(const NlMeansGuide& guide, const PixelRect& tile) {
    tile_ = tile;
    for (int dy = -settings_.radius; dy <= settings_.radius; ++dy)
        for (int dx = -settings_.radius; dx <= settings_.radius; ++dx) compute_offset(guide, dx, dy);
}

void WindowWeights::sum_distances(const NlMeansGuide& guide, int dx, int dy) {
    const int patch = settings_.patch;
    const float scale = guide.variance_scale;
    const float k2 = settings_.k * settings_.k;
    const int width = tile_.width() + 2 * patch;
    std::fill(distances_.begin(), distances_.end(), 0.0f);
    for (int plane = 0; plane < guide.image.count(); ++plane) {
        for (int y = 0; y < tile_.height() + 2 * patch; ++y) {
            const int image_x = tile_.x0 - patch;
            const int image_y = tile_.y0 - patch + y;
            const float* u = guide.image.row(plane, image_y) + image_x;
            const float* v = guide.image.row(plane, image_y + dy) + image_x + dx;
            const float* u_variance = guide.variance.row(plane, image_y) + image_x;
            const float* v_variance = guide.variance.row(plane, image_y + dy) + image_x + dx;
            float* sums = distances_.data() + y * kPaddedTile;
            for (int x = 0; x < width; ++x) {
                const float a = scale * u_variance[x];
                const float b = scale * v_variance[x];
                const float difference = u[x] - v[x];
                const float squared = difference * difference - (a + std::min(a, b));
                sums[x] += std::min(squared / (kTinyVariance + k2 * (a + b)), kFarthest);
            }
        }
    }
}

void WindowWeights::compute_offset(const NlMeansGuide& guide, int dx, int dy) {
    const int patch = settings_.patch;
    sum_distances(guide, dx, dy);
    for (int y = 0; y < tile_.height() + 2 * patch; ++y) {
        const float* from = distances_.data() + y * kPaddedTile;
        float* to = row_sums_.data() + y * kPaddedTile;
        std::copy(from, from + tile_.width(), to);
        for (int i = 1; i <= 2 * patch; ++i)
            for (int x = 0; x < tile_.width(); ++x) to[x] += from[x + i];
    }
    const auto terms = static_cast<float>((2 * patch + 1) * (2 * patch + 1) * guide.image.count());
    const PixelRect image{0, 0, guide.image.width(), guide.image.height()};
    const int place = (dy + settings_.radius) * row_stride_ + dx + settings_.radius;
    const std::size_t size = window_size();
    std::array<float, kDenoiseTileSide> sums;
    for (int y = 0; y < tile_.height(); ++y) {
        sums.fill(0.0f);
        for (int i = 0; i <= 2 * patch; ++i) {
            const float* row = row_sums_.data() + (y + i) * kPaddedTile;
            for (int x = 0; x < tile_.width(); ++x) sums[static_cast<std::size_t>(x)] += row[x];
        }
        const bool row_inside = tile_.y0 + y + dy >= image.y0 && tile_.y0 + y + dy < image.y1;
        float* weight = weights_.data() + static_cast<std::size_t>(y) * kDenoiseTileSide * size + place;
        for (int x = 0; x < tile_.width(); ++x, weight += size) {
            const int qx = tile_.x0 + x + dx;
            const float distance = std::max(0.0f, sums[static_cast<std::size_t>(x)] / terms);
            const bool counts = row_inside && qx >= image.x0 && qx < image.x1 && distance < kNoWeight;
            *weight = counts ? std::exp(-distance) : 0.0f;
        }
    }
}

std::vector<PixelRect> denoise_tiles(int width, int height) {
    std::vector<PixelRect> tiles;
    for (int y = 0; y < height; y += kDenoiseTileSide)
        for (int x = 0; x < width; x += kDenoiseTileSide)
            tiles.push_back({x, y, std::min(x + kDenoiseTileSide, width), std::min(y + kDenoiseTileSide, height)});
    return tiles;
}

Planes nl_means(const Planes& target, const NlMeansGuide& guide, const NlMeansSettings& settings,
                const ThreadPool& threads) {
    Planes filtered(target.width(), target.height(), target.count());
    const std::vector<PixelRect> tiles = denoise_tiles(target.width(), target.height());
    std::vector<std::optional<WindowWeights>> scratch(static_cast<std::size_t>(threads.thread_count()));
    threads.parallel_for(tiles.size(), [&](std::size_t index, int slot) {
        const PixelRect& tile = tiles[index];
        auto& weights = scratch[static_cast<std::size_t>(slot)];
        if (!weights) weights.emplace(settings);
        weights->compute(guide, tile);
        for (int y = tile.y0; y < tile.y1; ++y) {
            for (int x = tile.x0; x < tile.x1; ++x) {
                for (int plane = 0; plane < target.count(); ++plane) {
                    const float* window = weights->window(x, y).data();
                    float sum = 0.0f;
                    float weight_sum = 0.0f;
                    for (int row = 0; row < weights->rows(); ++row, window += weights->row_stride()) {
                        const float* values = target.row(plane, y + row - settings.radius) + x - settings.radius;
                        for (int i = 0; i < weights->rows(); ++i) {
                            sum += window[i] * values[i];
                            weight_sum += window[i];
                        }
                    }
                    filtered.row(plane, y)[x] = sum / weight_sum;  // the pixel itself has weight 1
                }
            }
        }
    });
    filtered.extend();
    return filtered;
}

}  // namespace etendue
