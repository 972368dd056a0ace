// Names of files in a scene's JSON, without loading the scene.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// What `file`, a glTF file or settings, names where names of files stand, as the file system would spell it. Empty if
/// the file cannot be read or is no JSON; nothing says that the names are of files that exist.
[[nodiscard]] std::vector<std::string> named_files(const std::filesystem::path& file);

}  // namespace etendue
