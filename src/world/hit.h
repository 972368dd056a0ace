// What rays are asked and what they meet.
#pragma once

#include "core/vec.h"
#include "world/geometry.h"

#include <cstdint>

namespace etendue {

/// Holds the nearest surface along a ray, in 28 bytes.
struct Hit {
    /// Is in metres along the ray; of one that met nothing, how far the camera shows what lies along it, or 0.
    float t = 0.0f;
    float u = 0.0f, v = 0.0f;    ///< barycentric coordinates of the second and third vertex, or the place on a shape
    std::uint32_t triangle = 0;  ///< or the face of a shape (shape/shape.h)
    std::uint32_t geometry : 31 = 0;
    std::uint32_t in_contact : 1 = 0;  ///< there are other surfaces in this place (world/contacts.h)
    std::uint32_t instance = kNone;    ///< kNone if nothing was hit
    float time = 0.0f;                 ///< the time of the ray: what moves is hit where it was then

    [[nodiscard]] bool valid() const { return instance != kNone; }
    /// Returns whether the ray goes on to a surface or to the camera's far plane, and not out of the scene.
    [[nodiscard]] bool has_end() const { return valid() || t > 0.0f; }
};

/// Says what is known about the rays of a batch; decides how they are traced, not what they hit.
enum class Coherence {
    Coherent,    ///< neighbours have similar origins and directions: camera rays
    Incoherent,  ///< anything else
};

/// Answer a ray that asks whether something is in the way.
inline constexpr std::uint8_t kFree = 0, kOccluded = 1, kPassesClear = 2;

/// Says where rays begin and end: those with an end at the camera pass what is hidden from it. All pass culled backs,
/// as the eye sees them: rays that follow light meet those surfaces from the other side.
enum class RayEnds {
    InScene,    ///< from the eye's side towards lights
    AtCamera,   ///< from the camera, straight or through clear surfaces
    ToCamera,   ///< from a light's side to the camera, straight or through clear surfaces
    FromLight,  ///< from a light's side into the scene
};

/// True of rays that pass what is hidden from the camera.
[[nodiscard]] constexpr bool has_end_at_camera(RayEnds ends) {
    return ends == RayEnds::AtCamera || ends == RayEnds::ToCamera;
}

/// True of rays that go where light goes; the others go where the eye looks.
[[nodiscard]] constexpr bool follows_light(RayEnds ends) {
    return ends == RayEnds::ToCamera || ends == RayEnds::FromLight;
}

/// True if rays pass culled surfaces whose front has a normal at this `cosine`, of either length, to their direction.
[[nodiscard]] constexpr bool passes_culled(RayEnds ends, float cosine) {
    return follows_light(ends) ? cosine < 0.0f : cosine > 0.0f;
}

/// Says how a batch goes through Embree; the default is what measured best for its coherence, and benchmarks compare.
enum class QueryForm { Best, Single, Packet8, Packet16 };

/// Holds a triangle that was hit, with the normal that its vertices make there; zero where it is flat.
struct HitTriangle {
    Vec3f p0, edge1, edge2;
    Vec3f shading_normal;
};

/// Holds the texture coordinates of a triangle's first vertex, and their differences to those of the others; zero where
/// the triangle has none.
struct HitCoordinates {
    Vec2f uv0{0.0f, 0.0f}, edge1{0.0f, 0.0f}, edge2{0.0f, 0.0f};
};

}  // namespace etendue
