#include "report/accelerator_json.h"

#include "report/json_values.h"

#include <utility>

namespace etendue {

namespace {

void add_traced(nlohmann::ordered_json& json, const TracedRays& traced) {
    json["rays"] = traced.rays;
    json["rays_per_second"] = traced.rays_per_second;
    json["nodes_per_ray"] = traced.nodes;
    json["triangles_per_ray"] = traced.triangles;
}

}  // namespace

nlohmann::ordered_json accelerators_object(const AcceleratorReport& report) {
    using Json = nlohmann::ordered_json;
    Json measures = Json::array();
    for (const AcceleratorMeasure& measure : report.measures) {
        Json kinds = Json::array();
        for (const TracedKind& kind : measure.kinds) {
            Json json{{"kind", kind.kind}};
            add_traced(json, kind.traced);
            json["ties"] = kind.ties;
            json["differ"] = kind.differ;
            kinds.push_back(std::move(json));
        }
        measures.push_back({{"name", measure.name},
                            {"triangles", measure.triangles},
                            {"build_seconds", measure.build_seconds},
                            {"bytes", measure.bytes},
                            {"nodes", measure.nodes},
                            {"references", measure.references},
                            {"depth", measure.depth},
                            {"picture", known(measure.picture)},
                            {"picture_high", measure.picture_high},
                            {"kinds", std::move(kinds)}});
    }
    Json growth = Json::array();
    for (const GrowthPoint& point : report.growth) {
        Json json{{"name", point.name},
                  {"triangles", point.triangles},
                  {"build_seconds", point.build_seconds},
                  {"bytes", point.bytes}};
        add_traced(json, point.traced);
        growth.push_back(std::move(json));
    }
    return {{"measures", std::move(measures)}, {"growth", std::move(growth)}};
}

}  // namespace etendue
