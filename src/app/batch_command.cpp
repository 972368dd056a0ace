// etendue batch: every scene directory below some directories.
#include "app/commands.h"
#include "app/image_job.h"
#include "app/interrupt.h"
#include "app/progress_display.h"
#include "core/log.h"
#include "loader/loader.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

struct BatchArguments {
    std::vector<std::string> roots;
    std::string output;
    SettingsOverrides overrides;
    int threads = 0;
    bool force = false;
    bool quiet = false;
    bool json = false;
};

struct BatchItem {
    fs::path scene;
    fs::path root;     ///< the directory given, below which it was found
    std::string name;  ///< path below the output directory, without extension
};

/// A scene's name is its path below the root; with several roots that hold the same name, the root's name comes first.
std::vector<BatchItem> collect_items(const BatchArguments& arguments) {
    std::vector<BatchItem> items;
    std::map<std::string, int> uses;
    std::set<fs::path> seen;
    for (const std::string& text : arguments.roots) {
        // Absolute, so that "." has a name, and without a trailing slash, so that the last component has one.
        fs::path root = fs::absolute(text).lexically_normal();
        if (!root.has_filename()) root = root.parent_path();
        for (const fs::path& scene : find_scene_directories(root)) {
            if (!seen.insert(scene).second) continue;
            const fs::path relative = scene.lexically_relative(root);
            const std::string name = (relative == "." ? root.filename() : relative).string();
            items.push_back({scene.lexically_proximate(fs::current_path()), root, name});
            ++uses[name];
        }
    }
    for (BatchItem& item : items)
        if (uses[item.name] > 1) item.name = (item.root.filename() / item.name).string();
    return items;
}

/// One job for each image of each scene. Throws SceneError if two would be written to the same file.
std::vector<ImageJob> collect_jobs(const BatchArguments& arguments) {
    std::vector<ImageJob> jobs;
    std::set<fs::path> taken;
    for (const BatchItem& item : collect_items(arguments)) {
        const fs::path output = fs::path(arguments.output) / (item.name + ".exr");
        for (ImageJob& job : image_jobs(item.scene, output, item.name, arguments.overrides)) {
            if (!taken.insert(job.output).second)
                throw SceneError(
                    {item.scene.string(), ""},
                    fmt::format("two images would be written to '{}'; render them to different directories",
                                job.output.string()));
            jobs.push_back(std::move(job));
        }
    }
    return jobs;
}

ImageResult process(const ImageJob& job, const std::string& title, const BatchArguments& arguments,
                    const ThreadPool& threads) {
    try {
        return run_job(job,
                       {.overrides = arguments.overrides,
                        .force = arguments.force,
                        .quiet = arguments.quiet,
                        .make_directories = true,
                        .title = title},
                       threads);
    } catch (const std::exception& error) {
        log_error("{}: {}", job.scene.string(), error.what());
        return {job, ImageOutcome::Failed, error.what(), {}};
    }
}

/// What is wrong with one frame of a scene is wrong with the others: they are not tried once one has failed.
std::vector<ImageResult> process_all(const std::vector<ImageJob>& jobs, const BatchArguments& arguments,
                                     const ThreadPool& threads) {
    std::vector<ImageResult> results;
    fs::path failed_scene;
    for (std::size_t i = 0; i < jobs.size() && !interrupt_requested(); ++i) {
        if (jobs[i].scene == failed_scene) continue;
        results.push_back(
            process(jobs[i], fmt::format("[{}/{}] {}", i + 1, jobs.size(), jobs[i].name), arguments, threads));
        if (results.back().outcome == ImageOutcome::Failed) failed_scene = jobs[i].scene;
    }
    return results;
}

void print_table(const std::vector<ImageResult>& results) {
    std::size_t width = 5;
    for (const ImageResult& result : results) width = std::max(width, result.job.name.size());
    fmt::print("{:<{}}  {:<11}  {:>11}  {:>6}  {:>9}  {:>8}  {}\n", "scene", width, "result", "size", "spp", "time",
               "Mrays/s", "image");
    for (const ImageResult& result : results) {
        const RenderStatistics& s = result.statistics;
        fmt::print("{:<{}}  {:<11}  ", result.job.name, width, outcome_name(result.outcome));
        if (s.samples > 0)
            fmt::print("{:>11}  {:>6}  {:>9}  {:>8.1f}  ", fmt::format("{}x{}", s.width, s.height), s.spp_done,
                       format_duration(s.render.wall),
                       static_cast<double>(s.rays.total()) / std::max(s.render.wall, 1e-9) * 1e-6);
        else
            fmt::print("{:>11}  {:>6}  {:>9}  {:>8}  ", "-", "-", "-", "-");
        // A message of several lines would break the table; its first line is enough here, all were logged.
        fmt::print("{}\n", result.outcome == ImageOutcome::Failed ? result.error.substr(0, result.error.find('\n'))
                                                                  : result.job.output.string());
    }
}

ExitCode run_batch(const BatchArguments& arguments) {
    const std::vector<ImageJob> jobs = collect_jobs(arguments);
    if (jobs.empty()) {
        log_error(
            "error: no scene directory was found; a scene directory holds a render.json or exactly one glTF file");
        return ExitCode::InvalidScene;
    }
    const ThreadPool threads(arguments.threads);
    const std::vector<ImageResult> results = process_all(jobs, arguments, threads);
    if (arguments.json)
        fmt::print("{}", to_json(results));
    else if (!arguments.quiet)
        print_table(results);
    if (interrupt_requested()) return interrupt_exit_code();
    const bool failed =
        std::ranges::any_of(results, [](const ImageResult& result) { return result.outcome == ImageOutcome::Failed; });
    return failed ? ExitCode::RenderFailed : ExitCode::Success;
}

}  // namespace

void add_batch_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<BatchArguments>();
    CLI::App* command = app.add_subcommand("batch", "Render every scene directory below some directories");
    command->add_option("dirs", arguments->roots, "Directories to look for scene directories in")
        ->required()
        ->check(CLI::ExistingDirectory);
    command->add_option("-o,--output", arguments->output, "Directory for the images; made if it does not exist")
        ->required();
    arguments->overrides.add_options(*command);
    command->add_option("--threads", arguments->threads, "Threads to use (default: one per processor)")
        ->check(CLI::Range(1, 4096));
    command->add_flag("--force", arguments->force, "Render again what is up to date");
    command->add_flag("--quiet", arguments->quiet, "No progress, notes, warnings or summary; errors only");
    command->add_flag("--json", arguments->json, "Print the summary as JSON on stdout");
    command->footer(
        "A scene directory holds a render.json or exactly one glTF file. A scene that fails is reported and the others "
        "go\n"
        "on; images that are newer than all of their inputs and were made with the same settings are skipped. Of a\n"
        "sequence of frames the table has one row for each.\n\n"
        "Examples:\n"
        "  etendue batch scenes -o out --quality draft\n"
        "  etendue batch shots/a shots/b -o /renders --spp 512 --force\n"
        "  etendue batch characters -o turntables --frames 0:47 --animation Walk\n"
        "  etendue batch scenes -o out --json --quiet > summary.json");
    command->callback([arguments, &action] { action = [arguments] { return run_batch(*arguments); }; });
}

}  // namespace etendue
