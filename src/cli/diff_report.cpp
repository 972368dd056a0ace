#include "cli/diff_report.h"

#include "core/log.h"
#include "core/pixel_rect_text.h"
#include "core/shown_text.h"
#include "core/standard_output.h"
#include "metrics/error_metrics.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using OrderedJson = nlohmann::ordered_json;

std::string describe(const ComparedFile& file) {
    return fmt::format("{}: {}, {}, {} channels, {}{}", shown_text(file.path.string()), size_text_of(file.display),
                       file.format, file.channels,
                       file.color_space.empty() ? "colour space not said" : shown_text(file.color_space),
                       file.data == file.display ? "" : fmt::format(", pixels {}", text_of(file.data)));
}

OrderedJson to_json(const PixelRect& rect) {
    return {rect.x0, rect.y0, rect.x1, rect.y1};
}

OrderedJson to_json(const NotFinite& faults) {
    OrderedJson first = OrderedJson::array();
    for (const Vec2i& place : faults.first) first.push_back({place.x, place.y});
    return {{"nan", faults.nan},
            {"infinite", faults.infinite},
            {"window", faults.count() > 0 ? to_json(faults.bounds) : OrderedJson()},
            {"first", first}};
}

OrderedJson to_json(const ComparedFile& file, const NotFinite& faults) {
    return {{"file", file.path.string()},
            {"format", file.format},
            {"channels", file.channels},
            {"size", {file.display.width(), file.display.height()}},
            {"window", to_json(file.data)},
            {"color_space", file.color_space.empty() ? OrderedJson() : OrderedJson(file.color_space)},
            {"not_finite", to_json(faults)}};
}

OrderedJson to_json(const Measure& measure, const MeasureOptions& options, const DiffResult& result) {
    const auto limit = result.limit_of(measure.name);
    OrderedJson json = {{"value", measure.value},  // JSON has no NaN: null
                        {"formula", measure.description},
                        {"limit", limit ? OrderedJson(*limit) : OrderedJson()},
                        {"exceeded", result.is_too_large(measure)}};
    if (measure.name.ends_with("flip"))
        json["pixels_per_degree"] = options.flip.pixels_per_degree;
    else
        json["epsilon"] = kMetricEpsilon;
    if (measure.exposures) {
        json["tone_mapper"] = kFlipToneMapper;
        json["exposures"] = {{"start", measure.exposures->start},
                             {"stop", measure.exposures->stop},
                             {"count", measure.exposures->count}};
    }
    return json;
}

void log_faults_of(const ComparedFile& file, const NotFinite& faults) {
    if (faults.count() == 0) return;
    std::string places;
    for (const Vec2i& place : faults.first) places += fmt::format(" ({}, {})", place.x, place.y);
    log_error("error: {}: {} pixels with NaN and {} with infinity, within {}:{}{}", file.path.string(), faults.nan,
              faults.infinite, text_of(faults.bounds), places, faults.count() > faults.first.size() ? " …" : "");
}

}  // namespace

void print_report(const MeasuredPair& pair, const MeasureOptions& options, const DiffResult& result) {
    std::string text;
    const auto out = std::back_inserter(text);
    const PixelRect region = options.region.value_or(pair.pair().window);
    fmt::format_to(out, "image           {}\n", describe(pair.pair().image_file));
    fmt::format_to(out, "reference       {}\n", describe(pair.pair().reference_file));
    fmt::format_to(
        out, "compared        R, G, B of {} pixels, {} from {},{}{}\n", pair.pixel_count(), size_text_of(region),
        region.x0, region.y0,
        pair.left_out_count() == 0 ? "" : fmt::format("; {} that are not finite left out", pair.left_out_count()));
    fmt::format_to(out, "                v is the image's value, r the reference's{}\n",
                   pair.pair().is_encoded ? ", in [0, 1] as they stand in the files" : "");
    for (const Measure& measure : result.measures) {
        const auto limit = result.limit_of(measure.name);
        fmt::format_to(
            out, "{:<15} {:<12.6g} {}{}\n", measure.name, measure.value, measure.description,
            limit ? fmt::format("; limit {:g}{}", *limit, result.is_too_large(measure) ? ", exceeded" : "") : "");
    }
    if (result.map)
        fmt::format_to(out, "map             {}: {} from 0 to {:.6g} ({})\n", shown_text(result.map->file),
                       result.map->measure, result.map->largest, result.map->scale);
    print_text(text);
}

void print_json(const MeasuredPair& pair, const MeasureOptions& options, const DiffResult& result, bool passed) {
    OrderedJson json;
    json["image"] = to_json(pair.pair().image_file, pair.not_finite_in_image());
    json["reference"] = to_json(pair.pair().reference_file, pair.not_finite_in_reference());
    json["region"] = to_json(options.region.value_or(pair.pair().window));
    json["pixels"] = pair.pixel_count();
    json["left_out"] = pair.left_out_count();
    json["color_space"] = pair.pair().color_space.empty() ? OrderedJson() : OrderedJson(pair.pair().color_space);
    json["measures"] = OrderedJson::object();
    for (const Measure& measure : result.measures) json["measures"][measure.name] = to_json(measure, options, result);
    json["map"] = nullptr;
    if (result.map)
        json["map"] = {{"file", result.map->file}, {"measure", result.map->measure}, {"largest", result.map->largest}};
    json["warnings"] = pair.pair().warnings;
    json["passed"] = passed;
    print_data(json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n");
}

void log_faults(const MeasuredPair& pair) {
    log_faults_of(pair.pair().image_file, pair.not_finite_in_image());
    log_faults_of(pair.pair().reference_file, pair.not_finite_in_reference());
}

}  // namespace etendue
