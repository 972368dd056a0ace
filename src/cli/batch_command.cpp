// etendue batch: every scene directory below some directories.
#include "batch/batch_child.h"
#include "batch/batch_lock.h"
#include "batch/batch_options.h"
#include "batch/batch_plan.h"
#include "batch/batch_runner.h"
#include "batch/batch_table.h"
#include "batch/batch_units.h"
#include "cli/command_options.h"
#include "cli/commands.h"
#include "cli/settings_options.h"
#include "core/byte_size.h"
#include "core/error.h"
#include "core/log.h"
#include "core/standard_output.h"
#include "picture/output_paths.h"
#include "process/process_limits.h"
#include "session/interrupt.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// Makes the output directory. Throws IoError if nothing can be written in it: better now than after the first image.
void prepare_output(const fs::path& output) {
    std::error_code error;
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
    const BatchTotals sum = totals(runner.report());
    const bool is_whole = sum.rendered + sum.up_to_date == sum.units && runner.has_kept_books();
    return is_whole ? ExitCode::Success : ExitCode::RenderFailed;
}

ExitCode run_batch(const BatchOptions& options) {
    BatchProgress progress(options.quiet);
    const auto look = [&](const fs::path& scene) { return find_variants(scene, options); };
    std::vector<BatchTask> tasks = collect_tasks(options, look);
    if (tasks.empty()) {
        log_error("error: no scene directory was found; a scene directory holds a render.json or a glTF file");
        return ExitCode::InvalidScene;
    }
    if (!options.dry_run) prepare_output(options.output);
    LedgerHistory history(options.output / "ledger.jsonl");
    history.read_new();
    BatchPlan plan =
        make_plan(std::move(tasks), options, history, [&](const std::string& what, std::size_t done, std::size_t of) {
            progress.update({.done = done, .of = of, .current = what, .state = "planning"});
        });
    progress.clear();
    if (interrupt_requested()) {
        if (!options.dry_run) BatchLocks(options.output).tidy();
        progress.say("interrupted before anything was rendered");
        return interrupt_exit_code();
    }
    if (options.dry_run) {
        print(options, to_json(plan), to_table(plan));
        return ExitCode::Success;
    }
    progress.say(summary(plan));
    BatchRunner runner(options, std::move(plan), history, progress);
    runner.run();
    print(options, to_json(runner.report()), to_table(runner.report(), options.output.string()));
    return exit_code_of(runner);
}

void add_own_options(CLI::App& command, BatchOptions& options) {
    command.add_option("dirs", options.roots, "Directories to look for scene directories in")
        ->required()
        ->check(CLI::ExistingDirectory);
    command.add_option("-o,--output", options.output, "Directory for the images; made if it does not exist")
        ->required();
    command.add_option("--threads", options.threads, "Threads to use (default: one per processor)")
        ->check(CLI::Range(1, 4096));
    command.add_flag("--force", options.force, "Render again what is up to date");
    command.add_flag("--variants", options.all_variants,
                     "Render every set of materials that a scene's file offers (KHR_materials_variants) to an image of "
                     "its own, NAME.VARIANT.exr");
    command.add_flag("--dry-run", options.dry_run, "Print what would be rendered, why and for how long; write nothing");
    command.add_flag("--no-probe", options.no_probe,
                     "No estimate of time, which takes a second for each scene that is stale");
    command.add_option("--retries", options.retries, "Attempts after one that crashed or could not read or write")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    command
        .add_option("--checkpoint-every", options.checkpoint_minutes,
                    "Minutes between checkpoints, from which interrupted images go on; 0: none but when interrupted")
        ->check(real_range(0.0, 1e6))
        ->capture_default_str();
    command
        .add_option("--stall-minutes", options.stall_minutes,
                    "Minutes without any progress after which the render of an image counts as crashed; 0: never")
        ->check(real_range(0.0, 1e6))
        ->capture_default_str();
    auto* in_process = command.add_flag("--in-process", options.in_process,
                                        "Render in this process instead of one for each image: a crash ends all");
    command
        .add_option_function<std::string>(
            "--max-memory",
            [&options](const std::string& text) {
                options.max_memory = parse_byte_size(text);
                options.max_memory_text = text;
                if (!options.max_memory)
                    throw CLI::ValidationError("--max-memory", fmt::format("'{}' is not {}", text, kByteSizeForm));
                if (*options.max_memory < kLeastMemoryLimit)
                    throw CLI::ValidationError(
                        "--max-memory", fmt::format("'{}' is less than {} MiB, which the program itself may need", text,
                                                    kLeastMemoryLimit >> 20u));
            },
            "Memory that the render of an image may take, such as 8G; one that needs more fails, the others go on")
        ->excludes(in_process);
    command.add_flag("--quiet", options.quiet, "No progress, notes, warnings or summary; errors only");
    command.add_flag("--json", options.json, "Print the report, or with --dry-run the plan, as JSON on stdout");
}

}  // namespace

void add_batch_command(CLI::App& app, Action& action) {
    auto options = std::make_shared<BatchOptions>();
    CLI::App* command = app.add_subcommand("batch", "Render every scene directory below some directories");
    add_own_options(*command, *options);
    const std::size_t own = command->get_options().size();
    add_settings_options(*command, options->overrides);
    command->get_option("--variants")->excludes(command->get_option("--variant"));
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
        "  etendue batch shots/a shots/b -o /renders --spp 512 --force --max-memory 16G\n"
        "  etendue batch characters -o turntables --frames 0:47 --animation Walk\n"
        "  etendue batch products -o catalogue --variants --checkpoint-every 1\n"
        "  etendue batch scenes -o out --json --quiet > summary.json");
    command->callback([options, command, own, &action] {
        const std::vector<const CLI::Option*> all = std::as_const(*command).get_options();
        options->command = command_line("etendue batch", given_options(all));
        options->given = given_options(std::span(all).subspan(own));
        if (!options->output.has_filename()) options->output = options->output.parent_path();
        action = [options] { return run_batch(*options); };
    });
}

}  // namespace etendue
