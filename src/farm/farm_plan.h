// What a farm has to do: the tasks that images consist of, put together to job arrays.
//
// An image in one piece is one task. An image that is split is one task for each range of its samples and one that
// merges their parts. Task i of each array belongs to the same image where it can, so that a scheduler can begin to
// merge an image as soon as its own parts are there, and the number of arrays does not grow with that of images.
#pragma once

#include "picture/sample_ranges.h"
#include "session/given_options.h"
#include "session/image_job.h"

#include <compare>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Seconds that a task has at least to write its checkpoint, from when it is told that its time is up soon.
inline constexpr int kLeastWarningSeconds = 60;

/// Holds what a task may use at most; the scheduler ends tasks that use more.
struct TaskNeeds {
    int minutes = 0;
    int mebibytes = 0;
    int warning_seconds = kLeastWarningSeconds;  ///< seconds to write its checkpoint, where so much time is left

    friend auto operator<=>(const TaskNeeds&, const TaskNeeds&) = default;
};

/// An image that is to be made. All paths are absolute.
struct FarmImage {
    ImageJob job;
    std::filesystem::path render_output;  ///< path that `etendue render` is told to write: without the frame's number
    std::vector<SampleRange> ranges;      ///< ranges of its parts, two at least; empty if it is rendered in one piece
    std::vector<SampleRange> missing;     ///< ranges of the parts that are not there yet
    TaskNeeds needs;                      ///< needs of each of its tasks that render
    TaskNeeds merge_needs{};              ///< needs of the task that merges its parts
    std::string texture_memory{};         ///< --texture-memory of its renders; empty if the scene or the options say
};

struct FarmOptions {
    std::filesystem::path program;     ///< etendue, as the nodes find it
    std::filesystem::path output;      ///< the directory of all images
    std::vector<GivenOption> options;  ///< options of each render
    double checkpoint_minutes = 5.0;
    int threads = 4;  ///< threads of each task
    PixelDepth depth = PixelDepth::Half;
};

/// Says what an array waits for before its tasks begin.
enum class ArrayWait {
    No,
    SameTask,  ///< each task for those of the same index in other arrays to succeed
    AllTasks,  ///< for all tasks of other arrays to end, however they do
};

struct JobArray {
    std::string name;
    TaskNeeds needs;
    std::vector<std::string> commands;  ///< a line of a shell for each task
    ArrayWait wait = ArrayWait::No;
    std::vector<std::size_t> after;  ///< the arrays that it waits for
};

/// Where a task is, and the file that it makes.
struct TaskPlace {
    std::size_t array = 0;
    std::size_t index = 0;
    std::filesystem::path makes;
};

struct FarmPlan {
    std::vector<JobArray> arrays;
    std::vector<std::vector<TaskPlace>> places;  ///< places of the tasks of each image, the one that makes it last
};

/// Plans the tasks that make `images`, with `max_array_size` tasks in an array at most.
[[nodiscard]] FarmPlan plan_farm(std::span<const FarmImage> images, const FarmOptions& options,
                                 std::size_t max_array_size);

/// The folder of the parts of the image `image` below the output directory `output`.
[[nodiscard]] std::filesystem::path parts_folder(const std::filesystem::path& output,
                                                 const std::filesystem::path& image);

/// The part of the samples `range` of the image in such a folder.
[[nodiscard]] std::filesystem::path part_file(const std::filesystem::path& folder, const ImageJob& job,
                                              const SampleRange& range);

}  // namespace etendue
