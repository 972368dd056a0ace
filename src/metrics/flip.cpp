#include "metrics/flip.h"

#include "core/rgb.h"
#include "metrics/error_metrics.h"
#include "metrics/flip_color.h"
#include "metrics/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Rows that one task filters. It also reads as many rows above and below as the filters reach.
constexpr int kStripRows = 48;

/// Holds the filters of both images and the errors of colours, for one number of pixels per degree.
struct Model {
    explicit Model(double pixels_per_degree)
        : contrast(contrast_filters(pixels_per_degree)),
          feature(feature_filters(pixels_per_degree)),
          radius(std::max(contrast.radius, feature.radius)) {}

    ContrastFilters contrast;
    FeatureFilters feature;
    int radius;
    ColorError color_error;
};

/// Scene-linear to what the display shows.
class ToneMapping {
  public:
    /// No tone mapping: the image is what the display shows.
    ToneMapping() = default;
    /// The tone mapper after `exposure` stops.
    explicit ToneMapping(float exposure) : scale_(std::exp2(exposure)), maps_(true) {}

    [[nodiscard]] Rgb operator()(std::span<const float> pixel) const {
        return clamp_unit({shown(pixel[0]), shown(pixel[1]), shown(pixel[2])});
    }

    /// The scene-linear value that is shown as `value` in (0, 1): the positive root of the fit.
    [[nodiscard]] static double inverse(double value) {
        const double a = kA - value * kC;
        const double b = kB - value * kD;
        return (-b + std::sqrt(b * b + 4.0 * a * value * kE)) / (2.0 * a);
    }

  private:
    // (A x^2 + B x) / (C x^2 + D x + E) of x, which is multiplied by 0.6 first.
    static constexpr double kA = 0.6 * 0.6 * 2.51;
    static constexpr double kB = 0.6 * 0.03;
    static constexpr double kC = 0.6 * 0.6 * 2.43;
    static constexpr double kD = 0.6 * 0.59;
    static constexpr double kE = 0.14;

    [[nodiscard]] float shown(float value) const {
        if (!maps_) return value;
        // Below 0 the fit rises again; above 1e6 it is flat, and its square would overflow far above.
        const float x = value > 0.0f ? std::min(value * scale_, 1e6f) : 0.0f;
        constexpr auto a = static_cast<float>(kA);
        constexpr auto b = static_cast<float>(kB);
        constexpr auto c = static_cast<float>(kC);
        constexpr auto d = static_cast<float>(kD);
        constexpr auto e = static_cast<float>(kE);
        return x * (a * x + b) / (x * (c * x + d) + e);
    }

    float scale_ = 1.0f;
    bool maps_ = false;
};

/// sum += weights ⋆ values, which has as many values more than `sum` as there are weights but one.
void filter_row(std::span<const float> weights, const float* values, std::span<float> sum) {
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const float weight = weights[k];
        const float* shifted = values + k;
        for (std::size_t x = 0; x < sum.size(); ++x) sum[x] += weight * shifted[x];
    }
}

/// Rows of equal length.
class Plane {
  public:
    void resize(std::size_t width, std::size_t rows) {
        width_ = width;
        values_.assign(width * rows, 0.0f);
    }
    [[nodiscard]] std::span<float> row(std::size_t y) { return {values_.data() + y * width_, width_}; }
    [[nodiscard]] std::span<const float> row(std::size_t y) const { return {values_.data() + y * width_, width_}; }

  private:
    std::size_t width_ = 0;
    std::vector<float> values_;
};

/// sum += the rows of `plane` from `first` on, times `weights`.
void filter_column(std::span<const float> weights, const Plane& plane, std::size_t first, std::span<float> sum) {
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const float weight = weights[k];
        const std::span<const float> values = plane.row(first + k);
        for (std::size_t x = 0; x < sum.size(); ++x) sum[x] += weight * values[x];
    }
}

/// Holds what the eye sees in one row of an image.
struct SeenRow {
    void resize(std::size_t width) {
        color.resize(width);
        edge.resize(width);
        point.resize(width);
    }

    std::vector<HuntLab> color;
    std::vector<float> edge;   ///< how strong an edge there is
    std::vector<float> point;  ///< how strong a point or line
};

/// Some rows of one image, filtered along the rows; then row by row along the columns.
class FilteredStrip {
  public:
    /// Rows [y_begin, y_end) of `image`, whose border pixels are continued outwards.
    void load(const ImageF& image, const ToneMapping& mapping, const Model& model, int y_begin, int y_end);
    /// Row y_begin + `row`.
    void see(const Model& model, std::size_t row, SeenRow& seen);

  private:
    void load_row(const ImageF& image, const ToneMapping& mapping, int radius, int y);

    /// One row in the opponent space, with `radius` pixels more at both ends.
    std::vector<float> y_;
    std::vector<float> cx_;
    std::vector<float> cz_;
    /// All rows, and as many more above and below.
    Plane luminance_, red_green_, blue_narrow_, blue_wide_, gaussian_, edge_, point_;
    /// One row of the image.
    Plane sums_;
};

void FilteredStrip::load_row(const ImageF& image, const ToneMapping& mapping, int radius, int y) {
    const auto r = static_cast<std::size_t>(radius);
    const std::size_t padded = static_cast<std::size_t>(image.width) + 2 * r;
    y_.resize(padded);
    cx_.resize(padded);
    cz_.resize(padded);
    const auto put = [&](std::size_t i, const Opponent& c) {
        y_[i] = c.y;
        cx_[i] = c.cx;
        cz_[i] = c.cz;
    };
    for (int x = 0; x < image.width; ++x) put(r + static_cast<std::size_t>(x), opponent_of(mapping(image.pixel(x, y))));
    const Opponent first{y_[r], cx_[r], cz_[r]};
    const std::size_t last_place = padded - r - 1;
    const Opponent last{y_[last_place], cx_[last_place], cz_[last_place]};
    for (std::size_t i = 0; i < r; ++i) {
        put(i, first);
        put(padded - 1 - i, last);
    }
}

void FilteredStrip::load(const ImageF& image, const ToneMapping& mapping, const Model& model, int y_begin, int y_end) {
    const int radius = model.radius;
    const std::size_t rows = static_cast<std::size_t>(y_end - y_begin) + 2 * static_cast<std::size_t>(radius);
    const auto width = static_cast<std::size_t>(image.width);
    for (Plane* plane : {&luminance_, &red_green_, &blue_narrow_, &blue_wide_, &gaussian_, &edge_, &point_})
        plane->resize(width, rows);
    const ContrastFilters& contrast = model.contrast;
    const FeatureFilters& feature = model.feature;
    // Where a narrower filter begins in the padded row.
    const auto contrast_begin = static_cast<std::size_t>(radius - contrast.radius);
    const auto feature_begin = static_cast<std::size_t>(radius - feature.radius);
    for (std::size_t row = 0; row < rows; ++row) {
        const int y = std::clamp(y_begin - radius + static_cast<int>(row), 0, image.height - 1);
        load_row(image, mapping, radius, y);
        filter_row(contrast.luminance, y_.data() + contrast_begin, luminance_.row(row));
        filter_row(contrast.red_green, cx_.data() + contrast_begin, red_green_.row(row));
        filter_row(contrast.blue_narrow, cz_.data() + contrast_begin, blue_narrow_.row(row));
        filter_row(contrast.blue_wide, cz_.data() + contrast_begin, blue_wide_.row(row));
        filter_row(feature.gaussian, y_.data() + feature_begin, gaussian_.row(row));
        filter_row(feature.edge, y_.data() + feature_begin, edge_.row(row));
        filter_row(feature.point, y_.data() + feature_begin, point_.row(row));
    }
}

void FilteredStrip::see(const Model& model, std::size_t row, SeenRow& seen) {
    const std::size_t width = luminance_.row(0).size();
    sums_.resize(width, 7);
    const ContrastFilters& contrast = model.contrast;
    const FeatureFilters& feature = model.feature;
    const std::size_t contrast_first = row + static_cast<std::size_t>(model.radius - contrast.radius);
    const std::size_t feature_first = row + static_cast<std::size_t>(model.radius - feature.radius);
    const std::span<float> y = sums_.row(0);
    const std::span<float> cx = sums_.row(1);
    const std::span<float> cz = sums_.row(2);
    filter_column(contrast.luminance, luminance_, contrast_first, y);
    filter_column(contrast.red_green, red_green_, contrast_first, cx);
    filter_column(contrast.blue_narrow, blue_narrow_, contrast_first, cz);
    filter_column(contrast.blue_wide, blue_wide_, contrast_first, cz);
    const std::span<float> edge_x = sums_.row(3);
    const std::span<float> edge_y = sums_.row(4);
    const std::span<float> point_x = sums_.row(5);
    const std::span<float> point_y = sums_.row(6);
    filter_column(feature.gaussian, edge_, feature_first, edge_x);
    filter_column(feature.edge, gaussian_, feature_first, edge_y);
    filter_column(feature.gaussian, point_, feature_first, point_x);
    filter_column(feature.point, gaussian_, feature_first, point_y);
    seen.resize(width);
    for (std::size_t x = 0; x < width; ++x) {
        seen.color[x] = hunt_lab(clamp_unit(linear_of({y[x], cx[x], cz[x]})));
        seen.edge[x] = std::sqrt(edge_x[x] * edge_x[x] + edge_y[x] * edge_y[x]);
        seen.point[x] = std::sqrt(point_x[x] * point_x[x] + point_y[x] * point_y[x]);
    }
}

/// Holds the memory that one thread works with.
struct Scratch {
    FilteredStrip image_strip;
    FilteredStrip reference_strip;
    SeenRow image_row;
    SeenRow reference_row;
};

/// Raises each value of `errors` to the error of its pixel, if that is larger: color error ^ (1 - feature error).
void raise_errors(const Model& model, const SeenRow& image, const SeenRow& reference, std::span<float> errors) {
    constexpr float kHalfSqrt2 = 0.5f * std::numbers::sqrt2_v<float>;
    for (std::size_t x = 0; x < errors.size(); ++x) {
        const float color = model.color_error(image.color[x], reference.color[x]);
        if (color == 0.0f) continue;
        const float feature =
            std::max(std::abs(image.edge[x] - reference.edge[x]), std::abs(image.point[x] - reference.point[x]));
        // The exponent of the feature's error, q_f, is 0.5.
        const float error = std::pow(color, 1.0f - std::sqrt(kHalfSqrt2 * feature));
        errors[x] = std::max(errors[x], std::min(error, 1.0f));
    }
}

/// Rec.709's, of every pixel; 0 where it is below or the pixel is not finite.
std::vector<double> luminances_of(const ImageF& image) {
    std::vector<double> luminances;
    const auto channels = static_cast<std::size_t>(image.channels);
    luminances.reserve(image.pixels.size() / channels);
    for (std::size_t i = 0; i + 2 < image.pixels.size(); i += channels) {
        const Rgb c{image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]};
        const double luminance =
            0.2126 * static_cast<double>(c.r) + 0.7152 * static_cast<double>(c.g) + 0.0722 * static_cast<double>(c.b);
        luminances.push_back(is_finite(c) ? std::max(luminance, 0.0) : 0.0);
    }
    return luminances;
}

/// The upper one of two; reorders `values`, which are not empty.
double median_of(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

void require_rgb(const ImageF& image, const ImageF& reference) {
    require_same_shape(image, reference, "image and reference");
    if (image.channels < 3)
        throw std::invalid_argument(fmt::format("FLIP needs colours: the images have {} channels", image.channels));
}

/// The largest error over all `mappings`.
ImageF largest_flip(const ImageF& image, const ImageF& reference, double pixels_per_degree,
                    std::span<const ToneMapping> mappings, const ThreadPool& threads) {
    const Model model(pixels_per_degree);
    ImageF map(image.width, image.height, 1);
    std::vector<Scratch> scratch(static_cast<std::size_t>(threads.thread_count()));
    const int strips = (image.height + kStripRows - 1) / kStripRows;
    threads.parallel_for(static_cast<std::size_t>(strips), [&](std::size_t strip, int slot) {
        Scratch& s = scratch[static_cast<std::size_t>(slot)];
        const int y_begin = static_cast<int>(strip) * kStripRows;
        const int y_end = std::min(y_begin + kStripRows, image.height);
        for (const ToneMapping& mapping : mappings) {
            s.image_strip.load(image, mapping, model, y_begin, y_end);
            s.reference_strip.load(reference, mapping, model, y_begin, y_end);
            for (int y = y_begin; y < y_end; ++y) {
                s.image_strip.see(model, static_cast<std::size_t>(y - y_begin), s.image_row);
                s.reference_strip.see(model, static_cast<std::size_t>(y - y_begin), s.reference_row);
                const auto width = static_cast<std::size_t>(image.width);
                raise_errors(model, s.image_row, s.reference_row,
                             {map.pixels.data() + static_cast<std::size_t>(y) * width, width});
            }
        }
    });
    return map;
}

}  // namespace

ImageF ldr_flip(const ImageF& image, const ImageF& reference, double pixels_per_degree, const ThreadPool& threads) {
    require_rgb(image, reference);
    const ToneMapping none;
    return largest_flip(image, reference, pixels_per_degree, {&none, 1}, threads);
}

ExposureRange exposure_range(float start, float stop) {
    return {start, stop, std::max(2, static_cast<int>(std::ceil(stop - start)))};
}

ExposureRange exposures_for(const ImageF& reference) {
    std::vector<double> luminances = luminances_of(reference);
    double median = median_of(luminances);
    if (median == 0.0) {
        std::erase(luminances, 0.0);
        if (luminances.empty()) return {};
        median = median_of(luminances);
    }
    const double shown_bright = ToneMapping::inverse(0.85);
    return exposure_range(static_cast<float>(std::log2(shown_bright / std::ranges::max(luminances))),
                          static_cast<float>(std::log2(shown_bright / median)));
}

HdrFlip hdr_flip(const ImageF& image, const ImageF& reference, const HdrFlipOptions& options,
                 const ThreadPool& threads) {
    require_rgb(image, reference);
    const ExposureRange chosen =
        options.start_exposure && options.stop_exposure ? ExposureRange{} : exposures_for(reference);
    const float start = options.start_exposure.value_or(chosen.start);
    const float stop = options.stop_exposure.value_or(chosen.stop);
    if (!(start <= stop))
        throw std::invalid_argument(
            fmt::format("the exposures of HDR-FLIP start at {:g}, which is above their stop at {:g}", start, stop));
    HdrFlip result{{}, exposure_range(start, stop)};
    std::vector<ToneMapping> mappings;
    mappings.reserve(static_cast<std::size_t>(result.exposures.count));
    for (int i = 0; i < result.exposures.count; ++i) mappings.emplace_back(result.exposures.exposure(i));
    result.map = largest_flip(image, reference, options.pixels_per_degree, mappings, threads);
    return result;
}

std::string describe_ldr_flip(double pixels_per_degree) {
    return fmt::format("mean LDR-FLIP (Andersson et al. 2020), {:.2f} pixels per degree", pixels_per_degree);
}

std::string describe_hdr_flip(double pixels_per_degree, const ExposureRange& exposures) {
    return fmt::format(
        "mean HDR-FLIP (Andersson et al. 2021), {:.2f} pixels per degree, tone mapper {}, {} exposures from {:.4f} to "
        "{:.4f}",
        pixels_per_degree, kFlipToneMapper, exposures.count, exposures.start, exposures.stop);
}

}  // namespace etendue
