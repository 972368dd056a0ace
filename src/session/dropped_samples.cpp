#include "session/dropped_samples.h"

#include "core/byte_size.h"
#include "core/log.h"
#include "process/shell_word.h"

#include <fmt/format.h>

namespace etendue {

void report_dropped(const RenderCounters& counters, const std::filesystem::path& scene,
                    const SettingsOverrides& overrides, const RenderSettings& settings,
                    const std::string& working_space) {
    if (counters.dropped == 0) return;
    const DroppedSample& first = counters.first_dropped.front();
    // A part of an image keeps splats for all of it, as an image of the one pixel would not.
    std::string command = fmt::format(
        "etendue render {} --integrator {} --max-depth {} --size {}x{} --crop {},{},{},{} --samples {}:{} --seed {} "
        "--working-space {}",
        quoted(scene.string()), settings.integrator.type, settings.integrator.max_depth, settings.film.width,
        settings.film.height, first.x, first.y, first.x + 1, first.y + 1, first.sample, first.sample + 1, settings.seed,
        quoted(working_space));
    if (overrides.min_depth) command += fmt::format(" --min-depth {}", *overrides.min_depth);
    if (overrides.light_samples) command += fmt::format(" --light-samples {}", *overrides.light_samples);
    if (const auto& strategy = settings.integrator.strategy)
        command += fmt::format(" --strategy {},{}{}", (*strategy)[0], (*strategy)[1],
                               settings.integrator.weighted ? "" : " --unweighted");
    if (overrides.heuristic)
        command += *overrides.heuristic == HeuristicType::Power ? " --heuristic power" : " --heuristic balance";
    if (const auto& cached = overrides.cached_connections)
        command += " --bdpt-connections " + (*cached > 0 ? fmt::format("cache:{}", *cached) : "pairwise");
    if (overrides.clamp_indirect) command += fmt::format(" --clamp-indirect {}", *overrides.clamp_indirect);
    if (overrides.texture_memory) command += " --texture-memory " + to_byte_size(*overrides.texture_memory);
    if (!settings.camera.empty()) command += " --camera " + quoted(settings.camera);
    if (settings.time_code) command += fmt::format(" --time-code {}", *settings.time_code);
    if (settings.frame) command += fmt::format(" --frames {} --fps {}", *settings.frame, settings.fps);
    if (settings.shutter.is_open())
        command += fmt::format(" --shutter {}:{}", settings.shutter.open, settings.shutter.close);
    if (!settings.animation.empty()) command += " --animation " + quoted(settings.animation);
    if (!settings.variant.empty()) command += " --variant " + quoted(settings.variant);
    if (overrides.light_units) command += fmt::format(" --light-units {}", light_units_name(settings.light_units));
    if (overrides.environment) command += " --environment " + quoted(*overrides.environment);
    for (const std::filesystem::path& directory : overrides.moment.assets)
        command += " --assets " + quoted(directory.string());
    log_warning(
        "warning: {} samples were not finite and were dropped; the first is sample {} of pixel ({}, {}). To see it "
        "alone: {}",
        counters.dropped, first.sample, first.x, first.y, command);
}

}  // namespace etendue
