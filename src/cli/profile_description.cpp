#include "cli/profile_description.h"

#include "core/memory_nodes.h"
#include "core/source_date.h"
#include "output/software_name.h"
#include "picture/render_setup.h"
#include "processor/ray_code.h"
#include "report/profile_advice.h"
#include "report/profile_figures.h"
#include "session/render_identity.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <string>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns the processor's name as the system gives it; empty if the system gives none.
std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) {
            const std::size_t name = line.find_first_not_of(": \t", line.find(':'));
            return name == std::string::npos ? "" : line.substr(name);
        }
    return {};
}

/// Returns the settings that decide how much work a sample is, without those that each run sets itself.
std::map<std::string, std::string> settings_of_work(RenderSettings settings) {
    settings.integrator.type = "of each run";
    std::map<std::string, std::string> work = settings_identity(settings);
    work.erase("seed");
    if (settings.film.crop) work["crop"] = fmt::format("{}", fmt::join(*settings.film.crop, " "));
    if (settings.texture_memory) work["texture memory"] = fmt::format("{} bytes", *settings.texture_memory);
    return work;
}

/// Adds a note to `report` for each run whose time stamps took 1% of the run's time or more, as measuring must not be
/// what is measured.
void note_costly_stamps(ProfileReport& report) {
    constexpr double kMostShare = 0.01;
    for (const ProfileRun& run : report.runs)
        if (run.timing_share >= kMostShare)
            report.notes.push_back(
                fmt::format("{}, threads: {}: the time stamps took {:.1f}% of the time, more than the 1% they should; "
                            "figures of its stages hold "
                            "them, and larger images or more samples make them less",
                            run.integrator, run.threads, 100.0 * run.timing_share));
}

void note_other_work(ProfileReport& report) {
    if (const std::string note = busy_machine(report.runs); !note.empty()) report.notes.push_back(note);
    for (const ProfileRun& run : report.runs)
        if (const std::string note = disagreement_of_repetitions(run); !note.empty()) report.notes.push_back(note);
}

}  // namespace

void describe(ProfileReport& report, const RenderSettings& settings, const World& world) {
    const WorldStatistics of_world = world.statistics();
    report.program = software_name();
    report.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(creation_time()));
    report.width = settings.film.width;
    report.height = settings.film.height;
    if (const PixelRect window = make_render_options(settings).window;
        window != PixelRect{0, 0, report.width, report.height})
        report.crop = window;
    report.max_depth = settings.integrator.lengths.max_depth;
    report.seed = settings.seed;
    report.settings = settings_of_work(settings);
    report.processor = processor_name();
    report.processors = static_cast<int>(std::thread::hardware_concurrency());
    report.memory_nodes = std::max(1, static_cast<int>(memory_nodes().size()));
    report.isa = of_world.isa;
    report.ray_tracer = "Embree " + ray_tracer_version();
    report.bvh = {.build_seconds = of_world.bvh_build_seconds,
                  .triangles = of_world.triangles,
                  .instanced_triangles = of_world.instanced_triangles,
                  .instances = of_world.instances,
                  .bytes = of_world.bvh_bytes,
                  .quality = of_world.bvh_quality};
}

void describe_memory(ProfileReport& report, const World& world, const ProfileRuns& runs) {
    const WorldStatistics of_world = world.statistics();
    const auto bytes = [](std::size_t value) { return static_cast<double>(value); };
    report.memory = {{"geometry", bytes(of_world.geometry_bytes)},
                     {"instances", bytes(of_world.instance_bytes)},
                     {"BVH", bytes(of_world.bvh_bytes)},
                     {"materials", bytes(of_world.material_bytes)},
                     {"textures", bytes(of_world.texture_bytes)},
                     {"lights", bytes(of_world.light_bytes)},
                     {"film", bytes(runs.film_bytes)},
                     {"tiles and splats", bytes(runs.tile_bytes)},
                     {"waves", bytes(runs.wave_bytes)}};
    report.peak_memory_bytes = runs.peak_memory_bytes;
}

void note_doubtful_runs(ProfileReport& report) {
    note_costly_stamps(report);
    note_other_work(report);
}

}  // namespace etendue
