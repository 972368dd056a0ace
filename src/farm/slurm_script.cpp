#include "farm/slurm_script.h"

#include "processor/ray_code.h"
#include "session/usage_error.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Times that a task is started again because its time was up; more than that is a loop.
constexpr int kMostRestarts = 20;

/// Returns how many seconds before its time limit Slurm warns a task: at most half of the limit.
int warning_seconds_of(const TaskNeeds& needs) {
    return std::max(kLeastWarningSeconds, std::min(needs.warning_seconds, needs.minutes * 60 / 2));
}

bool is_harmless(char c) {
    constexpr std::string_view kPunctuation = "-_=.,:;/@+%[]&|*!";
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           kPunctuation.find(c) != std::string_view::npos;
}

std::string option_lines(const SlurmOptions& options) {
    std::string lines;
    for (const std::string& option : options.options) lines += (lines.empty() ? "#SBATCH " : "\n#SBATCH ") + option;
    return lines;
}

/// `text` with what stands for each @NAME@ in its place. Values are not looked at again.
std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& values) {
    std::string result;
    while (!text.empty()) {
        const std::size_t begin = text.find('@');
        const std::size_t end = begin == std::string_view::npos ? begin : text.find('@', begin + 1);
        if (end == std::string_view::npos) break;
        const auto value = values.find(text.substr(begin + 1, end - begin - 1));
        // An '@' of the script's own stays.
        const std::size_t taken = value == values.end() ? begin + 1 : end + 1;
        result += value == values.end() ? text.substr(0, taken) : text.substr(0, begin);
        if (value != values.end()) result += value->second;
        text.remove_prefix(taken);
    }
    return result + std::string(text);
}

}  // namespace

void check_options(const SlurmOptions& options) {
    for (const std::string& option : options.options)
        if (!option.starts_with("--") || !std::ranges::all_of(option, is_harmless))
            throw UsageError(
                fmt::format("'{}' cannot be given to sbatch: it must be one word, --NAME or --NAME=VALUE, "
                            "without quotes or blanks",
                            option));
}

std::string tasks_file_name(const std::string& array) {
    return array + ".tasks";
}

std::string log_file_name(const std::string& array, std::size_t index) {
    return fmt::format("logs/{}.{}.log", array, index);
}

std::string slurm_script(const JobArray& array, const std::string& job_name, const SlurmOptions& options) {
    if (array.commands.empty()) throw std::logic_error("a job array without tasks");
    check_options(options);
    std::string range = fmt::format("0-{}", array.commands.size() - 1);
    if (options.max_running > 0) range += fmt::format("%{}", options.max_running);
    return filled(slurm_template(), {{"NAME", job_name},
                                     {"ARRAY", range},
                                     {"THREADS", fmt::format("{}", options.threads)},
                                     {"MEMORY", fmt::format("{}M", array.needs.mebibytes)},
                                     {"MINUTES", fmt::format("{}", array.needs.minutes)},
                                     {"WARNING", fmt::format("{}", warning_seconds_of(array.needs))},
                                     {"LOG", fmt::format("logs/{}.%a.log", array.name)},
                                     {"TASKS", tasks_file_name(array.name)},
                                     {"ISA", std::string(instruction_set_name(ray_code().instruction_set))},
                                     {"RESTARTS", fmt::format("{}", kMostRestarts)},
                                     {"OPTIONS", option_lines(options)}});
}

}  // namespace etendue
