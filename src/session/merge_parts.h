// Adding up the parts of an image.
#pragma once

#include "render/checkpoint.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace etendue {

/// Parts added up.
struct MergedParts {
    Checkpoint sum;
    /// Number of samples from `sum.state.first_sample` on to the last that any pixel has: more than
    /// `sum.state.spp_done` if there are gaps.
    std::uint32_t spp_span = 0;
    bool has_one_window = true;  ///< all parts have the same pixels
};

/// The sum of the parts in `files`, of which there is at least one: of their smallest common window, with as many
/// samples per pixel as all that share a pixel have together. `note` is told what is odd but no error: a gap
/// between ranges of samples, or windows that do not have the same ones. Throws SceneError, naming the files, if parts
/// belong to different renders, have samples in common, have windows that overlap without being equal, are not
/// finished, or leave pixels with fewer samples than others; IoError if one cannot be read. Holds one part at a time
/// beside the sum.
[[nodiscard]] MergedParts merge_parts(std::span<const std::filesystem::path> files,
                                      const std::function<void(const std::string&)>& note);

}  // namespace etendue
