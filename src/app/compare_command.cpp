// etendue compare: ways of rendering one scene against each other.
#include "app/commands.h"
#include "app/comparison_images.h"
#include "app/comparison_measures.h"
#include "app/comparison_renders.h"
#include "app/comparison_variants.h"
#include "app/image_pair.h"
#include "app/interrupt.h"
#include "app/library_versions.h"
#include "core/log.h"
#include "image/write.h"
#include "output/software_name.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
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
constexpr std::array kLetters{'a', 'b', 'c', 'd', 'e', 'f'};

/// Far from those of the renders that are measured.
constexpr std::uint32_t kReferenceSeed = 0x5eed0000u;

struct CompareArguments {
    std::string scene;
    std::string output;
    std::vector<std::string> integrators;
    std::array<std::optional<std::string>, kLetters.size()> variants;
    SettingsOverrides overrides;
    std::string common_options;  ///< the overrides, as they stand on a command line
    std::string command_line;
    std::optional<double> seconds;
    int seeds = kDefaultSeeds;
    std::string reference;
    std::string reference_integrator;
    std::optional<double> reference_seconds;
    std::vector<NamedRegion> regions;
    int longest_strategy = kDefaultStrategies;
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

/// The options among `chosen` that were given, as they would stand on a command line.
std::string options_text(const std::vector<const CLI::Option*>& chosen) {
    std::vector<std::string> words;
    for (const CLI::Option* option : chosen) {
        if (option->count() == 0) continue;
        if (option->get_positional()) {
            for (const std::string& value : option->results()) words.push_back(quoted(value));
            continue;
        }
        words.push_back(option->get_name());
        const bool is_flag = option->get_items_expected_max() == 0;
        for (const std::string& value : is_flag ? std::vector<std::string>() : option->results())
            words.push_back(quoted(value));
    }
    return fmt::format("{}", fmt::join(words, " "));
}

std::vector<VariantRequest> variant_requests(const CompareArguments& arguments) {
    std::vector<VariantRequest> requests;
    for (std::size_t i = 0; i < kLetters.size(); ++i)
        if (arguments.variants[i])
            requests.push_back({fmt::format("{}: {}", kLetters[i], *arguments.variants[i]), *arguments.variants[i]});
    const std::vector<std::string> usual{"path", "bdpt"};
    if (requests.empty())
        for (const std::string& name : arguments.integrators.empty() ? usual : arguments.integrators)
            requests.push_back({name, "--integrator " + name});
    return requests;
}

std::string join(const std::string& a, const std::string& b) {
    return a.empty() || b.empty() ? a + b : a + " " + b;
}

ComparisonReport start_report(const CompareArguments& arguments, const Variant& variant,
                              const std::vector<VariantRenders>& renders, const ThreadPool& threads) {
    const RenderSettings& settings = variant.settings;
    ComparisonReport report;
    report.program = software_name();
    report.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                                 fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
    report.command = arguments.command_line;
    report.scene = scene_name(arguments.scene);
    report.scene_path = arguments.scene;
    report.width = settings.film.width;
    report.height = settings.film.height;
    if (settings.film.crop) report.crop = variant.sampling.window;
    report.working_space = settings.color.working_space;
    report.display = settings.color.display;
    report.view = settings.color.view;
    report.exposure = static_cast<double>(settings.color.exposure);
    report.threads = threads.thread_count();
    report.isa = ray_tracer_info().isa;
    report.libraries = library_versions();
    if (arguments.overrides.spp)
        report.spp = static_cast<std::uint32_t>(*arguments.overrides.spp);
    else
        report.seconds = arguments.seconds.value_or(kDefaultSeconds);
    report.seeds = static_cast<int>(renders.front().seeds.size());
    report.first_seed = settings.seed;
    return report;
}

/// The command that renders a variant's first image.
std::string render_command(const CompareArguments& arguments, const VariantReport& variant, std::uint32_t seed) {
    std::string command = join("etendue render " + quoted(arguments.scene), arguments.common_options);
    command = join(command, variant.options);
    if (!arguments.overrides.spp) command += fmt::format(" --spp {}", variant.spp);
    if (!arguments.overrides.seed) command += fmt::format(" --seed {}", seed);
    return command + " --float -o image.exr";
}

std::optional<Reference> find_reference(const CompareArguments& arguments, const std::vector<Variant>& variants,
                                        const std::vector<FinishedImages>& images, const MeasureContext& context,
                                        ComparisonReport& report) {
    const Variant& first = variants.front();
    const RenderOptions& sampling = first.sampling;
    if (!arguments.reference.empty())
        return Reference(read_scene_linear(arguments.reference, sampling.full_width, sampling.full_height,
                                           sampling.window, report.working_space, context.colors),
                         {.kind = "file", .text = fmt::format("The file {}.", arguments.reference)});
    if (!arguments.reference_integrator.empty()) {
        const Variant variant = with_integrator(first, arguments.reference_integrator);
        const double seconds = arguments.reference_seconds.value_or(10.0 * report.seconds.value_or(kDefaultSeconds));
        auto image = render_reference(variant, seconds, kReferenceSeed, context.threads, arguments.quiet);
        if (!image) return std::nullopt;
        for (const Variant& measured : variants)
            if (measured.settings.integrator.type == variant.settings.integrator.type)
                report.notes.push_back(
                    fmt::format("the reference comes from '{}' alone, which '{}' is measured "
                                "against: an error of that algorithm would not be seen",
                                variant.name, measured.name));
        return Reference(std::move(*image), {.kind = "integrator",
                                             .text = fmt::format("Rendered by {} for {:g} s with a seed of its own.",
                                                                 variant.name, seconds)});
    }
    std::string why_not;
    auto pooled = pool_reference(variants, images, report.pairs, why_not);
    if (!pooled)
        report.notes.push_back(
            fmt::format("there is no reference, so no errors are given: {}; --reference or "
                        "--reference-integrator give one",
                        why_not));
    return pooled;
}

void print_summary(const ComparisonReport& report) {
    for (const VariantReport& variant : report.variants) {
        const auto error = [&](const char* metric) {
            return variant.errors.contains(metric) ? variant.errors.at(metric).mean() : kUnknown;
        };
        log_info("{}: {} spp in {:.3g} s, relMSE {:.3g}, trimmed {:.3g}, {:.2f} Msamples per CPU s", variant.name,
                 variant.spp, variant.seconds.mean(), error("relmse"), error("relmse-trimmed"),
                 variant.samples_per_cpu_second * 1e-6);
    }
    for (const PairReport& pair : report.pairs) {
        if (const auto ratio = pair.ratios.find("relmse_seconds"); ratio != pair.ratios.end())
            log_info("relMSE x seconds of {} over that of {}: {:.3g}", pair.a, pair.b, ratio->second);
        if (pair.agreement && pair.comparable)
            log_info("{} and {} {}: {}", pair.a, pair.b, pair.agreement->agree() ? "agree" : "DISAGREE",
                     pair.agreement->str());
    }
    for (const RegionReport& region : report.regions)
        for (const RegionVariant& variant : region.variants)
            if (!region.found)
                log_info("{}, {}: relMSE {:.3g}, relMSE x seconds {:.3g}, mean off by {:.2f}% (deviation {:.2f}%)",
                         region.name, variant.name, variant.errors.at("relmse").mean(), variant.rel_mse_seconds,
                         100.0 * variant.mean_error.mean(), 100.0 * variant.mean_error.deviation());
    for (const std::string& note : report.notes) log_warning("note: {}", note);
}

void require_regions_within(const std::vector<NamedRegion>& regions, const PixelRect& window) {
    for (const NamedRegion& region : regions)
        if (intersection(region.pixels, window) != region.pixels)
            throw SceneError({"--region", {}},
                             fmt::format("'{}' does not lie within the pixels {},{},{},{} that are rendered",
                                         region.name, window.x0, window.y0, window.x1, window.y1));
}

ExitCode write_report(const CompareArguments& arguments, const ComparisonReport& report, const ReportImages& images) {
    const std::filesystem::path directory = arguments.output;
    write_text(directory / "report.json", to_json(report));
    write_text(directory / "index.html", make_page(report, images));
    if (!arguments.quiet) {
        print_summary(report);
        log_info("{}", (directory / "index.html").string());
    }
    if (arguments.json) std::fputs(to_json(report).c_str(), stdout);
    if (interrupt_requested()) return interrupt_exit_code();
    const bool agree = std::ranges::all_of(report.pairs, [](const PairReport& pair) {
        return !pair.comparable || !pair.agreement || pair.agreement->agree();
    });
    return agree ? ExitCode::Success : ExitCode::DiffFailed;
}

ExitCode run_compare(const CompareArguments& arguments) {
    const ThreadPool threads(arguments.threads);
    const ColorConfig colors = ColorConfig::from_environment();
    const std::vector<Variant> variants = make_variants(arguments.scene, variant_requests(arguments),
                                                        arguments.overrides, colors, threads, arguments.quiet);
    const PixelRect& window = variants.front().sampling.window;
    require_regions_within(arguments.regions, window);
    std::filesystem::create_directories(arguments.output);
    ImageStore store(arguments.output, window.width(), window.height(), 3);
    RendersRequest request{
        .seeds = arguments.seeds, .first_seed = variants.front().settings.seed, .quiet = arguments.quiet};
    if (arguments.overrides.spp)
        request.budget.spp = static_cast<std::uint32_t>(*arguments.overrides.spp);
    else
        request.budget.seconds = arguments.seconds.value_or(kDefaultSeconds);
    const std::vector<VariantRenders> renders = render_variants(variants, request, store, threads);
    if (renders.front().seeds.empty()) return interrupt_exit_code();

    ComparisonReport report = start_report(arguments, variants.front(), renders, threads);
    if (report.seeds < arguments.seeds)
        report.notes.push_back(fmt::format("interrupted after {} of {} seeds", report.seeds, arguments.seeds));
    const MeasureContext context{colors, threads, store};
    const std::vector<FinishedImages> images = finished_images(renders, store);
    report.pairs = compare_pairs(variants, images);
    const std::optional<Reference> reference = find_reference(arguments, variants, images, context, report);
    report.reference = reference ? reference->report() : ReferenceReport{.kind = "none", .text = "There is none."};
    std::vector<NamedRegion> regions = arguments.regions;
    if (regions.empty() && reference) regions = find_regions(images, *reference, window);
    measure(report, variants, renders, images, reference, regions, context);
    for (VariantReport& variant : report.variants)
        variant.command = render_command(arguments, variant, report.first_seed);

    const DisplayView view{report.working_space, report.display, report.view, static_cast<float>(report.exposure)};
    ReportImages pictures;
    add_images(pictures, report, images, reference, view, context);
    const auto bdpt = std::ranges::find_if(
        variants, [](const Variant& variant) { return has_strategies(variant.settings.integrator.type); });
    if (bdpt != variants.end() && arguments.longest_strategy > 0)
        add_strategies(pictures, report, *bdpt, arguments.longest_strategy, view, context, arguments.quiet);
    return write_report(arguments, report, pictures);
}

void add_compare_options(CLI::App& command, CompareArguments& arguments) {
    command.add_option("scene", arguments.scene, "Scene directory, .gltf or .glb")->required();
    command
        .add_option("-o,--output", arguments.output, "Directory for report.json and index.html; made if it is missing")
        ->required();
    auto* integrators = command.add_option("--integrators", arguments.integrators,
                                           "Algorithms to compare, separated by commas (default: path,bdpt)");
    integrators->delimiter(',')->check(CLI::IsMember(integrator_names()));
    for (std::size_t i = 0; i < kLetters.size(); ++i)
        command
            .add_option(fmt::format("--variant-{}", kLetters[i]), arguments.variants[i],
                        "Options of 'render' that make this variant, in quotes; in place of --integrators")
            ->excludes(integrators);
    command.add_option("--seconds", arguments.seconds, "Time of each render (default: 10)")
        ->check(CLI::Range(1e-3, 1e9));
    command.add_option("--seeds", arguments.seeds, "Independent renders of each variant (default: 4)")
        ->check(CLI::Range(1, 1000));
    auto* file = command.add_option("--reference", arguments.reference, "EXR or HDR file to measure errors against")
                     ->check(CLI::ExistingFile);
    auto* by = command.add_option("--reference-integrator", arguments.reference_integrator,
                                  "Algorithm that renders the reference (default: the variants' renders are pooled)");
    by->check(CLI::IsMember(integrator_names()))->excludes(file);
    command
        .add_option("--reference-seconds", arguments.reference_seconds,
                    "Time of that render (default: ten times --seconds)")
        ->check(CLI::Range(1e-3, 1e9))
        ->needs(by);
    command.add_option_function<std::vector<std::string>>(
        "--region",
        [&arguments](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) arguments.regions.push_back(parse_region(text));
        },
        "Part of the image to report by itself, NAME:x0,y0,x1,y1; may be repeated (default: where variants differ "
        "most)");
    command
        .add_option("--strategies-depth", arguments.longest_strategy,
                    "Longest paths whose strategies are shown for bdpt (default: 5); 0 for none")
        ->check(CLI::Range(0, 12));
    command.add_option("--threads", arguments.threads, "Threads to use (default: one per processor)")
        ->check(CLI::Range(1, 4096));
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
    arguments->overrides.add_options(*command);
    command->footer(
        "Every variant is rendered with each seed, for the same time unless --spp is given, and its error is measured\n"
        "on the way. Other options override render.json for all variants. Exit code 1 if variants that both find all\n"
        "light of the scene do not make the same image.\n\n"
        "Examples:\n"
        "  etendue compare scenes/caustic-glass -o report\n"
        "  etendue compare scenes/cornell-box --integrators path,bdpt,light --seconds 5 --seeds 8 -o report\n"
        "  etendue compare scenes/caustic-glass --region caustic:150,160,230,215 --reference glass.exr -o report\n"
        "  etendue compare scenes/veach-mis --variant-a '--integrator path' --variant-b '--integrator path --max-depth "
        "4' -o report");
    command->callback([arguments, command, own, &action] {
        const std::vector<const CLI::Option*> all = std::as_const(*command).get_options();
        arguments->command_line = join("etendue compare", options_text(all));
        arguments->common_options = options_text({all.begin() + static_cast<std::ptrdiff_t>(own), all.end()});
        action = [arguments] {
            if (arguments->overrides.time_seconds || arguments->overrides.frames) {
                log_error("error: {} is for 'render'; here {}", arguments->overrides.frames ? "--frames" : "--time",
                          arguments->overrides.frames ? "--time-code names the moment" : "it is --seconds");
                return ExitCode::UsageError;
            }
            if (arguments->overrides.spp && arguments->seconds) {
                log_error("error: --seconds and --spp exclude each other");
                return ExitCode::UsageError;
            }
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
