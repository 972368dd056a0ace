#include "farm/farm_work.h"

#include "color/color_config.h"
#include "core/byte_size.h"
#include "core/error.h"
#include "core/log.h"
#include "farm/farm_leftovers.h"
#include "farm/farm_needs.h"
#include "picture/aov_setup.h"
#include "picture/output_paths.h"
#include "picture/render_setup.h"
#include "session/input_files.h"
#include "session/interrupt.h"
#include "session/prepared_scene.h"
#include "session/render_identity.h"
#include "session/up_to_date.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace fs = std::filesystem;

namespace {

PreparedScene prepare_job(const ImageJob& job, const SettingsOverrides& overrides) {
    return prepare_scene(job.scene, overrides_of(job, overrides));
}

/// A first look at the files saves most images from being loaded.
bool is_done_already(const ImageJob& job, const SettingsOverrides& overrides) {
    const OutputPaths paths = OutputPaths::beside(job.output);
    if (why_unfinished(paths) || why_outdated(paths, job.scene)) return false;
    const PreparedScene prepared = prepare_job(job, overrides);
    return !why_outdated(paths, prepared.scene, overrides.depth);
}

WantedImage wanted_image(const ImageJob& job, const SettingsOverrides& overrides, const std::string& texture_memory) {
    PreparedScene prepared = prepare_job(job, overrides);
    SceneDesc& scene = prepared.scene;
    WantedImage wanted;
    // Before names are resolved, as `render` does.
    wanted.settings_hash = settings_hash(scene, overrides.depth);
    if (!scene.settings.texture_memory) scene.settings.texture_memory = parse_byte_size(texture_memory);
    const std::string working_space = resolve_colors(scene.settings, ColorConfig::from_environment());
    hash_inputs(scene, prepared.inputs);
    wanted.identity = render_identity(scene, prepared.inputs, working_space);
    wanted.has_halves = make_aov_plan(scene, prepared.problems).has_halves;
    wanted.settings = std::move(scene.settings);
    return wanted;
}

/// Holds what the images of one scene have in common.
struct SceneNeeds {
    std::vector<SampleRange> ranges;
    TaskNeeds needs;
    TaskNeeds merge_needs;
    std::string texture_memory;
};

class WorkFinder {
  public:
    WorkFinder(const FarmRequest& request, std::span<const FarmImageStatus> earlier) : request_(request) {
        for (const FarmImageStatus& status : earlier)
            if (status.state == FarmState::Running || status.state == FarmState::Pending)
                busy_.insert(status.image.output);
    }

    /// The images of one scene: the first that has to be made tells what they need.
    void add_scene(std::span<const BatchTask> tasks) {
        std::optional<SceneNeeds> needs;
        std::string error;
        for (const BatchTask& task : tasks) {
            if (interrupt_requested()) return;
            const ImageJob& job = task.job;
            if (busy_.contains(job.output)) {
                work_.busy.push_back(job);
                continue;
            }
            // What is wrong with one image of a scene is wrong with the others.
            if (error.empty()) {
                try {
                    add_image(task, needs);
                    continue;
                } catch (const std::exception& problem) {
                    // A probe that was interrupted is no fault of the scene.
                    if (interrupt_requested()) return;
                    error = problem.what();
                    log_error("{}: {}", job.name, error);
                }
            }
            work_.failed.push_back({job.name, job.scene, job.output, job.frame, {}, error});
        }
    }

    [[nodiscard]] FarmWork take() { return std::move(work_); }

  private:
    void add_image(const BatchTask& task, std::optional<SceneNeeds>& needs) {
        const ImageJob& job = task.job;
        for (const fs::path& path : {job.scene, job.output})
            if (!can_be_recorded(path.string()))
                throw SceneError({path.string(), ""}, "its name is not UTF-8; rename it to submit it");
        if (!request_.force && is_done_already(job, request_.overrides)) {
            work_.up_to_date.push_back(job);
            return;
        }
        if (!needs) needs = needs_of_scene(job);
        FarmImage image{job,          task.render_output, needs->ranges,        {},
                        needs->needs, needs->merge_needs, needs->texture_memory};
        FarmLeftovers leftovers = find_leftovers(image, request_.farm.output, [&] {
            return request_.force ? WantedImage() : wanted_image(job, request_.overrides, request_.texture_memory);
        });
        work_.useless.insert(work_.useless.end(), leftovers.useless.begin(), leftovers.useless.end());
        // Tasks leave an image alone that looks finished to them.
        if (request_.force) work_.useless.push_back(OutputPaths::beside(job.output).json);
        image.missing = std::move(leftovers.missing);
        work_.images.push_back(std::move(image));
    }

    [[nodiscard]] SceneNeeds needs_of_scene(const ImageJob& first) const {
        const PreparedScene prepared = prepare_job(first, request_.overrides);
        const RenderSettings& settings = prepared.scene.settings;
        SceneNeeds scene;
        if (!settings.texture_memory) scene.texture_memory = request_.texture_memory;
        if (request_.parts > 1) {
            if (settings.time_limit > 0.0)
                throw SceneError(settings.at("/time"), "a limit of time cannot be split; leave out --split-samples");
            if (settings.relative_error > 0.0)
                throw SceneError(settings.at("/error"), "a limit of error cannot be split; leave out --split-samples");
            scene.ranges = split_samples(static_cast<std::uint32_t>(settings.spp), request_.parts);
            if (scene.ranges.size() == 1) scene.ranges.clear();
        }
        const FilmSize size = film_size_of(prepared.scene);
        double share = scene.ranges.empty() ? 1.0 : 0.0;  // of the longest range
        for (const SampleRange& range : scene.ranges)
            share = std::max(share, static_cast<double>(range.end - range.begin) / settings.spp);
        if (!request_.task_minutes || !request_.task_memory)
            scene.needs = needs_of(probe_scene(first, request_.farm.options), size, share, request_.farm.threads);
        scene.needs.warning_seconds = warning_seconds_for(size);
        scene.merge_needs = merge_needs_of(size, scene.ranges.size());
        if (request_.task_minutes) {
            scene.needs.minutes = *request_.task_minutes;
            scene.merge_needs.minutes = std::max(scene.merge_needs.minutes, *request_.task_minutes);
        }
        if (request_.task_memory) scene.needs.mebibytes = static_cast<int>(*request_.task_memory >> 20u);
        return scene;
    }

    const FarmRequest& request_;
    std::set<fs::path> busy_;
    FarmWork work_;
};

}  // namespace

FarmWork find_farm_work(const FarmRequest& request, std::span<const BatchTask> tasks,
                        std::span<const FarmImageStatus> earlier) {
    WorkFinder finder(request, earlier);
    while (!tasks.empty() && !interrupt_requested()) {
        const auto other = std::ranges::find_if(
            tasks, [&](const BatchTask& task) { return task.job.scene != tasks.front().job.scene; });
        const auto count = static_cast<std::size_t>(other - tasks.begin());
        finder.add_scene(tasks.first(count));
        tasks = tasks.subspan(count);
    }
    return finder.take();
}

}  // namespace etendue
