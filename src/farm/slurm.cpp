#include "farm/slurm.h"

#include "core/error.h"
#include "core/log.h"
#include "process/run_command.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

/// `text` as a number, all of it.
std::optional<std::size_t> parse_number(std::string_view text) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
    return text;
}

/// Runs one of Slurm's programs.
CommandResult run_slurm(const std::vector<std::string>& words) {
    CommandResult result;
    try {
        result = run_command(words);
    } catch (const IoError& error) {
        throw IoError(
            fmt::format("{}; Slurm's programs are needed here: submit from a machine of the cluster, or see "
                        "docs/farm.md for other schedulers",
                        error.what()));
    }
    if (result.exit_code != 0)
        throw IoError(fmt::format("{} failed with exit code {}: {}", words.front(), result.exit_code,
                                  trimmed(result.err.empty() ? result.out : result.err)));
    return result;
}

}  // namespace

std::size_t slurm_max_array_size() {
    const CommandResult result = run_slurm({"scontrol", "show", "config"});
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t equals = line.find('=');
        if (equals == std::string::npos || trimmed(line.substr(0, equals)) != "MaxArraySize") continue;
        // It is one more than the highest index of a task.
        if (const auto size = parse_number(trimmed(std::string_view(line).substr(equals + 1))); size && *size > 0)
            return *size;
        throw IoError("job arrays are turned off on this cluster: 'scontrol show config' says " + line);
    }
    throw IoError("'scontrol show config' names no MaxArraySize, so that it is not known how long job arrays may be");
}

std::vector<std::string> sbatch_command(const std::filesystem::path& script, const std::filesystem::path& directory,
                                        const std::string& dependency) {
    std::vector<std::string> command{"sbatch", "--parsable", "--chdir=" + directory.string()};
    if (!dependency.empty()) {
        command.push_back("--dependency=" + dependency);
        // What waits for a task that has failed would wait for ever.
        command.emplace_back("--kill-on-invalid-dep=yes");
    }
    command.push_back(script.string());
    return command;
}

std::string slurm_submit(const std::vector<std::string>& command) {
    const CommandResult result = run_slurm(command);
    // "1234", or "1234;cluster".
    const std::string_view job = trimmed(std::string_view(result.out).substr(0, result.out.find(';')));
    if (!parse_number(job)) throw IoError(fmt::format("sbatch answered '{}', which is no job's number", result.out));
    return std::string(job);
}

void slurm_cancel(std::span<const std::string> jobs) {
    if (jobs.empty()) return;
    std::vector<std::string> words{"scancel"};
    words.insert(words.end(), jobs.begin(), jobs.end());
    try {
        (void)run_slurm(words);
    } catch (const IoError& error) {
        log_warning("warning: {}; cancel them by hand", error.what());
    }
}

std::vector<SlurmTask> slurm_tasks(const std::string& user) {
    return parse_squeue(run_slurm({"squeue", "--noheader", "--array", "--user=" + user, "--format=%j|%K|%T|%r"}).out);
}

std::vector<SlurmTask> parse_squeue(const std::string& text) {
    std::vector<SlurmTask> tasks;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::array<std::string_view, 4> fields;
        std::string_view rest = line;
        // From the end: names of other people's jobs may hold any character.
        for (std::size_t i = fields.size(); i-- > 1;) {
            const std::size_t bar = rest.rfind('|');
            if (bar == std::string_view::npos) break;
            fields[i] = trimmed(rest.substr(bar + 1));
            rest = rest.substr(0, bar);
        }
        fields[0] = trimmed(rest);
        if (const auto index = parse_number(fields[1]))
            tasks.push_back({std::string(fields[0]), *index, std::string(fields[2]), std::string(fields[3])});
    }
    return tasks;
}

}  // namespace etendue
