// Cameras: from a point on the film and one on the lens to a ray.
//
// To add another: a struct with `pose`, `clip`, `kPanoramic`, `generate_ray`, `project`, `connect`, `pixel_cone` and
// `has_lens`, its place in the variant, its projection in camera.cpp, one case in world/compile_camera.cpp, and its row
// in tests/camera. What lies nearer or farther than a camera shows is cut off for all of them alike, by the functions
// on `Camera`.
//
// Film coordinates run over [0, 1)², x to the right and y down from the top left corner of the full image.
#pragma once

#include "core/bounds.h"
#include "core/ray.h"
#include "core/ray_cone.h"
#include "core/vec.h"

#include <limits>
#include <optional>
#include <span>
#include <variant>

namespace etendue {

/// Where a camera stands. `forward` is its viewing direction; the three axes are orthonormal.
struct CameraPose {
    Vec3f position{0.0f};
    Vec3f right{1.0f, 0.0f, 0.0f};
    Vec3f up{0.0f, 1.0f, 0.0f};
    Vec3f forward{0.0f, 0.0f, -1.0f};

    /// Makes a pose from a camera-to-world matrix of glTF's kind (looking along local -Z, +Y up); its scale is ignored,
    /// as the specification asks.
    [[nodiscard]] static CameraPose from_matrix(const Mat4f& to_world);
    [[nodiscard]] Vec3f to_world(const Vec3f& local) const {
        return right * local.x + up * local.y - forward * local.z;
    }
};

/// Holds between which depths a camera shows surfaces.
struct ClipRange {
    float start = 0.0f;                                  ///< metres, >= 0
    float end = std::numeric_limits<float>::infinity();  ///< metres, > start
};

/// How a camera sees a point.
struct CameraConnection {
    Vec3f lens{0.0f};        ///< where light from the point reaches the camera, world space, metres
    Vec2f film{0.0f, 0.0f};  ///< where it is seen; may lie outside of [0, 1)²
    /// Share of the film that a surface at the point takes per area across the ray, 1/m²; 0 if the camera cannot see
    /// the point, wherever its film ends.
    float importance_area = 0.0f;
};

/// Perspective through a point.
struct PinholeCamera {
    static constexpr bool kPanoramic = false;  ///< true if no plane film shows what the camera sees

    CameraPose pose;
    float half_width = 0.5f;   ///< half the extent of the image plane at distance 1
    float half_height = 0.5f;  ///< half the extent of the image plane at distance 1
    Vec2f center{0.0f, 0.0f};  ///< middle of the film on that plane, x right and y up from the viewing direction
    ClipRange clip{};

    [[nodiscard]] Ray generate_ray(Vec2f film, Vec2f lens) const;
    [[nodiscard]] std::optional<Vec2f> project(const Vec3f& point) const;
    [[nodiscard]] CameraConnection connect(const Vec3f& point, Vec2f lens) const;
    [[nodiscard]] RayCone pixel_cone(const Vec3f& direction, float pixel_area) const;
    [[nodiscard]] static constexpr bool has_lens() { return false; }
};

/// Describes the opening of a lens, of radius 1: a disk, or a regular polygon with its corners on the circle, made
/// narrower or wider.
struct Aperture {
    int blades = 0;         ///< sides of the polygon, at least 3; 0 for a disk
    float rotation = 0.0f;  ///< radians, counter-clockwise as seen by the camera; without it, a side is on the right
    float ratio = 1.0f;     ///< divides the width, after the rotation; > 0

    /// Returns the point for `u` in [0, 1)², of uniform density over the opening.
    [[nodiscard]] Vec2f point(Vec2f u) const;
};

/// Perspective through an aperture: what lies at the focus distance is sharp.
struct ThinLensCamera {
    PinholeCamera pinhole;
    float lens_radius = 0.0f;     ///< metres, > 0
    float focus_distance = 1.0f;  ///< metres along the optical axis, > 0
    Aperture aperture{};

    [[nodiscard]] Ray generate_ray(Vec2f film, Vec2f lens) const;
    [[nodiscard]] std::optional<Vec2f> project(const Vec3f& point) const;
    [[nodiscard]] CameraConnection connect(const Vec3f& point, Vec2f lens) const;
    /// Returns the cone of the pinhole: what the lens blurs, its samples blur.
    [[nodiscard]] RayCone pixel_cone(const Vec3f& direction, float pixel_area) const;
    [[nodiscard]] static constexpr bool has_lens() { return true; }
};

/// Parallel rays.
struct OrthographicCamera {
    static constexpr bool kPanoramic = false;  ///< true if no plane film shows what the camera sees

    CameraPose pose;
    float half_width = 1.0f;   ///< metres
    float half_height = 1.0f;  ///< metres
    Vec2f center{0.0f, 0.0f};  ///< middle of the film, metres right and up from the viewing direction
    ClipRange clip{};

    [[nodiscard]] Ray generate_ray(Vec2f film, Vec2f lens) const;
    [[nodiscard]] std::optional<Vec2f> project(const Vec3f& point) const;
    [[nodiscard]] CameraConnection connect(const Vec3f& point, Vec2f lens) const;
    [[nodiscard]] RayCone pixel_cone(const Vec3f& direction, float pixel_area) const;
    [[nodiscard]] static constexpr bool has_lens() { return false; }
};

/// All directions from a point, by longitude and latitude; depths are distances. The film goes on beyond its edges.
struct EquirectangularCamera {
    static constexpr bool kPanoramic = true;  ///< true if no plane film shows what the camera sees

    CameraPose pose;  ///< `forward` is in the middle of the film
    ClipRange clip{};

    [[nodiscard]] Ray generate_ray(Vec2f film, Vec2f lens) const;
    [[nodiscard]] std::optional<Vec2f> project(const Vec3f& point) const;
    [[nodiscard]] CameraConnection connect(const Vec3f& point, Vec2f lens) const;
    [[nodiscard]] RayCone pixel_cone(const Vec3f& direction, float pixel_area) const;
    [[nodiscard]] static constexpr bool has_lens() { return false; }
};

/// Says how far from the middle of a fisheye's film an angle to the viewing direction is seen.
enum class FisheyeMapping {
    Equidistant,  ///< as far as the angle is large
    Equisolid,    ///< so that equal areas are equal solid angles
};

/// Directions within an angle of the viewing direction, from a point, in a circle; depths are distances. Beyond the
/// circle the film sees nothing.
struct FisheyeCamera {
    static constexpr bool kPanoramic = true;  ///< true if no plane film shows what the camera sees

    CameraPose pose;
    float half_width = 1.0f;        ///< half the extent of the film, in radii of the circle
    float half_height = 1.0f;       ///< half the extent of the film, in radii of the circle
    Vec2f center{0.0f, 0.0f};       ///< middle of the film, in radii right and up from the circle's
    float half_angle = kPi / 2.0f;  ///< that the circle's edge sees, radians, (0, π]
    FisheyeMapping mapping = FisheyeMapping::Equidistant;
    ClipRange clip{};

    /// Returns a ray with nowhere to go, of t_max 0, for film points beyond the circle.
    [[nodiscard]] Ray generate_ray(Vec2f film, Vec2f lens) const;
    [[nodiscard]] std::optional<Vec2f> project(const Vec3f& point) const;
    [[nodiscard]] CameraConnection connect(const Vec3f& point, Vec2f lens) const;
    [[nodiscard]] RayCone pixel_cone(const Vec3f& direction, float pixel_area) const;
    [[nodiscard]] static constexpr bool has_lens() { return false; }
};

using Camera = std::variant<PinholeCamera, ThinLensCamera, OrthographicCamera, EquirectangularCamera, FisheyeCamera>;

[[nodiscard]] const CameraPose& pose_of(const Camera& camera);
/// Returns whether numbers for a point on the lens mean something.
[[nodiscard]] bool has_lens(const Camera& camera);
/// `camera` with another pose.
[[nodiscard]] Camera with_pose(const Camera& camera, const CameraPose& pose);

/// Returns true if no plane film shows what the camera sees.
[[nodiscard]] bool is_panoramic(const Camera& camera);
/// Returns true if the camera sees in all directions and its film goes on beyond its edges: beyond the sides it begins
/// anew, beyond top and bottom it goes on upside down, half a width aside.
[[nodiscard]] bool film_wraps(const Camera& camera);
/// Returns true if some of the film may see nothing.
[[nodiscard]] bool has_blind_film(const Camera& camera);
/// Returns the depths that the camera shows.
[[nodiscard]] const ClipRange& clip_of(const Camera& camera);
/// Returns how far `point` lies along the viewing direction, metres; from a panoramic camera, how far away it is.
[[nodiscard]] float camera_depth(const Camera& camera, const Vec3f& point);

/// The ray through film point `film`, for a lens point made from `lens` in [0, 1)². Its direction is unit length. It
/// begins where the camera begins to show surfaces, and does not end where it ceases to. Its t_max is 0 where the film
/// sees nothing.
[[nodiscard]] Ray generate_ray(const Camera& camera, Vec2f film, Vec2f lens);
/// Returns a box around all places where rays of the camera begin, on a film that reaches half its extent beyond its
/// edges, as filters of small images do.
[[nodiscard]] Bounds bounds_of_origins(const Camera& camera);
/// Returns where on the film, or beside it, `point` lies as seen through the middle of the lens, at whatever depth;
/// none behind a perspective camera and where a panoramic one stands.
[[nodiscard]] std::optional<Vec2f> project(const Camera& camera, const Vec3f& point);
/// Generates a ray for each of many film and lens points, as `generate_ray` does; all spans have one length.
void generate_rays(const Camera& camera, std::span<const Vec2f> film, std::span<const Vec2f> lens, std::span<Ray> rays);

/// The inverse of `generate_ray`: how `point` is seen through the lens point made from `lens` in [0, 1)². Averaged over
/// lens points and times the radiance and the cosine of a surface, `importance_area` integrates over surfaces to what
/// `generate_ray` averages over the film.
[[nodiscard]] CameraConnection connect(const Camera& camera, const Vec3f& point, Vec2f lens);

/// The cone around a camera ray along `direction` that is as large as a pixel, which takes the share `pixel_area` of
/// the film. Not divided by the samples per pixel: what a pixel shows does not depend on their number.
[[nodiscard]] RayCone pixel_cone(const Camera& camera, const Vec3f& direction, float pixel_area);

/// World to camera space (looking along -Z), and world to screen: x and y in [-1, 1] over the image, for image
/// metadata; panoramic cameras have no such screen.
[[nodiscard]] Mat4f world_to_camera(const Camera& camera);
[[nodiscard]] std::optional<Mat4f> world_to_screen(const Camera& camera);

}  // namespace etendue
