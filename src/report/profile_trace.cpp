#include "report/profile_report.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kMicroseconds = 1e6;  // in which the format gives times

Json name_event(const char* what, std::size_t process, int thread, const std::string& name) {
    return {{"name", what}, {"ph", "M"}, {"pid", process}, {"tid", thread}, {"args", {{"name", name}}}};
}

Json tile_event(std::size_t process, const TileReport& tile) {
    const PixelRect& rect = tile.rect;
    return {{"name", fmt::format("tile ({}, {})", rect.x0, rect.y0)},
            {"cat", "tile"},
            {"ph", "X"},
            {"pid", process},
            {"tid", tile.thread},
            {"ts", tile.start * kMicroseconds},
            {"dur", std::max(0.0, tile.end - tile.start) * kMicroseconds},
            {"args", {{"rect", {rect.x0, rect.y0, rect.x1, rect.y1}}, {"first sample", tile.first_sample}}}};
}

}  // namespace

// "Trace Event Format" (Google, 2016): an object with events; "M" names processes and threads, "X" is a complete event.
std::string to_chrome_trace(const ProfileReport& report) {
    std::string events;
    const auto add = [&](const Json& event) {
        events += events.empty() ? "\n" : ",\n";
        events += event.dump(-1, ' ', false, Json::error_handler_t::replace);
    };
    for (std::size_t i = 0; i < report.runs.size(); ++i) {
        const ProfileRun& run = report.runs[i];
        const std::size_t process = i + 1;
        add(name_event("process_name", process, 0,
                       fmt::format("{}, {} thread{}", run.integrator, run.threads, run.threads == 1 ? "" : "s")));
        std::set<int> threads;
        for (const TileReport& tile : run.tiles) threads.insert(tile.thread);
        for (const int thread : threads)
            add(name_event("thread_name", process, thread, fmt::format("thread {}", thread)));
        for (const TileReport& tile : run.tiles) add(tile_event(process, tile));
    }
    const Json about{{"program", report.program}, {"scene", report.scene}, {"created", report.created}};
    return fmt::format("{{\"traceEvents\": [{}\n],\n\"displayTimeUnit\": \"ms\",\n\"otherData\": {}}}\n", events,
                       about.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace etendue
