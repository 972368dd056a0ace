// Whether an image must be rendered again.
#pragma once

#include "app/output_paths.h"

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// True if all three files of `output` exist, are newer than every file in `inputs`, and were completed with the
/// settings whose hash is `hash`.
[[nodiscard]] bool is_up_to_date(const OutputPaths& output, const std::vector<std::filesystem::path>& inputs,
                                 const std::string& hash);

}  // namespace etendue
