#include "session/scene_render.h"

#include "color/color_config.h"
#include "core/log.h"
#include "image/image_module.h"
#include "output/auto_exposure.h"
#include "output/preview_png.h"
#include "picture/aov_setup.h"
#include "picture/description_text.h"
#include "picture/image_description.h"
#include "picture/integrator_choice.h"
#include "picture/output_paths.h"
#include "picture/render_setup.h"
#include "processor/ray_code.h"
#include "render/brightest_paths.h"
#include "render/checkpoint.h"
#include "render/render.h"
#include "session/brightest_list.h"
#include "session/checkpoint_files.h"
#include "session/dropped_samples.h"
#include "session/image_files.h"
#include "session/image_outline.h"
#include "session/input_files.h"
#include "session/interrupt.h"
#include "session/library_versions.h"
#include "session/output_checks.h"
#include "session/phase_timer.h"
#include "session/progress_display.h"
#include "session/progress_pipe.h"
#include "session/render_identity.h"
#include "session/sequence_choice.h"
#include "session/showing_times.h"
#include "session/world_statistics.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// One render, step by step.
class SceneRender {
  public:
    SceneRender(PreparedScene prepared, const SceneRenderRequest& request, const ThreadPool& threads)
        : request_(request),
          threads_(threads),
          problems_(std::move(prepared.problems)),
          scene_(std::move(prepared.scene)),
          output_(request.output.empty() ? std::filesystem::path(scene_.name + ".exr") : request.output),
          paths_(OutputPaths::beside(output_, request.overrides.png)),
          checkpoints_(output_),
          progress_pipe_(request.progress_descriptor) {
        for (RenderWatcher* const watcher : request_.watchers)
            watcher->begin(request_.title.empty() ? scene_.name : request_.title, output_);
        enter("load");
        if (!is_partial(output_)) image_module_ = load_image_module_early();
        report_problems();
        // Before names are resolved: batch compares it with that of a scene that was only prepared.
        const std::string hash = settings_hash(scene_, request_.overrides.depth);
        RenderSettings of_whole = scene_.settings;
        of_whole.film.crop.reset();
        const std::string hash_of_whole =
            scene_.settings.film.crop ? settings_hash(scene_, of_whole, request_.overrides.depth) : hash;
        const std::string requested = requested_settings(scene_.settings);
        to_choose_ = replace_auto(scene_.settings);
        options_ = options_of(scene_.settings);
        integrator_ = create_integrator(scene_.settings);
        aovs_ = make_aov_plan(scene_, problems_);
        report_problems();
        options_.aovs = aovs_.set;
        check_outputs({request_, output_, scene_, aovs_, options_, *integrator_});
        hash_inputs(scene_, prepared.inputs);
        describe_scene(prepared, requested);
        description_.statistics.settings_hash = hash;
        description_.statistics.hash_of_whole = hash_of_whole;
    }

    SceneRenderResult run() {
        std::optional<Checkpoint> kept = read_kept();
        if (kept && is_finished_part(*kept)) {
            tell_watchers("finished");
            return finished_part(*kept);
        }
        if (kept && !request_.quiet)
            log_info("{}: going on after {} of {} samples per pixel", output_.string(), kept->state.spp_done,
                     options_.spp);
        if (kept) {
            description_.statistics.seconds_before = kept->state.wall_seconds;
            description_.statistics.rays_before = kept->state.counters.rays.total();
        }
        std::optional<IntegratorChoice> chosen;
        if (!to_choose_.empty()) chosen = choice_from_elsewhere(kept);
        const World world = compile();
        if (!to_choose_.empty()) choose(world, std::move(chosen));
        for (const std::string& note : notes_on(world, *integrator_, settings_)) tell("note: " + note);
        require_image_module();
        const SomethingToKeep kept_from_signals;
        RenderResult rendered = render_from(world, kept ? std::move(kept->state) : new_state());
        find_brightest_paths(world, *integrator_, options_, rendered);
        report_dropped(rendered.counters, request_.scene, request_.overrides, settings_);
        fill_texture_statistics(world, description_.statistics);
        require_not_lost();
        const bool interrupted = rendered.halt_reason == HaltReason::Interrupted;
        if (interrupted && rendered.counters.samples > 0) {
            const bool is_kept = write_checkpoint(rendered);
            if (!request_.quiet)
                log_info("{}: stopped after {} of {} samples per pixel{}", output_.string(), rendered.spp_done,
                         options_.spp, is_kept ? "; --resume goes on from there" : "");
        }
        // An earlier image is worth more than a black one.
        if (!interrupted || rendered.counters.samples > 0) write(world, rendered, !interrupted);
        if (request_.overrides.has("/brightest") && !request_.quiet) list_brightest(description_.statistics);
        if (!interrupted) tidy_after(rendered);
        tell_watchers(interrupted ? "stopped" : "finished");
        return {std::move(description_.statistics), output_, interrupted, false};
    }

  private:
    [[nodiscard]] RenderOptions options_of(const RenderSettings& settings) const {
        return is_partial(output_) ? make_part_options(settings, request_.samples) : make_render_options(settings);
    }

    void enter(std::string_view phase) const {
        progress_pipe_.enter(phase);
        tell_watchers(phase);
    }

    void tell_watchers(std::string_view phase) const {
        for (RenderWatcher* const watcher : request_.watchers) watcher->enter(phase);
    }

    [[nodiscard]] bool is_lost() const { return request_.is_lost != nullptr && *request_.is_lost; }

    void require_not_lost() const {
        if (is_lost()) throw LostRender();
    }

    /// A render of hours must not end with an image that nothing can write. Does not wait for what is being loaded,
    /// which fails at once if at all.
    void require_image_module() {
        if (image_module_.valid() && image_module_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
            image_module_.get();
    }

    void report_problems() {
        for (; reported_ < problems_.all().size(); ++reported_) tell(problems_.all()[reported_].str());
    }

    /// Writes `text` to stderr unless it was told of an earlier image.
    void tell(const std::string& text) const {
        if (!request_.quiet && (request_.told == nullptr || request_.told->insert(text).second))
            log_warning("{}", text);
    }

    void describe_scene(PreparedScene& prepared, const std::string& requested) {
        const std::string working_space = resolve_colors(scene_.settings, colors_);
        description_ = describe_settings(scene_, aovs_);
        description_.depth = request_.overrides.depth;
        RenderStatistics& s = description_.statistics;
        s.camera = outline_of(scene_).camera;
        s.load = prepared.load;
        s.inputs = std::move(prepared.inputs);
        s.requested_settings = requested;
        s.command = request_.command;
        s.threads = threads_.thread_count();
        s.libraries = library_versions();
        s.instruction_set = instruction_set_name(ray_code().instruction_set);
        identity_ = render_identity(scene_, s.inputs, working_space);
        settings_ = scene_.settings;
        if (to_choose_.empty()) return;
        RenderSettings asked = settings_;
        asked.integrator.type = kAutoIntegrator;
        for (const auto& [name, text] : settings_identity(asked)) identity_[name] = text;
    }

    [[nodiscard]] std::uint32_t first_sample() const { return request_.samples ? request_.samples->begin : 0; }

    [[nodiscard]] RenderState new_state() const {
        RenderState state = make_render_state(options_, aovs_.has_halves);
        state.first_sample = first_sample();
        return state;
    }

    /// Returns what has most samples: a checkpoint, or a part or sums that were rendered before.
    [[nodiscard]] std::optional<Checkpoint> read_kept() const {
        if (!request_.resume) return std::nullopt;
        enter("resume");
        const bool has_second_film = keeps_every_other_pass(options_, aovs_.has_halves);
        const CheckpointFiles::Expected expected =
            is_partial(output_) ? expected_part(identity_, options_, first_sample(), has_second_film)
                                : expected_image(identity_, options_, has_second_film);
        std::optional<Checkpoint> kept = checkpoints_.read(expected, request_.quiet);
        if (is_partial(output_) && !request_.force) {
            std::optional<Checkpoint> part = read_part(output_, expected, request_.quiet);
            if (part && (!kept || part->state.spp_done >= kept->state.spp_done)) kept = std::move(part);
        }
        if (!kept && !is_partial(output_))
            kept = read_sums(sums_path(output_), expected, static_cast<int>(options_.spp), request_.quiet);
        return kept;
    }

    /// One that was to be shown otherwise has all samples but is written again: its merged image would be shown so,
    /// too.
    [[nodiscard]] bool is_finished_part(const Checkpoint& kept) const {
        return is_partial(output_) && std::filesystem::exists(output_) && kept.state.pass_size == 0 &&
               kept.state.spp_done == options_.spp &&
               description_of(kept, output_).statistics.settings_hash == description_.statistics.settings_hash;
    }

    /// Returns the result of a part that needs nothing to be done, from the part `kept`.
    [[nodiscard]] SceneRenderResult finished_part(const Checkpoint& kept) const {
        ImageDescription description = description_of(kept, output_);
        describe_state(description, kept.state, true, halt_reason_name(HaltReason::SamplesDone));
        return {std::move(description.statistics), output_, false, true};
    }

    [[nodiscard]] World compile() {
        enter("build");
        const PhaseTimer timer;
        World world = ray_code().compile_world(std::move(scene_), colors_, settings_.color.working_space, threads_,
                                               problems_, {});
        report_problems();
        for (const Problem& problem : problems_.all())
            if (problem.severity == Severity::Warning) description_.statistics.warnings.push_back(problem.str());
        description_.statistics.build = timer.elapsed();
        fill_world_statistics(world, description_.statistics);
        describe_camera(description_, world);
        return world;
    }

    /// Returns the integrator that was chosen for what is gone on with, or else for the sequence: in its first frame,
    /// or in the first that lies beside this one. None if this image alone decides.
    [[nodiscard]] std::optional<IntegratorChoice> choice_from_elsewhere(const std::optional<Checkpoint>& kept) const {
        const auto can_serve = [&](const std::string& name) {
            return std::ranges::find(to_choose_, name) != to_choose_.end();
        };
        if (kept) {
            const RenderStatistics before = description_of(*kept, output_).statistics;
            if (can_serve(before.integrator)) return IntegratorChoice{before.integrator, before.integrator_choice};
        }
        const std::optional<int> frame = description_.statistics.frame;
        if (!frame) return std::nullopt;
        if (!is_partial(output_))
            if (auto earlier = choice_of_sequence(paths_.json, description_.statistics);
                earlier && can_serve(earlier->integrator))
                return earlier;
        if (request_.first_frame.value_or(*frame) == *frame) return std::nullopt;
        return choose_in_frame(request_.scene, request_.overrides, *request_.first_frame, colors_, threads_);
    }

    /// Takes the integrator that was chosen elsewhere or has a pilot choose, and all that depends on it follow. The
    /// identity names what was asked for: with the scene and the program it decides what is chosen.
    void choose(const World& world, std::optional<IntegratorChoice> chosen) {
        const PhaseTimer timer;
        const IntegratorChoice choice =
            chosen ? *std::move(chosen) : choose_integrator(world, settings_, to_choose_, threads_);
        settings_.integrator.type = choice.integrator;
        options_.adaptive = options_of(settings_).adaptive;
        integrator_ = create_integrator(settings_);
        require_depths_of_part(output_, options_, aovs_, *integrator_);
        describe_integrator(description_, settings_);
        description_.statistics.integrator_choice = choice.reason;
        const PhaseTime taken = timer.elapsed();
        description_.statistics.build.wall += taken.wall;
        description_.statistics.build.cpu += taken.cpu;
        // Who takes progress as JSON says itself what it is about.
        const std::string of = request_.progress_descriptor >= 0 ? "" : title() + ": ";
        if (!request_.quiet) log_info("{}auto chose {}", of, choice.reason);
    }

    [[nodiscard]] RenderResult render_from(const World& world, RenderState state) {
        ProgressDisplay display(title(), request_.quiet || request_.progress_descriptor >= 0);
        PhaseTimer since_checkpoint;
        // Each checkpoint has samples that the previous one lacks, however often checkpoints are asked for.
        std::atomic<bool> has_new_samples = false;
        const auto checkpoint_is_due = [&] {
            return request_.checkpoint_minutes > 0.0 && has_new_samples &&
                   since_checkpoint.elapsed().wall >= request_.checkpoint_minutes * 60.0;
        };
        ShowingTimes showings;
        const auto image_is_due = [&] {
            return showings.is_due() &&
                   std::ranges::any_of(request_.watchers, [](const RenderWatcher* w) { return w->wants_image(); });
        };
        tell_watchers("render");
        const RenderPause pause{
            [&] { return preview_requested() || checkpoint_is_due() || is_lost() || image_is_due(); },
            [&](const RenderState& now) {
                require_not_lost();
                if (image_is_due()) {
                    showings.begin();
                    show(now);
                }
                if (preview_requested()) write_preview(now);
                if (!checkpoint_is_due()) return;
                write_checkpoint(now);
                since_checkpoint = {};
                has_new_samples = false;
            }};
        return render(
            world, *integrator_, options_, threads_, interrupt_requested(),
            [&](const RenderProgress& now) {
                has_new_samples = true;
                display.update(now);
                progress_pipe_.update(now);
                showings.go_on();
                for (RenderWatcher* const watcher : request_.watchers) watcher->update(now);
            },
            pause, std::move(state));
    }

    /// False if it could not be written. A disk that is full must not end a render: it may have room again by the end.
    bool write_checkpoint(const RenderState& state) const {
        try {
            checkpoints_.write(identity_, to_text(description_), state);
            return true;
        } catch (const IoError& error) {
            log_error("error: no checkpoint was written: {}", error.what());
            return false;
        }
    }

    /// Leaves the files of a finished image, and its sums if they are to be kept.
    void tidy_after(const RenderResult& rendered) const {
        checkpoints_.remove();
        if (is_partial(output_)) return;
        remove_preview(output_);
        const bool are_sums_kept =
            request_.keep_sums_after && description_.statistics.render.wall >= *request_.keep_sums_after;
        keep_sums(output_, are_sums_kept, identity_, to_text(description_), rendered);
    }

    /// Shows the image as it is to whoever looks on.
    void show(const RenderState& state) const {
        ImageDescription now = description_;
        describe_state(now, state, false, "under way");
        resolve_layers(now, state);
        for (RenderWatcher* const watcher : request_.watchers) watcher->show(now);
    }

    void write_preview(const RenderState& state) {
        clear_preview_request();
        const std::filesystem::path path = preview_path(output_);
        if (const std::filesystem::path other = std::filesystem::path(path).replace_extension(".json");
            std::filesystem::exists(other)) {
            log_error("error: no preview was written: {} belongs to an image of its own, as {} tells", path.string(),
                      other.string());
            return;
        }
        ImageDescription now = description_;
        describe_state(now, state, false, "preview");
        choose_missing_exposure(now.frame);
        try {
            write_preview_png(path, now.frame, colors_);
            // Of a pass that was stopped, some pixels have samples.
            const double spp =
                static_cast<double>(state.counters.samples) / static_cast<double>(options_.window.area());
            if (!request_.quiet)
                log_info("{}: preview after {} samples per pixel", path.string(),
                         spp < 10.0 ? fmt::format("{:.2g}", spp) : fmt::format("{:.0f}", spp));
        } catch (const IoError& error) {
            log_error("error: {}", error.what());
        }
    }

    /// Returns options with which strategies get the samples that every pixel of the image has, whatever ended it.
    [[nodiscard]] RenderOptions options_of_strategies(const RenderState& rendered) const {
        RenderOptions options = options_;
        options.spp = static_cast<int>(rendered.spp_done);
        options.relative_error = 0.0;
        options.time_limit_seconds = 0.0;
        return options;
    }

    void write(const World& world, const RenderResult& rendered, bool complete) {
        enter("write");
        describe_state(description_, rendered, complete, halt_reason_name(rendered.halt_reason));
        if (is_partial(output_)) {
            if (complete) etendue::write_checkpoint(output_, identity_, to_text(description_), rendered);
            return;
        }
        if (const auto note = few_buckets(description_.statistics); note && !request_.quiet)
            log_warning("note: {}: {}", output_.string(), *note);
        note_error(rendered.halt_reason);
        resolve_layers(description_, rendered);
        for (RenderWatcher* const watcher : request_.watchers) watcher->show(description_);
        const PixelDepth depth = request_.overrides.depth;
        const std::vector<std::string> earlier = write_image_files(paths_, description_, colors_, depth, [&] {
            if (request_.strategies.output.empty() || !complete) return;
            if (write_strategies_image(request_.strategies, world, settings_.integrator,
                                       options_of_strategies(rendered), description_.frame, colors_, depth, threads_,
                                       title(), request_.quiet))
                description_.statistics.strategies_image =
                    strategies_shown(request_.strategies, settings_.integrator.lengths);
        });
        if (request_.quiet) return;
        note_brightest(paths_, description_.frame, colors_, depth);
        note_exposure(paths_, description_.statistics);
        note_earlier_files(earlier);
    }

    /// Says so if there were no more samples before the error was as small as was asked for.
    void note_error(HaltReason halt_reason) const {
        const double wanted = options_.relative_error;
        const double error = description_.statistics.relative_error.value_or(0.0);
        if (request_.quiet || halt_reason != HaltReason::SamplesDone || !(wanted > 0.0 && error > wanted)) return;
        log_warning("note: {}: error {:.3g} in place of {:g}: all {} samples were taken first; give a larger --spp",
                    output_.string(), error, wanted, options_.spp);
    }

    [[nodiscard]] const std::string& title() const {
        return request_.title.empty() ? description_.statistics.scene : request_.title;
    }

    const SceneRenderRequest& request_;
    const ThreadPool& threads_;
    ProblemList problems_;
    std::size_t reported_ = 0;
    SceneDesc scene_;  ///< until it is compiled
    std::filesystem::path output_;
    OutputPaths paths_;
    CheckpointFiles checkpoints_;
    ProgressPipe progress_pipe_;
    std::future<void> image_module_;  ///< while it is loaded; of a part, which is no image, none
    RenderOptions options_;
    std::vector<std::string> to_choose_;  ///< integrators that a pilot is to choose from; empty if one was asked for
    std::unique_ptr<const Integrator> integrator_;
    AovPlan aovs_;
    ColorConfig colors_ = ColorConfig::from_environment();
    RenderSettings settings_;  ///< with names of colour spaces resolved
    RenderIdentity identity_;
    ImageDescription description_;
};

}  // namespace

SceneRenderResult render_scene(PreparedScene prepared, const SceneRenderRequest& request, const ThreadPool& threads) {
    return SceneRender(std::move(prepared), request, threads).run();
}

}  // namespace etendue
