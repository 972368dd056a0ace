// etendue compare: ways of rendering one scene against each other.
#include "cli/command_options.h"
#include "cli/commands.h"
#include "cli/settings_options.h"
#include "cli/variant_options.h"
#include "compare/comparison_classes.h"
#include "compare/comparison_files.h"
#include "compare/comparison_images.h"
#include "compare/comparison_measures.h"
#include "compare/comparison_reference.h"
#include "compare/comparison_renders.h"
#include "compare/comparison_summary.h"
#include "compare/comparison_variants.h"
#include "compare/image_pair.h"
#include "core/log.h"
#include "core/source_date.h"
#include "core/standard_output.h"
#include "core/write_file.h"
#include "live/render_page.h"
#include "output/software_name.h"
#include "picture/render_setup.h"
#include "session/interrupt.h"
#include "session/library_versions.h"
#include "session/output_directory.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>

namespace etendue {

namespace {

constexpr double kDefaultSeconds = 10.0;
constexpr int kDefaultSeeds = 4;
constexpr int kDefaultStrategies = 5;  // edges

/// A variant on the command line: "power: --heuristic power".
struct NamedOptions {
    std::string name;
    std::string options;
};

struct CompareArguments {
    std::string scene;
    std::string output;
    std::vector<std::string> integrators;
    std::vector<NamedOptions> variants;
    RenderRequest common;  ///< options that all variants share
    std::string command;   ///< this comparison's
    std::optional<double> seconds;
    bool by_wall = false;
    int seeds = kDefaultSeeds;
    std::string reference;
    std::string reference_integrator;
    std::optional<double> reference_seconds;
    std::vector<NamedRegion> regions;
    std::vector<std::string> inset_classes;
    std::optional<int> longest_strategy;
    bool keep_images = false;
    std::string live;  ///< as `live_port` reads it
    int threads = 0;
    bool quiet = false;
    bool json = false;
};

/// "caustic:10,20,100,80".
NamedRegion parse_region(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos || colon == 0)
        throw CLI::ValidationError("--region", "'" + text + "' is not NAME:x0,y0,x1,y1");
    const auto window = parse_pixel_window("--region", text.substr(colon + 1));
    return {text.substr(0, colon), {window[0], window[1], window[2], window[3]}, false};
}

NamedOptions parse_variant(const std::string& text) {
    const std::size_t colon = text.find(':');
    const auto trimmed = [](const std::string& part) {
        const std::size_t first = part.find_first_not_of(' ');
        return first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(' ') - first + 1);
    };
    NamedOptions variant{trimmed(text.substr(0, colon)),
                         colon == std::string::npos ? "" : trimmed(text.substr(colon + 1))};
    if (colon == std::string::npos || variant.name.empty() || variant.name.starts_with('-'))
        throw CLI::ValidationError(
            "--variant", fmt::format("'{}' is not NAME: OPTIONS, such as 'power: --heuristic power'; a set of "
                                     "materials is chosen there, as in 'red: --variant red'",
                                     text));
    return variant;
}

/// Throws a validation error for `option` if `names` has a name twice, because what has one name could not be told
/// apart.
void require_different(const std::string& option, const std::vector<std::string>& names) {
    std::set<std::string> known;
    for (const std::string& name : names)
        if (!known.insert(name).second) throw CLI::ValidationError(option, "'" + name + "' is named twice");
}

std::vector<VariantRequest> variant_requests(const CompareArguments& arguments) {
    std::vector<VariantRequest> requests;
    const bool chooses = arguments.variants.empty() && arguments.integrators.empty();
    const std::vector<std::string> usual{"path", "bdpt", "vcm"};
    for (const std::string& name : chooses ? usual : arguments.integrators)
        requests.push_back({name, "--integrator " + name, {}, chooses && name == "vcm"});
    for (const NamedOptions& variant : arguments.variants) requests.push_back({variant.name, variant.options, {}});
    for (VariantRequest& request : requests) request.request = with_options(arguments.common, request.options);
    return requests;
}

/// The seconds on the clock, or what all threads would take in them if they had the machine to themselves.
RenderBudget budget_of(double seconds, const CompareArguments& arguments, const ThreadPool& threads) {
    return {.seconds = arguments.by_wall ? seconds : seconds * threads.thread_count(), .by_wall = arguments.by_wall};
}

RenderBudget budget_of(const CompareArguments& arguments, const ThreadPool& threads) {
    if (const auto spp = arguments.common.overrides.spp()) return {.spp = *spp};
    return budget_of(arguments.seconds.value_or(kDefaultSeconds), arguments, threads);
}

/// Returns the time that a reference is rendered for: what is asked for, or ten times that of the longest variant.
RenderBudget reference_budget(const CompareArguments& arguments, const std::vector<VariantRenders>& renders,
                              const ThreadPool& threads) {
    if (arguments.reference_seconds) return budget_of(*arguments.reference_seconds, arguments, threads);
    double longest = 0.0;
    for (const VariantRenders& variant : renders)
        for (const SeedRender& render : variant.seeds) {
            const Snapshot& last = render.checkpoints.back();
            longest = std::max(longest, arguments.by_wall ? last.seconds : last.cpu_seconds);
        }
    return {.seconds = 10.0 * longest, .by_wall = arguments.by_wall};
}

std::vector<std::string> file_names(const CompareArguments& arguments) {
    std::vector<std::string> names{"report.json", "index.html"};
    for (const std::string& name : names_of_data_files()) names.push_back(name);
    if (arguments.reference.empty()) names.emplace_back(kReferenceFile);
    return names;
}

ComparisonReport start_report(const CompareArguments& arguments, const Variant& variant, const RendersRequest& request,
                              std::size_t rounds, const ThreadPool& threads) {
    const RenderSettings& settings = variant.settings;
    ComparisonReport report;
    report.program = software_name();
    report.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(creation_time()));
    report.command = arguments.command;
    report.scene = scene_name(arguments.scene);
    report.scene_path = arguments.scene;
    report.width = settings.film.width;
    report.height = settings.film.height;
    if (settings.film.crop) report.crop = variant.sampling.window;
    report.working_space = settings.color.working_space;
    report.display = settings.color.display;
    report.view = settings.color.view;
    report.look = settings.color.look;
    report.exposure = static_cast<double>(settings.color.exposure.value_or(0.0f));
    report.threads = threads.thread_count();
    report.isa = variant.world->statistics().isa;
    report.libraries = library_versions();
    report.by_wall = arguments.by_wall;
    report.seconds = request.budget.seconds;
    report.spp = request.budget.spp;
    report.seeds = static_cast<int>(rounds);
    report.first_seed = request.first_seed;
    return report;
}

/// A reference that is asked for: what can be known of it before anything is rendered.
struct RequestedReference {
    std::optional<ImageF> image{};            ///< image of the file
    std::optional<ReferenceOrigin> origin{};  ///< origin of a file that tells its seeds
    std::optional<Variant> variant{};         ///< that renders it
    std::vector<std::string> notes{};
};

RequestedReference requested_reference(const CompareArguments& arguments, const std::vector<Variant>& variants,
                                       const ColorConfig& colors) {
    RequestedReference requested;
    const Variant& first = variants.front();
    if (!arguments.reference.empty()) {
        const RenderOptions& sampling = first.sampling;
        SceneLinearImage file = read_scene_linear(arguments.reference, sampling.full_width, sampling.full_height,
                                                  sampling.window, first.settings.color.working_space, colors);
        requested.image = std::move(file.pixels);
        requested.notes = std::move(file.warnings);
        requested.origin = read_reference_origin(arguments.reference, sampling.window);
        if (requested.origin && requested.origin->variance && file.is_converted) {
            requested.origin->variance.reset();
            requested.notes.push_back(
                fmt::format("the noise of '{}' is known in its own colour space alone, and is a part of all errors: "
                            "--working-space has that one",
                            arguments.reference));
        }
    } else if (!arguments.reference_integrator.empty()) {
        requested.variant = with_integrator(first, arguments.reference_integrator);
        requested.notes = reference_notes(*requested.variant, variants);
    }
    return requested;
}

/// `seed` is the first of its renders', if it is rendered.
std::optional<Reference> find_reference(const CompareArguments& arguments, RequestedReference requested,
                                        std::uint32_t seed, const std::vector<Variant>& variants,
                                        const std::vector<VariantRenders>& renders,
                                        const std::vector<FinishedImages>& images, const ThreadPool& threads,
                                        ComparisonReport& report) {
    if (requested.image) {
        const bool is_of_comparison = requested.origin && requested.origin->has_other_renders;
        ReferenceReport file{.kind = "file",
                             .text = fmt::format("The file {}{}.", arguments.reference,
                                                 is_of_comparison ? ", which another comparison has made" : "")};
        if (!requested.origin || !requested.origin->variance) return Reference(std::move(*requested.image), file);
        return Reference({std::move(*requested.image), std::move(*requested.origin->variance)}, std::move(file));
    }
    if (!requested.variant) return pool_reference(variants, images, report.pairs, report.notes);
    const auto rendered = render_reference(*requested.variant, reference_budget(arguments, renders, threads), seed,
                                           threads, arguments.quiet);
    if (!rendered) {
        report.notes.emplace_back(
            "there is no reference, so no errors are given: it was not rendered, because the comparison was "
            "interrupted");
        return std::nullopt;
    }
    return Reference(estimate_image(rendered->images),
                     {.kind = "integrator",
                      .text = fmt::format("Rendered by {} in {} parts of {} samples per pixel with seeds of their own, "
                                          "from {} on, in {:.3g} s, {:.3g} s of CPU time.",
                                          requested.variant->name, kReferenceRenders, rendered->spp, seed,
                                          rendered->seconds, rendered->cpu_seconds),
                      .seeds = {seed, kReferenceRenders},
                      .spp = kReferenceRenders * rendered->spp,
                      .seconds = rendered->seconds,
                      .cpu_seconds = rendered->cpu_seconds});
}

/// Writes what there is besides report and page, in place of what an earlier comparison has left.
void write_files(const CompareArguments& arguments, const ComparisonReport& report,
                 const std::optional<Reference>& reference, const std::vector<FinishedImages>& images,
                 const ColorConfig& colors) {
    const std::filesystem::path directory = arguments.output;
    write_data_files(directory, report);
    if (arguments.keep_images) write_renders(directory / kImagesDirectory, report, images, colors);
    if (!arguments.reference.empty()) return;
    if (reference) {
        write_reference(directory / kReferenceFile, *reference, report, colors);
    } else {
        std::error_code ignored;  // it may never have been there
        std::filesystem::remove(directory / kReferenceFile, ignored);
    }
}

/// Returns the variant whose strategies are shown; null if none has any.
const Variant* first_with_strategies(const std::vector<Variant>& variants) {
    const auto found = std::ranges::find_if(
        variants, [](const Variant& variant) { return has_strategies(variant.settings.integrator.type); });
    return found == variants.end() ? nullptr : &*found;
}

/// Returns the variant that finds most kinds of light: one with strategies, or the first.
const Variant& variant_of_insets(const std::vector<Variant>& variants) {
    const Variant* const with_strategies = first_with_strategies(variants);
    return with_strategies != nullptr ? *with_strategies : variants.front();
}

/// Throws SceneError if options that were given would change nothing.
void require_effective(const CompareArguments& arguments, const std::vector<Variant>& variants) {
    if (arguments.longest_strategy.value_or(0) > 0 && first_with_strategies(variants) == nullptr)
        throw SceneError({"--strategies-depth", {}},
                         "no variant has strategies to be shown: they are those of bdpt and vcm");
}

void require_regions_within(const std::vector<NamedRegion>& regions, const PixelRect& window) {
    for (const NamedRegion& region : regions)
        if (intersection(region.pixels, window) != region.pixels)
            throw SceneError({"--region", {}},
                             fmt::format("'{}' does not lie within the pixels {},{},{},{} that are rendered",
                                         region.name, window.x0, window.y0, window.x1, window.y1));
}

/// Returns the seed of the first render. Renders that have a part in their own reference would look better than they
/// are: seeds go on after those of the reference's file, unless --seed was given.
std::uint32_t first_seed(const CompareArguments& arguments, const std::vector<Variant>& variants,
                         RequestedReference& requested) {
    const std::uint32_t first = variants.front().settings.seed;
    if (!requested.origin) return first;
    const SeedRange& taken = requested.origin->seeds;
    const std::uint32_t count =
        static_cast<std::uint32_t>(arguments.seeds) * static_cast<std::uint32_t>(variants.size());
    // Differences of unsigned numbers, as seeds go on with 0 after the last.
    if (first - taken.first >= taken.count && taken.first - first >= count) return first;
    const bool is_given =
        std::ranges::any_of(arguments.common.given, [](const GivenOption& option) { return option.name == "--seed"; });
    const std::uint32_t after = taken.first + taken.count;
    requested.notes.push_back(
        is_given ? fmt::format("the reference was rendered with some of the same seeds, so that errors are not those "
                               "of independent images; --seed {} has others",
                               after)
                 : fmt::format("seeds begin with {}, after those of the reference", after));
    return is_given ? first : after;
}

ExitCode run_compare(const CompareArguments& arguments) {
    const ThreadPool threads(arguments.threads);
    const ColorConfig colors = ColorConfig::from_environment();
    const std::vector<VariantRequest> requests = variant_requests(arguments);
    std::optional<NothingToKeep> while_reading(std::in_place);
    const std::vector<Variant> variants = make_variants(arguments.scene, requests, colors, threads, arguments.quiet);
    while_reading.reset();
    const PixelRect& window = variants.front().sampling.window;
    require_regions_within(arguments.regions, window);
    require_effective(arguments, variants);
    const Variant& of_insets = variant_of_insets(variants);
    const AovPlan insets = plan_of_classes(
        arguments.scene, *std::ranges::find(requests, of_insets.name, &VariantRequest::name), arguments.inset_classes);
    RequestedReference requested = requested_reference(arguments, variants, colors);
    std::optional<RenderPage> page;
    if (const auto port = live_port(arguments.live)) page.emplace(*port);
    const RendersRequest request{.budget = budget_of(arguments, threads),
                                 .seeds = arguments.seeds,
                                 .first_seed = first_seed(arguments, variants, requested),
                                 .quiet = arguments.quiet,
                                 .watcher = page ? &*page : nullptr};
    if (!arguments.quiet)
        for (const std::string& note : requested.notes) log_warning("note: {}", note);
    std::vector<std::filesystem::path> inputs;
    if (!arguments.reference.empty()) inputs.emplace_back(arguments.reference);
    for (const Variant& variant : variants) inputs.insert(inputs.end(), variant.inputs.begin(), variant.inputs.end());
    const std::vector<std::filesystem::path> files = prepare_directory(arguments.output, file_names(arguments), inputs);
    ImageStore store(arguments.output, window.width(), window.height(), 3);
    const MeasureContext context{colors, threads, store};
    const std::vector<NamedRegion> of_classes = regions_of_classes(of_insets, insets, context, requested.notes);
    const std::vector<VariantRenders> renders = render_variants(variants, request, store, threads);
    if (page) page->enter(interrupt_requested() ? "stopped" : "measure");
    const std::size_t rounds = renders.front().seeds.size();
    if (rounds == 0) return interrupt_exit_code();

    ComparisonReport report = start_report(arguments, variants.front(), request, rounds, threads);
    report.notes = requested.notes;
    const std::size_t notes_said = report.notes.size();
    if (report.seeds < arguments.seeds)
        report.notes.push_back(fmt::format("interrupted after {} of {} seeds", report.seeds, arguments.seeds));
    const std::vector<FinishedImages> images = finished_images(renders, store);
    report.pairs = compare_pairs(variants, images);
    // The one after those of all renders.
    const std::uint32_t reference_seed =
        render_seed(request.first_seed, static_cast<std::size_t>(request.seeds), 0, variants.size());
    const std::optional<Reference> reference =
        find_reference(arguments, std::move(requested), reference_seed, variants, renders, images, threads, report);
    report.reference = reference ? reference->report() : ReferenceReport{.kind = "none", .text = "There is none."};
    if (report.reference.kind == "pooled")
        report.reference.seeds = {request.first_seed, static_cast<std::uint32_t>(rounds * variants.size())};
    const ErrorMaps maps = reference ? map_errors(images, *reference, report.working_space, context) : ErrorMaps{};
    std::vector<NamedRegion> regions = arguments.regions;
    regions.insert(regions.end(), of_classes.begin(), of_classes.end());
    if (regions.empty()) regions = find_regions(maps.rel_mse, window);
    measure(report, variants, renders, images, reference, maps, regions, context);
    for (std::size_t v = 0; v < variants.size(); ++v) {
        VariantReport& variant = report.variants[v];
        variant.command = render_command(arguments.scene, variants[v], variant.spp, variant.seeds.front());
        variant.command_note = command_note(variants[v]);
    }

    for (const std::string& note :
         {reference_noise(report), off_budget(report), unequal_times(report), lost_in_pdf(report)})
        if (!note.empty()) report.notes.push_back(note);

    // What was measured must not be lost with pictures that cannot be made.
    write_text(files[0], to_json(report));
    write_files(arguments, report, reference, images, colors);
    const DisplayView view{report.working_space, report.display, report.view, report.look,
                           static_cast<float>(report.exposure)};
    ReportImages pictures;
    add_images(pictures, report, images, reference, maps, view, context);
    const int longest_strategy = arguments.longest_strategy.value_or(kDefaultStrategies);
    if (const Variant* const bdpt = first_with_strategies(variants); bdpt != nullptr && longest_strategy > 0)
        add_strategies(pictures, report, *bdpt, renders[static_cast<std::size_t>(bdpt - variants.data())],
                       longest_strategy, view, context, arguments.quiet);

    write_text(files[0], to_json(report));
    write_text(files[1], make_page(report, pictures));
    if (!arguments.quiet) {
        print_summary(report, notes_said);
        log_info("{}", files[1].string());
    }
    if (arguments.json) print_data(to_json(report));
    if (page) page->enter(interrupt_requested() ? "stopped" : "finished");
    if (interrupt_requested()) return interrupt_exit_code();
    return report.agrees() ? ExitCode::Success : ExitCode::DiffFailed;
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

void add_compare_options(CLI::App& command, CompareArguments& arguments) {
    add_scene_argument(command, arguments.scene);
    command
        .add_option("-o,--output", arguments.output,
                    "Directory for index.html, report.json, data.csv, tables.tex and plots; made if it is missing")
        ->required()
        ->check(CLI::Validator([](const std::string& text) { return std::string(text.empty() ? "it is empty" : ""); },
                               "DIR"));
    auto* integrators =
        command.add_option("--integrators", arguments.integrators,
                           "Algorithms to compare, separated by commas (default: path,bdpt, and vcm where the "
                           "scene has mirrors or smooth glass)");
    integrators->delimiter(',')->allow_extra_args(false)->check(CLI::IsMember(integrator_setting_names()));
    command.add_flag("--wall", arguments.by_wall,
                     "Compare by time on the clock in place of CPU time, as where variants leave threads idle");
    command
        .add_option("--seeds", arguments.seeds,
                    "Independent renders of each variant, 3 or more without a reference; 1 shows images and times "
                    "only (default: 4)")
        ->check(CLI::Range(1, 1000));
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
    command.add_option("--threads", arguments.threads, "Threads to use (default: one per processor)")
        ->check(CLI::Range(1, 4096));
    add_live_option(command, arguments.live, "Show each render in a browser as it grows");
    command.add_flag("--quiet", arguments.quiet, "No progress, notes or summary; errors only");
    command.add_flag("--json", arguments.json, "Print report.json on stdout, too");
}

}  // namespace

void add_compare_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<CompareArguments>();
    CLI::App* command =
        app.add_subcommand("compare", "Render one scene in several ways and report which comes to the image soonest");
    add_compare_options(*command, *arguments);
    const std::size_t own = command->get_options().size();
    add_settings_options(*command, arguments->common.overrides);
    // Here it names what is compared; among the options of a variant it is what it is for 'render'.
    command->remove_option(command->get_option("--variant"));
    command
        ->add_option_function<std::vector<std::string>>(
            "--variant",
            [arguments](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) arguments->variants.push_back(parse_variant(text));
            },
            "A variant to compare, with options of 'render', such as 'deep: --max-depth 64'; may be repeated, and goes "
            "with --integrators")
        ->allow_extra_args(false)
        ->type_name("'NAME: OPTIONS'");
    replace_time_option(*command, arguments->seconds,
                        "Time of each render, in seconds, if all threads work for it alone: all variants get as much "
                        "CPU time, that of so many seconds on all threads; --spp says how many samples instead "
                        "(default: 10)");
    hide_options(*command, options_compare_sets());
    set_compare_groups(*command);
    command->footer(
        "Every variant is rendered as many times, each time with a seed that no other render has and for the same "
        "CPU\n"
        "time unless --spp is given, and its error is measured on the way. Other options override render.json for all\n"
        "variants. Exit code 1 if variants that show the same light and find all of it do not make the same image.\n\n"
        "Examples:\n"
        "  etendue compare scenes/caustic-glass -o report\n"
        "  etendue compare scenes/caustic-glass -o report --live\n"
        "  etendue compare scenes/cornell-box --integrators path,bdpt,light --time 5 --seeds 8 -o report\n"
        "  etendue compare scenes/caustic-glass --region caustic:105,192,150,216 --reference glass.exr -o report\n"
        "  etendue compare scenes/veach-mis --integrator bdpt --variant 'power: --heuristic power' --variant 'balance: "
        "'"
        " -o report");
    command->callback([arguments, command, own, &action] {
        const CompareArguments& given = *arguments;
        refuse_options(*command, options_compare_sets());
        if (given.common.overrides.spp() && given.seconds)
            throw CLI::ValidationError("--time", "cannot be given with --spp: one of them ends a render");
        if (given.variants.empty() && command->count("--integrator") > 0)
            throw CLI::ValidationError("--integrator", "--integrators names the algorithms that are compared");
        if (given.seeds == 2 && given.reference.empty() && given.reference_integrator.empty())
            throw CLI::ValidationError("--seeds",
                                       "2 give no reference, which is pooled from 3 or more, and so no errors: give "
                                       "--seeds 3, --reference or --reference-integrator");
        require_different("--integrators", given.integrators);
        std::vector<std::string> names = given.integrators;
        for (const NamedOptions& variant : given.variants) names.push_back(variant.name);
        require_different("--variant", names);
        require_different("--insets", given.inset_classes);
        std::vector<std::string> regions = given.inset_classes;
        for (const NamedRegion& region : given.regions) regions.push_back(region.name);
        require_different("--region", regions);
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
