#include "film/error_estimate.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace etendue {

namespace {

constexpr int kBlock = 8;  // pixels

using Means = std::array<double, 3>;

/// Means of one pixel over samples of one kind: all, those of the part, and the others.
struct Halves {
    Means whole;
    Means part;
    Means other;
    double odds;  ///< s / (1 - s), which takes (a - v)² to (a - b)² s (1 - s); 0 if the part has none or all

    Halves(const Means& of_whole, const Means& of_part, std::uint64_t part_count, std::uint64_t whole_count)
        : whole(of_whole), part(of_part), other(of_whole), odds(0.0) {
        if (part_count == 0 || part_count >= whole_count) return;
        odds = static_cast<double>(part_count) / static_cast<double>(whole_count - part_count);
        for (std::size_t c = 0; c < 3; ++c) other[c] += odds * (whole[c] - part[c]);
    }

    /// Rounding of sums aside.
    [[nodiscard]] bool differ() const {
        constexpr double kRounding = 1e-9;
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(part[c] - whole[c]) > kRounding * std::abs(whole[c])) return true;
        return false;
    }
    /// Mean over the channels of the squared error, over `square` of each.
    [[nodiscard]] double relative_square(const Means& square) const {
        double sum = 0.0;
        for (std::size_t c = 0; c < 3; ++c) sum += (part[c] - whole[c]) * (part[c] - whole[c]) / square[c];
        return odds * sum / 3.0;
    }
};

/// Mean over the channels of 3 (scale / n)² over value² + ε²; 1 / n if the image is black and has no scale.
double unseen_square(const Means& value, double scale, double dark, std::uint64_t samples) {
    const auto count = static_cast<double>(samples);
    if (scale == 0.0) return 1.0 / count;
    const double off = scale / count;
    double sum = 0.0;
    for (const double v : value) sum += 3.0 * off * off / (v * v + dark);
    return sum / 3.0;
}

/// False for films that get all of their light from light paths.
bool has_eye_light(const Film& film) {
    return std::ranges::any_of(film.sums(), [](const PixelSum& p) { return p.r != 0.0 || p.g != 0.0 || p.b != 0.0; });
}

}  // namespace

double ErrorEstimate::relative_error() const {
    return std::sqrt(eye_mean + light);
}

double image_scale(const Film& film, const ThreadPool& threads) {
    const PixelRect& window = film.window();
    const auto columns = static_cast<std::size_t>((window.width() + kBlock - 1) / kBlock);
    const auto rows = static_cast<std::size_t>((window.height() + kBlock - 1) / kBlock);
    std::vector<double> blocks(columns * rows);
    threads.parallel_for(rows, [&](std::size_t row, int) {
        for (std::size_t column = 0; column < columns; ++column) {
            const int x0 = window.x0 + kBlock * static_cast<int>(column);
            const int y0 = window.y0 + kBlock * static_cast<int>(row);
            const PixelRect block{x0, y0, std::min(x0 + kBlock, window.x1), std::min(y0 + kBlock, window.y1)};
            double sum = 0.0;
            for (int y = block.y0; y < block.y1; ++y)
                for (int x = block.x0; x < block.x1; ++x) {
                    const Means eye = film.eye_mean(x, y);
                    const Means light = film.light_mean(x, y);
                    for (std::size_t c = 0; c < 3; ++c) sum += eye[c] + light[c];
                }
            blocks[row * columns + column] = sum / (3.0 * static_cast<double>(block.area()));
        }
    });
    // A filter with negative lobes can make a block's mean negative.
    std::erase_if(blocks, [](double mean) { return !(mean > 0.0); });
    if (blocks.empty()) return 0.0;
    // Roots of numbers near 1, so that they are the same whatever power of two the light is multiplied by.
    const int exponent = std::ilogb(std::ranges::max(blocks));
    double roots = 0.0;
    for (const double value : blocks) roots += std::sqrt(std::ldexp(value, -exponent));
    const double mean = roots / static_cast<double>(blocks.size());
    return std::ldexp(mean * mean, exponent);
}

ErrorEstimate estimate_errors(const Film& whole, const Film& part, const ThreadPool& threads) {
    assert(whole.window() == part.window());
    const PixelRect& window = whole.window();
    const double scale = image_scale(whole, threads);
    // Of black nothing, any number will do.
    const double dark = scale > 0.0 ? kDarkShare * kDarkShare * scale * scale : 1.0;
    const bool unseen_is_of_light = whole.light_paths() > 0 && !has_eye_light(whole);
    const auto width = static_cast<std::size_t>(window.width());
    const auto height = static_cast<std::size_t>(window.height());
    ErrorEstimate errors{.eye = std::vector<float>(window.area())};
    std::vector<double> light_of_rows(height, 0.0);
    std::vector<double> eye_of_rows(height, 0.0);
    threads.parallel_for(height, [&](std::size_t row, int) {
        const int y = window.y0 + static_cast<int>(row);
        double eye_of_row = 0.0;
        double light_of_row = 0.0;
        for (int x = window.x0; x < window.x1; ++x) {
            const std::uint64_t samples = whole.sample_count(x, y);
            const Halves eye(whole.eye_mean(x, y), part.eye_mean(x, y), part.sample_count(x, y), samples);
            const Halves light(whole.light_mean(x, y), part.light_mean(x, y), part.light_paths(), whole.light_paths());
            Means square{};
            for (std::size_t c = 0; c < 3; ++c)
                square[c] = std::max(0.0, (eye.part[c] + light.part[c]) * (eye.other[c] + light.other[c])) + dark;
            double of_eye = eye.relative_square(square);
            double of_light = light.relative_square(square);
            if (eye.odds > 0.0 && !eye.differ() && !light.differ()) {
                const Means value{eye.whole[0] + light.whole[0], eye.whole[1] + light.whole[1],
                                  eye.whole[2] + light.whole[2]};
                (unseen_is_of_light ? of_light : of_eye) += unseen_square(value, scale, dark, samples);
            }
            errors.eye[row * width + static_cast<std::size_t>(x - window.x0)] = static_cast<float>(of_eye);
            eye_of_row += of_eye;
            light_of_row += of_light;
        }
        eye_of_rows[row] = eye_of_row;
        light_of_rows[row] = light_of_row;
    });
    // Row by row, so that any number of threads comes to the same sums.
    errors.eye_mean = std::accumulate(eye_of_rows.begin(), eye_of_rows.end(), 0.0);
    errors.light = std::accumulate(light_of_rows.begin(), light_of_rows.end(), 0.0);
    const auto area = static_cast<double>(window.area());
    errors.eye_mean /= area;
    errors.light /= area;
    return errors;
}

}  // namespace etendue
