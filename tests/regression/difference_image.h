// Pictures of what differs, for eyes.
#pragma once

#include "image/image.h"

#include <filesystem>
#include <string>

namespace etendue::test {

/// Writes `directory`/`name`.exr (the image), `name`.error.exr (image minus reference) and `name`.error.png: grey where
/// both agree, white and black where the image is 20% brighter or darker than the reference. Returns a sentence that
/// names them.
std::string write_difference(const std::filesystem::path& directory, const std::string& name, const ImageF& image,
                             const ImageF& reference);

}  // namespace etendue::test
