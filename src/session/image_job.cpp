#include "session/image_job.h"

#include "picture/output_paths.h"
#include "session/checkpoint_files.h"
#include "session/up_to_date.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

const char* outcome_name(ImageOutcome outcome) {
    switch (outcome) {
        case ImageOutcome::Rendered:
            return "rendered";
        case ImageOutcome::UpToDate:
            return "up to date";
        case ImageOutcome::Failed:
            return "failed";
        case ImageOutcome::Interrupted:
            return "interrupted";
    }
    return "?";
}

std::filesystem::path frame_path(const std::filesystem::path& output, int frame) {
    constexpr std::size_t kLeastDigits = 4;
    std::string stem = output.stem().string();
    const std::size_t end = stem.find_last_of('#');
    if (end == std::string::npos) {
        stem += fmt::format(".{}{:0{}}", frame < 0 ? "-" : "", std::abs(frame), kLeastDigits);
    } else {
        const std::size_t before = stem.find_last_not_of('#', end);
        const std::size_t begin = before == std::string::npos ? 0 : before + 1;
        const std::size_t length = end + 1 - begin;
        stem.replace(begin, length,
                     fmt::format("{}{:0{}}", frame < 0 ? "-" : "", std::abs(frame), std::max(length, kLeastDigits)));
    }
    return output.parent_path() / (stem + output.extension().string());
}

std::optional<FrameRange> frames_of(const std::filesystem::path& scene, const SettingsOverrides& overrides) {
    if (overrides.has("/frames")) return overrides.frames();
    if (overrides.has("/time_code")) return std::nullopt;
    return find_frames(scene);
}

std::vector<ImageJob> image_jobs(const std::filesystem::path& scene, const std::filesystem::path& output,
                                 const std::string& name, const SettingsOverrides& overrides) {
    const std::optional<FrameRange> frames = frames_of(scene, overrides);
    if (!frames) return {{scene, output, name, std::nullopt}};
    std::vector<ImageJob> jobs;
    jobs.reserve(frames->count());
    for (std::size_t i = 0; i < frames->count(); ++i) {
        const int frame = frames->frame(i);
        jobs.push_back({scene,
                        frame_path(output, frame),
                        fmt::format("{} frame {}", name, frame),
                        frame,
                        {},
                        {},
                        frames->frame(0)});
    }
    return jobs;
}

SettingsOverrides overrides_of(const ImageJob& job, SettingsOverrides overrides) {
    overrides.frame = job.frame;
    if (job.variant) overrides.give("--variant", *job.variant);
    if (job.camera) overrides.give("--camera", *job.camera);
    return overrides;
}

ImageResult run_job(const ImageJob& job, SceneRenderRequest request, const ThreadPool& threads) {
    ImageResult result{job, ImageOutcome::UpToDate, {}, {}};
    request.scene = job.scene;
    request.output = job.output;
    request.first_frame = job.first_frame;
    request.overrides = overrides_of(job, std::move(request.overrides));
    PreparedScene prepared = prepare_scene(job.scene, request.overrides);
    const OutputPaths paths = OutputPaths::beside(job.output, request.overrides.png);
    if (!request.force && !is_partial(job.output) &&
        has_strategies_image(request.strategies, prepared.scene.settings.integrator.lengths, paths) &&
        is_up_to_date(paths, job.scene, prepared.scene, request.overrides.depth)) {
        // A checkpoint older than the image is of the render that made the image; a newer one is of a longer render.
        if (const CheckpointFiles checkpoints(job.output); !checkpoints.are_newer_than(paths.json))
            checkpoints.remove();
        return result;
    }
    SceneRenderResult rendered = render_scene(std::move(prepared), request, threads);
    result.statistics = std::move(rendered.statistics);
    if (rendered.was_there) return result;
    result.outcome = rendered.interrupted ? ImageOutcome::Interrupted : ImageOutcome::Rendered;
    return result;
}

std::string to_json(std::span<const ImageResult> results) {
    nlohmann::json list = nlohmann::json::array();
    for (const ImageResult& result : results) {
        nlohmann::json entry{{"scene", result.job.scene.string()},
                             {"image", result.job.output.string()},
                             {"result", outcome_name(result.outcome)}};
        if (result.job.frame) entry["frame"] = *result.job.frame;
        if (!result.error.empty()) entry["error"] = result.error;
        if (result.statistics.samples > 0) entry["statistics"] = nlohmann::json::parse(to_json(result.statistics));
        list.push_back(std::move(entry));
    }
    return list.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace etendue
