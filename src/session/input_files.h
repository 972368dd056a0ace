// The files that a scene was read from, as they were: whether they are still what an image was made of.
#pragma once

#include "output/statistics.h"
#include "scene/scene_desc.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Throws ReplacedInput if one of `outputs`, which `option` asks for, is one of `inputs`, of the OpenColorIO config in
/// use or of its tables. For commands that read no scene, whose inputs hold these.
void require_files_kept(std::string_view option, std::span<const std::filesystem::path> outputs,
                        std::vector<std::filesystem::path> inputs);

/// Returns name, size and time of each input of `scene`, without content. An input that has changed since `started`,
/// when the first input was read, has the time InputFile::kChanged: nobody knows which of its content was read.
[[nodiscard]] std::vector<InputFile> stamp_inputs(const SceneDesc& scene, std::filesystem::file_time_type started);

/// Fills in the content of `files`, the stamps of the inputs of `scene`. A file that has changed since its stamp gets
/// the time InputFile::kChanged. Throws IoError if a file cannot be read.
void hash_inputs(const SceneDesc& scene, std::span<InputFile> files);

/// Returns the path of `input` from `directory`, which is the same wherever `directory` lies and however it is named,
/// or, for an `input` that lies elsewhere, the whole path.
[[nodiscard]] std::string input_name(const std::filesystem::path& input, const std::filesystem::path& directory);

/// Returns what is different about `file`, which was an input of a scene in `directory`: "input sky.exr has changed",
/// or that `file` is missing; none if `file` has the same size and time, or else the same content.
[[nodiscard]] std::optional<std::string> what_changed(const InputFile& file, const std::filesystem::path& directory);

}  // namespace etendue
