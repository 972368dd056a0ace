#include "farm/slurm_farm.h"

#include "core/error.h"
#include "farm/slurm.h"
#include "session/interrupt.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

namespace etendue {

namespace fs = std::filesystem;

namespace {

/// Name of the user who submits, as Slurm knows it.
std::string user_name() {
    const passwd* const entry = ::getpwuid(::geteuid());
    return entry == nullptr ? fmt::format("{}", ::geteuid()) : entry->pw_name;
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw IoError(fmt::format("cannot make the directory {}: {}", folder.string(), error.message()));
}

/// Returns for each array whether another one waits for it.
std::vector<bool> waited_for(const FarmPlan& plan) {
    std::vector<bool> result(plan.arrays.size(), false);
    for (const JobArray& array : plan.arrays)
        for (const std::size_t other : array.after) result[other] = true;
    return result;
}

}  // namespace

SlurmFarm make_slurm_farm(const FarmWork& work, FarmPlan plan, SlurmOptions options, const fs::path& directory) {
    SlurmFarm farm{std::move(plan), {directory, user_name(), {}}, std::move(options)};
    std::vector<SubmittedImage>& images = farm.submission.images;
    for (std::size_t i = 0; i < work.images.size(); ++i) {
        const ImageJob& job = work.images[i].job;
        SubmittedImage image{job.name, job.scene, job.output, job.frame, {}, {}};
        for (const TaskPlace& place : farm.plan.places[i])
            image.tasks.push_back({farm.plan.arrays[place.array].name, place.index, place.makes});
        images.push_back(std::move(image));
    }
    for (const ImageJob& job : work.up_to_date) images.push_back({job.name, job.scene, job.output, job.frame, {}, {}});
    images.insert(images.end(), work.failed.begin(), work.failed.end());
    return farm;
}

std::vector<std::string> submit_command(const SlurmFarm& farm, std::size_t array,
                                        const std::vector<std::string>& jobs) {
    const JobArray& it = farm.plan.arrays[array];
    std::string dependency;
    if (it.wait != ArrayWait::No) {
        dependency = it.wait == ArrayWait::SameTask ? "aftercorr" : "afterany";
        for (const std::size_t other : it.after) dependency += ":" + jobs[other];
    }
    const fs::path& directory = farm.submission.directory;
    return sbatch_command(directory / (it.name + ".sh"), directory, dependency);
}

std::vector<std::string> submit(const SlurmFarm& farm, const std::function<void()>& on_kept) {
    for (const SubmittedImage& image : farm.submission.images)
        for (const SubmittedTask& task : image.tasks) make_folder(task.makes.parent_path());
    write_submission(farm.submission, farm.plan, farm.options);
    std::vector<std::string> jobs;
    const std::vector<bool> is_waited_for = waited_for(farm.plan);
    std::size_t kept = 0;
    for (std::size_t array = 0; array < farm.plan.arrays.size(); ++array) {
        try {
            if (interrupt_requested()) throw IoError("interrupted");
            jobs.push_back(slurm_submit(submit_command(farm, array, jobs)));
            record_job(farm.submission, jobs.back());
        } catch (const IoError& error) {
            slurm_cancel(std::span(jobs).subspan(std::min(kept, jobs.size())));
            throw IoError(fmt::format("{}\n{} of {} job arrays were submitted; 'etendue submit' again submits the rest",
                                      error.what(), kept, farm.plan.arrays.size()));
        }
        // An array of parts is of no use without its merge, which comes right behind all that it waits for.
        if (is_waited_for[array]) continue;
        kept = array + 1;
        on_kept();
    }
    return jobs;
}

}  // namespace etendue
