#include "session/dropped_samples.h"

#include "core/log.h"
#include "process/shell_word.h"
#include "scene/setting.h"

#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns the options that ask for the settings which a sample depends on, also where they are as render.json says:
/// all that are given, and all that are not the default.
std::vector<std::string> words_of_sample(const RenderSettings& settings) {
    std::vector<std::string> options;
    for (const Setting& setting : settings_table()) {
        const SettingValue value = setting.place.read(settings);
        const bool is_given = settings.options.contains(std::string(setting.pointer));
        const bool is_told = setting.decides == Decides::Samples ? is_given || value != default_value(setting)
                                                                 : is_given && setting.pointer == "/texture_memory";
        const std::vector<std::string> words = option_words(setting, value);
        if (!is_told || words.empty()) continue;
        options.push_back(words.size() > 1 ? words[0] + " " + quoted(words[1]) : words[0]);
    }
    return options;
}

}  // namespace

void report_dropped(const RenderCounters& counters, const std::filesystem::path& scene,
                    const SettingsOverrides& overrides, const RenderSettings& settings) {
    if (counters.dropped == 0) return;
    const DroppedSample& first = counters.first_dropped.front();
    // A part of an image keeps splats for all of it, as an image of the one pixel would not.
    std::string command = fmt::format("etendue render {} --crop {},{},{},{} --samples {}:{}", quoted(scene.string()),
                                      first.x, first.y, first.x + 1, first.y + 1, first.sample, first.sample + 1);
    for (const std::string& words : words_of_sample(settings)) command += " " + words;
    if (settings.frame) command += fmt::format(" --frames {} --fps {}", *settings.frame, settings.fps);
    if (overrides.environment) command += " --environment " + quoted(*overrides.environment);
    for (const std::filesystem::path& directory : overrides.assets)
        command += " --assets " + quoted(directory.string());
    log_warning(
        "warning: {} samples were not finite and were dropped; the first is sample {} of pixel ({}, {}). To see it "
        "alone: {}",
        counters.dropped, first.sample, first.x, first.y, command);
}

}  // namespace etendue
