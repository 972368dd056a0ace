#include "compare/image_pair.h"

#include "core/error.h"
#include "core/pixel_rect_text.h"
#include "image/read.h"
#include "metrics/not_finite.h"
#include "session/file_color_space.h"
#include "texture/srgb.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

namespace fs = std::filesystem;

ImageInfo read_info(const fs::path& path) {
    try {
        return read_image_info(path);
    } catch (const IoError& error) {
        throw SceneError({path.string(), ""}, error.what());
    }
}

ImageF read_pixels(const fs::path& path) {
    try {
        return read_image_float(path);
    } catch (const IoError& error) {
        throw SceneError({path.string(), ""}, error.what());
    }
}

ComparedFile describe_file(const fs::path& path, const ImageInfo& info, const ColorConfig& colors) {
    if (info.decoded_channels < 3)
        throw SceneError({path.string(), ""}, fmt::format("it has {} channel{} where R, G and B are compared",
                                                          info.channels, info.channels == 1 ? "" : "s"));
    return {path, info.format, info.channels,
            // Counted from the full image's first pixel, which is not (0, 0) in every EXR.
            moved_to(info.data_window, info.data_window.x0 - info.display_window.x0,
                     info.data_window.y0 - info.display_window.y0),
            moved_to(info.display_window, 0, 0), space_of_file(info, colors)};
}

void require_same_kind(const ComparedFile& a, bool a_is_float, const ComparedFile& b, bool b_is_float) {
    if (a_is_float == b_is_float) return;
    const auto kind = [](bool is_float) { return is_float ? "scene-linear floats" : "integers encoded for a display"; };
    throw SceneError({a.path.string(), ""},
                     fmt::format("it holds {} and '{}' holds {}; compare two EXRs, or two PNGs made with the same view "
                                 "and exposure",
                                 kind(a_is_float), b.path.string(), kind(b_is_float)));
}

void require_same_display(const ComparedFile& a, const ComparedFile& b) {
    if (a.display == b.display) return;
    throw SceneError({a.path.string(), ""},
                     fmt::format("it is {} pixels large and '{}' is {}; render both in one size",
                                 size_text_of(a.display), b.path.string(), size_text_of(b.display)));
}

std::string assumed_space(const fs::path& path, const std::string& space, const std::string& like) {
    return fmt::format("'{}' does not say its colour space; it is taken to be in '{}' as {} is", path.string(), space,
                       like);
}

/// The space of both, with a word about what was assumed.
std::string common_space(const ComparedFile& a, const ComparedFile& b, bool is_encoded,
                         std::vector<std::string>& warnings) {
    if (a.color_space == b.color_space) {
        if (a.color_space.empty() && !is_encoded)
            warnings.emplace_back("neither file says its colour space; they are taken to be in the same one");
        return a.color_space;
    }
    const bool one_is_unknown = a.color_space.empty() || b.color_space.empty();
    if (!one_is_unknown)
        throw SceneError({a.path.string(), ""},
                         fmt::format("it is in the colour space '{}' and '{}' is in '{}'; render both with the same "
                                     "--working-space, or convert one of them (oiiotool --colorconvert)",
                                     a.color_space, b.path.string(), b.color_space));
    const ComparedFile& known = a.color_space.empty() ? b : a;
    const ComparedFile& unknown = a.color_space.empty() ? a : b;
    warnings.push_back(assumed_space(unknown.path, known.color_space, fmt::format("'{}'", known.path.string())));
    return known.color_space;
}

/// R, G and B of the pixels in `window`.
ImageF rgb_in(const ImageF& image, const PixelRect& data, const PixelRect& window) {
    if (image.width != data.width() || image.height != data.height() || image.channels < 3)
        throw IoError("an image changed while it was read");
    ImageF rgb(window.width(), window.height(), 3);
    for (int y = 0; y < rgb.height; ++y)
        for (int x = 0; x < rgb.width; ++x)
            std::ranges::copy(image.pixel(x + window.x0 - data.x0, y + window.y0 - data.y0).first(3),
                              rgb.pixel(x, y).begin());
    return rgb;
}

}  // namespace

ImagePair read_image_pair(const fs::path& image, const fs::path& reference, const ColorConfig& colors) {
    const ImageInfo image_info = read_info(image);
    const ImageInfo reference_info = read_info(reference);
    ImagePair pair;
    pair.image_file = describe_file(image, image_info, colors);
    pair.reference_file = describe_file(reference, reference_info, colors);
    const ComparedFile& a = pair.image_file;
    const ComparedFile& b = pair.reference_file;
    require_same_kind(a, image_info.is_float, b, reference_info.is_float);
    require_same_display(a, b);
    pair.is_encoded = !image_info.is_float;
    pair.color_space = common_space(a, b, pair.is_encoded, pair.warnings);
    if (pair.is_encoded && !pair.color_space.empty() && !pair.color_space.starts_with("sRGB"))
        pair.warnings.push_back(
            fmt::format("the files are in '{}'; FLIP takes integers to be encoded as sRGB", pair.color_space));

    pair.window = intersection(intersection(a.data, b.data), a.display);
    if (pair.window.empty())
        throw SceneError({image.string(), ""},
                         fmt::format("it has no pixel in common with '{}': crop windows {},{},{},{} and {},{},{},{}",
                                     reference.string(), a.data.x0, a.data.y0, a.data.x1, a.data.y1, b.data.x0,
                                     b.data.y0, b.data.x1, b.data.y1));
    pair.image = rgb_in(read_pixels(image), a.data, pair.window);
    pair.reference = rgb_in(read_pixels(reference), b.data, pair.window);
    return pair;
}

SceneLinearImage read_scene_linear(const fs::path& path, int full_width, int full_height, const PixelRect& window,
                                   const std::string& working_space, const ColorConfig& colors) {
    const ImageInfo info = read_info(path);
    const ComparedFile file = describe_file(path, info, colors);
    const SourceLocation where{path.string(), ""};
    if (!info.is_float) throw SceneError(where, "it holds integers encoded for a display; give an EXR or HDR file");
    if (file.display != PixelRect{0, 0, full_width, full_height})
        throw SceneError(where, fmt::format("it is {} pixels large, the scene is rendered at {}x{}",
                                            size_text_of(file.display), full_width, full_height));
    if (intersection(file.data, window) != window)
        throw SceneError(
            where, fmt::format("it has the pixels {},{},{},{} only, not all of {},{},{},{}", file.data.x0, file.data.y0,
                               file.data.x1, file.data.y1, window.x0, window.y0, window.x1, window.y1));
    SceneLinearImage image{.pixels = rgb_in(read_pixels(path), file.data, window), .warnings = {}};
    if (file.color_space.empty()) {
        image.warnings.push_back(assumed_space(path, working_space, "the render"));
    } else if (file.color_space != working_space) {
        const std::optional<ColorMatrix> matrix = find_matrix(file.color_space, working_space, colors);
        if (!matrix)
            throw SceneError(where, fmt::format("it is in '{}', which is no linear space of the OpenColorIO config",
                                                file.color_space));
        apply_matrix(image.pixels, *matrix);
        image.is_converted = true;
    }
    if (const NotFinite faults = find_not_finite(image.pixels); faults.count() > 0)
        throw SceneError(
            where, fmt::format("{} of its pixels are NaN or infinite, the first is ({}, {}); nothing can be "
                               "measured against them: render it anew, or give a --crop without them",
                               faults.count(), faults.first.front().x + window.x0, faults.first.front().y + window.y0));
    return image;
}

ImageF to_linear_rec709(const ImageF& image, bool is_encoded, const std::string& color_space,
                        const ColorConfig& colors) {
    ImageF linear = image;
    if (is_encoded) {
        for (float& value : linear.pixels) value = linear_from_srgb(value);
    } else if (!color_space.empty()) {
        if (const auto matrix = find_matrix(color_space, kGltfColorSpace, colors)) apply_matrix(linear, *matrix);
    }
    return linear;
}

}  // namespace etendue
