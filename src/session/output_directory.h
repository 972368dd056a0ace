// The directories that files are written into.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Makes the directory of `file` if it is missing; whether that failed, `require_writable` says.
void make_directory_of(const std::filesystem::path& file);

/// Makes `directory`, which --output names, and those below that are in `names`, and returns its files of these names.
/// Throws IoError if they could not be written, ReplacedInput if one of them is one of `inputs`.
[[nodiscard]] std::vector<std::filesystem::path> prepare_directory(const std::filesystem::path& directory,
                                                                   const std::vector<std::string>& names,
                                                                   std::span<const std::filesystem::path> inputs);

}  // namespace etendue
