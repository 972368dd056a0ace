// Writes the report of a profile that never was, for tools/ci/check_profile_page: figures as a renderer may have them,
// made up all the same, names that would like to be markup, and passes of tiles on as many threads as are asked for.
//
// Usage: sample_profile DIRECTORY THREADS [empty]. With `empty` next to nothing was measured.
#include "core/write_file.h"
#include "image/write.h"
#include "metrics/color_map.h"
#include "report/profile_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr int kWidth = 480, kHeight = 270, kTile = 32;
constexpr std::array kPasses{1u, 1u, 2u, 4u, 8u, 16u, 16u};
constexpr double kPixelSamples = 480.0 * 270.0 * 48.0;

/// What a sample at this pixel costs, in [0, 1]: two spheres in a dim room.
double cost_at(double x, double y) {
    const auto sphere = [&](double cx, double cy, double r) {
        return std::exp(-std::pow((std::hypot(x - cx, y - cy) / r), 6.0));
    };
    return 0.18 + 0.08 * std::sin(0.05 * x) * std::cos(0.04 * y) + 0.7 * sphere(150, 170, 62) +
           0.45 * sphere(330, 180, 52);
}

ImageF heat_map() {
    ImageF map(kWidth, kHeight, 1);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) map.pixel(x, y)[0] = static_cast<float>(cost_at(x, y));
    return paint_magma(map, 1.0);
}

/// Each tile goes to the thread that is free first, pass by pass.
std::vector<TileReport> make_tiles(int threads, double seconds_per_cost) {
    std::vector<TileReport> tiles;
    std::vector<double> free_at(static_cast<std::size_t>(threads), 0.0);
    std::uint32_t first_sample = 0;
    for (const std::uint32_t samples : kPasses) {
        for (int y = 0; y < kHeight; y += kTile)
            for (int x = 0; x < kWidth; x += kTile) {
                const PixelRect rect{x, y, std::min(x + kTile, kWidth), std::min(y + kTile, kHeight)};
                const auto thread = std::min_element(free_at.begin(), free_at.end());
                const double jitter = 1.0 + 0.1 * std::sin(12.9898 * x + 78.233 * y + 7.0 * samples);
                const double seconds = seconds_per_cost * jitter * cost_at(x + 16.0, y + 16.0) *
                                       static_cast<double>(rect.area()) * samples;
                tiles.push_back({rect, static_cast<int>(thread - free_at.begin()), first_sample, *thread,
                                 *thread + seconds, 0.97 * seconds, rect.area() * samples});
                *thread += seconds;
            }
        const double end = *std::max_element(free_at.begin(), free_at.end());
        std::fill(free_at.begin(), free_at.end(), end);
        first_sample += samples;
    }
    return tiles;
}

/// Of `rays` million rays, traced at `rate` million per second; bare Embree takes them at these.
RayKindReport kind(const char* name, double rays, double rate, double single, double packet8, double packet16,
                   double hit) {
    return {
        name, static_cast<std::uint64_t>(rays * 1e6), rays / rate, 200000, single * 1e6, packet8 * 1e6, packet16 * 1e6,
        hit};
}

/// About `most` of one ray, and so much fewer of each ray more.
PathsReport make_paths(double most, double fall) {
    PathsReport paths{.endings = {{"left the scene", 0.45 * most},
                                  {"absorbed by a surface", 0.3 * most},
                                  {"Russian roulette", 1.07 * most},
                                  {"longest path allowed", 0.008 * most}},
                      .lengths = {0}};
    for (int length = 1; length <= 24; ++length)
        paths.lengths.push_back(static_cast<std::uint64_t>(most * std::exp(-fall * length) + 3.0));
    return paths;
}

ProfileRun make_run(const std::string& integrator, int threads) {
    const bool is_path = integrator == "path";
    const double scale = is_path ? 1.0 : 2.3;
    ProfileRun run{.integrator = integrator, .threads = threads, .spp = 48};
    run.tiles = make_tiles(threads, 1.45e-6 * scale);
    const double wall = run.tiles.back().end;
    for (const double noise : {1.0, 1.013, 0.991, 1.004, 0.998}) {
        run.seconds.push_back(wall * 0.97 * noise);
        run.cpu_seconds.push_back(wall * 0.96 * noise * threads);
    }
    run.instrumented_seconds = wall;
    run.samples = static_cast<std::uint64_t>(kPixelSamples);
    run.kinds = {kind("camera", 6.2, 31.0, 12.6, 57.0, 70.3, 0.98), kind("bounce", 17.6, 8.9, 8.7, 11.0, 11.4, 0.91),
                 kind("shadow", 14.2, 19.6, 15.2, 27.1, 28.7, 0.38)};
    run.stages = {{"generate", 0.18 * scale},
                  {"random numbers", 0.14 * scale},
                  {"intersect", 2.18 * scale},
                  {"hit set-up", 0.61 * scale},
                  {"emission", 0.15 * scale},
                  {"textures", 0.34 * scale},
                  {"light sampling", 0.55 * scale},
                  {"material evaluation", 1.12 * scale},
                  {"MIS", 0.21 * scale},
                  {"roulette", 0.24 * scale},
                  {"occluded", 0.72 * scale},
                  {"splat", is_path ? 0.0 : 0.31},
                  {"film", 0.16 * scale},
                  {"other", 0.42 * scale}};
    if (!is_path) {
        run.kinds.push_back(kind("light-subpath", 9.1, 8.1, 8.2, 10.1, 10.4, 0.88));
        run.kinds.push_back(kind("connection", 21.4, 18.0, 14.8, 26.0, 27.5, 0.55));
        run.kinds.push_back(kind("light-to-camera", 8.3, 16.0, 13.7, 21.0, 22.4, 0.72));
    }
    for (const RayKindReport& one : run.kinds) run.rays += one.rays;
    run.timing_share = 0.012;
    run.efficiency_single = is_path ? 0.61 : 0.43;
    run.efficiency_best = is_path ? 0.39 : 0.27;
    run.parallel_efficiency = threads == 1 ? 1.0 : 0.985 - 0.012 * threads;
    run.load_imbalance = threads == 1 ? 0.0 : 0.018;
    run.eye_paths = make_paths(2.9e6, 0.52);
    if (!is_path) run.light_paths = make_paths(2.1e6, 0.8);
    for (int i = 0; i < 8; ++i)
        run.longest.push_back({140 + 7 * i, 150 + 5 * i, static_cast<std::uint32_t>(3 + 5 * i), 25 - i / 3});
    run.shadow_unoccluded = 0.62;
    run.light_sampling_used = 0.81;
    run.bsdf_met_light = 0.043;
    run.bsdf_absorbed = 0.007;
    if (is_path)
        run.hardware.values = {{"cycles", 1.96e10 * threads}, {"instructions", 3.1e10 * threads},
                               {"cache-references", 4.4e8},   {"cache-misses", 7.1e7},
                               {"branches", 3.9e9},           {"branch-misses", 8.8e7}};
    else
        run.hardware.unavailable =
            "The kernel does not let programs without privileges count: /proc/sys/kernel/perf_event_paranoid is 3.";
    run.heat_map = fmt::format("heat-{}-{}.exr", integrator, threads);
    run.heat_map_high = 6.1e-5 * scale;
    return run;
}

/// Makes a structure that is `times` as slow as a tree.
AcceleratorMeasure make_measure(const char* name, double times) {
    AcceleratorMeasure measure{.name = name,
                               .triangles = 640000,
                               .build_seconds = 0.4 / times,
                               .bytes = 30u << 20,
                               .nodes = 500000,
                               .references = 640000,
                               .depth = 31,
                               .picture = fmt::format("visits-{}.exr", name),
                               .picture_high = 60.0};
    for (const char* one : {"camera", "bounce", "shadow"})
        measure.kinds.push_back({one, {65536, 2.1e6 / times, 31.0 * times, 6.4 * times}, 3, times > 2.0 ? 1u : 0u});
    return measure;
}

AcceleratorReport make_accelerators() {
    AcceleratorReport report;
    report.measures = {make_measure("embree", 0.3), make_measure("bvh", 1.0), make_measure("grid", 4.0)};
    for (TracedKind& one : report.measures[0].kinds) one.traced.nodes = one.traced.triangles = std::nan("");
    for (double triangles = 100.0; triangles <= 1e6; triangles *= 10.0)
        for (const AcceleratorMeasure& measure : report.measures) {
            const TracedRays& traced = measure.kinds[0].traced;
            const double growth = std::log10(triangles) / 6.0;
            report.growth.push_back(
                {measure.name,
                 static_cast<std::uint64_t>(triangles),
                 1e-6 * triangles,
                 static_cast<std::uint64_t>(48.0 * triangles),
                 {32768, traced.rays_per_second / growth, traced.nodes * growth, traced.triangles}});
        }
    return report;
}

ProfileReport make_report(int threads) {
    ProfileReport report{.program = "etendue 0.8 \"sample\"",
                         .created = "2026-11-22T08:12:03Z",
                         .command = "etendue profile 'glass & </script><img src=x onerror=alert(1)>' -o out",
                         .scene = "Test data: </script><img src=x onerror=alert(1)>",
                         .scene_path = "scenes/test & data",
                         .width = kWidth,
                         .height = kHeight,
                         .max_depth = 24,
                         .processor = "made-up processor",
                         .processors = threads,
                         .isa = "AVX-512",
                         .ray_tracer = "Embree 3.13.5"};
    report.load = {{"start", 0.02},
                   {"read", 0.31},
                   {"decode textures", 0.44},
                   {"build BVH", 0.21},
                   {"compile materials", 0.05},
                   {"compile lights", 0.09}};
    report.first_pixel_seconds = 1.31;
    report.bvh = {0.21, 640000, 12800000, 20, 61u << 20, "medium, robust"};
    report.memory = {{"geometry", 44e6}, {"BVH", 61 << 20}, {"textures", 210e6},
                     {"film", 8.3e6},    {"waves", 3.1e6},  {"light structures", 1.4e6}};
    report.peak_memory_bytes = 412u << 20;
    report.notes = {"All numbers of this page are made up."};
    for (const char* integrator : {"path", "bdpt"}) {
        report.runs.push_back(make_run(integrator, 1));
        if (threads > 1) report.runs.push_back(make_run(integrator, threads));
    }
    report.accelerators = make_accelerators();
    ProfileReport before = report;
    for (double& seconds : before.runs.front().cpu_seconds) seconds *= 0.9;
    for (double& seconds : before.runs.back().cpu_seconds) seconds *= 1.2;
    before.created = "2026-11-01T10:00:00Z";
    before.isa = "AVX2";
    report.against = compare_profiles(before, report);
    return report;
}

void write_sample(const std::filesystem::path& directory, const ProfileReport& report) {
    ProfileImages images;
    for (const ProfileRun& run : report.runs) images[heat_map_key(run)] = encode_png(heat_map());
    if (report.accelerators)
        for (const AcceleratorMeasure& measure : report.accelerators->measures)
            images["visits/" + measure.name] = encode_png(heat_map());
    write_text(directory / "profile.json", to_json(report));
    write_text(directory / "index.html", make_profile_page(report, images));
    write_text(directory / "trace.json", to_chrome_trace(report));
    std::fputs(to_table(report).c_str(), stdout);
}

}  // namespace

}  // namespace etendue

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fputs("usage: sample_profile DIRECTORY THREADS [empty]\n", stderr);
        return 2;
    }
    std::filesystem::create_directories(argv[1]);
    const bool empty = argc > 3 && std::string_view(argv[3]) == "empty";
    etendue::ProfileReport nothing{.scene = "empty"};
    nothing.runs.push_back({.integrator = "path"});
    etendue::write_sample(argv[1], empty ? nothing : etendue::make_report(std::atoi(argv[2])));
    return 0;
}
