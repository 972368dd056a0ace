#include "farm/submission.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/write_file.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <random>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>

namespace etendue {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::string_view kDirectoryPrefix = "submit-";

/// Paths in the output directory are kept relative to it: it may be mounted elsewhere.
fs::path output_of(const Submission& submission) {
    return submission.directory.parent_path().parent_path();
}

json to_json(const SubmittedImage& image, const fs::path& output) {
    json tasks = json::array();
    for (const SubmittedTask& task : image.tasks)
        tasks.push_back(
            {{"array", task.array}, {"index", task.index}, {"makes", task.makes.lexically_relative(output).string()}});
    json entry{{"name", image.name},
               {"scene", image.scene.string()},
               {"image", image.output.lexically_relative(output).string()},
               {"tasks", std::move(tasks)}};
    if (image.frame) entry["frame"] = *image.frame;
    if (!image.error.empty()) entry["error"] = image.error;
    return entry;
}

SubmittedImage image_of(const json& entry, const fs::path& output) {
    SubmittedImage image;
    image.name = entry.at("name").get<std::string>();
    image.scene = entry.at("scene").get<std::string>();
    image.output = output / entry.at("image").get<std::string>();
    if (entry.contains("frame")) image.frame = entry.at("frame").get<int>();
    if (entry.contains("error")) image.error = entry.at("error").get<std::string>();
    for (const json& task : entry.at("tasks"))
        image.tasks.push_back({task.at("array").get<std::string>(), task.at("index").get<std::size_t>(),
                               output / task.at("makes").get<std::string>()});
    return image;
}

Submission read_submission(const fs::path& directory) {
    Submission submission{directory, {}, {}};
    std::ifstream stream = open_regular_file(submission.file());
    try {
        const json document = json::parse(stream);
        submission.user = document.at("user").get<std::string>();
        for (const json& entry : document.at("images"))
            submission.images.push_back(image_of(entry, output_of(submission)));
    } catch (const json::exception& error) {
        throw IoError(fmt::format("{} cannot be read: {}; if it is not needed any more, remove its directory",
                                  submission.file().string(), error.what()));
    }
    return submission;
}

}  // namespace

std::string Submission::job_prefix() const {
    return "etendue-" + directory.filename().string().substr(kDirectoryPrefix.size());
}

fs::path farm_directory(const fs::path& output) {
    return output / ".etendue";
}

FileDescriptor lock_submissions(const fs::path& output) {
    const fs::path file = farm_directory(output) / "submitting";
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    require_no_pipe(file);
    FileDescriptor opened(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
    if (!opened.is_open())
        throw IoError(fmt::format("cannot write {}: {}", file.string(), std::generic_category().message(errno)));
    if (::flock(opened.get(), LOCK_EX | LOCK_NB) == 0) return opened;
    if (errno != EWOULDBLOCK)
        throw IoError(fmt::format("cannot lock {}: {}", file.string(), std::generic_category().message(errno)));
    throw IoError(
        fmt::format("another 'etendue submit' is submitting to {} now: run this command again when the other one "
                    "has ended",
                    output.string()));
}

fs::path make_submission_directory(const fs::path& output) {
    const fs::path parent = farm_directory(output);
    std::error_code error;
    fs::create_directories(parent, error);
    const auto now = std::chrono::system_clock::now();
    const auto milliseconds = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch()).count();
    // Names sort in the order of time: unlike local time, universal time is never set back.
    const std::string name = fmt::format("{}{:%Y%m%d-%H%M%S}{:03}", kDirectoryPrefix,
                                         fmt::gmtime(std::chrono::system_clock::to_time_t(now)), milliseconds % 1000);
    // The jobs of different output directories have different names, too.
    std::random_device random;
    while (!error) {
        fs::path directory = parent / fmt::format("{}-{:06x}", name, random() & 0xffffffu);
        if (fs::create_directory(directory, error)) return directory;
    }
    throw IoError(fmt::format("cannot make a directory in {}: {}", parent.string(), error.message()));
}

void write_submission(const Submission& submission, const FarmPlan& plan, const SlurmOptions& options) {
    const fs::path output = output_of(submission);
    std::error_code error;
    fs::create_directory(submission.directory / "logs", error);
    if (error) throw IoError(fmt::format("cannot make {}/logs: {}", submission.directory.string(), error.message()));
    for (const JobArray& array : plan.arrays) {
        std::string lines;
        for (const std::string& command : array.commands) lines += command + "\n";
        write_text(submission.directory / tasks_file_name(array.name), lines);
        write_text(submission.directory / (array.name + ".sh"),
                   slurm_script(array, submission.job_name(array.name), options));
    }
    json images = json::array();
    for (const SubmittedImage& image : submission.images) images.push_back(to_json(image, output));
    const json document{{"scheduler", "slurm"}, {"user", submission.user}, {"images", std::move(images)}};
    write_text(submission.file(), document.dump(1) + "\n");
}

void record_job(const Submission& submission, const std::string& job) {
    const fs::path file = submission.directory / "jobs";
    std::ofstream stream(file, std::ios::app);
    stream << job << "\n";
    if (!stream.flush()) throw IoError(fmt::format("cannot write {}", file.string()));
}

std::vector<Submission> read_submissions(const fs::path& output) {
    std::vector<fs::path> directories;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(farm_directory(output), none))
        // Without the file, whoever wrote it did not come as far as submitting anything.
        if (entry.path().filename().string().starts_with(kDirectoryPrefix) &&
            fs::exists(entry.path() / "submission.json"))
            directories.push_back(entry.path());
    std::ranges::sort(directories);
    std::vector<Submission> submissions;
    submissions.reserve(directories.size());
    for (const fs::path& directory : directories) submissions.push_back(read_submission(directory));
    return submissions;
}

void remove_superseded(std::span<const Submission> earlier, const Submission& last) {
    std::set<fs::path> images;
    for (const SubmittedImage& image : last.images) images.insert(image.output);
    for (const Submission& submission : earlier) {
        const bool superseded = std::ranges::all_of(
            submission.images, [&](const SubmittedImage& image) { return images.contains(image.output); });
        std::error_code ignored;
        if (superseded) fs::remove_all(submission.directory, ignored);
    }
}

bool can_be_recorded(const std::string& text) {
    try {
        (void)json(text).dump();
        return true;
    } catch (const json::type_error&) {
        return false;
    }
}

}  // namespace etendue
