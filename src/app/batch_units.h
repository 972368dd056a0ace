// The images that a batch is about: one for each scene, or for each of its frames, or variants, or frames of variants.
#pragma once

#include "app/batch_options.h"
#include "app/image_job.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace etendue {

struct BatchTask {
    ImageJob job;
    std::filesystem::path render_output;  ///< what `etendue render` is told to write: without the frame's number
    std::string id;                       ///< path of the image below the output directory, without its extension
};

/// Names of the variants that the scene directory or file `scene` offers.
using FindVariants = std::function<std::vector<std::string>(const std::filesystem::path& scene)>;

/// The tasks, those of one scene beside each other. `find_variants` is asked once for each scene if all variants are
/// wanted. Throws SceneError if two images, or an image and a file of the batch, would have one name.
[[nodiscard]] std::vector<BatchTask> collect_tasks(const BatchOptions& options, const FindVariants& find_variants);

}  // namespace etendue
