// Names of files in a scene's JSON, without loading the scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// Lists the names of files in `file`, a glTF file or settings, as the file system would spell them. The list is empty
/// if the file cannot be read or is no JSON; the files that it names need not exist.
[[nodiscard]] std::vector<std::string> named_files(const std::filesystem::path& file);

}  // namespace etendue
