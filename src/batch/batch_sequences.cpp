#include "batch/batch_sequences.h"

#include "loader/loader.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <functional>
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
    std::map<std::filesystem::path, bool> has_exposure;     // of scenes
    std::map<std::filesystem::path, std::size_t> sequence;  // by its output's name without a frame's number
    const auto is_in_sequence = [&](const BatchTask& task) {
        if (!task.job.frame) return false;
        const auto [scene, is_new] = has_exposure.try_emplace(task.job.scene, false);
        if (is_new) scene->second = names_exposure(task.job.scene);
        return !scene->second;
    };
    sequences_.resize(plan.size());
    for (std::size_t i = 0; i < plan.size(); ++i) {
        if (!is_in_sequence(plan[i].task)) continue;
        const auto [place, is_new] = sequence.try_emplace(plan[i].task.render_output, frames_that_wait_.size());
        if (is_new) frames_that_wait_.emplace_back();
        sequences_[i] = place->second;
        frames_that_wait_[place->second].push_back(i);
    }
    for (std::vector<std::size_t>& frames : frames_that_wait_) {
        std::ranges::sort(frames, std::greater{}, [&](std::size_t i) { return *plan[i].task.job.frame; });
        // The exposure of a first frame that is made already is there to be taken.
        if (!plan[frames.back()].is_stale()) frames.clear();
        std::erase_if(frames, [&](std::size_t i) { return !plan[i].is_stale(); });
    }
}

bool FirstFrames::lets_begin(std::size_t index) const {
    if (index >= sequences_.size() || !sequences_[index]) return true;
    const std::vector<std::size_t>& frames = frames_that_wait_[*sequences_[index]];
    return frames.empty() || frames.back() == index;
}

void FirstFrames::end(std::size_t index, bool is_made) {
    if (index >= sequences_.size() || !sequences_[index]) return;
    std::vector<std::size_t>& frames = frames_that_wait_[*sequences_[index]];
    if (frames.empty() || frames.back() != index) return;
    if (is_made)
        frames.clear();
    else
        frames.pop_back();
}

}  // namespace etendue
