#include "report/comparison_report.h"
#include "report/json_values.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

/// Writes numbers that are not finite as null.
using Json = nlohmann::ordered_json;

constexpr int kComparisonFormat = 4;
constexpr std::array kChannels{"R", "G", "B"};

Json range(const SeedValues& values) {
    return {{"mean", values.mean()}, {"median", values.median()}, {"min", values.least()}, {"max", values.largest()}};
}

Json times(const SeedValues& values) {
    Json json = range(values);
    json["values"] = values.values;
    return json;
}

Json spread(const SeedValues& values) {
    return {{"mean", values.mean()},
            {"median", values.median()},
            {"deviation", values.deviation()},
            {"values", values.values}};
}

template <typename Value, typename Write>
Json object(const std::map<std::string, Value>& members, const Write& write) {
    Json json = Json::object();
    for (const auto& [name, value] : members) json[name] = write(value);
    return json;
}

Json to_json(const ConvergenceStep& step) {
    return {{"spp", step.spp},
            {"seconds", step.seconds.mean()},
            {"cpu_seconds", step.cpu_seconds.mean()},
            {"errors", object(step.errors, range)}};
}

Json to_json(const VariantReport& variant) {
    Json convergence = Json::array();
    for (const ConvergenceStep& step : variant.convergence) convergence.push_back(to_json(step));
    return {{"name", variant.name},
            {"options", variant.options},
            {"command", variant.command},
            {"command_note", known(variant.command_note)},
            {"seeds", variant.seeds},
            {"cannot_find", variant.cannot_find},
            {"spp", variant.spp},
            {"seconds", times(variant.seconds)},
            {"cpu_seconds", times(variant.cpu_seconds)},
            {"samples_per_cpu_second", variant.samples_per_cpu_second},
            {"rays", variant.rays},
            {"rays_per_second", variant.rays_per_second},
            {"mean", variant.mean},
            {"dropped_samples", variant.dropped_samples},
            {"errors", object(variant.errors, spread)},
            {"variance", variant.variance},
            {"efficiency", variant.efficiency},
            {"convergence", std::move(convergence)},
            {"slopes", object(variant.slopes, [](const ConvergenceSlope& slope) {
                 return Json{{"spp", slope.spp}, {"seconds", slope.seconds}, {"cpu_seconds", slope.cpu_seconds}};
             })}};
}

Json to_json(const std::optional<ReachedError>& reached) {
    if (!reached) return {};
    return {{"seconds", reached->seconds}, {"extrapolated", reached->extrapolated}};
}

Json test_of(const PairReport& pair) {
    if (!pair.agreement) return {};
    const BlockAgreement& agreement = *pair.agreement;
    const AgreementOptions& options = pair.agreement_options;
    const BlockDifference& worst = agreement.worst;
    return {{"agree", agreement.agree()},
            {"verdict", pair.verdict()},
            {"blocks_agree", agreement.blocks_agree},
            {"means_agree", agreement.means_agree},
            {"block_size", options.block_size},
            {"tests", agreement.tests},
            {"whole_image_only", agreement.whole_image_only},
            {"p_value", agreement.p_value},
            {"significance", options.significance},
            {"mean_difference", agreement.mean_difference},
            {"mean_tolerance", options.mean_tolerance},
            {"smallest_seen",
             {{"power", kPower}, {"image", pair.smallest_of_image()}, {"block", pair.smallest_of_block()}}},
            {"worst",
             {{"x", worst.x},
              {"y", worst.y},
              {"width", worst.width},
              {"height", worst.height},
              {"channel", kChannels.at(static_cast<std::size_t>(worst.channel))},
              {"mean_a", worst.mean_a},
              {"mean_b", worst.mean_b},
              {"z", worst.z}}},
            {"text", agreement.str()}};
}

Json to_json(const PairReport& pair) {
    return {{"a", pair.a},
            {"b", pair.b},
            {"ratios", object(pair.ratios, [](const RatioInterval& interval) { return Json(interval.ratio); })},
            {"intervals", object(pair.ratios,
                                 [](const RatioInterval& interval) {
                                     return Json::array({interval.low, interval.high});
                                 })},
            {"confidence", kRatioConfidence},
            {"no_interval", pair.no_interval},
            {"time_to_reach",
             {{"metric", "relmse"},
              {"a_reaches_b", to_json(pair.a_reaches_b)},
              {"b_reaches_a", to_json(pair.b_reaches_a)}}},
            {"comparable", pair.comparable},
            {"different_light", known(pair.different_light)},
            {"not_tested", known(pair.not_tested)},
            {"agreement", test_of(pair)}};
}

Json to_json(const UntestedVariant& variant) {
    return {{"name", variant.name}, {"why", variant.why}};
}

Json to_json(const RegionReport& region) {
    Json variants = Json::array();
    for (const RegionVariant& variant : region.variants)
        variants.push_back({{"name", variant.name},
                            {"mean", variant.mean},
                            {"luminance", spread(variant.luminance)},
                            {"mean_error", variant.mean_error.mean()},
                            {"mean_error_deviation", variant.mean_error.deviation()},
                            {"mean_error_of_reference", variant.reference_error},
                            {"errors", object(variant.errors, spread)},
                            {"relmse_time", variant.rel_mse_time}});
    return {{"name", region.name},
            {"found", region.found},
            {"x0", region.pixels.x0},
            {"y0", region.pixels.y0},
            {"x1", region.pixels.x1},
            {"y1", region.pixels.y1},
            {"reference_noise_relmse", region.reference_noise},
            {"variants", std::move(variants)}};
}

Json to_json(const StrategiesReport& report) {
    Json rows = Json::array();
    for (const StrategyReport& strategy : report.strategies) {
        if (const int edges = strategy.edges(); rows.empty() || rows.back()["edges"] != edges) {
            const auto row = std::ranges::find(report.rows, edges, &StrategyRow::edges);
            rows.push_back({{"edges", edges},
                            {"exposure", row == report.rows.end() ? 0.0 : row->exposure},
                            {"images", Json::array()}});
        }
        rows.back()["images"].push_back({{"s", strategy.s},
                                         {"t", strategy.t},
                                         {"weighted_mean", strategy.weighted_mean},
                                         {"unweighted_mean", strategy.unweighted_mean},
                                         {"share", strategy.share},
                                         {"mean_weight", strategy.mean_weight}});
    }
    return {{"variant", report.variant}, {"spp", report.spp}, {"longest", report.longest}, {"rows", std::move(rows)}};
}

Json to_json(const ReferenceReport& reference) {
    const bool is_rendered = reference.spp > 0;
    const auto& seeds = reference.seeds;
    return {{"kind", reference.kind},
            {"text", reference.text},
            {"noise_relmse", reference.noise_rel_mse},
            {"weights", reference.weights.empty() ? Json() : Json(reference.weights)},
            {"spp", is_rendered ? Json(reference.spp) : Json()},
            {"seconds", is_rendered ? Json(reference.seconds) : Json()},
            {"cpu_seconds", is_rendered ? Json(reference.cpu_seconds) : Json()},
            {"seeds", seeds.count > 0 ? Json{{"first", seeds.first}, {"count", seeds.count}} : Json()}};
}

Json to_json(const ReportedMetric& metric) {
    return {{"key", metric.key}, {"name", metric.name}, {"formula", metric.formula}};
}

template <typename Value>
Json array(const std::vector<Value>& values) {
    Json json = Json::array();
    for (const Value& value : values) json.push_back(to_json(value));
    return json;
}

}  // namespace

std::string to_json(const ComparisonReport& report) {
    Json json{{"format", kComparisonFormat},
              {"program", report.program},
              {"created", report.created},
              {"command", report.command},
              {"scene",
               {{"name", report.scene},
                {"path", report.scene_path},
                {"width", report.width},
                {"height", report.height},
                {"crop", report.crop ? window(*report.crop) : Json()},
                {"working_space", report.working_space},
                {"display", report.display},
                {"view", report.view},
                {"look", report.look},
                {"exposure", report.exposure}}},
              {"machine", {{"threads", report.threads}, {"isa", report.isa}, {"libraries", report.libraries}}},
              {"settings",
               {{"time", report.by_wall ? "wall" : "cpu"},
                {"seconds", known(report.seconds)},
                {"spp", known(report.spp)},
                {"seeds", report.seeds},
                {"first_seed", report.first_seed}}},
              {"reference", to_json(report.reference)},
              {"headline", headline(report)},
              {"leading_metric", known(report.leading_metric())},
              {"metrics", array(report.metrics)},
              {"maps", object(report.maps,
                              [](const MapScale& scale) {
                                  return Json{{"low", scale.low}, {"high", scale.high}};
                              })},
              {"notes", report.notes},
              {"variants", array(report.variants)},
              {"pairs", array(report.pairs)},
              {"not_tested", array(report.untested())},
              {"regions", array(report.regions)}};
    if (report.strategies) json["strategies"] = to_json(*report.strategies);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace etendue
