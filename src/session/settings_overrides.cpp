#include "session/settings_overrides.h"

#include "core/byte_size.h"
#include "integrator/integrator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

const std::map<std::string, Quality> kQualities{
    {"draft", Quality::Draft}, {"preview", Quality::Preview}, {"final", Quality::Final}};

/// Of a path, as --max-depth and --min-depth take it.
constexpr int kMostEdges = 1 << 20;

const std::map<std::string, HeuristicType> kHeuristics{{"power", HeuristicType::Power},
                                                       {"balance", HeuristicType::Balance}};

const std::map<std::string, AovLayout> kAovLayouts(kAovLayoutNames.begin(), kAovLayoutNames.end());
const std::map<std::string, MissingTextures> kMissingTextures(kMissingTexturesNames.begin(),
                                                              kMissingTexturesNames.end());
const std::map<std::string, LightUnits> kLightUnits(kLightUnitNames.begin(), kLightUnitNames.end());

void apply_quality(Quality quality, RenderSettings& settings) {
    if (quality == Quality::Final) return;
    settings.spp = std::max(1, settings.spp / (quality == Quality::Draft ? 16 : 4));
    if (quality == Quality::Preview) return;
    FilmSettings& film = settings.film;
    film.width = std::max(1, film.width / 2);
    film.height = std::max(1, film.height / 2);
    if (film.crop) {
        auto& c = *film.crop;
        // An odd size loses its last column or row; a window that was only there keeps the one before.
        c = {std::min(c[0] / 2, film.width - 1), std::min(c[1] / 2, film.height - 1),
             std::min(film.width, (c[2] + 1) / 2), std::min(film.height, (c[3] + 1) / 2)};
    }
}

/// "1920x1080" to two numbers; the message that CLI11 shows if it is not of that form.
std::array<int, 2> parse_size(const std::string& text) {
    std::array<int, 2> size{};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &size[0], &size[1], &rest) != 2 || size[0] < 1 || size[1] < 1 ||
        size[0] > 65536 || size[1] > 65536)
        throw CLI::ValidationError("--size", "'" + text + "' is not WIDTHxHEIGHT with 1 to 65536 pixels each");
    return size;
}

/// "2,3" to s and t.
std::array<int, 2> parse_strategy(const std::string& text) {
    std::array<int, 2> st{};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%d,%d%c", &st[0], &st[1], &rest) != 2 || st[0] < 0 || st[1] < 0)
        throw CLI::ValidationError("--strategy", "'" + text + "' is not S,T, the vertices from the light and the eye");
    return st;
}

std::uint64_t parse_texture_memory(const std::string& text) {
    const auto bytes = parse_byte_size(text);
    if (!bytes) throw CLI::ValidationError("--texture-memory", fmt::format("'{}' is not {}", text, kByteSizeForm));
    return *bytes;
}

std::vector<AovDesc> parse_aovs(const std::vector<std::string>& texts) {
    std::vector<AovDesc> aovs;
    for (const std::string& text : texts) {
        std::optional<AovDesc> aov = parse_aov(text);
        if (!aov) throw CLI::ValidationError("--aov", fmt::format("'{}' is not {}", text, kAovForm));
        aov->location = {"--aov", {}};
        aovs.push_back(std::move(*aov));
    }
    return aovs;
}

/// "3", "1:48" or "1:48:2".
FrameRange parse_frames(const std::string& text) {
    FrameRange f;
    char rest = 0;
    const int ends = std::sscanf(text.c_str(), "%d:%d%c", &f.first, &f.last, &rest);
    const bool is_one = std::sscanf(text.c_str(), "%d%c", &f.first, &rest) == 1;
    const bool has_step = std::sscanf(text.c_str(), "%d:%d:%d%c", &f.first, &f.last, &f.step, &rest) == 3;
    if (is_one) f.last = f.first;
    constexpr int kMost = FrameRange::kMaxFrame;
    if (!(is_one || ends == 2 || has_step) || f.first < -kMost || f.last > kMost || f.last < f.first || f.step < 1)
        throw CLI::ValidationError(
            "--frames", fmt::format("'{}' is not FRAME, FIRST:LAST or FIRST:LAST:STEP with {} <= FIRST <= LAST <= {} "
                                    "and STEP >= 1",
                                    text, -kMost, kMost));
    return f;
}

/// "0:0.02".
Shutter parse_shutter(const std::string& text) {
    Shutter shutter;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%lf:%lf%c", &shutter.open, &shutter.close, &rest) != 2 ||
        !std::isfinite(shutter.open) || !std::isfinite(shutter.close) || shutter.close < shutter.open)
        throw CLI::ValidationError("--shutter", "'" + text + "' is not OPEN:CLOSE in seconds with OPEN <= CLOSE");
    return shutter;
}

}  // namespace

std::vector<std::string> integrator_names() {
    std::vector<std::string> names;
    for (const IntegratorEntry& entry : integrator_registry()) names.emplace_back(entry.name);
    return names;
}

CLI::Validator real_range(double least, double most) {
    const auto check = [least, most](const std::string& text) {
        double value = 0.0;
        // Written so that NaN does not pass.
        if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return std::string();
        return fmt::format("'{}' is not a number from {:g} to {:g}", text, least, most);
    };
    return CLI::Validator(check, fmt::format("FLOAT in [{:g} - {:g}]", least, most));
}

std::array<int, 4> parse_pixel_window(const std::string& option, const std::string& text) {
    std::array<int, 4> c{};
    char rest = 0;
    if (std::sscanf(text.c_str(), "%d,%d,%d,%d%c", &c[0], &c[1], &c[2], &c[3], &rest) != 4 || c[0] < 0 || c[1] < 0 ||
        c[2] <= c[0] || c[3] <= c[1])
        throw CLI::ValidationError(option, "'" + text + "' is not x0,y0,x1,y1 with 0 <= x0 < x1 and 0 <= y0 < y1");
    return c;
}

void add_moment_options(CLI::App& command, LoadOptions& options) {
    command.add_option("--time-code", options.time_code, "Moment of the animation to show, seconds (default: at rest)");
    command.add_option("--animation", options.animation, "Name of the animation to show (default: the first)");
    command.add_option_function<std::string>(
        "--shutter", [&options](const std::string& text) { options.shutter = parse_shutter(text); },
        "Blur what moves from OPEN to CLOSE, seconds from the moment shown: OPEN:CLOSE (default: no motion blur)");
}

void add_assets_option(CLI::App& command, std::vector<std::filesystem::path>& assets) {
    if (const char* listed = std::getenv("ETENDUE_ASSETS")) {
        std::istringstream list(listed);
        for (std::string directory; std::getline(list, directory, ':');)
            if (!directory.empty()) assets.emplace_back(directory);
    }
    command
        .add_option_function<std::vector<std::string>>(
            "--assets",
            [&assets](const std::vector<std::string>& given) {
                assets.insert(assets.begin(), given.begin(), given.end());
            },
            "Directory outside of the scene's from which the environment image that render.json names may come; may be "
            "repeated. $ETENDUE_ASSETS lists more, with ':' between them")
        ->check(CLI::ExistingDirectory)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_missing_textures_option(CLI::App& command, LoadOptions& options) {
    command
        .add_option_function<std::string>(
            "--missing-textures",
            [&options](const std::string& text) { options.missing_textures = kMissingTextures.at(text); },
            "warn: materials do without a texture that is missing or broken (default); error: the scene is refused")
        ->check(CLI::IsMember(kMissingTextures));
}

void SettingsOverrides::add_options(CLI::App& command) {
    command
        .add_option_function<std::string>(
            "--quality", [this](const std::string& text) { quality = kQualities.at(text); },
            "draft: half the size, 1/16 of the samples; preview: 1/4 of the samples; final: as the scene says")
        ->check(CLI::IsMember(kQualities));
    command.add_option("--integrator", integrator, "Light transport algorithm")
        ->check(CLI::IsMember(integrator_names()));
    command.add_option("--spp", spp, "Samples per pixel")->check(CLI::Range(1, 1 << 24));
    command.add_option_function<std::string>(
        "--size", [this](const std::string& text) { size = parse_size(text); }, "Image size, WIDTHxHEIGHT");
    command.add_option_function<std::string>(
        "--crop", [this](const std::string& text) { crop = parse_pixel_window("--crop", text); },
        "Render only pixels x0,y0,x1,y1 (half-open, y down)");
    command.add_option("--camera", camera, "Name of the camera (default: the first)");
    add_moment_options(command, moment);
    command.add_option_function<std::string>(
        "--frames", [this](const std::string& text) { frames = parse_frames(text); },
        "Render a sequence, FIRST:LAST or FIRST:LAST:STEP, or one frame of it; frame f is at time code + f / fps");
    command.add_option("--fps", moment.fps, "Frames per second of a sequence (default: 24)")
        ->check(real_range(1e-3, 1e6));
    command.add_option("--variant", variant, "Name of the file's set of materials (KHR_materials_variants)");
    command.add_option("--seed", seed, "Seed of everything random");
    command.add_option("--time", time_seconds, "Start no new pass after this many seconds")
        ->check(real_range(1e-3, 1e9));
    command
        .add_option("--error", relative_error,
                    "Start no new pass once the image's estimated relative error is at most this: 0.05 is a clean "
                    "preview, 0.01 a clean image. It is the root mean square; values below half of the image's own "
                    "scale count against that (docs/adaptive.md). Pixels get as many samples as they need, --spp at "
                    "most. Doubles the memory of the film")
        ->check(real_range(1e-6, 1e3));
    add_firefly_options(command);
    add_adaptive_options(command);
    command
        .add_option("--max-depth", max_depth, "Most edges of a path from camera to light; 1 is emission seen directly")
        ->check(CLI::Range(1, kMostEdges));
    command.add_option("--min-depth", min_depth, "Least edges of a path that is kept (default: 1)")
        ->check(CLI::Range(1, kMostEdges));
    command
        .add_option("--light-samples", light_samples,
                    "Lights that path and direct sample where the eye looks, path in mirrors, too (default: 1); more "
                    "take noise "
                    "out of soft shadows and of the light of many lamps, for more time")
        ->check(CLI::Range(1, kMostLightSamples));
    command
        .add_option_function<std::string>(
            "--heuristic", [this](const std::string& text) { heuristic = kHeuristics.at(text); },
            "How bdpt weighs its strategies: balance (default) or power")
        ->check(CLI::IsMember(kHeuristics));
    command.add_option_function<std::string>(
        "--strategy", [this](const std::string& text) { strategy = parse_strategy(text); },
        "Of bdpt, only paths with S vertices from the light and T from the eye, those on light and lens included: S,T");
    command.add_flag_callback(
        "--unweighted", [this] { weighted = false; }, "That strategy as if no other made its paths");
    command.add_option_function<std::string>(
        "--bdpt-connections",
        [this](const std::string& text) {
            cached_connections = parse_connections(text);
            if (!cached_connections)
                throw CLI::ValidationError("--bdpt-connections", fmt::format("'{}' is not {}", text, kConnectionsForm));
        },
        "What bdpt connects an eye vertex to: all light vertices of its own sample (pairwise, default) or N drawn from "
        "those of many samples (cache:N)");
    command
        .add_option_function<std::string>(
            "--light-units", [this](const std::string& text) { light_units = kLightUnits.at(text); },
            "photometric: candela, lux and emission one to one, the image is in cd/m2 (default); radiometric: emission "
            "is in watts, candela and lux are divided by 683.002 lm/W")
        ->check(CLI::IsMember(kLightUnits));
    command.add_option("--environment", environment, "Environment image (EXR or HDR), in place of the scene's")
        ->check(CLI::ExistingFile);
    add_assets_option(command, moment.assets);
    command.add_option_function<std::string>(
        "--texture-memory", [this](const std::string& text) { texture_memory = parse_texture_memory(text); },
        "Memory for decoded textures, such as 8G or 512M; scenes with more read them piece by piece as they are "
        "needed (default: half of the machine's)");
    add_missing_textures_option(command, moment);
    command
        .add_option_function<std::vector<std::string>>(
            "--aov", [this](const std::vector<std::string>& texts) { aovs = parse_aovs(texts); },
            "Another layer to write, besides those of render.json: one of those that 'etendue render --help' lists, "
            "NAME=lpe:EXPRESSION or "
            "NAME=light:NAME; :half or :float behind it says how. Can be given several times (docs/aovs.md)")
        ->allow_extra_args(false);
    command
        .add_option_function<std::string>(
            "--aov-layout", [this](const std::string& text) { aov_layout = kAovLayouts.at(text); },
            "Layers as channels of the image (layers, default), as parts of its file (parts) or in files of their own "
            "(files)")
        ->check(CLI::IsMember(kAovLayouts));
    command.add_flag_callback(
        "--deep", [this] { deep = true; },
        "Write a deep image beside the image, IMAGE.deep.exr: colour and opacity at up to 16 depths of each pixel "
        "(docs/deep.md)");
    add_color_options(command);
    auto* half = command.add_flag_callback(
        "--half", [this] { depth = PixelDepth::Half; }, "Write 16-bit floats (default)");
    command
        .add_flag_callback(
            "--float", [this] { depth = PixelDepth::Float; }, "Write 32-bit floats")
        ->excludes(half);
}

void SettingsOverrides::add_firefly_options(CLI::App& command) {
    command
        .add_option("--clamp-indirect", clamp_indirect,
                    "Limit each contribution of indirect light to this, in units of the image: fewer fireflies, and "
                    "light is missing (docs/fireflies.md). 0 for no limit (default)")
        ->check(real_range(0.0, 1e30));
    command.add_option_function<std::string>(
        "--robust",
        [this](const std::string& text) {
            robust_buckets = parse_robust(text);
            if (!robust_buckets)
                throw CLI::ValidationError("--robust", fmt::format("'{}' is not {}", text, kRobustForm));
        },
        "mean (default), or mon:N, N odd and from 3 to 31: each pixel is the median of the means of N parts of its "
        "samples, which a few fireflies do not move; too dark with few samples, right with many (docs/fireflies.md)");
    command
        .add_option("--brightest", brightest,
                    "List this many of the brightest contributions, with the paths that brought them, in NAME.json and "
                    "at the end (default: 8, in NAME.json only; 0 for none)")
        ->check(CLI::Range(0, kMostBrightest));
}

void SettingsOverrides::add_adaptive_options(CLI::App& command) {
    auto* const on = command.add_flag_callback(
        "--adaptive", [this] { adaptive = true; },
        "With --error, give every pixel as many samples as it needs, --spp at most (default)");
    command
        .add_flag_callback(
            "--no-adaptive", [this] { adaptive = false; }, "With --error, give all pixels as many samples")
        ->excludes(on);
    command.add_option("--min-spp", min_spp, "Samples that every pixel gets before an adaptive render leaves any out")
        ->check(CLI::Range(1, 1 << 24));
}

void SettingsOverrides::add_color_options(CLI::App& command) {
    command.add_option("--exposure", exposure, "Exposure of the preview image, stops")->check(real_range(-64.0, 64.0));
    command.add_option("--display", display, "OpenColorIO display that the preview image is for");
    command.add_option("--view", view, "OpenColorIO view of the preview image, one of its display's");
    command.add_option("--look", look,
                       "OpenColorIO look of the preview image, in place of the view's own; several with commas, or "
                       "none ('etendue view --list' names displays, views and looks)");
    command.add_option("--working-space", working_space, "Scene-linear space to render in");
    command.add_option("--exr-space", output_space,
                       "Scene-linear space of the EXR, such as ACES2065-1 (default: the working space)");
    command.add_flag_callback(
        "--aces-container", [this] { aces_container = true; },
        "Write the EXR as SMPTE ST 2065-4 asks: in ACES2065-1, 16-bit floats, not compressed");
}

void SettingsOverrides::apply(SceneDesc& scene) const {
    RenderSettings& settings = scene.settings;
    if (quality) apply_quality(*quality, settings);
    const auto set = [&](const auto& given, auto& setting, const char* pointer, const char* option) {
        if (!given) return;
        setting = *given;
        settings.options[pointer] = option;
    };
    set(integrator, settings.integrator.type, "/integrator/type", "--integrator");
    set(max_depth, settings.integrator.max_depth, "/integrator/max_depth", "--max-depth");
    set(min_depth, settings.integrator.min_depth, "/integrator/min_depth", "--min-depth");
    set(light_samples, settings.integrator.light_samples, "/integrator/light_samples", "--light-samples");
    set(heuristic, settings.integrator.heuristic, "/integrator/heuristic", "--heuristic");
    set(strategy, settings.integrator.strategy, "/integrator/strategy", "--strategy");
    set(weighted, settings.integrator.weighted, "/integrator/weighted", "--unweighted");
    set(cached_connections, settings.integrator.cached_connections, "/integrator/connections", "--bdpt-connections");
    set(spp, settings.spp, "/spp", "--spp");
    set(crop, settings.film.crop, "/crop", "--crop");
    set(camera, settings.camera, "/camera", "--camera");
    set(variant, settings.variant, "/variant", "--variant");
    set(seed, settings.seed, "/seed", "--seed");
    set(light_units, settings.light_units, "/light_units", "--light-units");
    set(time_seconds, settings.time_limit, "/time", "--time");
    set(relative_error, settings.relative_error, "/error", "--error");
    set(clamp_indirect, settings.clamp_indirect, "/clamp_indirect", "--clamp-indirect");
    set(robust_buckets, settings.robust_buckets, "/robust", "--robust");
    set(brightest, settings.brightest, "/brightest", "--brightest");
    set(adaptive, settings.adaptive, "/adaptive", "--no-adaptive");
    set(min_spp, settings.min_spp, "/min_spp", "--min-spp");
    set(texture_memory, settings.texture_memory, "/texture_memory", "--texture-memory");
    settings.aovs.insert(settings.aovs.end(), aovs.begin(), aovs.end());
    if (deep) settings.aovs.push_back({.name = "deep", .source = "deep", .is_float = {}, .location = {"--deep", {}}});
    set(aov_layout, settings.aov_layout, "/aov_layout", "--aov-layout");
    set(exposure, settings.color.exposure, "/color/exposure", "--exposure");
    set(display, settings.color.display, "/color/display", "--display");
    set(view, settings.color.view, "/color/view", "--view");
    set(look, settings.color.look, "/color/look", "--look");
    set(working_space, settings.color.working_space, "/color/working_space", "--working-space");
    set(output_space, settings.color.output_space, "/color/output_space", "--exr-space");
    set(aces_container, settings.color.aces_container, "/color/aces_container", "--aces-container");
    if (settings.color.aces_container && depth == PixelDepth::Float)
        throw SceneError(settings.at("/color/aces_container"),
                         "an ACES container (SMPTE ST 2065-4) holds 16-bit floats; leave --float out");
    if (size) {
        settings.film.width = (*size)[0];
        settings.film.height = (*size)[1];
        settings.options["/resolution"] = "--size";
    }
    if (environment) {
        scene.environment.enabled = true;
        scene.environment.image = std::filesystem::absolute(*environment);
        scene.environment.color = Rgb(1.0f);
        scene.environment.location = {*environment, ""};
        scene.inputs.push_back(scene.environment.image);
    }
}

}  // namespace etendue
