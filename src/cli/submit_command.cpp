// etendue submit: every scene directory below some directories, on the machines of a cluster.
#include "batch/batch_units.h"
#include "cli/command_options.h"
#include "cli/commands.h"
#include "cli/settings_options.h"
#include "core/byte_size.h"
#include "core/error.h"
#include "core/log.h"
#include "core/shown_text.h"
#include "core/standard_output.h"
#include "farm/farm_needs.h"
#include "farm/farm_status.h"
#include "farm/farm_work.h"
#include "farm/slurm.h"
#include "farm/slurm_farm.h"
#include "process/shell_word.h"
#include "session/interrupt.h"
#include "session/usage_error.h"
#include "world/compile.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

namespace fs = std::filesystem;

struct SubmitArguments {
    std::vector<std::string> roots;
    std::string output;
    std::string status;
    std::string scheduler;
    std::string program;
    std::string partition;
    std::string account;
    FarmRequest request;
    SlurmOptions slurm;
    bool dry_run = false;
    bool json = false;
};

/// The images of all scenes, with absolute paths: tasks run somewhere else.
std::vector<BatchTask> find_images(const SubmitArguments& arguments) {
    BatchOptions options;
    options.roots = arguments.roots;
    options.output = arguments.request.farm.output;
    options.overrides = arguments.request.overrides;
    std::vector<BatchTask> tasks = collect_tasks(options, {}).chosen;
    for (BatchTask& task : tasks) task.job.scene = fs::absolute(task.job.scene).lexically_normal();
    return tasks;
}

std::vector<FarmImageStatus> status_of(const fs::path& output) {
    return farm_status(output, [](const std::string& user) { return slurm_tasks(user); });
}

std::size_t task_count(const FarmPlan& plan) {
    std::size_t count = 0;
    for (const JobArray& array : plan.arrays) count += array.commands.size();
    return count;
}

/// The plan for people: each array with what its tasks get, and, before anything is submitted, what would be called.
void print_plan(const SlurmFarm& farm, const FarmWork& work, bool dry_run) {
    std::string text;
    const auto out = std::back_inserter(text);
    const FarmPlan& plan = farm.plan;
    fmt::format_to(out, "{} images in {} tasks of {} job arrays; {} up to date, {} submitted before, {} failed\n",
                   work.images.size(), task_count(plan), plan.arrays.size(), work.up_to_date.size(), work.busy.size(),
                   work.failed.size());
    if (!plan.arrays.empty())
        fmt::format_to(out, "{:<12}  {:>6}  {:>8}  {:>10}\n", "array", "tasks", "minutes", "memory");
    for (const JobArray& array : plan.arrays)
        fmt::format_to(out, "{:<12}  {:>6}  {:>8}  {:>6} MiB\n", array.name, array.commands.size(), array.needs.minutes,
                       array.needs.mebibytes);
    print_text(text);
    if (!dry_run) return;
    text.clear();
    std::vector<std::string> jobs;
    for (std::size_t array = 0; array < plan.arrays.size(); ++array) {
        const std::vector<std::string> words = submit_command(farm, array, jobs);
        for (const std::string& word : words)
            fmt::format_to(out, "{}{}", quoted(word), &word == &words.back() ? "\n" : " ");
        // A number that the shell would not take for one.
        jobs.push_back(fmt::format("JOB-OF-{}", plan.arrays[array].name));
    }
    print_text(text);
}

void print_json(const SlurmFarm& farm, const FarmWork& work, const std::vector<std::string>& jobs) {
    nlohmann::json arrays = nlohmann::json::array();
    for (std::size_t i = 0; i < farm.plan.arrays.size(); ++i) {
        const JobArray& array = farm.plan.arrays[i];
        nlohmann::json entry{{"name", array.name},
                             {"tasks", array.commands.size()},
                             {"minutes", array.needs.minutes},
                             {"mebibytes", array.needs.mebibytes}};
        if (i < jobs.size()) entry["job"] = jobs[i];
        arrays.push_back(std::move(entry));
    }
    nlohmann::json failed = nlohmann::json::array();
    for (const SubmittedImage& image : work.failed)
        failed.push_back({{"image", image.output.string()}, {"error", image.error}});
    const nlohmann::json document{{"directory", jobs.empty() ? "" : farm.submission.directory.string()},
                                  {"images", work.images.size()},
                                  {"up_to_date", work.up_to_date.size()},
                                  {"submitted_before", work.busy.size()},
                                  {"failed", std::move(failed)},
                                  {"arrays", std::move(arrays)}};
    print_data(document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

/// Returns what was submitted before. A dry run does without a cluster that can be asked.
std::vector<FarmImageStatus> submitted_before(const SubmitArguments& arguments) try {
    return status_of(arguments.request.farm.output);
} catch (const IoError& error) {
    if (!arguments.dry_run) throw;
    log_warning("note: nothing is taken to be under way: {}", error.what());
    return {};
}

/// Returns how many tasks a job array may have. A dry run does without a cluster that can be asked.
std::size_t array_size_for(const SubmitArguments& arguments) try {
    return slurm_max_array_size();
} catch (const IoError& error) {
    constexpr std::size_t kSlurmDefault = 1001;
    if (!arguments.dry_run) throw;
    log_warning("note: job arrays are taken to have {} tasks at most, as Slurm's do by default: {}", kSlurmDefault,
                error.what());
    return kSlurmDefault;
}

/// Hides files that the tasks of a submission must not find, by renaming them. The destructor gives them their names
/// back, unless `remove` has deleted them: if the submission fails, the files are needed again.
class HiddenFiles {
  public:
    explicit HiddenFiles(std::span<const fs::path> files) {
        for (const fs::path& file : files) {
            std::error_code error;
            fs::rename(file, hidden_name(file), error);
            if (!error) files_.push_back(file);
        }
    }
    ~HiddenFiles() {
        std::error_code ignored;
        for (const fs::path& file : files_)
            if (!fs::exists(file, ignored)) fs::rename(hidden_name(file), file, ignored);
    }
    HiddenFiles(const HiddenFiles&) = delete;
    HiddenFiles& operator=(const HiddenFiles&) = delete;

    void remove() {
        std::error_code ignored;
        for (const fs::path& file : files_) fs::remove(hidden_name(file), ignored);
        files_.clear();
    }

  private:
    static fs::path hidden_name(fs::path file) { return file += ".replaced"; }

    std::vector<fs::path> files_;
};

ExitCode run_submit(const SubmitArguments& arguments) {
    const std::vector<BatchTask> tasks = find_images(arguments);
    if (tasks.empty()) {
        log_error("error: no scene directory was found; a scene directory holds a render.json or a glTF file");
        return ExitCode::InvalidScene;
    }
    if (const std::string note = note_on_exposures(tasks, arguments.request.overrides); !note.empty())
        log_warning("{}", note);
    const fs::path& output = arguments.request.farm.output;
    const std::vector<Submission> known = read_submissions(output);
    const FarmWork work = find_farm_work(arguments.request, tasks, submitted_before(arguments));
    if (interrupt_requested()) {
        log_error("interrupted before anything was submitted");
        return interrupt_exit_code();
    }
    std::size_t max_array_size = 1;
    if (!work.images.empty()) {
        max_array_size = array_size_for(arguments);
        if (arguments.request.parts > max_array_size)
            throw UsageError(fmt::format("--split-samples {} is more than the {} tasks that a job array may have here",
                                         arguments.request.parts, max_array_size));
    }
    const FileDescriptor lock = arguments.dry_run ? FileDescriptor() : lock_submissions(output);
    const std::vector<Submission> earlier = read_submissions(output);
    // A submission that supersedes another one does not change the number of submissions.
    if (!arguments.dry_run && !std::ranges::equal(earlier, known, {}, &Submission::directory, &Submission::directory))
        throw IoError(fmt::format("another 'etendue submit' has submitted to {} meanwhile: run this command again",
                                  output.string()));
    FarmPlan plan = plan_farm(work.images, arguments.request.farm, max_array_size);
    std::vector<std::string> jobs;
    const fs::path directory =
        arguments.dry_run ? farm_directory(output) / "submit-DRY-RUN" : make_submission_directory(output);
    const SlurmFarm farm = make_slurm_farm(work, std::move(plan), arguments.slurm, directory);
    if (!arguments.dry_run) {
        HiddenFiles useless(work.useless);
        jobs = submit(farm, [&] { useless.remove(); });
        useless.remove();
        remove_superseded(earlier, farm.submission);
    }
    if (arguments.json)
        print_json(farm, work, jobs);
    else
        print_plan(farm, work, arguments.dry_run);
    return work.failed.empty() ? ExitCode::Success : ExitCode::RenderFailed;
}

ExitCode run_status(const SubmitArguments& arguments) {
    const std::vector<FarmImageStatus> images = status_of(arguments.status);
    if (images.empty()) throw UsageError(fmt::format("nothing was ever submitted to '{}'", arguments.status));
    std::map<FarmState, std::size_t> counts;
    for (const FarmImageStatus& image : images) ++counts[image.state];
    if (arguments.json) {
        print_data(to_json(images));
    } else {
        std::string text;
        const auto out = std::back_inserter(text);
        for (const FarmImageStatus& image : images) {
            fmt::format_to(out, "{:<8} {}/{}  {}\n", farm_state_name(image.state), image.tasks_done,
                           image.image.tasks.size(), shown_text(image.image.output.string()));
            if (image.state != FarmState::Failed) continue;
            if (!image.log.empty()) fmt::format_to(out, "    {}:\n", shown_text(image.log.string()));
            std::istringstream lines(image.error);
            for (std::string line; std::getline(lines, line);) fmt::format_to(out, "    {}\n", line);
        }
        fmt::format_to(out, "{} done, {} running, {} pending, {} failed\n", counts[FarmState::Done],
                       counts[FarmState::Running], counts[FarmState::Pending], counts[FarmState::Failed]);
        print_text(text);
    }
    if (counts[FarmState::Failed] > 0) return ExitCode::RenderFailed;
    return counts[FarmState::Done] == images.size() ? ExitCode::Success : ExitCode::Unfinished;
}

/// Adds to `command` the options that say what a task gets and how the task is run.
void add_task_options(CLI::App& command, const std::shared_ptr<SubmitArguments>& arguments) {
    FarmRequest& request = arguments->request;
    command
        .add_option(
            "--split-samples", request.parts,
            "Render the samples of each image in this many parts, at borders of 16 samples where it has enough, "
            "and merge them (default: 1)")
        ->check(CLI::Range(1, 1000));
    command.add_option("--threads", request.farm.threads, "Processors and threads of each task (default: 4)")
        ->check(CLI::Range(1, 4096));
    command
        .add_option("--task-minutes", request.task_minutes,
                    fmt::format("Time of a task before it is stopped and goes on later (default: {:g} times what a "
                                "probe of each scene says, {} minutes at least)",
                                kTimeSafety, kLeastMinutes))
        ->check(CLI::Range(2, 1000000));
    command.add_option_function<std::string>(
        "--task-memory",
        [arguments](const std::string& text) {
            const auto bytes = parse_byte_size(text);
            if (!bytes || *bytes < (1u << 20u))
                throw CLI::ValidationError("--task-memory", fmt::format("'{}' is not {}", text, kByteSizeForm));
            arguments->request.task_memory = bytes;
        },
        fmt::format(
            "Memory of a task, such as 8G (default: {:g} times what a probe of each scene says, {} MiB at least)",
            kMemorySafety, kLeastMebibytes));
    command
        .add_option("--checkpoint-every", request.farm.checkpoint_minutes,
                    "Minutes between checkpoints, from which a task goes on after its node has failed (default: 5)")
        ->check(real_range(0.0, 1e6));
    command
        .add_option("--max-running", arguments->slurm.max_running,
                    "Most tasks of one job array at once (default: no limit)")
        ->check(CLI::Range(1, 1000000));
    command.add_option("--partition", arguments->partition, "Partition of the cluster");
    command.add_option("--account", arguments->account, "Account that the time is charged to");
    command.add_option("--sbatch-option", arguments->slurm.options,
                       "One further option of sbatch, such as --qos=low; can be given several times");
    command.add_option("--program", arguments->program,
                       "etendue on the nodes: its path, or a name to be found in PATH there (default: the path of this "
                       "one, which then has to be there, too)");
}

/// Options as tasks get them, which run elsewhere: with an absolute path, and each for its own frame.
std::vector<GivenOption> options_of_tasks(std::vector<GivenOption> given) {
    given = without(std::move(given), "--frames");
    for (GivenOption& option : given)
        if (option.value &&
            (option.name == "--assets" || (option.name == "--environment" && *option.value != kNoEnvironment &&
                                           *option.value != kNeutralEnvironment)))
            option.value = fs::absolute(*option.value).string();
    return given;
}

/// Makes the paths absolute that are named by $OCIO and listed by $ETENDUE_ASSETS: tasks get these variables, and run
/// in another directory.
void make_environment_absolute() {
    if (const char* const config = std::getenv("OCIO")) {
        const std::string_view name = config;
        // OpenColorIO has configs of its own, which are no files.
        if (!name.empty() && !name.starts_with("ocio://")) ::setenv("OCIO", fs::absolute(name).c_str(), 1);
    }
    if (const char* const listed = std::getenv("ETENDUE_ASSETS")) {
        std::istringstream list(listed);
        std::string absolute;
        for (std::string directory; std::getline(list, directory, ':');)
            if (!directory.empty()) absolute += (absolute.empty() ? "" : ":") + fs::absolute(directory).string();
        ::setenv("ETENDUE_ASSETS", absolute.c_str(), 1);
    }
}

/// Makes of the options as they were given what they mean.
void complete(SubmitArguments& arguments, std::vector<GivenOption> overrides) {
    make_environment_absolute();
    FarmOptions& farm = arguments.request.farm;
    farm.output = fs::absolute(arguments.output).lexically_normal();
    if (!farm.output.has_filename()) farm.output = farm.output.parent_path();
    farm.program = arguments.program.empty() ? fs::read_symlink("/proc/self/exe") : fs::path(arguments.program);
    // Tasks run in another directory. A name alone is looked up in the PATH that they have.
    if (farm.program.has_parent_path()) farm.program = fs::absolute(farm.program).lexically_normal();
    farm.options = options_of_tasks(std::move(overrides));
    farm.depth = arguments.request.overrides.depth;
    arguments.request.texture_memory = to_byte_size(default_texture_memory());
    arguments.slurm.threads = farm.threads;
    // Slurm takes both in the names of log files for its own, and cannot be told otherwise.
    if (farm.output.string().find_first_of("\\%") != std::string::npos)
        throw UsageError(
            fmt::format("Slurm cannot write its logs below '{}': its name has a backslash or a percent sign",
                        farm.output.string()));
    if (!arguments.partition.empty()) arguments.slurm.options.push_back("--partition=" + arguments.partition);
    if (!arguments.account.empty()) arguments.slurm.options.push_back("--account=" + arguments.account);
    check_options(arguments.slurm);
}

}  // namespace

void add_submit_command(CLI::App& app, Action& action) {
    auto arguments = std::make_shared<SubmitArguments>();
    CLI::App* command = app.add_subcommand("submit", "Render scenes on a cluster, or tell what has become of them");
    auto* dirs =
        command->add_option("DIRS", arguments->roots, "Directories to look for scene directories in, or glTF files")
            ->check(CLI::ExistingPath);
    auto* output = command->add_option("-o,--output", arguments->output,
                                       "Directory for the images, on a file system that all nodes share");
    auto* scheduler = command->add_option("--scheduler", arguments->scheduler, "What the cluster is run by: slurm")
                          ->check(CLI::IsMember({"slurm"}));
    auto* status = command
                       ->add_option("--status", arguments->status,
                                    "Instead of submitting, tell for each image of this directory whether it is done")
                       ->check(CLI::ExistingDirectory)
                       ->excludes(dirs)
                       ->excludes(output);
    add_task_options(*command, arguments);
    command->add_flag("--force", arguments->request.force, "Render again what is up to date");
    command->add_flag("--dry-run", arguments->dry_run, "Tell what would be submitted; write nothing");
    command->add_flag("--json", arguments->json, "Print the summary or the status as JSON on stdout");
    const std::size_t own = command->get_options().size();
    add_settings_options(*command, arguments->request.overrides);
    command->footer(
        "Each image is a task of a job array, or one for each part of its samples and one that merges them. What is "
        "up\n"
        "to date or was submitted before and is not ready yet is not submitted. A task whose node fails or whose time\n"
        "is up is queued again and goes on from its checkpoint. docs/farm.md tells more.\n\n"
        "Exit codes of --status: 0 all images are done, 1 some have failed, 4 some still wait or run.\n\n"
        "Examples:\n"
        "  etendue submit scenes -o /shared/out --scheduler slurm --quality preview\n"
        "  etendue submit shots -o /shared/out --scheduler slurm --split-samples 8 --frames 1:240 --exposure 0\n"
        "  etendue submit shots -o /shared/out --scheduler slurm --threads 16 --task-memory 24G --dry-run\n"
        "  etendue submit --status /shared/out");
    command->callback([=, &action] {
        if (status->count() == 0)
            for (const CLI::Option* option : {dirs, output, scheduler})
                if (option->count() == 0) throw CLI::RequiredError(option->get_name());
        const std::vector<const CLI::Option*> all = std::as_const(*command).get_options();
        const std::vector<GivenOption> overrides = given_options(std::span(all).subspan(own));
        action = [arguments, overrides] {
            if (!arguments->status.empty()) return run_status(*arguments);
            complete(*arguments, overrides);
            try {
                return run_submit(*arguments);
            } catch (const IoError& error) {
                if (!interrupt_requested()) throw;
                log_error("{}", error.what());
                return interrupt_exit_code();
            }
        };
    });
}

}  // namespace etendue
