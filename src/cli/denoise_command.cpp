// etendue denoise: an image with less noise, from what the renderer knows of its noise.
#include "cli/command_options.h"
#include "cli/commands.h"
#include "core/error.h"
#include "core/log.h"
#include "core/process_time.h"
#include "denoise/fireflies.h"
#include "denoise/layers.h"
#include "denoise/nfor.h"
#include "denoise/oidn.h"
#include "denoise/unusable_pixels.h"
#include "image/read_channels.h"
#include "output/software_name.h"
#include "picture/output_paths.h"
#include "session/input_files.h"
#include "session/interrupt.h"
#include "session/usage_error.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace etendue {

namespace {

constexpr const char* kHalfShare = "etendue:halfShare";
constexpr const char* kLightLayers = "etendue:lightLayers";
constexpr const char* kDenoised = "etendue:denoised";
/// Names the feature layers that Open Image Denoise's network knows.
const std::vector<std::string> kOidnFeatures{"albedo", "N"};

struct DenoiseArguments {
    std::string image;
    std::string output;
    std::string method = "nfor";
    std::vector<std::string> features;
    int radius = 9;
    std::optional<PixelDepth> depth;
    int threads = 0;
    bool keep_fireflies = false;
    bool quiet = false;
};

/// A file, and what its channels are.
struct DenoiseInput {
    ChannelImage file;
    LayerPlan plan;
    float half_share = 0.5f;
};

/// The names that the file gives of its layers of light; none if it does not tell.
std::optional<std::vector<std::string>> light_layers(const ChannelImage& file) {
    const ImageAttribute* const attribute = file.find(kLightLayers);
    const auto* const text = attribute != nullptr ? std::get_if<std::string>(&attribute->value) : nullptr;
    if (text == nullptr) return std::nullopt;
    std::istringstream words(*text);
    return std::vector<std::string>(std::istream_iterator<std::string>(words), {});
}

DenoiseInput read_input(const DenoiseArguments& arguments) {
    try {
        DenoiseInput input;
        input.file = read_channels(std::filesystem::path(arguments.image));
        if (input.file.find(kDenoised)) throw std::invalid_argument("the image has been denoised already");
        const bool is_oidn = arguments.method == "oidn";
        const std::vector<std::string> usual = is_oidn ? kOidnFeatures : default_features();
        const std::vector<std::string> features = arguments.features.empty() ? usual : arguments.features;
        input.plan = plan_layers(input.file.channel_names, light_layers(input.file), features, arguments.features,
                                 is_oidn ? HalvesUse::None : HalvesUse::Needed);
        if (is_oidn) return input;
        const ImageAttribute* share = input.file.find(kHalfShare);
        const auto* value = share ? std::get_if<float>(&share->value) : nullptr;
        if (!value || !(*value > 0.0f && *value < 1.0f))
            throw std::invalid_argument(fmt::format(
                "its attribute {} does not say what share of the samples, above 0 and below 1, the channels "
                "of half of them are from; render with '--aov denoising'",
                kHalfShare));
        input.half_share = *value;
        return input;
    } catch (const IoError& error) {
        throw SceneError({arguments.image, {}}, error.what());
    } catch (const std::invalid_argument& error) {
        throw SceneError({arguments.image, {}}, error.what());
    }
}

/// Reads the halves of the samples of `layer`, which is light or a feature; `filled` counts pixels that could not be
/// used.
Halves read_halves(const DenoiseInput& input, const LayerChannels& layer, bool is_feature, std::size_t& filled) {
    Planes whole(input.file.pixels, layer.whole);
    Planes half(input.file.pixels, layer.half);
    filled = fill_unusable(whole, half);
    if (is_feature) bring_background_near(whole, half);
    return make_halves(whole, std::move(half), input.half_share);
}

std::string shown(const LayerChannels& layer) {
    return layer.name.empty() ? "RGB" : layer.name;
}

void report_filled(const LayerChannels& layer, std::size_t filled, const DenoiseArguments& arguments) {
    if (filled > 0 && !arguments.quiet)
        log_warning(
            "warning: {}: {} pixels of {} are not finite or beyond {:g}; they are filled from those around them",
            arguments.image, filled, shown(layer), kLargestUsable);
}

void take_fireflies(Halves& light, const LayerChannels& layer, const DenoiseArguments& arguments) {
    if (arguments.keep_fireflies) return;
    const Fireflies found = remove_fireflies(light);
    if (found.count > 0 && !arguments.quiet)
        log_info("note: {}: {} fireflies of {} removed, {:.3g}% of its light; --keep-fireflies keeps them",
                 arguments.image, found.count, shown(layer), 100.0 * found.light_share);
}

/// Denoises the layers of light in place. Returns false if it was interrupted.
bool denoise_layers_nfor(DenoiseInput& input, const DenoiseArguments& arguments) {
    const ThreadPool threads(arguments.threads);
    const NforSettings settings{arguments.radius, &interrupt_requested()};
    std::vector<Halves> features;
    for (const LayerChannels& layer : input.plan.features) {
        std::size_t filled = 0;
        features.push_back(read_halves(input, layer, true, filled));
        report_filled(layer, filled, arguments);
    }
    const ImageF& pixels = input.file.pixels;
    const PreparedFeatures prepared = prepare_features(features, pixels.width, pixels.height, settings, threads);
    features.clear();
    for (const LayerChannels& layer : input.plan.lights) {
        std::size_t filled = 0;
        Halves halves = read_halves(input, layer, false, filled);
        report_filled(layer, filled, arguments);
        if (is_black(halves)) {
            if (filled > 0) mean_of_all(halves.a, halves.b, halves.share).copy_to(input.file.pixels, layer.whole);
            continue;
        }
        take_fireflies(halves, layer, arguments);
        const Planes denoised = denoise_nfor(halves, prepared, settings, threads);
        if (interrupt_requested()) return false;
        denoised.copy_to(input.file.pixels, layer.whole);
    }
    return !interrupt_requested();
}

/// Three channels of finite values.
ImageF read_channels_of(const ImageF& file, const LayerChannels& layer, const DenoiseArguments& arguments) {
    if (layer.whole.size() != 3)
        throw SceneError({arguments.image, {}}, fmt::format("the layer '{}' has not three channels", layer.name));
    Planes planes(file, layer.whole);
    Planes same = planes;
    report_filled(layer, fill_unusable(planes, same), arguments);
    ImageF image(file.width, file.height, 3);
    planes.copy_to(image, std::array{0, 1, 2});
    return image;
}

/// Denoises the layers of light in place with Open Image Denoise; returns false if the work was interrupted, and throws
/// SceneError if a layer has not three channels.
bool denoise_layers_oidn(DenoiseInput& input, const DenoiseArguments& arguments) {
    ImageF& pixels = input.file.pixels;
    OidnFeatures features;
    for (const LayerChannels& layer : input.plan.features) {
        if (layer.name == "albedo") features.albedo = read_channels_of(pixels, layer, arguments);
        if (layer.name == "N") features.normal = read_channels_of(pixels, layer, arguments);
    }
    for (const LayerChannels& layer : input.plan.lights) {
        const ImageF light = read_channels_of(pixels, layer, arguments);
        const auto denoised = denoise_oidn(light, features, {arguments.threads, &interrupt_requested()});
        if (!denoised || interrupt_requested()) return false;
        Planes(*denoised, std::array{0, 1, 2}).copy_to(pixels, layer.whole);
    }
    return true;
}

bool denoise_layers(DenoiseInput& input, const DenoiseArguments& arguments) {
    return arguments.method == "oidn" ? denoise_layers_oidn(input, arguments) : denoise_layers_nfor(input, arguments);
}

/// Returns the depth in which `channel` is written: for light and alpha the one that `arguments` ask for, if any, else
/// the depth in the input, because normals or mattes of 16 bits would be others.
PixelDepth depth_of(const DenoiseInput& input, int channel, const DenoiseArguments& arguments) {
    const auto has_it = [&](const LayerChannels& layer) {
        return std::ranges::find(layer.whole, channel) != layer.whole.end();
    };
    const auto place = static_cast<std::size_t>(channel);
    const bool is_light = std::ranges::any_of(input.plan.lights, has_it) || input.file.channel_names[place] == "A";
    return is_light ? arguments.depth.value_or(input.file.depths[place]) : input.file.depths[place];
}

/// The channels that are kept, with the attributes of the file.
void write_denoised(const DenoiseInput& input, const DenoiseArguments& arguments) {
    const ImageF& pixels = input.file.pixels;
    ImageF image(pixels.width, pixels.height, static_cast<int>(input.plan.kept.size()));
    for (int y = 0; y < pixels.height; ++y)
        for (int x = 0; x < pixels.width; ++x)
            std::ranges::transform(
                input.plan.kept, image.pixel(x, y).begin(),
                [source = pixels.pixel(x, y)](int channel) { return source[static_cast<std::size_t>(channel)]; });
    ImageWriteOptions options;
    ImagePart part{.image = &image};
    for (const int channel : input.plan.kept) {
        part.channel_names.push_back(input.file.channel_names[static_cast<std::size_t>(channel)]);
        part.channel_depths.push_back(depth_of(input, channel, arguments));
    }
    options.attributes = input.file.attributes;
    std::erase_if(options.attributes,
                  [](const ImageAttribute& a) { return a.name == kHalfShare || a.name == kLightLayers; });
    const std::string radius = arguments.method == "nfor" ? fmt::format(", radius {}", arguments.radius) : "";
    options.attributes.push_back({kDenoised, fmt::format("{}{}, {}", arguments.method, radius, software_name())});
    const PixelRect& data = input.file.data_window;
    const PixelRect& display = input.file.display_window;
    options.offset_x = data.x0 - display.x0;
    options.offset_y = data.y0 - display.y0;
    options.full_x = display.x0;
    options.full_y = display.y0;
    options.full_width = display.width();
    options.full_height = display.height();
    write_image_parts(arguments.output, std::array{part}, options);
}

std::string layer_names(const std::vector<LayerChannels>& layers) {
    std::vector<std::string> names;
    names.reserve(layers.size());
    for (const LayerChannels& layer : layers) names.push_back(shown(layer));
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

ExitCode run_denoise(const DenoiseArguments& arguments) {
    if (arguments.method == "oidn" && !has_oidn())
        throw UsageError(
            "--method oidn: this program was built without Intel Open Image Denoise; '--method nfor' needs no library");
    if (std::filesystem::path(arguments.output).extension() != ".exr")
        throw UsageError(fmt::format("--output '{}' must end in .exr", arguments.output));
    for (const std::string& feature : arguments.features)
        if (arguments.method == "oidn" && std::ranges::find(kOidnFeatures, feature) == kOidnFeatures.end())
            throw UsageError(fmt::format("--features {}: the network of '--method oidn' knows {} only", feature,
                                         fmt::join(kOidnFeatures, " and ")));
    require_writable(arguments.output);
    require_files_kept("--output", std::array<std::filesystem::path, 1>{arguments.output}, {arguments.image});
    try {
        const auto start = std::chrono::steady_clock::now();
        DenoiseInput input = read_input(arguments);
        if (!denoise_layers(input, arguments)) return interrupt_exit_code();
        write_denoised(input, arguments);
        const double seconds = seconds_since(start);
        if (!arguments.quiet)
            log_info("{}: {}x{}, denoised {}; features {}; {:.1f} s", arguments.output, input.file.pixels.width,
                     input.file.pixels.height, layer_names(input.plan.lights), layer_names(input.plan.features),
                     seconds);
    } catch (const std::bad_alloc&) {
        throw IoError(fmt::format("there is not enough memory to denoise {}", arguments.image));
    }
    return ExitCode::Success;
}

}  // namespace

void add_denoise_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<DenoiseArguments>();
    CLI::App* command = app.add_subcommand("denoise", "Take the noise out of an image");
    command->add_option("IMAGE", arguments->image, "EXR file of 'etendue render --aov denoising'")
        ->required()
        ->check(CLI::ExistingFile);
    command->add_option("-o,--output", arguments->output, "EXR file to write")->required();
    command
        ->add_option("--method", arguments->method,
                     fmt::format("nfor (default): regression on features, without trained weights; oidn: Intel Open "
                                 "Image Denoise, in builds that have it (this one {})",
                                 has_oidn() ? "has" : "has not"))
        ->check(CLI::IsMember({"nfor", "oidn"}));
    command
        ->add_option(
            "--features", arguments->features,
            fmt::format("Layers that say where edges and textures are (default: those of {} that the file has)",
                        fmt::join(default_features(), ", ")))
        ->delimiter(',')
        ->allow_extra_args(false);
    command
        ->add_option("--radius", arguments->radius,
                     "Pixels that are looked at on each side of a pixel (default: 9). Time is as its square")
        ->check(CLI::Range(1, kLargestWindowRadius));
    auto* half = command->add_flag_callback(
        "--half", [arguments] { arguments->depth = PixelDepth::Half; },
        "Write what is denoised as 16-bit floats (default: as in the file)");
    command
        ->add_flag_callback(
            "--float", [arguments] { arguments->depth = PixelDepth::Float; }, "The same as 32-bit floats")
        ->excludes(half);
    command->add_flag("--keep-fireflies", arguments->keep_fireflies,
                      fmt::format("Spread, and do not remove, what is more than {:g} times brighter in one half of the "
                                  "samples than its surroundings in the other",
                                  kFireflyFactor));
    add_threads_option(*command, arguments->threads);
    command->add_flag("--quiet", arguments->quiet, "No notes or warnings; errors only");
    command->footer(
        "R, G and B are denoised, and every layer of light that has R, G and B; each by its own variance, which the\n"
        "channels of half of the samples tell. Features, alpha and all else are written as they are, these are not.\n"
        "The result is the same for every number of threads. docs/denoising.md says what it does to caustics, "
        "textures\n"
        "and fireflies.\n\n"
        "Examples:\n"
        "  etendue render scenes/cornell-box --spp 64 --aov denoising -o noisy.exr\n"
        "  etendue denoise noisy.exr -o box.exr\n"
        "  etendue denoise noisy.exr -o box.exr --features albedo,N,shadow");
    command->callback([arguments, &action] { action = [arguments] { return run_denoise(*arguments); }; });
}

}  // namespace etendue
