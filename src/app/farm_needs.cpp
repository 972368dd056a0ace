#include "app/farm_needs.h"

#include "app/run_command.h"
#include "core/error.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

RenderProbe parse_probe(const std::string& text) {
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        const double start = json.at("load_seconds").get<double>() + json.at("build_seconds").get<double>();
        const RenderProbe probe{.start_seconds = start,
                                .render_seconds = json.at("estimated_seconds").get<double>() - start,
                                .peak_memory_bytes = json.at("peak_memory_bytes").get<std::uint64_t>(),
                                .threads = json.at("threads").get<int>()};
        if (probe.start_seconds >= 0.0 && probe.render_seconds >= 0.0 && probe.threads > 0) return probe;
    } catch (const nlohmann::json::exception& error) {
        throw IoError(fmt::format("the probe's answer cannot be read: {}", error.what()));
    }
    throw IoError("the probe's answer makes no sense: " + text);
}

RenderProbe probe_scene(const ImageJob& first_image, const std::vector<GivenOption>& options) {
    std::vector<std::string> words{"/proc/self/exe", "render", first_image.scene.string(), "--probe", "--quiet"};
    if (first_image.frame) {
        words.emplace_back("--frames");
        words.push_back(fmt::format("{}", *first_image.frame));
    }
    for (const GivenOption& option : options) {
        words.push_back(option.name);
        if (option.value) words.push_back(*option.value);
    }
    const CommandResult result = run_command(words);
    if (result.exit_code == 0) return parse_probe(result.out);
    throw SceneError({first_image.scene.string(), ""},
                     fmt::format("a probe of it failed with exit code {}: {}", result.exit_code, result.err));
}

TaskNeeds needs_of(const RenderProbe& probe, std::size_t parts, int threads) {
    const double render =
        probe.render_seconds * probe.threads / static_cast<double>(threads) / static_cast<double>(parts);
    // What schedulers take; far more than a year.
    constexpr double kMost = 1e6;
    const double minutes = kTimeSafety * (probe.start_seconds + render) / 60.0;
    const double mebibytes = kMemorySafety * static_cast<double>(probe.peak_memory_bytes) / (1 << 20);
    return {std::max(kLeastMinutes, static_cast<int>(std::ceil(std::min(minutes, kMost)))),
            std::max(kLeastMebibytes, static_cast<int>(std::ceil(std::min(mebibytes, 1e9))))};
}

}  // namespace etendue
