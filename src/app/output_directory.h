// The directory that a report is written into.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// Makes `directory` if it is missing, and returns its files of these names. Throws IoError if they could not be
/// written.
[[nodiscard]] std::vector<std::filesystem::path> prepare_directory(const std::filesystem::path& directory,
                                                                   const std::vector<std::string>& names);

}  // namespace etendue
