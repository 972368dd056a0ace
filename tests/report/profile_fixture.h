// A profile that was made up, with something in every part.
#pragma once

#include "report/profile_report.h"

#include <vector>

namespace etendue::test {

inline ProfileRun made_up_run(int threads, std::vector<double> cpu_seconds) {
    ProfileRun run{.integrator = "path",
                   .threads = threads,
                   .spp = 16,
                   .seconds = {2.0, 1.0, 4.0},
                   .cpu_seconds = std::move(cpu_seconds),
                   .instrumented_seconds = 2.5,
                   .samples = 1000,
                   .rays = 6000};
    run.kinds = {{.kind = "camera",
                  .rays = 1000,
                  .seconds = 0.5,
                  .recorded = 100,
                  .single = 4e3,
                  .packet8 = 8e3,
                  .packet16 = 1.6e4,
                  .hit_share = 0.75},
                 {.kind = "shadow", .rays = 5000, .seconds = 1.0}};
    run.stages = {{"generate", 0.5}, {"intersect", 0.5}, {"occluded", 1.0}, {"other", 1.0}};
    run.efficiency_single = 0.625;
    run.tiles = {{.rect = {0, 0, 32, 32},
                  .thread = 0,
                  .first_sample = 0,
                  .start = 0.0,
                  .end = 0.25,
                  .cpu_seconds = 0.2,
                  .samples = 1000},
                 {.rect = {32, 0, 64, 32},
                  .thread = 1,
                  .first_sample = 0,
                  .start = 0.0,
                  .end = 0.5,
                  .cpu_seconds = 0.4,
                  .samples = 1000},
                 {.rect = {0, 0, 32, 32},
                  .thread = 1,
                  .first_sample = 1,
                  .start = 0.5,
                  .end = 1.25,
                  .cpu_seconds = 0.6,
                  .samples = 1000}};
    run.eye_paths = {.endings = {{"left the scene", 750.0}, {"roulette", 250.0}}, .lengths = {0, 600, 300, 100}};
    run.light_paths = {.endings = {{"left the scene", 300.0}, {"roulette", 100.0}}, .lengths = {0, 300, 0, 100}};
    run.longest = {{.x = 3, .y = 4, .sample = 5, .vertices = 9}};
    run.shadow_unoccluded = 0.5;
    run.scene_hits = {.materials = {{"red", 900.0, 0.3}, {"green", 100.0, 0.15}},
                      .objects = {{"box", 1000.0, 0.9}},
                      .textures = {},
                      .lamps = {{"lamp", 4000.0, 3000.0, 0.8}, {"lights without a surface", 1000.0, 1000.0, 0.2}}};
    run.hardware.values = {{"cycles", 2e9}, {"instructions", 3e9}};
    run.heat_map = "heat-path-2.exr";
    return run;
}

inline ProfileReport made_up_profile() {
    ProfileReport report{.program = "etendue 0.8",
                         .created = "2026-11-22T08:00:00Z",
                         .command = "etendue profile box -o out",
                         .scene = "box",
                         .scene_path = "scenes/box",
                         .width = 64,
                         .height = 32,
                         .max_depth = 12,
                         .seed = 7,
                         .settings = {{"film", "film: filter box"}, {"sampler", "sobol"}},
                         .processor = "made up",
                         .processors = 2,
                         .memory_nodes = 2,
                         .isa = "AVX2",
                         .ray_tracer = "Embree 3.13.5"};
    report.load = {{"read", 0.25}, {"compile", 0.5}};
    report.first_pixel_seconds = 0.875;
    report.bvh = {.build_seconds = 0.5,
                  .triangles = 1000,
                  .instanced_triangles = 4000,
                  .instances = 4,
                  .bytes = 64000,
                  .quality = "medium, robust"};
    report.memory = {{"geometry", 1 << 20}, {"film", 1 << 19}};
    report.peak_memory_bytes = 3u << 20;
    report.notes = {"made up"};
    report.accelerators = AcceleratorReport{
        .measures = {{.name = "bvh",
                      .triangles = 4000,
                      .build_seconds = 0.25,
                      .bytes = 128000,
                      .nodes = 3000,
                      .references = 4000,
                      .depth = 17,
                      .kinds = {{.kind = "camera", .traced = {1000, 2.5e6, 12.5, 3.25}, .ties = 2, .differ = 1}},
                      .picture = "visits-bvh.exr",
                      .picture_high = 40.0}},
        .growth = {{.name = "embree", .triangles = 98, .build_seconds = 0.125, .bytes = 9000, .traced = {500, 5e6}}}};
    report.runs = {made_up_run(1, {2.0, 2.02, 1.98}), made_up_run(2, {2.1, 2.11, 2.09})};
    return report;
}

}  // namespace etendue::test
