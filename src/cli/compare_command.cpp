// etendue compare: ways of rendering one scene against each other.
#include "cli/command_options.h"
#include "cli/commands.h"
#include "cli/compare_run.h"
#include "cli/settings_options.h"
#include "cli/variant_options.h"
#include "core/log.h"
#include "picture/render_setup.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

/// "caustic:10,20,100,80".
NamedRegion parse_region(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos || colon == 0)
        throw CLI::ValidationError("--region", "'" + text + "' is not NAME:x0,y0,x1,y1");
    return {text.substr(0, colon), parse_pixel_window("--region", text.substr(colon + 1)), false};
}

NamedOptions parse_variant(const std::string& text) {
    const std::size_t colon = text.find(':');
    NamedOptions variant{CLI::detail::trim_copy(text.substr(0, colon)),
                         colon == std::string::npos ? "" : CLI::detail::trim_copy(text.substr(colon + 1))};
    if (colon == std::string::npos || variant.name.empty() || variant.name.starts_with('-'))
        throw CLI::ValidationError(
            "--variant", fmt::format("'{}' is not NAME: OPTIONS, such as 'power: --heuristic power'; a set of "
                                     "materials is chosen there, as in 'red: --variant red'",
                                     text));
    return variant;
}

void set_compare_groups(CLI::App& command) {
    set_group(command, "What is compared", {"--integrators", "--variant", "--time", "--wall", "--seeds", "--threads"});
    set_group(command, "What errors are measured against",
              {"--reference", "--reference-integrator", "--reference-time"});
    set_group(command, "What is reported",
              {"--region", "--insets", "--strategies-depth", "--keep-images", "--live", "--quiet", "--json"});
    command.get_option("--spp")->description("Samples per pixel of each render, in place of --time");
    command.get_option("--integrator")->description("Algorithm of the variants of --variant that name none");
}

void add_comparison_options(CLI::App& command, CompareArguments& arguments) {
    add_scene_argument(command, arguments.scene);
    add_directory_option(
        command, arguments.output,
        "Directory for index.html, report.json, data.csv, tables.tex and plots; made if it is missing");
    auto* integrators =
        command.add_option("--integrators", arguments.integrators,
                           "Algorithms to compare, separated by commas (default: path,bdpt, and vcm where the "
                           "scene has mirrors or smooth glass)");
    integrators->delimiter(',')->allow_extra_args(false)->check(CLI::IsMember(integrator_setting_names()));
    command.add_flag("--wall", arguments.by_wall,
                     "Compare by time on the clock in place of CPU time, as where variants leave threads idle");
    command
        .add_option("--seeds", arguments.seeds,
                    "Independent renders of each variant, 3 or more without a reference; a single one does not show "
                    "its noise (default: 4)")
        ->check(CLI::Range(1, 1000));
}

void add_reference_options(CLI::App& command, CompareArguments& arguments) {
    auto* file = command.add_option("--reference", arguments.reference, "EXR or HDR file to measure errors against")
                     ->check(CLI::ExistingFile);
    auto* by = command.add_option("--reference-integrator", arguments.reference_integrator,
                                  "Algorithm that renders the reference (default: the variants' renders are pooled)");
    by->check(CLI::IsMember(integrator_names()))->excludes(file);
    command
        .add_option(
            "--reference-time", arguments.reference_seconds,
            "Time of that render, in seconds, counted as --time is (default: ten times that of the longest variant)")
        ->check(real_range(1e-3, 1e9))
        ->needs(by);
    add_old_name(command, "--reference-seconds", "--reference-time");
}

void add_report_options(CLI::App& command, CompareArguments& arguments) {
    command
        .add_option_function<std::vector<std::string>>(
            "--region",
            [&arguments](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) arguments.regions.push_back(parse_region(text));
            },
            "Part of the image to report by itself, in pixels as of --crop; may be repeated (default: where variants "
            "differ most)")
        ->allow_extra_args(false)
        ->type_name("NAME:x0,y0,x1,y1");
    command
        .add_option(
            "--insets", arguments.inset_classes,
            "Layers of light, such as caustics,diffuse_indirect, with commas: the part of the image in which each "
            "is brightest is reported by itself (etendue render --help and docs/aovs.md have their names)")
        ->delimiter(',')
        ->allow_extra_args(false);
    command.add_flag("--keep-images", arguments.keep_images,
                     "Write the image of every render to DIR/images, as EXR of 32-bit floats");
    command
        .add_option("--strategies-depth", arguments.longest_strategy,
                    "Longest paths whose strategies are shown for bdpt (default: 5); 0 for none")
        ->check(CLI::Range(0, 12));
    add_threads_option(command, arguments.threads);
    add_live_option(command, arguments.live, "Show each render in a browser as it grows");
    command.add_flag("--quiet", arguments.quiet, "No progress, notes or summary; errors only");
    command.add_flag("--json", arguments.json, "Print report.json on stdout, too");
}

/// Puts the variants that are compared in the place of the set of materials, which is chosen among the options of a
/// variant.
void replace_variant_option(CLI::App& command, CompareArguments& arguments) {
    command.remove_option(command.get_option("--variant"));
    command
        .add_option_function<std::vector<std::string>>(
            "--variant",
            [&arguments](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) arguments.variants.push_back(parse_variant(text));
            },
            "A variant to compare, with options of 'render', such as 'deep: --max-depth 64'; may be repeated, and goes "
            "with --integrators")
        ->allow_extra_args(false)
        ->type_name("'NAME: OPTIONS'");
}

/// Throws a validation error for options that cannot be given together.
void require_consistent(const CLI::App& command, const CompareArguments& given) {
    if (given.common.overrides.spp() && given.seconds)
        throw CLI::ValidationError("--time", "cannot be given with --spp: one of them ends a render");
    if (given.variants.empty() && command.count("--integrator") > 0)
        throw CLI::ValidationError("--integrator", "--integrators names the algorithms that are compared");
    if (given.seeds == 2 && given.reference.empty() && given.reference_integrator.empty())
        throw CLI::ValidationError("--seeds",
                                   "2 give no reference, which is pooled from 3 or more, and so no errors: give "
                                   "--seeds 3, --reference or --reference-integrator");
    require_different("--integrators", given.integrators);
    std::vector<std::string> names = given.integrators;
    for (const NamedOptions& variant : given.variants) names.push_back(variant.name);
    if (names.size() == 1 && given.seeds > 1 && given.reference.empty() && given.reference_integrator.empty())
        throw CLI::ValidationError(given.variants.empty() ? "--integrators" : "--variant",
                                   fmt::format("'{}' alone gives no reference, which is pooled from 2 variants or "
                                               "more, and so no errors: give another, --reference or "
                                               "--reference-integrator",
                                               names.front()));
    require_different("--variant", names);
    require_different("--insets", given.inset_classes);
    std::vector<std::string> regions = given.inset_classes;
    for (const NamedRegion& region : given.regions) regions.push_back(region.name);
    require_different("--region", regions);
}

constexpr const char* kCompareFooter =
    "Every variant is rendered as many times, each time with a seed that no other render has and for the same CPU\n"
    "time unless --spp is given, and its error is measured on the way. Other options override render.json for all\n"
    "variants. Exit code 1 if variants that show the same light and find all of it do not make the same image.\n\n"
    "Examples:\n"
    "  etendue compare scenes/caustic-glass -o report\n"
    "  etendue compare scenes/caustic-glass -o report --live\n"
    "  etendue compare scenes/cornell-box --integrators path,bdpt,light --time 5 --seeds 8 -o report\n"
    "  etendue compare scenes/caustic-glass --region caustic:105,192,150,216 --reference glass.exr -o report\n"
    "  etendue compare scenes/veach-mis --integrator bdpt --variant 'power: --heuristic power' --variant 'balance: '"
    " -o report";

}  // namespace

void add_compare_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<CompareArguments>();
    CLI::App* command =
        app.add_subcommand("compare", "Render one scene in several ways and report which comes to the image soonest");
    add_comparison_options(*command, *arguments);
    add_reference_options(*command, *arguments);
    add_report_options(*command, *arguments);
    const std::size_t own = command->get_options().size();
    add_settings_options(*command, arguments->common.overrides);
    replace_variant_option(*command, *arguments);
    replace_time_option(*command, arguments->seconds,
                        "Time of each render, in seconds, if all threads work for it alone: all variants get as much "
                        "CPU time, that of so many seconds on all threads; --spp says how many samples instead "
                        "(default: 10)");
    hide_options(*command, options_compare_sets());
    set_compare_groups(*command);
    command->footer(kCompareFooter);
    command->callback([arguments, command, own, &action] {
        refuse_options(*command, options_compare_sets());
        require_consistent(*command, *arguments);
        const std::vector<const CLI::Option*> all = std::as_const(*command).get_options();
        arguments->command = command_line("etendue compare", given_options(all));
        arguments->common.given = without(without(given_options(std::span(all).subspan(own)), "--variant"), "--time");
        action = [arguments] {
            try {
                return run_compare(*arguments);
            } catch (const CLI::ParseError& error) {
                log_error("error: in the options of a variant: {}", error.what());
                return ExitCode::UsageError;
            }
        };
    });
}

}  // namespace etendue
