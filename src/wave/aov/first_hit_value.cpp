#include "wave/aov/first_hit_value.h"

#include <array>

namespace etendue {

namespace {

/// Stands for infinitely far, metres: compositing programs take it so, and filter it without harm.
constexpr float kFar = 1e10f;

constexpr std::array kTable{
    FirstHitEntry{FirstHitValue::Depth, "depth", "Z", true, true, kFar, "metres along the viewing direction"},
    FirstHitEntry{FirstHitValue::Position, "P", "XYZ", true, true, 0.0f, "position in the world, metres"},
    FirstHitEntry{FirstHitValue::Normal, "N", "XYZ", false, false, 0.0f,
                  "shading normal in the world, towards the eye"},
    FirstHitEntry{FirstHitValue::GeometricNormal, "Ng", "XYZ", false, false, 0.0f, "the same of the triangles"},
    FirstHitEntry{FirstHitValue::Uv, "uv", "UV", true, true, 0.0f, "first set of texture coordinates"},
    FirstHitEntry{FirstHitValue::Albedo, "albedo", "RGB", false, false, 0.0f, "share of light that is scattered"},
    FirstHitEntry{FirstHitValue::AlbedoDiffuse, "albedo_diffuse", "RGB", false, false, 0.0f, "its diffuse part"},
    FirstHitEntry{FirstHitValue::AlbedoSpecular, "albedo_specular", "RGB", false, false, 0.0f,
                  "its glossy and singular part"},
    FirstHitEntry{FirstHitValue::ObjectId, "object_id", "X", true, true, 0.0f, "number of the object, from 1 on"},
    FirstHitEntry{FirstHitValue::MaterialId, "material_id", "X", true, true, 0.0f, "number of the material, from 1 on"},
    FirstHitEntry{FirstHitValue::Motion, "motion", "XY", true, true, 0.0f,
                  "pixels moved while the shutter is open, x right and y down"},
    FirstHitEntry{FirstHitValue::Mist, "mist", "Z", false, false, 1.0f, "share that mist hides, by its distance"},
    FirstHitEntry{FirstHitValue::Vector, "vector", "XYZW", true, true, 0.0f,
                  "pixels to where it was a frame before, and from where it is a frame after, as Blender has them"},
};

}  // namespace

std::span<const FirstHitEntry> first_hit_table() {
    return kTable;
}

const FirstHitEntry& first_hit_entry(FirstHitValue value) {
    return kTable[static_cast<std::size_t>(value)];
}

}  // namespace etendue
