#include "compare/image_measures.h"

#include "metrics/error_metrics.h"

#include <algorithm>
#include <utility>

namespace etendue {

namespace {

constexpr std::string_view kLdrFlip = "ldr-flip";
constexpr std::string_view kHdrFlip = "hdr-flip";
constexpr std::string_view kFittingFlip = "flip";

std::optional<ErrorMetric> error_metric(std::string_view name) {
    const auto* const found =
        std::ranges::find_if(kErrorMetrics, [name](ErrorMetric metric) { return name_of(metric) == name; });
    return found != kErrorMetrics.end() ? std::optional(*found) : std::nullopt;
}

/// The places of `faults` as the full image counts them.
void move_to_full_image(NotFinite& faults, const PixelRect& window) {
    faults.bounds = moved_to(faults.bounds, faults.bounds.x0 + window.x0, faults.bounds.y0 + window.y0);
    for (Vec2i& place : faults.first) place += Vec2i(window.x0, window.y0);
}

}  // namespace

std::vector<std::string> default_measures() {
    std::vector<std::string> names(kErrorMetrics.size());
    std::ranges::transform(kErrorMetrics, names.begin(),
                           [](ErrorMetric metric) { return std::string(name_of(metric)); });
    names.emplace_back(kFittingFlip);
    return names;
}

std::vector<std::string> measure_names() {
    std::vector<std::string> names = default_measures();
    for (const std::string_view name : {kLdrFlip, kHdrFlip}) names.emplace_back(name);
    return names;
}

std::string resolve_measure(std::string_view name, bool is_encoded) {
    return std::string(name != kFittingFlip ? name : is_encoded ? kLdrFlip : kHdrFlip);
}

MeasuredPair::MeasuredPair(ImagePair pair, const MeasureOptions& options)
    : pair_(std::move(pair)),
      options_(options),
      image_faults_(find_not_finite(pair_.image)),
      reference_faults_(find_not_finite(pair_.reference)),
      left_out_(mark_not_finite(pair_.image, pair_.reference)) {
    blank(pair_.image, left_out_);
    blank(pair_.reference, left_out_);
    move_to_full_image(image_faults_, pair_.window);
    move_to_full_image(reference_faults_, pair_.window);
}

PixelSelection MeasuredPair::selection() const {
    PixelSelection selection{.left_out = left_out_};
    if (options_.region)
        selection.region =
            moved_to(*options_.region, options_.region->x0 - pair_.window.x0, options_.region->y0 - pair_.window.y0);
    return selection;
}

std::size_t MeasuredPair::pixel_count() const {
    std::size_t count = 0;
    for_each_pixel(pair_.image, selection(), [&count](std::size_t) { ++count; });
    return count;
}

std::size_t MeasuredPair::left_out_count() const {
    return options_.region.value_or(pair_.window).area() - pixel_count();
}

std::vector<Measure> MeasuredPair::measure(const std::vector<std::string>& names, const ColorConfig& colors,
                                           const ThreadPool& threads) {
    const auto is_named = [&names](std::string_view name) { return std::ranges::find(names, name) != names.end(); };
    ImageF linear;
    ImageF linear_reference;
    if (is_named(kLdrFlip) || is_named(kHdrFlip)) {
        linear = to_linear_rec709(pair_.image, pair_.is_encoded, pair_.color_space, colors);
        linear_reference = to_linear_rec709(pair_.reference, pair_.is_encoded, pair_.color_space, colors);
    }
    const ErrorMetrics errors = compute_error_metrics(pair_.image, pair_.reference, selection());
    const double ppd = options_.flip.pixels_per_degree;
    std::vector<Measure> measures;
    for (const std::string& name : names) {
        ImageF map;
        if (const auto metric = error_metric(name)) {
            if (measures.empty()) map = error_map(*metric, pair_.image, pair_.reference);
            measures.push_back({name, errors.value(*metric), formula_of(*metric)});
        } else if (name == kHdrFlip) {
            HdrFlip flip = hdr_flip(linear, linear_reference, options_.flip, threads);
            map = std::move(flip.map);
            measures.push_back(
                {name, mean_of(map, selection()), describe_hdr_flip(ppd, flip.exposures), flip.exposures});
        } else {
            map = ldr_flip(linear, linear_reference, ppd, threads);
            measures.push_back({name, mean_of(map, selection()), describe_ldr_flip(ppd)});
        }
        if (measures.size() == 1) {
            // A metric's filter may have spread error from its neighbours into a pixel that is left out.
            map_ = std::move(map);
            blank(map_, left_out_);
        }
    }
    return measures;
}

}  // namespace etendue
