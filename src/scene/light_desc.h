// Lights without a surface (KHR_lights_punctual) and the environment. Emissive surfaces are materials.
#pragma once

#include "core/error.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "scene/handle.h"
#include "scene/ies_profile_desc.h"
#include "scene/texture_desc.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace etendue {

enum class LightType { Point, Spot, Directional };

/// Names the types of lights as glTF spells them, in the order of `LightType`.
inline constexpr std::array<std::string_view, 3> kLightTypeNames{"point", "spot", "directional"};

/// How the luminous intensity (candela) and the illuminance (lux) of lamps meet the radiance of emissive surfaces and
/// of the environment, whose numbers always reach the image as they are.
enum class LightUnits {
    Photometric,  ///< all are photometric, as glTF has it: one to one, and the image is in cd/m²
    Radiometric,  ///< surfaces, environment and image are in W/(m² sr): lamps are divided by kLumensPerWatt
};

/// Names the light units as render.json and the command line spell them.
inline constexpr std::array<std::pair<std::string_view, LightUnits>, 2> kLightUnitNames{{
    {"photometric", LightUnits::Photometric},
    {"radiometric", LightUnits::Radiometric},
}};
[[nodiscard]] constexpr std::string_view light_units_name(LightUnits units) {
    return kLightUnitNames[static_cast<std::size_t>(units)].first;
}

/// Luminous efficacy of light at 555 nm, lm/W (CIE S 023): what exporters take for any light when they turn watts into
/// lumens.
inline constexpr float kLumensPerWatt = 683.002f;

/// Points along its local -Z, as in glTF.
struct LightDesc {
    std::string name;
    std::string node;  ///< name of the node that places it
    LightType type = LightType::Point;
    Rgb color{1.0f};  ///< linear Rec.709
    /// Point and spot: candela, or with a profile the factor on its candela. Directional: lux on a surface facing the
    /// light. >= 0.
    float intensity = 1.0f;
    Handle<IesProfileDesc> profile;  ///< point and spot: how intensity depends on direction, times the spot's cone
    float inner_cone_angle = 0.0f;   ///< spot: radians from the axis to where falloff begins
    float outer_cone_angle = 0.785398163f;  ///< spot: radians from the axis to where light ends, [inner, pi/2], > 0
    float angle = 0.0f;                     ///< directional: radians under which the disk of the sun is seen, [0, pi)
    Mat4f to_world;                         ///< in the middle of the shutter
    /// Holds `to_world` at equally spaced times while the shutter is open; empty if the light stands still.
    std::vector<Mat4f> motion{};
    SourceLocation location;
};

/// Six images of what is seen from the middle of a cube, with their tops towards +Y; those of the faces +Y and -Y
/// towards -Z and +Z. PNGs with alpha hold radiance over their alpha (RGBD), all others radiance up to 1; colour is
/// under the sRGB curve in both.
struct CubeMapDesc {
    std::array<Handle<ImageDesc>, 6> faces;  ///< +X, -X, +Y, -Y, +Z, -Z: squares of one size
    Mat4f to_world;                          ///< a rotation
    float intensity = 1.0f;                  ///< multiplies the radiance, >= 0
};

/// Light from infinitely far away. With an image: latitude-longitude, its centre towards -Z rotated about +Y. An image
/// takes the place of a cube map.
struct EnvironmentDesc {
    bool enabled = false;
    std::filesystem::path image;      ///< EXR or HDR; empty for the cube map, or for a constant colour without one
    std::optional<CubeMapDesc> cube;  ///< cube map of the scene file
    Rgb color{1.0f};                  ///< linear Rec.709; radiance, or the image's tint
    float scale = 1.0f;               ///< multiplies the radiance, >= 0
    float rotation = 0.0f;            ///< radians about +Y, counter-clockwise seen from above
    bool visible_to_camera = true;
    bool is_studio = false;  ///< it is what `studio_radiance` says, times colour and scale, in place of all images
    SourceLocation location;
};

}  // namespace etendue
