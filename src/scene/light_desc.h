// Lights without a surface (KHR_lights_punctual) and the environment. Emissive surfaces are materials.
#pragma once

#include "core/error.h"
#include "core/rgb.h"
#include "core/vec.h"

#include <filesystem>
#include <string>

namespace etendue {

enum class LightType { Point, Spot, Directional };

/// Points along its local -Z, as in glTF. Photometric values are used as radiometric ones, one to one: a candela is one
/// W/sr and a lux one W/m² in each channel of the working space.
struct LightDesc {
    std::string name;
    LightType type = LightType::Point;
    Rgb color{1.0f};                ///< linear Rec.709
    float intensity = 1.0f;         ///< point and spot: W/sr; directional: W/m² on a surface facing the light; >= 0
    float inner_cone_angle = 0.0f;  ///< spot: radians from the axis to where falloff begins
    float outer_cone_angle = 0.785398163f;  ///< spot: radians from the axis to where light ends, (inner, pi/2]
    Mat4f to_world;
    SourceLocation location;
};

/// Light from infinitely far away. With an image: latitude-longitude, its centre towards -Z rotated about +Y.
struct EnvironmentDesc {
    bool enabled = false;
    std::filesystem::path image;  ///< EXR or HDR; empty for a constant colour
    Rgb color{1.0f};              ///< linear Rec.709; radiance, or the image's tint
    float scale = 1.0f;           ///< multiplies the radiance, >= 0
    float rotation = 0.0f;        ///< radians about +Y, counter-clockwise seen from above
    bool visible_to_camera = true;
    SourceLocation location;
};

}  // namespace etendue
