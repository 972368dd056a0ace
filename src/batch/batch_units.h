// The images that a batch is about: one for each scene, or for each of its frames, or variants, or frames of variants.
#pragma once

#include "batch/batch_options.h"
#include "session/image_job.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace etendue {

struct BatchTask {
    ImageJob job;
    std::filesystem::path render_output;  ///< path that `etendue render` is told to write: without the frame's number
    std::string id;                       ///< path of the image below the output directory, without its extension
};

/// The batch's own files in its directory `output`.
[[nodiscard]] std::vector<std::filesystem::path> batch_files(const std::filesystem::path& output);

/// Names of the variants that the scene directory or file `scene` offers.
using FindVariants = std::function<std::vector<std::string>(const std::filesystem::path& scene)>;

/// The tasks, those of one scene beside each other. `find_variants` is asked once for each scene if all variants are
/// wanted. Throws SceneError if two files of the images or the batch would have one name, and ReplacedInput if any of
/// them is an input of a scene.
[[nodiscard]] std::vector<BatchTask> collect_tasks(const BatchOptions& options, const FindVariants& find_variants);

}  // namespace etendue
