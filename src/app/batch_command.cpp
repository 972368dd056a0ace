// etendue batch: every scene directory below some directories.
#include "app/commands.h"
#include "app/interrupt.h"
#include "app/progress_display.h"
#include "app/scene_render.h"
#include "app/up_to_date.h"
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
#include <nlohmann/json.hpp>

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
    fs::path output;   ///< the EXR
    std::string name;  ///< path below the output directory, without extension
};

enum class Outcome { Rendered, UpToDate, Failed, Interrupted };

struct BatchRow {
    BatchItem item;
    Outcome outcome = Outcome::Failed;
    std::string error;
    RenderStatistics statistics;
};

const char* outcome_name(Outcome outcome) {
    switch (outcome) {
        case Outcome::Rendered:
            return "rendered";
        case Outcome::UpToDate:
            return "up to date";
        case Outcome::Failed:
            return "failed";
        case Outcome::Interrupted:
            return "interrupted";
    }
    return "?";
}

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
    std::set<std::string> taken;
    for (BatchItem& item : items) {
        if (uses[item.name] > 1) item.name = (item.output.filename() / item.name).string();
        if (!taken.insert(item.name).second)
            throw SceneError({item.scene.string(), ""}, "two scenes would be written to '" + item.name +
                                                            "'; render them to different directories");
        item.output = fs::path(arguments.output) / (item.name + ".exr");
    }
    return items;
}

BatchRow process(const BatchItem& item, const std::string& title, const BatchArguments& arguments,
                 const ThreadPool& threads) {
    BatchRow row{item, Outcome::Failed, {}, {}};
    try {
        PreparedScene prepared = prepare_scene(item.scene, arguments.overrides);
        const OutputPaths paths = OutputPaths::beside(item.output);
        const std::string hash = settings_hash(prepared.scene, arguments.overrides.depth);
        if (!arguments.force && is_up_to_date(paths, prepared.scene.inputs, hash)) {
            row.outcome = Outcome::UpToDate;
            return row;
        }
        fs::create_directories(item.output.parent_path());
        const SceneRenderRequest request{item.scene, item.output, arguments.overrides, arguments.quiet, title};
        const SceneRenderResult result = render_scene(std::move(prepared), request, threads);
        row.statistics = result.statistics;
        row.outcome = result.interrupted ? Outcome::Interrupted : Outcome::Rendered;
    } catch (const std::exception& error) {
        row.error = error.what();
        log_error("{}: {}", item.scene.string(), row.error);
    }
    return row;
}

void print_table(const std::vector<BatchRow>& rows) {
    std::size_t width = 5;
    for (const BatchRow& row : rows) width = std::max(width, row.item.name.size());
    fmt::print("{:<{}}  {:<11}  {:>11}  {:>6}  {:>9}  {:>8}  {}\n", "scene", width, "result", "size", "spp", "time",
               "Mrays/s", "image");
    for (const BatchRow& row : rows) {
        const RenderStatistics& s = row.statistics;
        fmt::print("{:<{}}  {:<11}  ", row.item.name, width, outcome_name(row.outcome));
        if (s.samples > 0)
            fmt::print("{:>11}  {:>6}  {:>9}  {:>8.1f}  ", fmt::format("{}x{}", s.width, s.height), s.spp_done,
                       format_duration(s.render.wall),
                       static_cast<double>(s.rays.total()) / std::max(s.render.wall, 1e-9) * 1e-6);
        else
            fmt::print("{:>11}  {:>6}  {:>9}  {:>8}  ", "-", "-", "-", "-");
        // A message of several lines would break the table; its first line is enough here, all were logged.
        fmt::print("{}\n", row.outcome == Outcome::Failed ? row.error.substr(0, row.error.find('\n'))
                                                          : row.item.output.string());
    }
}

void print_json(const std::vector<BatchRow>& rows) {
    nlohmann::json list = nlohmann::json::array();
    for (const BatchRow& row : rows) {
        nlohmann::json entry{{"scene", row.item.scene.string()},
                             {"image", row.item.output.string()},
                             {"result", outcome_name(row.outcome)}};
        if (!row.error.empty()) entry["error"] = row.error;
        if (row.statistics.samples > 0) entry["statistics"] = nlohmann::json::parse(to_json(row.statistics));
        list.push_back(std::move(entry));
    }
    fmt::print("{}\n", list.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

ExitCode run_batch(const BatchArguments& arguments) {
    const std::vector<BatchItem> items = collect_items(arguments);
    if (items.empty()) {
        log_error(
            "error: no scene directory was found; a scene directory holds a render.json or exactly one glTF file");
        return ExitCode::InvalidScene;
    }
    const ThreadPool threads(arguments.threads);
    std::vector<BatchRow> rows;
    for (std::size_t i = 0; i < items.size() && !interrupt_requested(); ++i)
        rows.push_back(
            process(items[i], fmt::format("[{}/{}] {}", i + 1, items.size(), items[i].name), arguments, threads));
    if (arguments.json)
        print_json(rows);
    else if (!arguments.quiet)
        print_table(rows);
    if (interrupt_requested()) return interrupt_exit_code();
    const bool failed =
        std::any_of(rows.begin(), rows.end(), [](const BatchRow& r) { return r.outcome == Outcome::Failed; });
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
        "on; images that are newer than all of their inputs and were made with the same settings are skipped.\n\n"
        "Examples:\n"
        "  etendue batch scenes -o out --quality draft\n"
        "  etendue batch shots/a shots/b -o /renders --spp 512 --force\n"
        "  etendue batch scenes -o out --json --quiet > summary.json");
    command->callback([arguments, &action] { action = [arguments] { return run_batch(*arguments); }; });
}

}  // namespace etendue
