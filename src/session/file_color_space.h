// The colour space that an image file is in.
#pragma once

#include "color/color_config.h"
#include "image/read.h"

#include <optional>
#include <string>

namespace etendue {

/// The config's name of the space that the file says it is in, if the config has it: by acesImageContainerFlag, by
/// oiio:ColorSpace, or by chromaticities. Else the file's own words; empty if the file does not say.
[[nodiscard]] std::string space_of_file(const ImageInfo& info, const ColorConfig& colors);

/// How the colours of a file come to a space of the config.
struct FileColors {
    std::string space;                    ///< a space of the config
    std::optional<ColorMatrix> to_space;  ///< if the file is in primaries that no space of the config has
    std::string assumed;                  ///< one sentence, if the file does not say what it is in
};

/// By `told` if that is not empty, else by what the file says, else linear Rec.709, which OpenEXR names for files that
/// do not say. Throws SceneError that blames `file` if the config does not know the space.
[[nodiscard]] FileColors colors_of_file(const ImageInfo& info, const std::string& told, const std::string& file,
                                        const ColorConfig& colors);

/// Returns the matrix from one space to another; none if the config lacks one of them, or one is not linear.
[[nodiscard]] std::optional<ColorMatrix> find_matrix(const std::string& from, const std::string& to,
                                                     const ColorConfig& colors);

/// Applies `matrix` to the first three channels of `image`.
void apply_matrix(ImageF& image, const ColorMatrix& matrix);

}  // namespace etendue
