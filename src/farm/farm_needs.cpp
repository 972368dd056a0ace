#include "farm/farm_needs.h"

#include "core/error.h"
#include "core/pixel_rect.h"
#include "picture/aov_setup.h"
#include "picture/render_setup.h"
#include "process/run_command.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

RenderProbe parse_probe(const std::string& text) {
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        const double start = json.at("start_seconds").get<double>();
        const RenderProbe probe{.start_seconds = start,
                                .render_seconds = json.at("estimated_seconds").get<double>() - start,
                                .peak_memory_bytes = json.at("peak_memory_bytes").get<std::uint64_t>(),
                                .threads = json.at("threads").get<int>(),
                                .deep_bytes = json.at("deep_bytes").get<std::uint64_t>()};
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

namespace {

/// Estimates the bytes a pixel that writing an image takes beside its film: 124 less 48 were measured, from 500 x 500
/// to 2500 x 2500.
constexpr double kWritingBytes = 80.0;
/// Estimates the bytes a pixel that writing takes for each channel of a layer, which is resolved, put beside the
/// others, and made ready for the file.
constexpr double kLayerWritingBytes = 3.0 * sizeof(float);

/// Bounds the bytes a pixel that writing takes for its depths, which are resolved, put beside the others, and made
/// ready for the file.
constexpr double kDeepWritingBytes = 3.0 * sizeof(DeepSample) * DeepBuffer::kMostBins;

double writing_bytes(const FilmSize& size) {
    const double layers = static_cast<double>(size.channels - std::min<std::size_t>(size.channels, 4));
    return static_cast<double>(size.pixels) *
           (kWritingBytes + kLayerWritingBytes * layers + (size.layers.is_deep ? kDeepWritingBytes : 0.0));
}

/// Multiplies estimates by the factors of safety, within limits that schedulers take: the longest time is far more than
/// a year.
TaskNeeds with_safety(double seconds, double bytes) {
    const double minutes = std::min(kTimeSafety * seconds / 60.0, 1e6);
    const double mebibytes = std::min(kMemorySafety * bytes / (1 << 20), 1e9);
    return {std::max(kLeastMinutes, static_cast<int>(std::ceil(minutes))),
            std::max(kLeastMebibytes, static_cast<int>(std::ceil(mebibytes)))};
}

}  // namespace

FilmSize film_size_of(const SceneDesc& scene) {
    const RenderOptions options = make_render_options(scene.settings);
    // Of `auto` it is not known yet.
    const bool has_splats =
        scene.settings.integrator.type == kAutoIntegrator || create_integrator(scene.settings)->makes_splats();
    const std::size_t all = scene.settings.film.frame().area();
    ProblemList ignored;  // the tasks will say them
    const AovPlan aovs = make_aov_plan(scene, ignored);
    FilmSize size{.pixels = options.window.area(),
                  .splat_pixels = has_splats ? all : 0,
                  .has_second_film = options.relative_error > 0.0 || aovs.has_halves};
    if (aovs.set) size.layers = aovs.set->layout;
    for (const AovOutput& output : aovs.outputs) size.channels += output.channels.size();
    if (aovs.has_halves) size.channels *= 2;
    return size;
}

int warning_seconds_for(const FilmSize& size) {
    constexpr double kBytesPerSecond = 50e6;  // of a disk that many nodes write to
    constexpr double kMostSeconds = 65535.0;  // that Slurm takes
    const double writing = static_cast<double>(size.bytes() + size.second_bytes()) / kBytesPerSecond;
    return static_cast<int>(std::min(kLeastWarningSeconds + writing, kMostSeconds));
}

TaskNeeds merge_needs_of(const FilmSize& size, std::size_t parts) {
    // The coefficients of docs/farm.md, which tools/lab/farm-model has measured.
    constexpr double kStart = 0.223;
    constexpr double kPerMegapixel = 0.32;
    constexpr double kPerMegapixelAndPart = 0.122;
    // They were measured without layers, and grow with the bytes that are read and the channels that are written.
    const double megapixels = static_cast<double>(size.pixels) * 1e-6;
    const double reading = kPerMegapixelAndPart * static_cast<double>(parts) * static_cast<double>(size.merge_bytes()) /
                           static_cast<double>(std::max<std::uint64_t>(1, sizeof(PixelSum) * size.pixels));
    const double writing = kPerMegapixel * static_cast<double>(size.channels) / 4.0;
    return with_safety(kStart + megapixels * (writing + reading),
                       3.0 * static_cast<double>(size.merge_bytes()) + writing_bytes(size));
}

double memory_of_render(std::uint64_t peak_memory_bytes, std::uint64_t deep_bytes, const FilmSize& size) {
    const std::uint64_t deep_growth = size.deep_bytes() - std::min(size.deep_bytes(), deep_bytes);
    return static_cast<double>(peak_memory_bytes) + writing_bytes(size) +
           static_cast<double>(deep_growth + size.second_bytes());
}

TaskNeeds needs_of(const RenderProbe& probe, const FilmSize& size, double share, int threads) {
    const double render = probe.render_seconds * probe.threads / static_cast<double>(threads) * share;
    return with_safety(probe.start_seconds + render, memory_of_render(probe.peak_memory_bytes, probe.deep_bytes, size));
}

}  // namespace etendue
