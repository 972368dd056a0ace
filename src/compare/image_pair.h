// Two image files that are to be compared: read, and made sure that comparing them means something.
#pragma once

#include "color/color_config.h"
#include "core/pixel_rect.h"
#include "image/image.h"

#include <filesystem>
#include <string>
#include <vector>

namespace etendue {

/// Holds what is said about one of the compared files.
struct ComparedFile {
    std::filesystem::path path;
    std::string format;  ///< "openexr", "png", …
    int channels = 0;    ///< in the file
    PixelRect data;      ///< where its pixels lie
    PixelRect display;   ///< the image that they are a part of
    /// The config's name of its colour space if the config has it, else the file's; empty if the file does not say.
    std::string color_space;
};

/// Holds two images that can be compared: each has 3 channels, R, G and B, and the size of `window`.
struct ImagePair {
    ComparedFile image_file;
    ComparedFile reference_file;
    ImageF image;
    ImageF reference;
    /// The pixels that both files have, in the coordinates of the full image, whose first pixel is (0, 0).
    PixelRect window;
    /// True for integers (PNG, JPEG, …): values are as they stand in the file, in [0, 1] and encoded for a display.
    /// False for floats (EXR, HDR): scene-linear.
    bool is_encoded = false;
    std::string color_space;            ///< colour space of both images; empty if neither file says it
    std::vector<std::string> warnings;  ///< assumptions, one sentence each
};

/// Reads both. The files must have RGB or RGBA channels (alpha is not compared), full images of the same size, pixels
/// in common, the same kind of values (integers or floats), and must not say that they are in different colour spaces.
/// Throws SceneError that says what is wrong, where, and what to do.
[[nodiscard]] ImagePair read_image_pair(const std::filesystem::path& image, const std::filesystem::path& reference,
                                        const ColorConfig& colors);

/// R, G and B of a part of a file.
struct SceneLinearImage {
    ImageF pixels;
    std::vector<std::string> warnings;  ///< assumptions, one sentence each
    bool is_converted = false;          ///< the file is in another colour space
};

/// R, G and B of the pixels `window` of the scene-linear file `path`, whose whole image has `full_width` times
/// `full_height` pixels, converted from its colour space to `working_space`; one that says no space is taken to be in
/// that, with a warning. Throws SceneError if it is of another size or kind, lacks pixels of the window, has some that
/// are not finite, or is in an unknown space.
[[nodiscard]] SceneLinearImage read_scene_linear(const std::filesystem::path& path, int full_width, int full_height,
                                                 const PixelRect& window, const std::string& working_space,
                                                 const ColorConfig& colors);

/// `image`, of a pair with these properties, as FLIP wants it: linear Rec.709. Integers are decoded from sRGB; floats
/// are converted from `color_space`, or taken to be linear Rec.709 already if that is empty or the config does not
/// know it.
[[nodiscard]] ImageF to_linear_rec709(const ImageF& image, bool is_encoded, const std::string& color_space,
                                      const ColorConfig& colors);

}  // namespace etendue
