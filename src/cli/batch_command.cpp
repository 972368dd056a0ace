// etendue batch: every scene directory below some directories.
#include "batch/batch_child.h"
#include "batch/batch_lock.h"
#include "batch/batch_options.h"
#include "batch/batch_plan.h"
#include "batch/batch_runner.h"
#include "batch/batch_table.h"
#include "batch/batch_units.h"
#include "cli/command_mistakes.h"
#include "cli/command_options.h"
#include "cli/commands.h"
#include "cli/program.h"
#include "cli/settings_options.h"
#include "core/byte_size.h"
#include "core/error.h"
#include "core/standard_output.h"
#include "live/batch_live_page.h"
#include "picture/output_paths.h"
#include "process/process_limits.h"
#include "process/run_command.h"
#include "session/interrupt.h"
#include "session/option_check.h"
#include "session/usage_error.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

const std::map<std::string, BatchOrder> kOrders{{"shortest", BatchOrder::Shortest},
                                                {"longest", BatchOrder::Longest},
                                                {"name", BatchOrder::Name},
                                                {"newest", BatchOrder::Newest}};

/// Makes the output directory. Throws UsageError if a file is in its place, IoError if nothing can be written in it:
/// better now than after the first image.
void prepare_output(const fs::path& output) {
    std::error_code error;
    if (fs::exists(output, error) && !fs::is_directory(output, error))
        throw UsageError(fmt::format("--output '{}' is a file: name a directory for the images", output.string()));
    fs::create_directories(output, error);
    if (error) throw IoError(fmt::format("cannot make {}: {}", output.string(), error.message()));
    for (const fs::path& file : batch_files(output)) require_writable(file);
    // What the directory allows is not all that counts: a whole file system may be read-only.
    BatchLocks(output).require();
}

void print(const BatchOptions& options, const std::string& json, const std::string& table) {
    if (options.json)
        print_data(json);
    else if (!options.quiet)
        print_text(table);
}

ExitCode exit_code_of(const BatchRunner& runner) {
    if (interrupt_requested()) return interrupt_exit_code();
    const BatchTotals sum = totals(of_chosen(runner.report()));
    const bool is_whole = sum.rendered + sum.up_to_date == sum.units && runner.has_kept_books();
    return is_whole ? ExitCode::Success : ExitCode::RenderFailed;
}

/// True if all images that were to be made fail because of options that fit none of the scenes.
bool is_command_line_wrong(const BatchPlan& plan) {
    const PlanTotals sum = totals(plan);
    return sum.stale > 0 && sum.failing == sum.stale && std::ranges::all_of(plan, [](const PlannedUnit& unit) {
               return !unit.is_stale() || unit.error.starts_with("error: --");
           });
}

/// Runs the command that is to follow a batch, with what became of that in its environment.
void run_on_finish(const BatchOptions& options, const BatchReport& report, ExitCode code, BatchProgress& progress) {
    const BatchTotals sum = totals(of_chosen(report));
    const CommandResult result = run_command(
        {"env", "ETENDUE_OUTPUT=" + report.output_directory,
         fmt::format("ETENDUE_EXIT_CODE={}", static_cast<int>(code)), fmt::format("ETENDUE_RENDERED={}", sum.rendered),
         fmt::format("ETENDUE_UP_TO_DATE={}", sum.up_to_date), fmt::format("ETENDUE_FAILED={}", sum.failed),
         fmt::format("ETENDUE_INTERRUPTED={}", sum.interrupted), fmt::format("ETENDUE_NOT_STARTED={}", sum.not_started),
         "sh", "-c", options.on_finish});
    for (const std::string& text : {result.out, result.err})
        if (!text.empty()) progress.say("--on-finish: " + text.substr(0, text.find_last_not_of('\n') + 1));
    if (result.exit_code != 0)
        progress.say_error(fmt::format("error: --on-finish: the command ended with exit code {}", result.exit_code));
}

/// Leaves out all but the images that failed last time, or were not tried as others of their scene had failed. Returns
/// the message if no image is left, else an empty text.
std::string keep_failed(BatchTasks& tasks, const LedgerHistory& history, const BatchOptions& options) {
    const auto has_failed = [&](const BatchTask& task) {
        const LedgerHistory::Entry* const last = history.find(task.id);
        return last != nullptr &&
               (last->kind == LedgerEventKind::UnitFailed || last->kind == LedgerEventKind::UnitNotTried);
    };
    const auto failed_but_left_out = std::ranges::count_if(tasks.left_out, has_failed);
    std::vector<BatchTask>& chosen = tasks.chosen;
    const auto others = std::stable_partition(chosen.begin(), chosen.end(), has_failed);
    std::move(others, chosen.end(), std::back_inserter(tasks.left_out));
    chosen.erase(others, chosen.end());
    if (!chosen.empty()) return {};
    if (failed_but_left_out == 0)
        return fmt::format("--failed: no image in {} failed last time", options.output.string());
    const std::string_view choosing = options.exclude.empty() ? "--only"
                                      : options.only.empty()  ? "--exclude"
                                                              : "--only with --exclude";
    return fmt::format("--failed: no image that {} chooses failed last time; {} that it leaves out did", choosing,
                       failed_but_left_out);
}

/// Opens the log, which may lie in the output directory that is still to be made.
void open_log(const BatchOptions& options, std::optional<BatchProgress>& progress) {
    if (!options.log.empty()) {
        const fs::path output = fs::absolute(options.output).lexically_normal();
        const fs::path below = fs::absolute(options.log).lexically_normal().lexically_relative(output);
        if (*below.begin() != "..") prepare_output(options.output);
    }
    progress.emplace(options.quiet, options.log);
}

ExitCode run_dry(std::vector<BatchTask> tasks, const BatchOptions& options, const LedgerHistory& history,
                 BatchProgress& progress) {
    BatchPlan plan = make_plan(
        std::move(tasks), options, history, [&](const std::string& what, const BatchPlan& so_far, std::size_t of) {
            progress.update({.done = so_far.size(), .of = of, .under_way = {{what, "planning"}}});
        });
    progress.clear();
    if (interrupt_requested()) {
        progress.say("interrupted before anything was rendered");
        return interrupt_exit_code();
    }
    arrange(plan, options.order, options.overrides.assets);
    print(options, to_json(plan), to_table(plan));
    if (is_command_line_wrong(plan)) return ExitCode::UsageError;
    return totals(plan).failing > 0 ? ExitCode::InvalidScene : ExitCode::Success;
}

/// Makes the batch, and puts its progress and its report where whoever follows it finds them. Shows it on a page of the
/// port `live`, unless that is none.
ExitCode make_batch(const BatchOptions& options, const std::optional<int>& live, std::optional<BatchProgress>& progress,
                    BatchReport& report) {
    // Checked here and not by CLI11, so that --on-finish runs.
    for (const std::string& root : options.roots)
        if (std::error_code error; !fs::exists(root, error)) throw UsageError(missing_in_words("DIRS", root));
    check_options(options.overrides);
    if (!options.name_pattern.empty()) check_name_pattern(options.name_pattern);
    const bool needs_times = options.order == BatchOrder::Shortest || options.order == BatchOrder::Longest;
    if (needs_times && options.no_probe)
        throw UsageError("--order: the shortest and the longest are known by the estimates that --no-probe leaves out");
    if (options.jobs != 1 && options.no_probe && !options.max_memory)
        throw UsageError(
            "--jobs: how much memory an image needs is not known with --no-probe: leave that out, or give "
            "--max-memory");
    BatchTasks tasks = collect_tasks(options, [&](const fs::path& scene) { return find_names(scene, options); });
    if (options.dry_run)
        progress.emplace(options.quiet);
    else
        open_log(options, progress);
    if (tasks.chosen.empty()) {
        progress->say_error(
            "error: no scene directory was found; a scene directory holds a render.json or a glTF file");
        return ExitCode::InvalidScene;
    }
    LedgerHistory history(options.output / "ledger.jsonl");
    history.read_new();
    if (options.only_failed) {
        const std::string none = keep_failed(tasks, history, options);
        if (!none.empty()) {
            progress->say(none);
            if (options.dry_run) print(options, to_json(BatchPlan()), "");
            if (!options.dry_run) print(options, to_json(report), "");
            return ExitCode::Success;
        }
    }
    if (options.dry_run) return run_dry(std::move(tasks.chosen), options, history, *progress);
    prepare_output(options.output);
    std::optional<BatchLivePage> page;
    if (live) page.emplace(*live);
    BatchRunner runner(options, std::move(tasks), history, *progress, page ? &*page : nullptr);
    const BatchPlan& plan = runner.plan();
    if (interrupt_requested()) {
        progress->say("interrupted before anything was rendered");
        return interrupt_exit_code();
    }
    progress->say(summary(plan));
    for (const std::string& lines : {failures(plan), replacements(plan)})
        if (!lines.empty()) progress->say(lines.substr(0, lines.size() - 1));
    if (is_command_line_wrong(plan)) {
        runner.fail_all();
        report = runner.report();
        return ExitCode::UsageError;
    }
    runner.run();
    report = runner.report();
    print(options, to_json(report), to_table(of_chosen(report), options.output.string()));
    return exit_code_of(runner);
}

/// Makes the batch, and runs what is to follow it however it ends.
ExitCode run_batch(const BatchOptions& options, const std::optional<int>& live) {
    std::optional<BatchProgress> progress;
    BatchReport report{.output_directory = fs::absolute(options.output).lexically_normal().string()};
    const ExitCode code = run_action([&] { return make_batch(options, live, progress, report); });
    if (options.on_finish.empty() || options.dry_run) return code;
    if (!progress) progress.emplace(options.quiet);
    run_on_finish(options, report, code, *progress);
    return code;
}

/// Reads how many images are rendered at the same time; 0 for "auto".
int parse_jobs(const std::string& text) {
    constexpr int kMostJobs = 1024;
    int jobs = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), jobs);
    if (text == "auto") return 0;
    if (error != std::errc() || end != text.data() + text.size() || jobs < 1 || jobs > kMostJobs)
        throw CLI::ValidationError("--jobs",
                                   fmt::format("'{}' is neither a number from 1 to {} nor auto", text, kMostJobs));
    return jobs;
}

std::uint64_t parse_memory(const char* option, const std::string& text) {
    const std::optional<std::uint64_t> bytes = parse_byte_size(text);
    if (!bytes) throw CLI::ValidationError(option, fmt::format("'{}' is not {}", text, kByteSizeForm));
    if (*bytes < kLeastMemoryLimit)
        throw CLI::ValidationError(option, fmt::format("'{}' is less than {} MiB, which the program itself may need",
                                                       text, kLeastMemoryLimit >> 20u));
    return *bytes;
}

/// Adds what says which images there are, and which of them are made first.
void add_image_options(CLI::App& command, BatchOptions& options) {
    command.add_option("DIRS", options.roots, "Directories to look for scene directories in, or glTF files")
        ->required();
    command.add_option("-o,--output", options.output, "Directory for the images; made if it does not exist")
        ->required()
        ->type_name("DIR");
    command.add_flag("--force", options.force, "Render again what is up to date");
    command.add_flag("--variants", options.all_variants,
                     "Render every set of materials that a scene's file offers (KHR_materials_variants) to an image of "
                     "its own, NAME.VARIANT.exr");
    command
        .add_option_function<std::string>(
            "--cameras", [&options](const std::string&) { options.all_cameras = true; },
            "all: render every camera of a scene to an image of its own, NAME.CAMERA.exr")
        ->check(CLI::IsMember({"all"}));
    command
        .add_option("--name", options.name_pattern,
                    "Name the images by this pattern of {scene}, {variant}, {camera} and {frame}, below the output "
                    "directory and without .exr: '{scene}/{camera}.{frame}' (default: {scene}.{frame}; --variants and "
                    "--cameras put .{variant} and .{camera} before the frame)")
        ->type_name("PATTERN");
    const auto add_globs = [&](const char* name, std::vector<std::string>& globs, const char* help) {
        command.add_option(name, globs, help)->allow_extra_args(false)->type_name("GLOB");
    };
    add_globs("--only", options.only,
              "Make only images whose name, scene or folder matches this glob, such as 'shots/*' or 'fox.00[0-4]?'; "
              "may be repeated");
    add_globs("--exclude", options.exclude, "Leave out images that match this glob, as with --only; may be repeated");
    command.add_flag("--failed", options.only_failed, "Make only images that failed last time");
    command
        .add_option_function<std::string>(
            "--order", [&options](const std::string& text) { options.order = kOrders.at(text); },
            "Which images come first, by the estimates, by name, or by the time of a scene's newest file (default: by "
            "directory and scene)")
        ->check(CLI::IsMember(kOrders));
}

/// Adds what says how many images are rendered at the same time, and what is done besides rendering them.
void add_work_options(CLI::App& command, BatchOptions& options) {
    add_threads_option(command, options.threads);
    auto* jobs =
        command
            .add_option_function<std::string>(
                "-j,--jobs", [&options](const std::string& text) { options.jobs = parse_jobs(text); },
                "Images to render at the same time, which share the threads; auto: one for every four threads. Another "
                "one begins only if the memory that it may need is free (default: 1)")
            ->type_name("N or auto");
    command
        .add_option_function<std::string>(
            "--jobs-memory",
            [&options](const std::string& text) { options.jobs_memory = parse_memory("--jobs-memory", text); },
            "Memory that the images of --jobs may need together, such as 24G (default: what the machine has free)")
        ->type_name("SIZE")
        ->needs(jobs);
    command.add_flag("--denoise", options.denoise,
                     "Also write each image without its noise, NAME.denoised.exr and .png; adds --aov denoising");
    command.add_flag("--dry-run", options.dry_run,
                     "Print what would be rendered, why, for how long, and what would fail; write nothing");
    command.add_flag("--no-probe", options.no_probe,
                     "Estimate neither time nor memory, which saves a second for each scene to render");
}

/// Adds what says how the render of an image goes on after a failure, and where it ends.
void add_attempt_options(CLI::App& command, BatchOptions& options) {
    command
        .add_option("--retries", options.retries,
                    "Try an image again this many times if its render crashes or cannot read or write a file")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    command
        .add_option(
            "--checkpoint-every", options.checkpoint_minutes,
            "Minutes between checkpoints, from which interrupted images go on; 0 writes one only when interrupted")
        ->check(real_range(0.0, 1e6))
        ->capture_default_str();
    command
        .add_option("--stall-minutes", options.stall_minutes,
                    "Count the render of an image as crashed after this many minutes without progress; 0: never")
        ->check(real_range(0.0, 1e6))
        ->capture_default_str();
    auto* in_process =
        command
            .add_flag("--in-process", options.in_process,
                      "Render all images in this process, not in one process each: a crash ends the batch")
            ->excludes(command.get_option("--jobs"));
    command
        .add_option_function<std::string>(
            "--max-memory",
            [&options](const std::string& text) {
                options.max_memory = parse_memory("--max-memory", text);
                options.max_memory_text = text;
            },
            "Memory that the render of an image may take, such as 8G; one that needs more fails, the others go on "
            "(default: no limit)")
        ->type_name("SIZE")
        ->excludes(in_process);
    command
        .add_flag_callback(
            "--keep-sums", [&options] { options.keep_sums_after = 0.0; },
            "Keep the sums of every finished image in NAME.sums, so that more samples can be added (default: only "
            "of renders over a minute)")
        ->excludes(command.add_flag_callback(
            "--no-keep-sums", [&options] { options.keep_sums_after.reset(); }, "Keep no sums of finished images"));
}

void add_message_options(CLI::App& command, BatchOptions& options) {
    command
        .add_option("--log", options.log,
                    "Append every line of progress, every note and every error to this file, with its time")
        ->type_name("FILE");
    command
        .add_option("--on-finish", options.on_finish,
                    "Run this shell command at the end of the batch, with $ETENDUE_OUTPUT, $ETENDUE_EXIT_CODE and "
                    "the numbers of images $ETENDUE_RENDERED, $ETENDUE_UP_TO_DATE, $ETENDUE_FAILED, "
                    "$ETENDUE_INTERRUPTED and $ETENDUE_NOT_STARTED")
        ->type_name("COMMAND");
    command.add_flag("--quiet", options.quiet, "No progress, notes, warnings or summary; errors only");
    command.add_flag("--json", options.json, "Print the report, or with --dry-run the plan, as JSON on stdout");
}

}  // namespace

void add_batch_command(CLI::App& app, Action& action) {
    auto options = std::make_shared<BatchOptions>();
    CLI::App* command = app.add_subcommand("batch", "Render every scene directory below some directories");
    auto live = std::make_shared<std::string>();
    add_image_options(*command, *options);
    add_work_options(*command, *options);
    add_attempt_options(*command, *options);
    add_message_options(*command, *options);
    add_live_option(*command, *live, "Show the batch in a browser: its table, and images as they are finished");
    const std::size_t own = command->get_options().size();
    add_settings_options(*command, options->overrides);
    add_png_option(*command, options->overrides);
    set_group(*command, "Which images",
              {"--variants", "--cameras", "--name", "--only", "--exclude", "--failed", "--force", "--order",
               "--dry-run", "--no-probe"});
    set_group(*command, "How they are made",
              {"--threads", "--jobs", "--jobs-memory", "--max-memory", "--retries", "--checkpoint-every",
               "--stall-minutes", "--in-process", "--denoise", "--keep-sums", "--no-keep-sums"});
    set_group(*command, "What is said", {"--live", "--log", "--on-finish", "--quiet", "--json"});
    for (const auto& [one, other] : {std::pair("--variants", "--variant"), std::pair("--cameras", "--camera"),
                                     std::pair("--denoise", "--in-process")})
        command->get_option(one)->excludes(command->get_option(other));
    command->footer(
        "A scene directory holds a render.json or a glTF file. Each image is rendered by a process of its "
        "own;\n"
        "one that fails is reported and the others go on. Images whose inputs have not changed and that were "
        "made\n"
        "with the same settings are skipped, and what was interrupted goes on where it was. Any number of 'etendue\n"
        "batch' may work on one output directory at once, also from several machines. What was done stands in\n"
        "OUT/ledger.jsonl, OUT/report.json and OUT/index.html; docs/batch.md tells more.\n\n"
        "Examples:\n"
        "  etendue batch scenes -o out --quality draft\n"
        "  etendue batch scenes -o out --dry-run\n"
        "  etendue batch scenes -o out --live\n"
        "  etendue batch scenes -o out --jobs 4\n"
        "  etendue batch shots/a shots/b -o /renders --spp 512 --force --max-memory 16G\n"
        "  etendue batch characters -o turntables --frames 0:47 --animation Walk\n"
        "  etendue batch products -o catalogue --variants --cameras all --name '{scene}/{variant}-{camera}'\n"
        "  etendue batch scenes -o out --failed --exclude 'tests/*' --log night.log --on-finish 'mail -s done me'\n"
        "  etendue batch scenes -o out --json --quiet > summary.json");
    command->callback([options, live, command, own, &action] {
        const std::vector<const CLI::Option*> all = std::as_const(*command).get_options();
        options->command = command_line("etendue batch", given_options(all));
        options->given = given_options(std::span(all).subspan(own));
        if (options->denoise) {
            options->overrides.give("--aov", "denoising");
            options->given.push_back({"--aov", "denoising"});
        }
        if (!options->output.has_filename()) options->output = options->output.parent_path();
        action = [options, live] { return run_batch(*options, live_port(*live)); };
    });
}

}  // namespace etendue
