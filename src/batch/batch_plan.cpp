#include "batch/batch_plan.h"

#include "batch/batch_lock.h"
#include "batch/batch_statistics.h"
#include "core/parallel.h"
#include "loader/loader.h"
#include "session/checkpoint_files.h"
#include "session/interrupt.h"
#include "session/prepared_scene.h"
#include "session/up_to_date.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include <sys/stat.h>

namespace etendue {

namespace {

/// Returns `changes_of_sums` for an image that was rendered before; empty if its scene cannot be loaded.
std::string changes_since_checkpoint(const PlannedUnit& unit, const OutputPaths& output, const BatchOptions& options) {
    try {
        const SettingsOverrides overrides = overrides_of(unit.task.job, options.overrides);
        return changes_of_sums(output, prepare_scene(unit.task.job.scene, overrides).scene.settings);
    } catch (const std::exception&) {
        return "";
    }
}

/// The reason of an image that is not whole, with what is known of its past.
void describe_unfinished(PlannedUnit& unit, const OutputPaths& output, const Staleness& stale,
                         const BatchOptions& options, const LedgerHistory& history) {
    const LedgerHistory::Entry* const last = history.find(unit.task.id);
    unit.reason = stale.reason;
    if (last != nullptr && last->kind == LedgerEventKind::UnitFailed) unit.reason = "failed last time";
    if (last != nullptr && last->kind == LedgerEventKind::UnitNotTried)
        unit.reason = "was not tried last time, as its scene was invalid";
    if (!CheckpointFiles(unit.task.job.output).exist()) return;
    if (unit.reason == "never rendered") unit.reason = "was interrupted";
    // Statistics older than the checkpoint describe an earlier render, so `render` itself compares the settings.
    const bool is_described = !CheckpointFiles(unit.task.job.output).are_newer_than(output.json);
    const std::string changed = is_described ? changes_since_checkpoint(unit, output, options) : "";
    unit.resumes = changed.empty();
    if (!unit.resumes) {
        unit.reason += ", begins anew as its settings changed" + changed;
        return;
    }
    unit.reason += ", goes on from a checkpoint";
    unit.done = stale.done;
}

/// True if the image without noise, and its PNG if one is wanted, was made of the image as it is.
bool is_denoised(const std::filesystem::path& image, bool has_png) {
    std::error_code error;
    const std::filesystem::path denoised = denoised_path(image);
    const auto made = std::filesystem::last_write_time(denoised, error);
    if (error || made < std::filesystem::last_write_time(image, error) || error) return false;
    return !has_png || is_whole_png(std::filesystem::path(denoised).replace_extension(".png"));
}

/// True if one look at a scene does for both: they may be frames of one sequence.
bool are_alike(const ImageJob& a, const ImageJob& b) {
    return a.scene == b.scene && a.variant == b.variant && a.camera == b.camera;
}

/// Finds out about an image that is to be rendered as much as the options ask for.
SceneLook look_at(const BatchTask& task, const BatchOptions& options) {
    if (options.denoise)
        if (std::string error = why_not_denoised(task, options); !error.empty()) return {.error = std::move(error)};
    if (options.no_probe) return options.dry_run ? inspect_in_child(task, options) : SceneLook{};
    SceneLook look = probe_in_child(task, options);
    // A probe tells no warnings.
    if (options.dry_run && look.error.empty()) look.warnings = inspect_in_child(task, options).warnings;
    return look;
}

std::uint64_t pixels_of(int width, int height) {
    return static_cast<std::uint64_t>(std::max(width, 0)) * static_cast<std::uint64_t>(std::max(height, 0));
}

/// Notes what the finished image, if there is one, has more of than the one that will replace it.
void compare_with_finished(PlannedUnit& unit, const BatchOptions& options) {
    const OutputPaths output = OutputPaths::beside(unit.task.job.output, options.overrides.png);
    if (unit.outline.width == 0 || why_unfinished(output)) return;
    BatchUnit finished;
    read_statistics(output.json, finished);
    unit.loses_samples = unit.outline.spp > 0 && unit.outline.spp < finished.spp;
    unit.loses_pixels = pixels_of(unit.outline.width, unit.outline.height) < pixels_of(finished.width, finished.height);
}

/// Adds the seconds that taking out the noise with `threads` threads will take to the estimate, if they are known.
void add_denoising(PlannedUnit& unit, const LedgerHistory& history, int threads) {
    if (!unit.estimated_seconds) return;
    const auto seconds = history.denoise_seconds(pixels_of(unit.outline.width, unit.outline.height), threads);
    unit.lacks_denoising = !seconds;
    *unit.estimated_seconds += seconds.value_or(0.0);
}

/// Puts into `unit` what was found out about it, or about an image that is alike.
void take_look(PlannedUnit& unit, const SceneLook& look) {
    if (look.outline.width > 0) unit.outline = look.outline;
    if (unit.task.job.camera) unit.outline.camera = *unit.task.job.camera;
    unit.error = look.error;
    unit.warnings = look.warnings;
    unit.memory_bytes = look.memory_bytes;
    if (look.seconds)
        unit.estimated_seconds = look.start_seconds + (*look.seconds - look.start_seconds) * (1.0 - unit.done);
}

}  // namespace

FileStamp FileStamp::of(const std::filesystem::path& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) return {};
    return {status.st_ino, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

void examine(PlannedUnit& unit, const BatchOptions& options, bool force, const LedgerHistory& history) {
    const OutputPaths output = OutputPaths::beside(unit.task.job.output, options.overrides.png);
    unit.seen = FileStamp::of(output.json);
    unit.reason.clear();
    unit.done = 0.0;
    unit.resumes = true;
    if (const auto stale = why_unfinished(output)) {
        describe_unfinished(unit, output, *stale, options, history);
    } else if (force) {
        unit.reason = kForced;
    } else if (const auto outdated = why_outdated(output, unit.task.job.scene)) {
        unit.reason = outdated->reason;
    } else {
        try {
            // Of files that were rendered before: what might crash a process has had its chance to crash another one.
            const SettingsOverrides overrides = overrides_of(unit.task.job, options.overrides);
            const PreparedScene prepared = prepare_scene(unit.task.job.scene, overrides);
            unit.outline = outline_of(prepared.scene);
            if (const auto changed = why_outdated(output, prepared.scene, overrides.depth)) {
                unit.reason = changed->reason;
                if (changed->done > 0.0 && std::filesystem::exists(sums_path(unit.task.job.output))) {
                    unit.reason += ", goes on from its sums";
                    unit.done = changed->done;
                }
            }
        } catch (const std::exception&) {
            unit.reason = "the scene cannot be loaded";
        }
    }
    if (unit.is_stale() || !options.denoise) return;
    if (!is_denoised(unit.task.job.output, options.overrides.png)) unit.reason = "was not denoised";
    const LedgerHistory::Entry* const last = history.find(unit.task.id);
    unit.denoise_seconds = last != nullptr ? last->denoise_seconds : std::nullopt;
}

BatchPlan make_plan(std::vector<BatchTask> tasks, const BatchOptions& options, const LedgerHistory& history,
                    const PlanProgress& progress) {
    BatchPlan plan;
    plan.reserve(tasks.size());
    const std::size_t count = tasks.size();
    const BatchLocks locks(options.output);
    const int threads = options.threads > 0 || !options.denoise ? options.threads : ThreadPool(0).thread_count();
    std::optional<ImageJob> looked_at;
    SceneLook look;
    for (BatchTask& task : tasks) {
        if (interrupt_requested()) break;
        progress(task.job.name, plan, count);
        PlannedUnit& unit = plan.emplace_back(PlannedUnit{.task = std::move(task)});
        examine(unit, options, options.force, history);
        if (!unit.is_stale()) continue;
        if (const auto holder = options.dry_run ? locks.find_holder(unit.task.id) : std::nullopt) {
            unit.is_running_elsewhere = true;
            unit.reason = "running elsewhere: " + holder->str();
        }
        if (!looked_at || !are_alike(*looked_at, unit.task.job)) {
            looked_at = unit.task.job;
            look = look_at(unit.task, options);
        }
        take_look(unit, look);
        compare_with_finished(unit, options);
        if (options.denoise) add_denoising(unit, history, threads);
    }
    return plan;
}

void arrange(BatchPlan& plan, BatchOrder order, std::span<const std::filesystem::path> assets) {
    const auto by = [&](const auto& key) {
        std::ranges::stable_sort(plan, [&](const PlannedUnit& a, const PlannedUnit& b) { return key(a) < key(b); });
    };
    static constexpr double kLast = std::numeric_limits<double>::infinity();
    switch (order) {
        case BatchOrder::Found:
            return;
        case BatchOrder::Shortest:
            return by([](const PlannedUnit& unit) { return unit.estimated_seconds.value_or(kLast); });
        case BatchOrder::Longest:
            return by([](const PlannedUnit& unit) { return -unit.estimated_seconds.value_or(-kLast); });
        case BatchOrder::Name:
            return by([](const PlannedUnit& unit) { return std::string_view(unit.task.id); });
        case BatchOrder::Newest: {
            std::map<std::filesystem::path, std::filesystem::file_time_type> times;
            for (const PlannedUnit& unit : plan) {
                const auto [time, is_new] = times.try_emplace(unit.task.job.scene);
                if (!is_new) continue;
                time->second = std::filesystem::file_time_type::min();
                std::error_code error;
                for (const std::filesystem::path& input : find_inputs(unit.task.job.scene, assets))
                    if (const auto changed = std::filesystem::last_write_time(input, error); !error)
                        time->second = std::max(time->second, changed);
            }
            std::ranges::stable_sort(plan, std::ranges::greater(),
                                     [&](const PlannedUnit& unit) { return times.at(unit.task.job.scene); });
        }
    }
}

PlanTotals totals(const BatchPlan& plan) {
    PlanTotals sum;
    for (const PlannedUnit& unit : plan) {
        if (!unit.is_stale()) continue;
        if (unit.is_running_elsewhere) {
            ++sum.elsewhere;
            continue;
        }
        ++sum.stale;
        if (!unit.error.empty())
            ++sum.failing;
        else if (unit.estimated_seconds)
            sum.seconds += *unit.estimated_seconds;
        else
            ++sum.unknown;
        sum.lacks_denoising = sum.lacks_denoising || (unit.error.empty() && unit.lacks_denoising);
    }
    return sum;
}

}  // namespace etendue
