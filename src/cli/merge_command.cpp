// etendue merge: one image from parts that were rendered apart.
#include "cli/command_options.h"
#include "cli/commands.h"
#include "color/color_config.h"
#include "core/error.h"
#include "core/log.h"
#include "core/pixel_rect_text.h"
#include "core/standard_output.h"
#include "loader/loader.h"
#include "picture/description_text.h"
#include "picture/exr_files.h"
#include "picture/image_description.h"
#include "picture/output_paths.h"
#include "session/image_files.h"
#include "session/input_files.h"
#include "session/interrupt.h"
#include "session/library_versions.h"
#include "session/merge_parts.h"
#include "session/output_checks.h"
#include "session/phase_timer.h"
#include "session/usage_error.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

struct MergeArguments {
    std::vector<std::string> parts;
    std::string output;
    std::string command;
    std::optional<PixelDepth> depth;  ///< the parts' if there is none
    bool quiet = false;
    bool json = false;
};

/// Returns whether the image is all that was asked for when its parts were rendered. Parts of one window may have been
/// meant to be a crop; other ones are tiles of the whole image, and parts that were merged of such have no hash.
bool is_whole(const MergedParts& merged, const RenderStatistics& statistics) {
    const RenderState& state = merged.sum.state;
    const bool may_be_a_crop = merged.has_one_window && !statistics.settings_hash.empty();
    return state.spp_done >= static_cast<std::uint32_t>(std::max(statistics.spp_requested, 0)) &&
           (may_be_a_crop || state.film.window() == state.film.splat_window());
}

/// Warns of the samples that are missing before and behind those of the parts, and of a common window of the parts that
/// is not the whole image; gaps have been noted before.
void note_missing(const MergedParts& merged, std::uint32_t spp_requested) {
    const RenderState& state = merged.sum.state;
    const std::uint32_t end = state.first_sample + merged.spp_span;
    if (state.first_sample > 0) log_warning("note: no part has samples 0 to {}", state.first_sample - 1);
    if (end < spp_requested) log_warning("note: no part has samples {} to {}", end, spp_requested - 1);
    const PixelRect& all = state.film.splat_window();
    if (!merged.has_one_window && state.film.window() != all)
        log_warning("note: the parts have the pixels {} of {}", text_of(state.film.window()), text_of(all));
}

/// Describes an image that was merged of several windows as one render of all its pixels; so far, the description has
/// the window of the first part.
void describe_window(const RenderState& state, ImageDescription& image) {
    RenderStatistics& statistics = image.statistics;
    const PixelRect& window = state.film.window();
    const bool is_whole = window == state.film.splat_window();
    statistics.settings_hash = is_whole ? statistics.hash_of_whole : "";
    const nlohmann::json crop =
        is_whole ? nlohmann::json() : nlohmann::json{window.x0, window.y0, window.x1, window.y1};
    nlohmann::json requested = nlohmann::json::parse(statistics.requested_settings);
    nlohmann::json resolved = nlohmann::json::parse(statistics.settings);
    requested["/crop"] = resolved["/crop"] = crop;
    if (is_whole) requested.erase("/crop");
    statistics.requested_settings = requested.dump();
    statistics.settings = image.frame.settings = resolved.dump();
}

/// Throws UsageError for names of files that can be neither parts nor what is made of them.
void check_names(const MergeArguments& arguments) {
    const std::filesystem::path output = arguments.output;
    if (!is_partial(output) && output.extension() != ".exr")
        throw UsageError(
            fmt::format("--output '{}' must end in .exr, or in .partial for a larger part", output.string()));
    for (const std::string& part : arguments.parts)
        if (std::filesystem::path(part).extension() == ".exr")
            throw UsageError(
                fmt::format("'{}' is an image, and an image is no part: parts are .partial files, of "
                            "'etendue render SCENE --samples A:B -o PART.partial'",
                            part));
}

void require_parts_kept(const MergeArguments& arguments, std::span<const std::filesystem::path> outputs) {
    const std::vector<std::filesystem::path> parts(arguments.parts.begin(), arguments.parts.end());
    require_files_kept("--output", outputs, parts);
}

MergedParts merge_given_parts(const MergeArguments& arguments) {
    const std::vector<std::filesystem::path> parts(arguments.parts.begin(), arguments.parts.end());
    const NothingToKeep while_reading;
    return merge_parts(parts, [&](const std::string& note) {
        // A part says where its samples begin and how many there are, and no more.
        if (is_partial(arguments.output))
            throw SceneError({arguments.output, {}}, note + "; such parts can become an image only");
        if (!arguments.quiet) log_warning("note: {}", note);
    });
}

/// Writes the image of the parts with its layers and all that stands beside it.
void write_merged_image(const MergeArguments& arguments, const OutputPaths& paths, const RenderState& state,
                        ImageDescription& image) {
    if (const auto note = few_buckets(image.statistics); note && !arguments.quiet)
        log_warning("note: {}: {}", arguments.output, *note);
    require_writable(paths.png);
    require_writable(paths.json);
    require_no_layer_of_another(paths.exr);
    const PixelDepth depth = arguments.depth.value_or(image.depth);
    if (image.frame.aces_container && depth == PixelDepth::Float)
        throw UsageError(
            "--float: the parts were rendered for an ACES container (SMPTE ST 2065-4), which holds 16-bit floats");
    resolve_layers(image, state);
    std::vector<std::filesystem::path> layers;
    for (const std::string& name : layer_file_names(paths.exr, image)) layers.push_back(paths.exr.parent_path() / name);
    require_parts_kept(arguments, layers);
    for (const std::filesystem::path& layer : layers) require_no_image_at(layer, {arguments.output, {}});
    image.statistics.libraries = library_versions();
    const ColorConfig colors = ColorConfig::from_environment();
    const std::vector<std::string> earlier = write_image_files(paths, image, colors, depth);
    if (arguments.quiet) return;
    note_brightest(paths, image.frame, colors, depth);
    note_exposure(paths, image.statistics);
    note_earlier_files(earlier);
}

ExitCode run_merge(const MergeArguments& arguments) {
    check_names(arguments);
    const std::filesystem::path output = arguments.output;
    const OutputPaths paths = OutputPaths::beside(output);
    require_writable(output);
    if (!is_partial(output) && paths.json.filename() == kSettingsName)
        throw UsageError(
            fmt::format("--output: the statistics, {}, would replace the settings of a scene, or be taken for "
                        "settings: give the image another name",
                        paths.json.string()));
    require_parts_kept(arguments,
                       is_partial(output) ? std::vector{output} : std::vector{output, paths.png, paths.json});
    const PhaseTimer timer;
    const MergedParts merged = merge_given_parts(arguments);
    const RenderState& state = merged.sum.state;
    ImageDescription image = description_of(merged.sum, arguments.parts.front());
    if (!merged.has_one_window) describe_window(state, image);
    const std::string of_part = merged.has_one_window ? merged.sum.description : to_text(image);
    image.statistics.load = timer.elapsed();
    image.statistics.command = arguments.command;
    const auto spp_requested = static_cast<std::uint32_t>(std::max(image.statistics.spp_requested, 0));
    const bool complete = is_whole(merged, image.statistics);
    describe_state(image, state, complete, "merged");
    if (is_partial(output)) {
        write_checkpoint(output, merged.sum.identity, of_part, state);
    } else {
        if (!arguments.quiet) note_missing(merged, spp_requested);
        write_merged_image(arguments, paths, state, image);
    }
    const PixelRect& window = state.film.window();
    if (!arguments.quiet)
        log_info("{}: {} part{}, {}x{}, {} spp{}", output.string(), arguments.parts.size(),
                 arguments.parts.size() == 1 ? "" : "s", window.width(), window.height(), state.spp_done,
                 complete || is_partial(output) ? "" : ", incomplete");
    if (arguments.json) print_data(to_json(image.statistics));
    return ExitCode::Success;
}

}  // namespace

void add_merge_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<MergeArguments>();
    CLI::App* command = app.add_subcommand("merge", "Make one image of parts that were rendered apart");
    command->add_option("PARTS", arguments->parts, "Files of 'etendue render -o PART.partial'")
        ->required()
        ->check(CLI::ExistingFile);
    command
        ->add_option("-o,--output", arguments->output,
                     "EXR file to write; PNG and JSON go beside it. Or a .partial, to be merged further")
        ->required();
    auto* half = command->add_flag_callback(
        "--half", [arguments] { arguments->depth = PixelDepth::Half; },
        "Write 16-bit floats (default: what the first part was rendered with)");
    command
        ->add_flag_callback(
            "--float", [arguments] { arguments->depth = PixelDepth::Float; }, "Write 32-bit floats")
        ->excludes(half);
    command->add_flag("--quiet", arguments->quiet, "No notes; errors only");
    command->add_flag("--json", arguments->json, "Print the statistics as JSON on stdout");
    command->footer(
        "Parts are ranges of samples (--samples) of the same pixels, or crops (--crop) that do not overlap,\n"
        "or both; all of the same scene, settings and version, which is checked, as is that no sample is\n"
        "there twice and no pixel has fewer than the others; windows must tile a rectangle. If samples are\n"
        "missing, or pixels around several windows, the image is marked incomplete. The image is that of a\n"
        "single render but for the order in which sums were added (1e-6).\n"
        "The memory it takes is that of two parts and the image: 48 bytes a pixel, 72 with light subpaths,\n"
        "and more with layers (docs/aovs.md).\n\n"
        "Examples:\n"
        "  etendue render scenes/cornell-box --samples 0:128 -o a.partial\n"
        "  etendue render scenes/cornell-box --samples 128:256 -o b.partial\n"
        "  etendue merge a.partial b.partial -o box.exr\n"
        "  etendue merge parts/*.partial -o half.partial");
    command->callback([arguments, command, &action] {
        const std::vector<const CLI::Option*> all = std::as_const(*command).get_options();
        arguments->command = command_line("etendue merge", given_options(all));
        action = [arguments] { return run_merge(*arguments); };
    });
}

}  // namespace etendue
