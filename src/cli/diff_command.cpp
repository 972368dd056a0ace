// etendue diff: how far an image is from a reference.
#include "cli/command_options.h"
#include "cli/commands.h"
#include "cli/diff_report.h"
#include "cli/settings_options.h"
#include "compare/image_measures.h"
#include "compare/image_pair.h"
#include "core/log.h"
#include "core/pixel_rect_text.h"
#include "image/write.h"
#include "metrics/color_map.h"
#include "metrics/error_metrics.h"
#include "output/software_name.h"
#include "picture/output_paths.h"
#include "session/file_color_space.h"
#include "session/input_files.h"
#include "session/usage_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

/// The share of the values that a map's scale holds where errors have no largest: what lies above is fireflies.
constexpr double kScaleQuantile = 0.99;

struct DiffArguments {
    std::string image;
    std::string reference;
    std::vector<std::string> measures;
    std::vector<Limit> limits;
    std::string map;
    std::optional<double> map_largest;
    MeasureOptions options;
    int threads = 0;
    bool json = false;
    bool quiet = false;
};

/// "flip=0.05".
Limit parse_limit(const std::string& text) {
    const std::size_t equals = text.find('=');
    Limit limit{CLI::detail::to_lower(text.substr(0, equals)), 0.0};
    const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
    char rest = 0;
    if (std::sscanf(value.c_str(), "%lf%c", &limit.value, &rest) != 1 || !(limit.value >= 0.0))
        throw CLI::ValidationError("--fail-above", fmt::format("'{}' is not MEASURE=VALUE with VALUE >= 0", text));
    const std::vector<std::string> names = measure_names();
    if (std::ranges::find(names, limit.measure) == names.end())
        throw CLI::ValidationError("--fail-above", fmt::format("there is no measure '{}'; there are {}", limit.measure,
                                                               fmt::join(names, ", ")));
    return limit;
}

/// "-4:2.5".
void parse_exposures(const std::string& text, HdrFlipOptions& options) {
    float start = 0.0f;
    float stop = 0.0f;
    char rest = 0;
    // As many exposures as there are stops between the two: half of what a float can hold is more than enough.
    constexpr float kMost = 64.0f;
    if (std::sscanf(text.c_str(), "%f:%f%c", &start, &stop, &rest) != 2 || !(std::abs(start) <= kMost) ||
        !(std::abs(stop) <= kMost) || stop < start)
        throw CLI::ValidationError(
            "--exposures",
            fmt::format("'{}' is not START:STOP in stops with -{:g} <= START <= STOP <= {:g}", text, kMost, kMost));
    options.start_exposure = start;
    options.stop_exposure = stop;
}

/// The measures that were named or have a limit, or the usual ones; each once, limits' last.
std::vector<std::string> chosen_measures(const DiffArguments& arguments, bool is_encoded) {
    std::vector<std::string> names = arguments.measures.empty() ? default_measures() : arguments.measures;
    for (const Limit& limit : arguments.limits) names.push_back(limit.measure);
    std::vector<std::string> chosen;
    for (const std::string& name : names) {
        std::string resolved = resolve_measure(name, is_encoded);
        if (std::ranges::find(chosen, resolved) == chosen.end()) chosen.push_back(std::move(resolved));
    }
    return chosen;
}

/// Returns the error that the map's last colour stands for, and where that number comes from.
std::pair<double, std::string> largest_of_map(const MeasuredPair& pair, const Measure& measure,
                                              const std::optional<double>& told) {
    if (told) return {*told, "as --map-max says"};
    if (measure.name.ends_with("flip")) return {1.0, "FLIP's largest"};
    const double quantile = quantile_of(pair.map(), kScaleQuantile, pair.selection());
    if (quantile > 0.0) return {quantile, fmt::format("{:g}% of the pixels are not above", 100.0 * kScaleQuantile)};
    const double largest = quantile_of(pair.map(), 1.0, pair.selection());
    if (largest > 0.0) return {largest, "the largest"};
    return {1.0, "there is no error"};
}

MapWritten write_map(const MeasuredPair& pair, const Measure& measure, const DiffArguments& arguments) {
    const auto [largest, scale] = largest_of_map(pair, measure, arguments.map_largest);
    MapWritten written{arguments.map, measure.name, largest, scale};
    const bool as_colors = std::filesystem::path(arguments.map).extension() != ".exr";
    ImageWriteOptions options;
    options.depth = as_colors ? PixelDepth::UInt8 : PixelDepth::Float;
    options.attributes = {{"Software", std::string(software_name())}, {"etendue:measure", measure.name}};
    if (as_colors) {
        options.attributes.push_back({"etendue:largest", static_cast<float>(largest)});
        options.attributes.push_back({"oiio:ColorSpace", std::string("sRGB")});
        write_image(arguments.map, paint_magma(pair.map(), largest, pair.selection().left_out), options);
        return written;
    }
    // Where the pixels lie in the full image, as in the images themselves.
    const PixelRect& window = pair.pair().window;
    const PixelRect& full = pair.pair().image_file.display;
    if (window != full) {
        options.offset_x = window.x0;
        options.offset_y = window.y0;
        options.full_width = full.width();
        options.full_height = full.height();
    }
    write_image(arguments.map, pair.map(), options);
    return written;
}

/// Throws UsageError for options that would change nothing of what `names` measure.
void require_effect(const DiffArguments& arguments, const std::vector<std::string>& names) {
    const bool has_flip = std::ranges::any_of(names, [](const std::string& name) { return name.ends_with("flip"); });
    const auto& flip = arguments.options.flip;
    if (arguments.map_largest && std::filesystem::path(arguments.map).extension() != ".png")
        throw UsageError("--map-max is of --map FILE.png");
    if (flip.pixels_per_degree != kFlipPixelsPerDegree && !has_flip)
        throw UsageError("--ppd is of FLIP, which is not among the measures");
    if (flip.start_exposure && std::ranges::find(names, "hdr-flip") == names.end())
        throw UsageError("--exposures is of hdr-flip, which is not among the measures");
}

/// Takes no measure that the images are not made for. Says why on stderr if it is asked to.
bool can_measure(const ImagePair& pair, const std::vector<std::string>& names, const DiffArguments& arguments) {
    if (pair.is_encoded && std::ranges::find(names, "hdr-flip") != names.end()) {
        log_error("error: hdr-flip is of scene-linear images (EXR, HDR); for {} there is ldr-flip",
                  pair.image_file.format);
        return false;
    }
    const auto& region = arguments.options.region;
    if (region && intersection(*region, pair.window) != *region) {
        log_error("error: --crop {} is not inside {}, the pixels that both images have", text_of(*region),
                  text_of(pair.window));
        return false;
    }
    return true;
}

void add_flip_warning(ImagePair& pair, const std::vector<std::string>& names, const ColorConfig& colors) {
    const bool has_flip = std::ranges::any_of(names, [](const std::string& name) { return name.ends_with("flip"); });
    if (!has_flip || pair.is_encoded || find_matrix(pair.color_space, kGltfColorSpace, colors)) return;
    pair.warnings.emplace_back("FLIP takes the images to be linear Rec.709, as their colour space is not known");
}

ExitCode run_diff(const DiffArguments& arguments) {
    if (!arguments.map.empty())
        require_files_kept("--map", std::array<std::filesystem::path, 1>{arguments.map},
                           {arguments.image, arguments.reference});
    const ColorConfig colors = ColorConfig::from_environment();
    ImagePair images = read_image_pair(arguments.image, arguments.reference, colors);
    const std::vector<std::string> names = chosen_measures(arguments, images.is_encoded);
    if (!can_measure(images, names, arguments)) return ExitCode::UsageError;
    require_effect(arguments, names);
    add_flip_warning(images, names, colors);
    if (!arguments.quiet)
        for (const std::string& warning : images.warnings) log_warning("warning: {}", warning);

    const ThreadPool threads(arguments.threads);
    MeasuredPair pair(std::move(images), arguments.options);
    DiffResult result;
    result.measures = pair.measure(names, colors, threads);
    for (const Limit& limit : arguments.limits)
        result.limits.push_back({resolve_measure(limit.measure, pair.pair().is_encoded), limit.value});
    // What was measured must not be lost with a map that cannot be written.
    std::exception_ptr map_failure;
    try {
        if (!arguments.map.empty()) {
            require_writable(arguments.map);
            result.map = write_map(pair, result.measures.front(), arguments);
        }
    } catch (const std::exception&) {
        map_failure = std::current_exception();
    }

    log_faults(pair);
    bool passed = pair.not_finite_in_image().count() + pair.not_finite_in_reference().count() == 0;
    for (const Measure& measure : result.measures) {
        if (!result.is_too_large(measure)) continue;
        passed = false;
        log_error("error: {} is {:.6g}, which is above its limit of {:g}", measure.name, measure.value,
                  *result.limit_of(measure.name));
    }
    if (arguments.json)
        print_json(pair, arguments.options, result, passed);
    else if (!arguments.quiet)
        print_report(pair, arguments.options, result);
    if (map_failure) std::rethrow_exception(map_failure);
    return passed ? ExitCode::Success : ExitCode::DiffFailed;
}

void add_diff_options(CLI::App& command, DiffArguments& arguments) {
    command.add_option("IMAGE", arguments.image, "The image to judge: EXR, HDR, PNG, JPEG, TIFF or WebP")->required();
    command.add_option("REFERENCE", arguments.reference, "What it should look like")->required();
    command
        .add_option("--metric", arguments.measures,
                    "Measures to take, with commas between them (default: all five and flip)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->transform(CLI::IsMember(measure_names(), CLI::ignore_case));
    command
        .add_option_function<std::vector<std::string>>(
            "--fail-above",
            [&arguments](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) arguments.limits.push_back(parse_limit(text));
            },
            "End with exit code 1 if the measure is larger; for several, again or with commas")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("MEASURE=VALUE");
    command
        .add_option("--map", arguments.map,
                    "Write the error of each pixel by the first measure: .png in colours (magma), .exr as numbers")
        ->type_name("FILE");
    command
        .add_option("--map-max", arguments.map_largest,
                    "What the brightest colour of the PNG stands for (default: 1 for FLIP, else what 99% of the "
                    "pixels are not above)")
        ->check(CLI::PositiveNumber);
    command
        .add_option_function<std::string>(
            "--crop",
            [&arguments](const std::string& text) { arguments.options.region = parse_pixel_window("--crop", text); },
            "Measure only the pixels from x0, y0 up to but not including x1, y1 of the full image, y downwards from "
            "the top left corner")
        ->type_name("x0,y0,x1,y1");
    add_old_name(command, "--region", "--crop");
    command
        .add_option("--ppd", arguments.options.flip.pixels_per_degree,
                    "FLIP: pixels per degree of the viewer's sight (default: 67.02, a screen of 3840 pixels and "
                    "0.7 m seen from 0.7 m)")
        ->check(CLI::Range(kLeastPixelsPerDegree, kMostPixelsPerDegree));
    command
        .add_option_function<std::string>(
            "--exposures", [&arguments](const std::string& text) { parse_exposures(text, arguments.options.flip); },
            "HDR-FLIP: exposures in stops (default: chosen by the reference; the same for images that are to be "
            "ranked)")
        ->type_name("START:STOP");
    add_threads_option(command, arguments.threads);
    command.add_flag("--json", arguments.json, "Print JSON on stdout");
    command.add_flag("--quiet", arguments.quiet, "No report and no warnings; errors only");
}

}  // namespace

void add_diff_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<DiffArguments>();
    CLI::App* command = app.add_subcommand("diff", "Measure how far an image is from a reference");
    add_diff_options(*command, *arguments);
    command->footer(fmt::format(
        "Measures, v being the image's value and r the reference's, means over pixels and channels R, G, B:\n"
        "  relmse          {}\n"
        "  relmse-trimmed  {}\n"
        "  mse             {}\n"
        "  mae             {}\n"
        "  smape           {}\n"
        "  ldr-flip        mean LDR-FLIP, for images encoded for a display; floats are clipped at 1\n"
        "  hdr-flip        mean HDR-FLIP, for scene-linear images\n"
        "  flip            the one of the two that fits\n\n"
        "Both files must have the same full size, the same kind of values and the same colour space; of crop windows\n"
        "the pixels that both have are compared. Pixels that are not finite are reported and left out.\n\n"
        "Exit codes: 0 compared, 1 a measure is above its limit or pixels are not finite, 2 usage error, 3 a file\n"
        "cannot be read or the two cannot be compared.\n\n"
        "Examples:\n"
        "  etendue diff box.exr reference.exr\n"
        "  etendue diff box.exr reference.exr --metric flip --map flip.png\n"
        "  etendue diff box.exr reference.exr --fail-above relmse=0.01,flip=0.05 --quiet\n"
        "  etendue diff new.png old.png --metric ldr-flip --json\n"
        "  etendue diff crop.exr reference.exr --crop 100,100,200,200 --metric mse,smape",
        formula_of(ErrorMetric::RelMse), formula_of(ErrorMetric::RelMseTrimmed), formula_of(ErrorMetric::Mse),
        formula_of(ErrorMetric::Mae), formula_of(ErrorMetric::Smape)));
    command->callback([arguments, &action] {
        action = [arguments] {
            const std::string extension = std::filesystem::path(arguments->map).extension().string();
            if (!arguments->map.empty() && extension != ".png" && extension != ".exr") {
                log_error("error: --map '{}' must end in .png or .exr", arguments->map);
                return ExitCode::UsageError;
            }
            return run_diff(*arguments);
        };
    });
}

}  // namespace etendue
