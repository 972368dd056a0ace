#include "farm/farm_status.h"

#include "core/content_hash.h"
#include "picture/output_paths.h"
#include "session/up_to_date.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace fs = std::filesystem;

namespace {

constexpr std::array<FarmState, 4> kStates{FarmState::Done, FarmState::Running, FarmState::Pending, FarmState::Failed};

/// Lines of a log that are shown.
constexpr std::size_t kLogLines = 5;

/// Holds tasks by the name of their job and their index.
using TaskMap = std::map<std::pair<std::string, std::size_t>, SlurmTask>;

TaskMap list_tasks(std::span<const Submission> submissions, const TaskLister& list) {
    std::set<std::string> users;
    for (const Submission& submission : submissions) users.insert(submission.user);
    TaskMap tasks;
    for (const std::string& user : users)
        for (SlurmTask& task : list(user)) {
            std::pair key(task.job_name, task.index);
            tasks.emplace(std::move(key), std::move(task));
        }
    return tasks;
}

/// Returns the first task whose file is not there, or the last one: the one to blame.
const SubmittedTask& missing_task(const SubmittedImage& image) {
    std::error_code ignored;
    const auto missing =
        std::ranges::find_if(image.tasks, [&](const SubmittedTask& task) { return !fs::exists(task.makes, ignored); });
    return missing == image.tasks.end() ? image.tasks.back() : *missing;
}

void explain_failure(const Submission& submission, FarmImageStatus& status) {
    if (!status.image.error.empty()) {
        status.error = status.image.error;
        return;
    }
    if (status.image.tasks.empty()) {
        status.error = "it was up to date, and is not any more";
        return;
    }
    const SubmittedTask& task = missing_task(status.image);
    const fs::path log = submission.directory / log_file_name(task.array, task.index);
    std::error_code ignored;
    if (!fs::exists(log, ignored)) {
        status.error = "a task of it has left no log: it was cancelled before it began, or never submitted";
        return;
    }
    status.log = log;
    status.error = last_lines(log, kLogLines);
}

/// Complete, and by the tasks that were submitted: an image that was there before is what they are to replace.
bool is_done(const Submission& submission, const SubmittedImage& image) {
    const OutputPaths paths = OutputPaths::beside(image.output);
    if (why_unfinished(paths)) return false;
    std::error_code error;
    return image.tasks.empty() ||
           fs::last_write_time(paths.json, error) > fs::last_write_time(submission.file(), error);
}

FarmImageStatus status_of(const Submission& submission, const SubmittedImage& image, const TaskMap& tasks) {
    FarmImageStatus status{image, FarmState::Failed, 0, {}, {}, {}};
    bool running = false;
    bool waits = false;
    std::error_code ignored;
    for (const SubmittedTask& task : image.tasks) {
        const auto found = tasks.find({submission.job_name(task.array), task.index});
        // What can never begin is about to be removed by Slurm.
        const bool alive = found != tasks.end() && found->second.reason != "DependencyNeverSatisfied";
        if (alive) status.job = found->second.job_name;
        running |= alive && found->second.state != "PENDING";
        waits |= alive;
        status.tasks_done += !alive && fs::exists(task.makes, ignored) ? 1 : 0;
    }
    if (running)
        status.state = FarmState::Running;
    else if (waits)
        status.state = FarmState::Pending;
    else if (image.error.empty() && is_done(submission, image))
        status.state = FarmState::Done;
    else
        explain_failure(submission, status);
    if (status.state == FarmState::Done) status.tasks_done = image.tasks.size();
    return status;
}

std::string without_controls(std::string text) {
    std::erase_if(text, [](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f; });
    return text;
}

}  // namespace

const char* farm_state_name(FarmState state) {
    switch (state) {
        case FarmState::Done:
            return "done";
        case FarmState::Running:
            return "running";
        case FarmState::Pending:
            return "pending";
        case FarmState::Failed:
            return "failed";
    }
    return "?";
}

std::vector<FarmImageStatus> farm_status(const fs::path& output, const TaskLister& list) {
    const std::vector<Submission> submissions = read_submissions(output);
    const TaskMap tasks = list_tasks(submissions, list);
    std::map<fs::path, std::pair<const Submission*, const SubmittedImage*>> last;
    for (const Submission& submission : submissions)
        for (const SubmittedImage& image : submission.images) last[image.output] = {&submission, &image};
    std::vector<FarmImageStatus> result;
    result.reserve(last.size());
    for (const auto& [path, image] : last) result.push_back(status_of(*image.first, *image.second, tasks));
    return result;
}

std::string last_lines(const fs::path& file, std::size_t count) {
    constexpr std::streamoff kMost = 4096;
    std::ifstream stream = open_regular_file(file);
    stream.seekg(0, std::ios::end);
    if (!stream) return {};
    const std::streamoff size = stream.tellg();
    const std::streamoff length = std::min(size, kMost);
    stream.seekg(size - length);
    std::string text(static_cast<std::size_t>(length), '\0');
    stream.read(text.data(), length);
    text.resize(static_cast<std::size_t>(stream.gcount()));
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::size_t begin = text.size();
    for (std::size_t i = 0; i < count && begin != std::string::npos; ++i)
        begin = begin == 0 ? std::string::npos : text.rfind('\n', begin - 1);
    return without_controls(begin == std::string::npos ? text : text.substr(begin + 1));
}

std::string to_json(std::span<const FarmImageStatus> images) {
    nlohmann::json list = nlohmann::json::array();
    std::map<FarmState, std::size_t> counts;
    for (const FarmImageStatus& status : images) {
        ++counts[status.state];
        nlohmann::json entry{{"name", status.image.name},
                             {"image", status.image.output.string()},
                             {"state", farm_state_name(status.state)},
                             {"tasks", status.image.tasks.size()},
                             {"tasks_done", status.tasks_done}};
        if (status.image.frame) entry["frame"] = *status.image.frame;
        if (!status.job.empty()) entry["job"] = status.job;
        if (!status.error.empty()) entry["error"] = status.error;
        if (!status.log.empty()) entry["log"] = status.log.string();
        list.push_back(std::move(entry));
    }
    nlohmann::json document{{"images", std::move(list)}};
    for (const FarmState state : kStates) document[farm_state_name(state)] = counts[state];
    return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace etendue
