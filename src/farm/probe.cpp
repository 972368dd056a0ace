#include "farm/probe.h"

#include "core/process_time.h"
#include "farm/farm_needs.h"
#include "picture/aov_setup.h"
#include "picture/integrator_choice.h"
#include "picture/render_setup.h"
#include "process/peak_memory.h"
#include "processor/ray_code.h"
#include "render/progressive_render.h"
#include "render/tiles.h"
#include "session/image_outline.h"
#include "session/interrupt.h"
#include "session/phase_timer.h"
#include "session/prepared_scene.h"
#include "session/sequence_choice.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

namespace etendue {

namespace {

constexpr double kSeconds = 1.0;

struct ShortRender {
    double seconds_per_spp = 0.0;  ///< for one sample of every pixel
    std::uint64_t deep_bytes = 0;  ///< that bins of depth have taken, which grow with the samples; 0 without such
};

/// Renders for about kSeconds, a tile at least.
ShortRender render_shortly(const World& world, const Integrator& integrator, const RenderOptions& options,
                           const ThreadPool& threads) {
    // Memory for large images may take longer than all of the time that there is for rendering.
    ProgressiveRender rendering(world, integrator, options, threads);
    const PhaseTimer timer;
    std::atomic<bool> has_tile = false;
    const auto enough = [&] { return interrupt_requested().load() || (has_tile && timer.elapsed().wall > kSeconds); };
    const RenderState& state = rendering.state();
    while (!enough() && state.spp_done < options.spp)
        rendering.add_samples(pass_size(state.spp_done, options.spp), enough,
                              [&](std::uint64_t, std::uint64_t) { has_tile = true; });
    const double spp = static_cast<double>(state.counters.samples) / static_cast<double>(options.window.area());
    return {state.wall_seconds / std::max(spp, 1e-9), state.film.layers().deep().bytes()};
}

}  // namespace

std::string probe(const ImageJob& job, const SettingsOverrides& overrides, const ThreadPool& threads) {
    SettingsOverrides given = overrides;
    given.frame = job.frame;
    PreparedScene prepared = prepare_scene(job.scene, given);
    const ColorConfig colors = ColorConfig::from_environment();
    const ImageOutline outline = outline_of(prepared.scene);
    const FilmSize film_size = film_size_of(prepared.scene);
    const std::vector<std::string> to_choose = replace_auto(prepared.scene.settings);
    RenderSettings settings = prepared.scene.settings;
    const std::string working_space = resolve_colors(settings, colors);
    RenderOptions options = make_render_options(settings);
    options.aovs = make_aov_plan(prepared.scene, prepared.problems).set;
    std::optional<IntegratorChoice> of_sequence;
    if (!to_choose.empty() && job.first_frame.value_or(job.frame.value_or(0)) != job.frame.value_or(0))
        of_sequence = choose_in_frame(job.scene, overrides, *job.first_frame, colors, threads);
    const PhaseTimer build_timer;
    const World world =
        ray_code().compile_world(std::move(prepared.scene), colors, working_space, threads, prepared.problems, {});
    if (!to_choose.empty())
        settings.integrator.type =
            of_sequence ? of_sequence->integrator : choose_integrator(world, settings, to_choose, threads).integrator;
    const auto integrator = create_integrator(settings);
    const PhaseTime build = build_timer.elapsed();
    // Each process also sets up colours and loads libraries, which takes most of the time of small images.
    const double start = std::max(seconds_since_process_start(), prepared.load.wall + build.wall);
    const ShortRender rendered = render_shortly(world, *integrator, options, threads);

    const double limit = settings.time_limit;
    const double all = rendered.seconds_per_spp * static_cast<double>(options.spp);
    const std::uint64_t peak = peak_memory_bytes();
    const double memory = kMemorySafety * memory_of_render(peak, rendered.deep_bytes, film_size);
    const nlohmann::ordered_json json{{"scene", job.scene.string()},
                                      {"width", outline.width},
                                      {"height", outline.height},
                                      {"spp", outline.spp},
                                      {"integrator", settings.integrator.type},
                                      {"camera", outline.camera},
                                      {"threads", threads.thread_count()},
                                      {"load_seconds", prepared.load.wall},
                                      {"build_seconds", build.wall},
                                      {"start_seconds", start},
                                      {"seconds_per_spp", rendered.seconds_per_spp},
                                      {"estimated_seconds", start + (limit > 0.0 ? std::min(all, limit) : all)},
                                      {"peak_memory_bytes", peak},
                                      {"estimated_memory_bytes", static_cast<std::uint64_t>(memory)},
                                      {"deep_bytes", rendered.deep_bytes}};
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace etendue
