#include "render/render.h"

#include "api/picture_state.h"
#include "api/scene_state.h"
#include "output/software_name.h"
#include "picture/aov_setup.h"
#include "picture/integrator_choice.h"
#include "picture/render_setup.h"
#include "processor/ray_code.h"

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <etendue/render.h>
#include <fmt/format.h>

namespace etendue {

namespace {

constexpr int kMostThreads = 4096;

Message warning(std::string text) {
    return {Message::Kind::Warning, {}, {}, std::move(text)};
}

/// Notes about what was rendered.
void report(const ImageDescription& image, const World& world, std::vector<Message>& messages) {
    const WorldStatistics textures = world.statistics();
    if (textures.failed_texture_lookups > 0)
        messages.push_back(warning(fmt::format("{} texture look-ups met broken pixels and read black: {}",
                                               textures.failed_texture_lookups, textures.first_texture_failure)));
    if (image.statistics.dropped_samples > 0)
        messages.push_back(warning(
            fmt::format("{} samples were not finite numbers and were left out", image.statistics.dropped_samples)));
    if (const auto note = few_buckets(image.statistics)) messages.push_back({Message::Kind::Note, {}, {}, *note});
}

ProgressCallback to_callback(const RenderControl& control) {
    return [&control](const RenderProgress& now) {
        if (control.progress) control.progress({now.fraction, now.seconds, now.samples, now.rays});
    };
}

}  // namespace

Picture render(Scene scene, const RenderControl& control) {
    const GivenSettings given = std::move(scene.state_->given);
    return translating(given, [&] {
        if (control.threads < 0 || control.threads > kMostThreads)
            throw failure(Error::Kind::Failed,
                          fmt::format("threads is {}; it can be 0 to {}", control.threads, kMostThreads));
        const ThreadPool threads(control.threads);
        auto state = std::make_unique<Picture::State>(Picture::State{
            .image = {}, .colors = ColorConfig::from_environment(), .inputs = {}, .messages = {}, .layers = {}});
        SceneDesc description = std::move(scene.state_->scene);
        state->inputs = description.files_to_keep();

        ProblemList problems;
        const std::vector<std::string> to_choose = replace_auto(description.settings);
        RenderOptions options = make_render_options(description.settings);
        (void)create_integrator(description.settings);
        const AovPlan aovs = make_aov_plan(description, problems);
        options.aovs = aovs.set;
        const std::string space = resolve_colors(description.settings, state->colors);
        state->image = describe_settings(description, aovs);
        RenderSettings settings = description.settings;
        const World world =
            ray_code().compile_world(std::move(description), state->colors, space, threads, problems, {});
        describe_camera(state->image, world);
        if (!to_choose.empty()) {
            settings.integrator.type = choose_integrator(world, settings, to_choose, threads).integrator;
            options.adaptive = make_render_options(settings).adaptive;
            describe_integrator(state->image, settings);
        }
        const std::unique_ptr<const Integrator> integrator = create_integrator(settings);
        for (const Problem& problem : problems.all()) state->messages.push_back(to_message(problem, given));
        for (std::string& note : notes_on(world, *integrator, settings))
            state->messages.push_back({Message::Kind::Note, {}, {}, std::move(note)});

        std::atomic<bool> stop = false;
        const std::stop_callback on_stop(control.stop, [&stop] { stop = true; });
        const RenderResult rendered = render(world, *integrator, options, threads, stop, to_callback(control), {},
                                             make_render_state(options, aovs.has_halves));
        describe_state(state->image, rendered, rendered.halt_reason != HaltReason::Interrupted,
                       halt_reason_name(rendered.halt_reason));
        resolve_layers(state->image, rendered);
        report(state->image, world, state->messages);
        return Picture(std::move(state));
    });
}

std::string_view version() {
    return software_name();
}

}  // namespace etendue
