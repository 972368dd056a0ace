// Adding up the parts of an image.
#pragma once

#include "render/checkpoint.h"

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace etendue {

/// The sum of the parts in `files`, of which there is at least one: of their smallest common window, with as many
/// samples per pixel as all that share a pixel have together. `note` is told what is odd but no error, such as a gap
/// between ranges of samples. Throws SceneError, naming the files, if parts belong to different renders, have samples
/// in common, have windows that overlap without being equal, are not finished, or leave pixels with fewer samples than
/// others; IoError if one cannot be read. Holds one part at a time beside the sum.
[[nodiscard]] Checkpoint merge_parts(std::span<const std::filesystem::path> files,
                                     const std::function<void(const std::string&)>& note);

}  // namespace etendue
