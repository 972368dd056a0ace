#include "cli/compare_run.h"

#include "cli/compare_reference.h"
#include "cli/variant_options.h"
#include "compare/comparison_classes.h"
#include "compare/comparison_files.h"
#include "compare/comparison_images.h"
#include "compare/comparison_measures.h"
#include "compare/comparison_notes.h"
#include "compare/comparison_renders.h"
#include "compare/comparison_summary.h"
#include "core/log.h"
#include "core/source_date.h"
#include "core/standard_output.h"
#include "core/write_file.h"
#include "live/render_page.h"
#include "output/auto_exposure.h"
#include "output/software_name.h"
#include "picture/render_setup.h"
#include "session/interrupt.h"
#include "session/library_versions.h"
#include "session/output_directory.h"
#include "session/usage_error.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace etendue {

namespace {

constexpr double kDefaultSeconds = 10.0;
constexpr int kDefaultStrategies = 5;  // edges

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

/// Returns what ends each render of a variant.
RenderBudget budget_of_renders(const CompareArguments& arguments, const ThreadPool& threads) {
    if (const auto spp = arguments.common.overrides.spp()) return {.spp = *spp};
    return budget_of(arguments.seconds.value_or(kDefaultSeconds), arguments, threads);
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
    if (variant.sampling.window != PixelRect{0, 0, report.width, report.height}) report.crop = variant.sampling.window;
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

/// Holds what is known of a comparison before anything is rendered.
struct ComparisonPlan {
    std::vector<Variant> variants{};
    const Variant* of_insets = nullptr;  ///< one of them, which renders the layers of --insets
    AovPlan insets{};
    RequestedReference reference{};
    std::uint32_t first_seed = 0;
};

/// Reads the scene and the reference. Throws SceneError for what cannot be compared.
ComparisonPlan plan_comparison(const CompareArguments& arguments, const ColorConfig& colors,
                               const ThreadPool& threads) {
    const NothingToKeep while_reading;
    const std::vector<VariantRequest> requests = variant_requests(arguments);
    ComparisonPlan plan;
    plan.variants = make_variants(arguments.scene, requests, colors, threads, arguments.quiet);
    require_regions_within(arguments.regions, plan.variants.front().sampling.window);
    require_effective(arguments, plan.variants);
    plan.of_insets = &variant_of_insets(plan.variants);
    plan.insets =
        plan_of_classes(arguments.scene, *std::ranges::find(requests, plan.of_insets->name, &VariantRequest::name),
                        arguments.inset_classes);
    plan.reference = requested_reference(arguments, plan.variants, colors);
    plan.first_seed = first_seed(arguments, plan.variants, plan.reference);
    return plan;
}

/// Returns the paths of what is written into the output directory, which is made, in the order of `file_names`.
std::vector<std::filesystem::path> prepare_report_files(const CompareArguments& arguments,
                                                        const std::vector<Variant>& variants) {
    std::vector<std::filesystem::path> inputs;
    if (!arguments.reference.empty()) inputs.emplace_back(arguments.reference);
    const std::filesystem::path images = std::filesystem::path(arguments.output) / kImagesDirectory;
    std::error_code none;  // either may be missing
    if (arguments.keep_images && !arguments.reference.empty() &&
        std::filesystem::equivalent(std::filesystem::path(arguments.reference).parent_path() / ".", images, none))
        throw UsageError(fmt::format("--reference lies in {}, whose images --keep-images replaces: move it elsewhere",
                                     images.string()));
    for (const Variant& variant : variants) inputs.insert(inputs.end(), variant.inputs.begin(), variant.inputs.end());
    return prepare_directory(arguments.output, file_names(arguments), inputs);
}

/// Holds what a comparison has found.
struct Findings {
    ComparisonReport report{};
    std::size_t notes_said = 0;  ///< notes of the report that were said before rendering
    std::vector<FinishedImages> images{};
    std::optional<Reference> reference{};
    ErrorMaps maps{};
};

void add_render_commands(const CompareArguments& arguments, const std::vector<Variant>& variants,
                         ComparisonReport& report) {
    for (std::size_t v = 0; v < variants.size(); ++v) {
        VariantReport& variant = report.variants[v];
        variant.command = render_command(arguments.scene, variants[v], variant.spp, variant.seeds.front());
        variant.command_note = command_note(variants[v]);
    }
}

/// Compares the images among themselves and with the reference, which is rendered now if it is one to be rendered.
/// `of_classes` are the regions of --insets.
Findings measure_renders(const CompareArguments& arguments, ComparisonPlan& plan, const RendersRequest& request,
                         const std::vector<VariantRenders>& renders, const std::vector<NamedRegion>& of_classes,
                         const MeasureContext& context) {
    const std::vector<Variant>& variants = plan.variants;
    const std::size_t rounds = renders.front().seeds.size();
    Findings found;
    ComparisonReport& report = found.report;
    report = start_report(arguments, variants.front(), request, rounds, context.threads);
    report.notes = plan.reference.notes;
    found.notes_said = report.notes.size();
    if (report.seeds < arguments.seeds)
        report.notes.push_back(fmt::format("interrupted after {} of {} seeds", report.seeds, arguments.seeds));
    found.images = finished_images(renders, context.store);
    report.pairs = compare_pairs(variants, found.images);
    // The one after those of all renders.
    const std::uint32_t reference_seed =
        render_seed(request.first_seed, static_cast<std::size_t>(request.seeds), 0, variants.size());
    found.reference = find_reference(arguments, std::move(plan.reference), reference_seed, variants, renders,
                                     found.images, context.threads, report);
    report.reference =
        found.reference ? found.reference->report() : ReferenceReport{.kind = "none", .text = "There is none."};
    if (report.reference.kind == "pooled")
        report.reference.seeds = {request.first_seed, static_cast<std::uint32_t>(rounds * variants.size())};
    if (!variants.front().settings.color.exposure) {
        const ImageF& image = found.reference ? found.reference->of_round(0) : found.images.front().of_seeds.front();
        report.exposure = static_cast<double>(choose_exposure(image).stops);
    }
    if (found.reference) found.maps = map_errors(found.images, *found.reference, report.working_space, context);
    std::vector<NamedRegion> regions = arguments.regions;
    regions.insert(regions.end(), of_classes.begin(), of_classes.end());
    if (regions.empty()) regions = find_regions(found.maps.rel_mse, variants.front().sampling.window);
    measure(report, variants, renders, found.images, found.reference, found.maps, regions, context);
    add_render_commands(arguments, variants, report);
    // The note on times off the budget names them all, so that the note on unequal times would repeat it.
    const std::string off = off_budget(report);
    for (const std::string& note :
         {reference_noise(report), off.empty() ? unequal_times(report) : off, lost_in_pdf(report)})
        if (!note.empty()) report.notes.push_back(note);
    return found;
}

/// Writes what there is besides report and page, in place of what an earlier comparison has left.
void write_files(const CompareArguments& arguments, const Findings& found, const ColorConfig& colors) {
    const std::filesystem::path directory = arguments.output;
    write_data_files(directory, found.report);
    if (arguments.keep_images) write_renders(directory / kImagesDirectory, found.report, found.images, colors);
    if (!arguments.reference.empty()) return;
    if (found.reference) {
        write_reference(directory / kReferenceFile, *found.reference, found.report, colors);
    } else if (!interrupt_requested() && remove_own_reference(directory / kReferenceFile)) {
        log_warning("note: {}, of an earlier comparison, is removed: this one has none",
                    (directory / kReferenceFile).string());
    }
}

/// Returns the pictures of the page, among them those of strategies, which are rendered now.
ReportImages make_pictures(const CompareArguments& arguments, const std::vector<Variant>& variants,
                           const std::vector<VariantRenders>& renders, Findings& found, const MeasureContext& context) {
    ComparisonReport& report = found.report;
    const DisplayView view{report.working_space, report.display, report.view, report.look,
                           static_cast<float>(report.exposure)};
    ReportImages pictures;
    add_images(pictures, report, found.images, found.reference, found.maps, view, context);
    const int longest_strategy = arguments.longest_strategy.value_or(kDefaultStrategies);
    if (const Variant* const bdpt = first_with_strategies(variants); bdpt != nullptr && longest_strategy > 0)
        add_strategies(pictures, report, *bdpt, renders[static_cast<std::size_t>(bdpt - variants.data())],
                       longest_strategy, view, context, arguments.quiet);
    return pictures;
}

}  // namespace

ExitCode run_compare(const CompareArguments& arguments) {
    const ThreadPool threads(arguments.threads);
    const ColorConfig colors = ColorConfig::from_environment();
    ComparisonPlan plan = plan_comparison(arguments, colors, threads);
    std::optional<RenderPage> page;
    if (const auto port = live_port(arguments.live)) page.emplace(*port);
    const RendersRequest request{.budget = budget_of_renders(arguments, threads),
                                 .seeds = arguments.seeds,
                                 .first_seed = plan.first_seed,
                                 .quiet = arguments.quiet,
                                 .watcher = page ? &*page : nullptr};
    const std::vector<std::filesystem::path> files = prepare_report_files(arguments, plan.variants);
    const PixelRect& window = plan.variants.front().sampling.window;
    ImageStore store(arguments.output, window.width(), window.height(), 3);
    const MeasureContext context{colors, threads, store};
    const std::vector<NamedRegion> of_classes =
        regions_of_classes(*plan.of_insets, plan.insets, context, plan.reference.notes);
    if (!arguments.quiet)
        for (const std::string& note : plan.reference.notes) log_warning("note: {}", note);
    const std::vector<VariantRenders> renders = render_variants(plan.variants, request, store, threads);
    if (page) page->enter(interrupt_requested() ? "stopped" : "measure");
    if (renders.front().seeds.empty()) {
        if (!arguments.quiet) log_info("interrupted before all variants were rendered once: there is no report");
        return interrupt_exit_code();
    }

    Findings found = measure_renders(arguments, plan, request, renders, of_classes, context);
    // What was measured must not be lost with pictures that cannot be made.
    write_text(files[0], to_json(found.report));
    write_files(arguments, found, colors);
    const ReportImages pictures = make_pictures(arguments, plan.variants, renders, found, context);
    write_text(files[0], to_json(found.report));
    write_text(files[1], make_page(found.report, pictures));
    if (!arguments.quiet) {
        print_summary(found.report, found.notes_said);
        log_info("{}", files[1].string());
    }
    if (arguments.json) print_data(to_json(found.report));
    if (page) page->enter(interrupt_requested() ? "stopped" : "finished");
    if (interrupt_requested()) return interrupt_exit_code();
    return found.report.agrees() ? ExitCode::Success : ExitCode::DiffFailed;
}
}  // namespace etendue
