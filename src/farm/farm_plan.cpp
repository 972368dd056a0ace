#include "farm/farm_plan.h"

#include "farm/farm_commands.h"

#include <algorithm>
#include <bit>
#include <map>
#include <tuple>

#include <fmt/format.h>

namespace etendue {

namespace {

/// How the tasks of an image depend on each other.
enum class Shape { Whole, Split, Mended };

/// Returns the shape of an image's tasks: if some of its parts are there already, the others are mended.
Shape shape_of(const FarmImage& image) {
    if (image.ranges.empty()) return Shape::Whole;
    return image.missing.size() == image.ranges.size() ? Shape::Split : Shape::Mended;
}

/// Images of one group can share arrays. Needs are the same within a factor of two, so that a small scene does not wait
/// for the memory of a large one, and there are few groups however many images there are.
using Group = std::tuple<Shape, unsigned, unsigned, std::size_t>;

Group group_of(const FarmImage& image) {
    const Shape shape = shape_of(image);
    return {shape, std::bit_width(static_cast<unsigned>(image.needs.mebibytes)),
            std::bit_width(static_cast<unsigned>(image.needs.minutes)),
            shape == Shape::Split ? image.ranges.size() : 0};
}

class TaskPlanner {
  public:
    TaskPlanner(std::span<const FarmImage> images, const FarmOptions& options) : images_(images), options_(options) {
        plan_.places.resize(images.size());
    }

    /// Arrays for images of one group, few enough to fit.
    void add(Shape shape, std::span<const std::size_t> images) {
        if (shape == Shape::Whole) {
            const std::size_t array = add_array("render", needs_of(images));
            for (const std::size_t i : images)
                add_task(array, i, whole_image_command(images_[i], options_), images_[i].job.output);
        } else if (shape == Shape::Split) {
            std::vector<std::size_t> arrays;
            for (std::size_t r = 0; r < images_[images.front()].ranges.size(); ++r) {
                arrays.push_back(add_array("render", needs_of(images)));
                for (const std::size_t i : images) add_part(arrays.back(), i, images_[i].ranges[r]);
            }
            add_merges(images, ArrayWait::SameTask, std::move(arrays));
        } else {
            // A part that is missing then still is known to the merge, which says so.
            const bool has_parts = std::ranges::any_of(images, [&](auto i) { return !images_[i].missing.empty(); });
            if (!has_parts) return add_merges(images, ArrayWait::No, {});
            const std::size_t array = add_array("render", needs_of(images));
            for (const std::size_t i : images)
                for (const SampleRange& range : images_[i].missing) add_part(array, i, range);
            add_merges(images, ArrayWait::AllTasks, {array});
        }
    }

    [[nodiscard]] FarmPlan take() { return std::move(plan_); }

  private:
    std::size_t add_array(const char* kind, const TaskNeeds& needs) {
        const std::size_t array = plan_.arrays.size();
        plan_.arrays.push_back({fmt::format("{}-{}", kind, array), needs, {}, ArrayWait::No, {}});
        return array;
    }
    void add_task(std::size_t array, std::size_t image, std::string command, std::filesystem::path makes) {
        plan_.places[image].push_back({array, plan_.arrays[array].commands.size(), std::move(makes)});
        plan_.arrays[array].commands.push_back(std::move(command));
    }
    void add_part(std::size_t array, std::size_t image, const SampleRange& range) {
        const FarmImage& it = images_[image];
        add_task(array, image, part_command(it, range, options_),
                 part_file(parts_folder(options_.output, it.job.output), it.job, range));
    }
    void add_merges(std::span<const std::size_t> images, ArrayWait wait, std::vector<std::size_t> after) {
        const std::size_t array = add_array("merge", needs_of(images, &FarmImage::merge_needs));
        plan_.arrays[array].wait = wait;
        plan_.arrays[array].after = std::move(after);
        for (const std::size_t i : images)
            add_task(array, i, merge_command(images_[i], options_), images_[i].job.output);
    }
    /// Returns needs that are enough for all of these images.
    [[nodiscard]] TaskNeeds needs_of(std::span<const std::size_t> images,
                                     TaskNeeds FarmImage::*of = &FarmImage::needs) const {
        TaskNeeds needs;
        for (const std::size_t i : images) {
            needs.minutes = std::max(needs.minutes, (images_[i].*of).minutes);
            needs.mebibytes = std::max(needs.mebibytes, (images_[i].*of).mebibytes);
            needs.warning_seconds = std::max(needs.warning_seconds, (images_[i].*of).warning_seconds);
        }
        return needs;
    }

    std::span<const FarmImage> images_;
    const FarmOptions& options_;
    FarmPlan plan_;
};

/// Tasks of one array that an image adds at most.
std::size_t tasks_in_one_array(const FarmImage& image) {
    return shape_of(image) == Shape::Mended ? std::max<std::size_t>(1, image.missing.size()) : 1;
}

}  // namespace

FarmPlan plan_farm(std::span<const FarmImage> images, const FarmOptions& options, std::size_t max_array_size) {
    std::map<Group, std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < images.size(); ++i) groups[group_of(images[i])].push_back(i);
    TaskPlanner planner(images, options);
    for (const auto& [group, members] : groups) {
        const std::span<const std::size_t> all(members);
        for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
            // One image at least: of an image, no more parts are missing than it has.
            std::size_t tasks = 0;
            do tasks += tasks_in_one_array(images[all[end++]]);
            while (end < all.size() && tasks + tasks_in_one_array(images[all[end]]) <= max_array_size);
            planner.add(std::get<Shape>(group), all.subspan(begin, end - begin));
        }
    }
    return planner.take();
}

std::filesystem::path parts_folder(const std::filesystem::path& output, const std::filesystem::path& image) {
    return output / ".etendue" / "parts" / image.lexically_relative(output);
}

std::filesystem::path part_file(const std::filesystem::path& folder, const ImageJob& job, const SampleRange& range) {
    const std::filesystem::path file = folder / fmt::format("{}-{}.partial", range.begin, range.end);
    return job.frame ? frame_path(file, *job.frame) : file;
}

}  // namespace etendue
