// What can be said of the first surface that the eye meets.
//
// To add another: its place in `FirstHitValue`, its row in the table of first_hit_value.cpp, its case in
// first_hits.cpp.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace etendue {

enum class FirstHitValue {
    Depth,            ///< metres along the camera's viewing direction
    Position,         ///< world space, metres
    Normal,           ///< shading normal, world space, unit, towards the eye
    GeometricNormal,  ///< normal of the triangle, world space, unit, towards the eye
    Uv,               ///< the first set of texture coordinates
    Albedo,           ///< share of light that is scattered, diffuse and specular
    AlbedoDiffuse,
    AlbedoSpecular,
    ObjectId,    ///< index of the instance, from 1 on
    MaterialId,  ///< index of the material, from 1 on
    Motion,      ///< pixels by which the point moves on the film while the shutter is open, x right and y down
    Mist,        ///< share of the surface that mist hides, [0, 1]
    Vector,      ///< pixels of x and y, right and up, from the point to itself a frame before, and from a frame after
};

struct FirstHitEntry {
    FirstHitValue value;
    std::string_view name;      ///< name of the AOV
    std::string_view channels;  ///< a letter each
    bool is_nearest;            ///< true: the nearest sample's value; false: averaged
    bool is_float;              ///< too large or too fine for half floats
    float background;           ///< value where there is no surface
    std::string_view summary;   ///< for --help
};

/// Returns all values of first hits, in the order of `FirstHitValue`.
[[nodiscard]] std::span<const FirstHitEntry> first_hit_table();
[[nodiscard]] const FirstHitEntry& first_hit_entry(FirstHitValue value);

}  // namespace etendue
