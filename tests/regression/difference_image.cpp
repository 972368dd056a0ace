#include "regression/difference_image.h"

#include "image/write.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace etendue::test {

std::string write_difference(const std::filesystem::path& directory, const std::string& name, const ImageF& image,
                             const ImageF& reference) {
    constexpr float kFullScale = 0.2f;
    constexpr float kBlack = 1e-3f;  // what differs by less than a share of this is no visible difference
    ImageF difference = image;
    ImageF picture = image;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        difference.pixels[i] = image.pixels[i] - reference.pixels[i];
        const float relative = difference.pixels[i] / (std::abs(reference.pixels[i]) + kBlack);
        picture.pixels[i] = 0.5f + 0.5f * std::clamp(relative / kFullScale, -1.0f, 1.0f);
    }
    const std::filesystem::path base = directory / name;
    const std::string image_path = base.string() + ".exr";
    const std::string error_path = base.string() + ".error.exr";
    const std::string picture_path = base.string() + ".error.png";
    write_image(image_path, image, {.depth = PixelDepth::Float});
    write_image(error_path, difference, {.depth = PixelDepth::Float});
    write_image(picture_path, picture, {.depth = PixelDepth::UInt8});
    return fmt::format("The render is {}, its difference from the reference {} and {}.", image_path, error_path,
                       picture_path);
}

}  // namespace etendue::test
