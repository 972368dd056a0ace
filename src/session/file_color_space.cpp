#include "session/file_color_space.h"

#include "color/primaries.h"
#include "core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Chromaticities of the same space differ by rounding only.
constexpr float kChromaticityTolerance = 1e-3f;

bool are_close(const std::array<float, 8>& file, const Chromaticities& space) {
    return std::ranges::equal(file, numbers_of(space),
                              [](float a, float b) { return std::abs(a - b) <= kChromaticityTolerance; });
}

std::optional<Chromaticities> chromaticities_of(const std::string& space, const ColorConfig& colors) {
    try {
        return colors.chromaticities(space);
    } catch (const SceneError&) {
        return std::nullopt;  // it is not linear
    }
}

/// The config's linear space with these primaries and white, if it has one.
std::string space_with(const std::array<float, 8>& chromaticities, const ColorConfig& colors) {
    for (const std::string& space : colors.spaces())
        if (const auto known = chromaticities_of(space, colors); known && are_close(chromaticities, *known))
            return space;
    return "";
}

/// Returns true if `name` is empty or what the image library, and files that know no better, call floats that are
/// linear in some primaries.
bool says_nothing(std::string_view name) {
    return name.empty() || name == "Linear" || name == "linear" || name == "scene_linear";
}

}  // namespace

std::string space_of_file(const ImageInfo& info, const ColorConfig& colors) {
    if (info.is_aces_container && !colors.aces_space().empty()) return colors.aces_space();
    if (!says_nothing(info.color_space)) {
        try {
            return colors.resolve_space(info.color_space);
        } catch (const SceneError&) {
            return info.color_space;
        }
    }
    if (!info.chromaticities) return "";
    if (std::string space = space_with(*info.chromaticities, colors); !space.empty()) return space;
    return fmt::format("linear with the chromaticities {:.4g}", fmt::join(*info.chromaticities, " "));
}

namespace {

/// From linear RGB with these primaries and white to AP0. Throws SceneError if they span no space.
ColorMatrix matrix_to_ap0(const std::array<float, 8>& c, const std::string& file) {
    const Matrix3d matrix = rgb_to_rgb({{c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}}, kAp0);
    ColorMatrix result;
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        result.m[i] = static_cast<float>(matrix[i]);
        if (!std::isfinite(result.m[i]))
            throw SceneError({file, {}},
                             fmt::format("its chromaticities {:.4g} are no primaries; name its colour space "
                                         "with --input-space",
                                         fmt::join(c, " ")));
    }
    return result;
}

bool has_space(const std::string& name, const ColorConfig& colors) {
    try {
        (void)colors.resolve_space(name);
        return true;
    } catch (const SceneError&) {
        return false;
    }
}

}  // namespace

FileColors colors_of_file(const ImageInfo& info, const std::string& told, const std::string& file,
                          const ColorConfig& colors) {
    if (!told.empty()) return {colors.resolve_space(told), {}, {}};
    const std::string said = space_of_file(info, colors);
    if (said.empty())
        return {colors.resolve_space(kGltfColorSpace),
                {},
                fmt::format("'{}' does not say its colour space; it is taken to be in '{}' (--input-space)", file,
                            kGltfColorSpace)};
    if (has_space(said, colors)) return {said, {}, {}};
    // Of a space with a name the chromaticities do not say whether it is linear.
    if (says_nothing(info.color_space) && info.chromaticities && !colors.aces_space().empty())
        return {colors.aces_space(), matrix_to_ap0(*info.chromaticities, file), {}};
    throw SceneError({file, {}}, fmt::format("it is in the colour space '{}', which the OpenColorIO config {} does not "
                                             "have; name one that it has with --input-space",
                                             said, colors.origin()));
}

std::optional<ColorMatrix> find_matrix(const std::string& from, const std::string& to, const ColorConfig& colors) {
    try {
        return colors.matrix(from, to);
    } catch (const SceneError&) {
        return std::nullopt;
    }
}

void apply_matrix(ImageF& image, const ColorMatrix& matrix) {
    const auto channels = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i + 2 < image.pixels.size(); i += channels) {
        const Rgb c = matrix({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
        image.pixels[i] = c.r;
        image.pixels[i + 1] = c.g;
        image.pixels[i + 2] = c.b;
    }
}

}  // namespace etendue
