#include "batch/batch_sequences.h"

#include "loader/loader.h"

#include <exception>
#include <filesystem>
#include <map>

namespace etendue {

namespace {

/// Returns whether render.json gives the scene an exposure.
bool names_exposure(const std::filesystem::path& scene) try {
    const std::optional<RenderSettings> settings = find_settings(scene);
    return settings && settings->color.exposure;
} catch (const std::exception&) {
    return false;  // rendering the scene will say what is wrong
}

}  // namespace

FirstFrames::FirstFrames(const BatchPlan& plan, const SettingsOverrides& overrides) {
    if (overrides.has("/color/exposure")) return;
    std::map<std::filesystem::path, bool> has_exposure;        // of scenes
    std::map<std::filesystem::path, std::size_t> first_frame;  // of sequences, by their name without a frame's number
    const auto is_in_sequence = [&](const BatchTask& task) {
        if (!task.job.frame) return false;
        const auto [scene, is_new] = has_exposure.try_emplace(task.job.scene, false);
        if (is_new) scene->second = names_exposure(task.job.scene);
        return !scene->second;
    };
    for (std::size_t i = 0; i < plan.size(); ++i) {
        if (!is_in_sequence(plan[i].task)) continue;
        std::size_t& first = first_frame.try_emplace(plan[i].task.render_output, i).first->second;
        if (*plan[i].task.job.frame < *plan[first].task.job.frame) first = i;
    }
    waits_for_.resize(plan.size());
    has_ended_.resize(plan.size(), false);
    for (std::size_t i = 0; i < plan.size(); ++i) {
        if (!is_in_sequence(plan[i].task)) continue;
        const std::size_t first = first_frame.at(plan[i].task.render_output);
        if (first != i && plan[first].is_stale()) waits_for_[i] = first;
    }
}

bool FirstFrames::lets_begin(std::size_t index) const {
    if (index >= waits_for_.size() || !waits_for_[index]) return true;
    return has_ended_[*waits_for_[index]];
}

void FirstFrames::end(std::size_t index) {
    if (index < has_ended_.size()) has_ended_[index] = true;
}

}  // namespace etendue
