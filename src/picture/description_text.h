// The description of an image as text, as checkpoints and parts keep it.
#pragma once

#include "picture/image_description.h"
#include "render/checkpoint.h"

#include <filesystem>
#include <string>

namespace etendue {

/// Returns `description` as text that `parse_description` understands.
[[nodiscard]] std::string to_text(const ImageDescription& description);

/// Reads the description in `text`, which stood in `file` with a film of the layers `layout`; throws IoError if `text`
/// is not what `to_text` writes, or not of such a film.
[[nodiscard]] ImageDescription parse_description(const std::string& text, const LayerLayout& layout,
                                                 const std::filesystem::path& file);

/// Reads the description in `kept`, a checkpoint or part that was read from `file`; throws IoError as
/// `parse_description`.
[[nodiscard]] ImageDescription description_of(const Checkpoint& kept, const std::filesystem::path& file);

}  // namespace etendue
