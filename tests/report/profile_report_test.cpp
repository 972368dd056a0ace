#include "report/profile_report.h"

#include "report/profile_advice.h"
#include "report/profile_figures.h"
#include "report/profile_fixture.h"
#include "report/text_table.h"
#include "support/page_script.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;
using test::made_up_profile;

TEST(ProfileFigures, FollowFromWhatWasMeasured) {
    const ProfileRun run = made_up_profile().runs[0];
    EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
    EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
    EXPECT_TRUE(std::isnan(median({})));
    EXPECT_EQ(rays_per_second(run), 3000.0) << "6000 rays in the median of 1, 2 and 4 s";
    EXPECT_EQ(samples_per_second(run), 500.0);
    EXPECT_EQ(rays_per_second(run.kinds[0]), 2000.0);
    EXPECT_EQ(tracing_share(run), 0.5);
    EXPECT_TRUE(std::isnan(tracing_share({}))) << "not timed";
    EXPECT_TRUE(std::isnan(rate(1.0, 0.0)));
}

TEST(ProfileFigures, TilesCostTheMedianOfTheirPassesInCpuTime) {
    const ProfileRun run = made_up_profile().runs[0];
    const std::vector<TileCost> tiles = most_expensive_tiles(run, 9);
    ASSERT_EQ(tiles.size(), 2u);
    EXPECT_EQ(tiles[0].rect, (PixelRect{0, 0, 32, 32}));
    EXPECT_DOUBLE_EQ(tiles[0].cpu_seconds, 0.8) << "twice the median of the passes' 0.2 and 0.6";
    EXPECT_DOUBLE_EQ(tiles[0].cpu_seconds_per_sample, 4e-4);
    EXPECT_DOUBLE_EQ(tiles[0].share, 2.0 / 3.0);
    EXPECT_EQ(tiles[1].rect, (PixelRect{32, 0, 64, 32}));
    EXPECT_EQ(most_expensive_tiles(run, 1).size(), 1u);
}

TEST(ProfileJson, HoldsWhatWasMeasured) {
    const Json json = Json::parse(to_json(made_up_profile()));
    EXPECT_EQ(json["format"], 2);
    EXPECT_EQ(json["scene"], Json({{"name", "box"},
                                   {"path", "scenes/box"},
                                   {"width", 64},
                                   {"height", 32},
                                   {"crop", nullptr},
                                   {"max_depth", 12},
                                   {"seed", 7},
                                   {"settings", {{"film", "film: filter box"}, {"sampler", "sobol"}}}}));
    EXPECT_EQ(json["machine"], Json({{"processor", "made up"},
                                     {"processors", 2},
                                     {"memory_nodes", 2},
                                     {"isa", "AVX2"},
                                     {"ray_tracer", "Embree 3.13.5"}}));
    EXPECT_EQ(json["load"]["phases"][1], Json({{"name", "compile"}, {"seconds", 0.5}}));
    EXPECT_EQ(json["load"]["seconds"], 0.75);
    EXPECT_EQ(json["bvh"]["triangles_per_second"], 2000.0);
    EXPECT_EQ(json["bvh"]["bytes_per_triangle"], 64.0);
    EXPECT_EQ(json["memory"]["owners"][0]["bytes"], 1048576.0);
    EXPECT_EQ(json["memory"]["peak_bytes"], 3u << 20);
    EXPECT_TRUE(json["against"].is_null());
    ASSERT_EQ(json["runs"].size(), 2u);
    const Json& run = json["runs"][1];
    EXPECT_EQ(run["threads"], 2);
    EXPECT_EQ(run["cpu_seconds"].size(), 3u);
    EXPECT_EQ(run["rays_per_second"], 3000.0);
    EXPECT_EQ(run["kinds"][0]["packet16"], 1.6e4);
    EXPECT_EQ(run["kinds"][0]["rays_per_second"], 2000.0);
    EXPECT_EQ(run["stages"][2], Json({{"name", "occluded"}, {"seconds", 1.0}}));
    EXPECT_EQ(run["tracing_share"], 0.5);
    EXPECT_EQ(run["tiles"][2], Json({0, 0, 32, 32, 1, 1, 0.5, 1.25, 0.6, 1000}));
    EXPECT_EQ(run["expensive_tiles"][0]["rect"], Json({0, 0, 32, 32}));
    EXPECT_EQ(run["path_lengths"], Json({0, 600, 300, 100}));
    EXPECT_EQ(run["longest"][0]["vertices"], 9);
    EXPECT_EQ(run["endings"][1], Json({{"name", "roulette"}, {"paths", 250.0}}));
    EXPECT_EQ(run["light_path_lengths"], Json({0, 300, 0, 100}));
    EXPECT_EQ(run["light_endings"][0], Json({{"name", "left the scene"}, {"paths", 300.0}}));
    EXPECT_EQ(run["hardware"]["counters"][1]["count"], 3e9);
    EXPECT_EQ(run["heat_map"]["key"], "heat/path-2");
}

TEST(ProfileJson, TellsOfAccelerators) {
    const Json accelerators = Json::parse(to_json(made_up_profile()))["accelerators"];
    const Json& measure = accelerators["measures"][0];
    EXPECT_EQ(measure["name"], "bvh");
    EXPECT_EQ(measure["nodes"], 3000);
    EXPECT_EQ(measure["picture"], "visits-bvh.exr");
    EXPECT_EQ(measure["kinds"], Json::array({{{"kind", "camera"},
                                              {"rays", 1000},
                                              {"rays_per_second", 2.5e6},
                                              {"nodes_per_ray", 12.5},
                                              {"triangles_per_ray", 3.25},
                                              {"ties", 2},
                                              {"differ", 1}}}));
    EXPECT_EQ(accelerators["growth"][0]["triangles"], 98);
    EXPECT_TRUE(accelerators["growth"][0]["nodes_per_ray"].is_null()) << "Embree does not tell";
    EXPECT_TRUE(Json::parse(to_json(ProfileReport{}))["accelerators"].is_null());
}

TEST(ProfileJson, WhatIsNotKnownIsNull) {
    ProfileReport report = made_up_profile();
    report.runs[0].seconds.clear();
    report.first_pixel_seconds = std::numeric_limits<double>::infinity();
    report.bvh = {};
    const Json json = Json::parse(to_json(report));
    const Json& run = json["runs"][0];
    for (const char* key : {"efficiency_best", "parallel_efficiency", "rays_per_second", "bsdf_met_light"})
        EXPECT_TRUE(run.contains(key) && run[key].is_null()) << key;
    EXPECT_TRUE(run["kinds"][1]["hit_share"].is_null());
    EXPECT_TRUE(run["hardware"]["unavailable"].is_null());
    EXPECT_TRUE(json["load"]["first_pixel_seconds"].is_null());
    EXPECT_TRUE(json["bvh"]["triangles_per_second"].is_null());
    EXPECT_TRUE(Json::parse(to_json(ProfileReport{}))["runs"].empty());
}

TEST(ProfileJson, TakesAnyBytes) {
    ProfileReport report = made_up_profile();
    report.scene = "\xff\"</script>";
    EXPECT_EQ(Json::parse(to_json(report))["scene"]["name"], "\xef\xbf\xbd\"</script>");
}

TEST(ProfileJson, StandsOnFewLines) {
    ProfileReport report = made_up_profile();
    const auto lines = [&] {
        const std::string text = to_json(report);
        return std::count(text.begin(), text.end(), '\n');
    };
    const auto before = lines();
    report.runs[0].tiles.resize(1003, report.runs[0].tiles[0]);
    EXPECT_EQ(lines(), before + 1000) << "a tile, a line";
}

std::size_t longest_line(const std::string& text) {
    std::istringstream lines(text);
    std::size_t longest = 0;
    for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
    return longest;
}

TEST(ProfileTable, SaysWhereTheTimeGoes) {
    const std::string table = to_table(made_up_profile());
    for (const char* text :
         {"path, 2 threads", "camera", "intersect", "16.7%", "########", "0.62", "1.00 MiB",
          "most expensive tiles, CPU time: (0, 0) 800 ms (66.7%)", "9 vertices at (3, 4), sample 5", "cycles 2.00 G",
          "875 ms", "2.50 M", "12.5", "64 bytes a triangle", "2 processors at 2 memory nodes"})
        EXPECT_NE(table.find(text), std::string::npos) << text << " is missing in\n" << table;
    EXPECT_EQ(table.find("nan"), std::string::npos) << table;
}

TEST(ProfileTable, FitsATerminal) {
    ProfileReport report = made_up_profile();
    report.processor = std::string(90, 'x');
    report.notes.push_back(std::string(300, 'y'));
    report.runs[0].integrator = "a-name-of-an-integrator-that-is-far-longer-than-any";
    report.runs[0].stages.push_back({std::string(80, 'z'), 1.0});
    report.runs[0].hardware = {{},
                               "the kernel does not lend its counters to programs without privileges: " +
                                   std::string("perf_event_paranoid is 3")};
    report.against = compare_profiles(report, report);
    EXPECT_LE(longest_line(to_table(report)), kMostColumns);
    EXPECT_FALSE(to_table(ProfileReport{}).empty());
}

TEST(TextTable, AlignsColumnsAndBreaksLines) {
    EXPECT_EQ(aligned({{"a", "1"}, {"\xc3\xa9\xc3\xa9", "22"}}, 1), " a    1\n \xc3\xa9\xc3\xa9  22\n");
    const std::string text = wrapped("word " + std::string(120, 'x') + " end", 3);
    EXPECT_EQ(text, "word\n   " + std::string(97, 'x') + "\n   " + std::string(23, 'x') + " end\n");
    EXPECT_EQ(wrapped("scene\nerror: fake", 3), "scene\\x0aerror: fake\n") << "a name begins no line";
}

TEST(ProfileTrace, NamesRunsAndTheirThreads) {
    const Json trace = Json::parse(to_chrome_trace(made_up_profile()));
    std::vector<std::string> processes, threads;
    std::map<std::string, int> of_category;
    Json last;
    for (const Json& event : trace["traceEvents"]) {
        if (event["name"] == "process_name") processes.push_back(event["args"]["name"]);
        if (event["name"] == "thread_name" && event["pid"] == 2) threads.push_back(event["args"]["name"]);
        if (event["ph"] != "X") continue;
        if (event["cat"] == "tile") last = event;
        ++of_category[event["cat"]];
        for (const char* key : {"name", "pid", "tid", "ts", "dur"})
            EXPECT_TRUE(event.contains(key)) << key << ", which every complete event must have";
    }
    EXPECT_EQ(processes, (std::vector<std::string>{"start", "path, 1 thread", "path, 2 threads"}));
    EXPECT_EQ(threads, (std::vector<std::string>{"thread 0", "thread 1", "sums of stages, all threads"}));
    // Thread 0 waits from 0.25 s on; thread 1 never does.
    EXPECT_EQ(of_category, (std::map<std::string, int>{{"load", 2}, {"tile", 6}, {"stage", 8}, {"wait", 2}}));
    EXPECT_EQ(last["ts"], 5e5) << "microseconds";
    EXPECT_EQ(last["dur"], 7.5e5);
    EXPECT_EQ(last["args"]["rect"], Json({0, 0, 32, 32}));
    EXPECT_EQ(last["args"]["first sample"], 1);
}

TEST(ProfileTrace, HasWaitsWhereAThreadHasNoTile) {
    const Json trace = Json::parse(to_chrome_trace(made_up_profile()));
    const auto wait =
        std::ranges::find_if(trace["traceEvents"], [](const Json& event) { return event["name"] == "wait"; });
    ASSERT_NE(wait, trace["traceEvents"].end());
    EXPECT_EQ((*wait)["tid"], 0);
    EXPECT_EQ((*wait)["ts"], 2.5e5);
    EXPECT_EQ((*wait)["dur"], 1e6);
}

std::string lines_of(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences) text += sentence + "\n";
    return text;
}

std::string advice_of(const ProfileRun& run) {
    return lines_of(advice(run));
}

std::string costs_of(const ProfileRun& run) {
    return lines_of(costs(run));
}

TEST(ProfileAdvice, SaysWhatTakesTheTimeAndWhatWouldChangeIt) {
    ProfileRun run = made_up_profile().runs[0];
    run.kinds[1].hit_share = 0.8;
    EXPECT_NE(
        costs_of(run).find("shadow rays are 33.3% of the time; 80.0% of them are blocked, about 75% of those on the "
                           "way to 'lamp'"),
        std::string::npos)
        << costs_of(run);
    EXPECT_EQ(advice_of(run).find("of the time"), std::string::npos) << "nothing to change: " << advice_of(run);
    EXPECT_EQ(advice_of(run).find("--light-samples"), std::string::npos) << "there is one already";
    run.light_samples = 4;
    run.light_sampling_used = 0.5;
    // Of 10000 samples three of four at 750 points, 22.5%; half of the samples have shadow rays, 5000 of 6000 rays.
    EXPECT_NE(advice_of(run).find("--light-samples 1 in place of 4 leaves out about 19% of the rays"),
              std::string::npos)
        << advice_of(run);
    for (RayKindReport& kind : run.kinds) kind.seconds *= 0.8;
    EXPECT_NE(advice_of(run).find("about 19% of the rays"), std::string::npos) << "whatever they took";
    run.kinds[0].seconds = 0.5;
    run.kinds[0].packet_fill = 0.31;
    EXPECT_NE(costs_of(run).find("camera rays are 16.7% of the time; their packets are 31.0% full\n"),
              std::string::npos)
        << costs_of(run);
    EXPECT_EQ(advice_of(run).find("--spp"), std::string::npos) << "they are as full as they get";
    run.spp = 4;
    EXPECT_NE(advice_of(run).find("--spp 16 or more makes the packets of camera rays fuller"), std::string::npos)
        << advice_of(run);
    EXPECT_TRUE(advice(ProfileRun{}).empty());
    EXPECT_TRUE(costs(ProfileRun{}).empty());
}

TEST(ProfileAdvice, CountsTheRaysOfLongPaths) {
    ProfileRun run = made_up_profile().runs[0];
    run.kinds.push_back({.kind = "bounce", .rays = 900});
    // Of 600 · 1 + 300 · 2 + 50 · 6 rays, two each of the last 50 paths.
    run.eye_paths.lengths = {0, 600, 300, 0, 0, 0, 50};
    EXPECT_NE(
        advice_of(run).find("6.7% of the rays of eye paths lie beyond their ray number 4: --max-depth 4 leaves out"),
        std::string::npos)
        << advice_of(run);
}

TEST(ProfileTable, SharesShadowRaysOutToSeveralLamps) {
    ProfileReport report = made_up_profile();
    EXPECT_NE(to_table(report).find("shadow rays by lamp, about: lamp 80%, 75% of these blocked"), std::string::npos)
        << to_table(report);
    for (ProfileRun& run : report.runs) run.scene_hits.lamps.resize(1);
    EXPECT_EQ(to_table(report).find("shadow rays by lamp"), std::string::npos) << "one has them all";
    EXPECT_NE(to_table(report).find("time by material, about: red 10%; green 5.0%"), std::string::npos)
        << to_table(report);
}

TEST(ProfileAdvice, TellsWaitingFromWhatOthersTook) {
    // Tiles take 1.5 of 2.5 s, and 1.2 s of CPU time, of which all threads together had 1.3 s.
    ProfileRun run = made_up_profile().runs[0];
    run.instrumented_cpu_seconds = 1.3;
    EXPECT_EQ(advice_of(run).find("no tile"), std::string::npos) << "one thread waits for nobody: " << advice_of(run);
    EXPECT_NE(busy_machine({run}).find("took 48.0% of the threads' time"), std::string::npos) << busy_machine({run});
    run.threads = 2;
    run.tiles[2].cpu_seconds = 0.4;
    run.instrumented_cpu_seconds = 1.1;
    // 3.5 s without a tile would have been two thirds of that; 0.1 s of them was work.
    EXPECT_NE(advice_of(run).find("threads have no tile for 46.7% of their time"), std::string::npos) << advice_of(run);
    EXPECT_NE(busy_machine({run}).find("took 33.3%"), std::string::npos) << busy_machine({run});
    run.parallel_efficiency = 0.5;
    run.load_imbalance = 0.5;
    EXPECT_EQ(costs_of(run).find("threads do the work"), std::string::npos) << "others did: " << costs_of(run);
    EXPECT_EQ(costs_of(run).find("busiest thread"), std::string::npos) << costs_of(run);
    for (TileReport& tile : run.tiles) tile.cpu_seconds = tile.end - tile.start;
    run.instrumented_cpu_seconds = 1.6;
    EXPECT_EQ(busy_machine({run}), "") << "all the rest is waiting";
    EXPECT_NE(costs_of(run).find("2 threads do the work of 1.0"), std::string::npos) << costs_of(run);
    EXPECT_EQ(busy_machine({ProfileRun{}}), "") << "nothing is known";
}

TEST(ProfileTable, BeginsWithWhatOthersTook) {
    ProfileReport report = made_up_profile();
    EXPECT_TRUE(Json::parse(to_json(report))["busy"].is_null());
    for (ProfileRun& run : report.runs) run.instrumented_cpu_seconds = 0.9;
    const std::string busy = busy_machine(report.runs);
    EXPECT_TRUE(busy.starts_with("path, threads: 1; path, threads: 2: other programs")) << busy;
    report.notes.push_back(busy);
    const std::string table = to_table(report);
    EXPECT_TRUE(table.starts_with("Note: path, threads: 1; path")) << table;
    EXPECT_EQ(table.find("other programs"), table.rfind("other programs")) << "once";
    EXPECT_NE(table.find("\nNote: made up\n"), std::string::npos) << table;
    EXPECT_EQ(Json::parse(to_json(report))["busy"], busy);
}

TEST(ProfileTable, CountsPathsThatReachTheLimit) {
    ProfileReport report = made_up_profile();
    report.max_depth = 3;
    for (ProfileRun& run : report.runs) run.longest.front().vertices = 4;
    const std::string table = to_table(report);
    EXPECT_NE(table.find("eye paths that reached the limit of 3 rays: 100\n"), std::string::npos) << table;
    EXPECT_EQ(table.find("4 vertices at"), std::string::npos) << table;
}

TEST(ProfileAdvice, WarnsWhereRepetitionsDisagree) {
    ProfileRun run{.integrator = "path", .threads = 2, .cpu_seconds = {1.0, 1.05, 1.09}};
    EXPECT_EQ(disagreement_of_repetitions(run), "");
    run.cpu_seconds.push_back(1.2);
    EXPECT_NE(disagreement_of_repetitions(run).find("took 1.00 s to 1.20 s of CPU time, 18.7% apart"),
              std::string::npos)
        << disagreement_of_repetitions(run);
}

TEST(ProfileCsv, HasALineForEachFigure) {
    const std::string csv = to_csv(made_up_profile());
    for (const char* line : {"box,2026-11-22T08:00:00Z,path,1,16,stage,occluded,1,thread s\n",
                             "box,2026-11-22T08:00:00Z,path,2,16,material,red,900,hits\n",
                             "box,2026-11-22T08:00:00Z,path,2,16,material,green,0.15,thread s\n",
                             "box,2026-11-22T08:00:00Z,path,2,16,run,efficiency best,,\n"})
        EXPECT_NE(csv.find(line), std::string::npos) << line << " in " << csv;
}

TEST(ProfileTrace, IsEmptyWithoutRuns) {
    EXPECT_TRUE(Json::parse(to_chrome_trace({}))["traceEvents"].empty());
}

TEST(ProfilePage, HoldsTheReportAndItsImages) {
    ProfileReport report = made_up_profile();
    report.scene = "</script><b>@IMAGES@ \"quoted\"";
    const std::string page = make_profile_page(report, {{"heat/path-2", {0xfb, 0xff}}});
    EXPECT_EQ(Json::parse(test::page_script(page, "report")), Json::parse(to_json(report)));
    EXPECT_EQ(Json::parse(test::page_script(page, "images"))["heat/path-2"], "data:image/png;base64,+/8=");
    for (const char* place : {"@STYLE@", "@SCRIPT@", "@REPORT@"}) EXPECT_EQ(page.find(place), std::string::npos);
}

}  // namespace

}  // namespace etendue
