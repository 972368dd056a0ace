#include "report/profile_report.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <set>
#include <utility>
#include <vector>

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
            {"args",
             {{"rect", {rect.x0, rect.y0, rect.x1, rect.y1}},
              {"first sample", tile.first_sample},
              {"CPU seconds", tile.cpu_seconds}}}};
}

/// A named stretch of time, seconds.
Json span_event(const std::string& name, const char* category, std::size_t process, int thread, double start,
                double seconds) {
    return {{"name", name},
            {"cat", category},
            {"ph", "X"},
            {"pid", process},
            {"tid", thread},
            {"ts", start * kMicroseconds},
            {"dur", std::max(0.0, seconds) * kMicroseconds}};
}

/// Adds parts one after the other in a row, such as phases of the start or stages: they are sums over all threads, and
/// the row does not show when they were.
void add_in_turn(const std::function<void(const Json&)>& add, const std::vector<NamedValue>& parts,
                 const char* category, std::size_t process, int thread) {
    double start = 0.0;
    for (const NamedValue& part : parts) {
        add(span_event(part.name, category, process, thread, start, part.value));
        start += part.value;
    }
}

/// The gaps between the tiles of a thread in which it had none, from the start of the first tile of all to the end of
/// the last; those below a thousandth of that are left out.
void add_waits(const std::function<void(const Json&)>& add, const ProfileRun& run, std::size_t process, int thread) {
    double begin = std::numeric_limits<double>::infinity();
    double end = 0.0;
    std::vector<std::pair<double, double>> busy;
    for (const TileReport& tile : run.tiles) {
        begin = std::min(begin, tile.start);
        end = std::max(end, tile.end);
        if (tile.thread == thread) busy.emplace_back(tile.start, tile.end);
    }
    std::ranges::sort(busy);
    busy.emplace_back(end, end);
    const double least = 1e-3 * (end - begin);
    double free = begin;
    for (const auto& [from, to] : busy) {
        if (from - free > least) add(span_event("wait", "wait", process, thread, free, from - free));
        free = std::max(free, to);
    }
}

}  // namespace

// "Trace Event Format" (Google, 2016): an object with events; "M" names processes and threads, "X" is a complete event.
std::string to_chrome_trace(const ProfileReport& report) {
    std::string events;
    const auto add = [&](const Json& event) {
        events += events.empty() ? "\n" : ",\n";
        events += event.dump(-1, ' ', false, Json::error_handler_t::replace);
    };
    if (!report.load.empty()) {
        add(name_event("process_name", 0, 0, "start"));
        add(name_event("thread_name", 0, 0, "load and build"));
    }
    add_in_turn(add, report.load, "load", 0, 0);
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
        for (const int thread : threads) add_waits(add, run, process, thread);
        // Behind the threads: rows have numbers.
        const int row = threads.empty() ? 0 : *threads.rbegin() + 1;
        add(name_event("thread_name", process, row, "sums of stages, all threads"));
        add_in_turn(add, run.stages, "stage", process, row);
    }
    const Json about{{"program", report.program}, {"scene", report.scene}, {"created", report.created}};
    return fmt::format("{{\"traceEvents\": [{}\n],\n\"displayTimeUnit\": \"ms\",\n\"otherData\": {}}}\n", events,
                       about.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace etendue
