#include "camera/camera.h"

#include "sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

/// Film point to the image plane at distance 1 (perspective) or to metres (orthographic), camera space, y up.
Vec2f to_plane(const auto& camera, Vec2f film) {
    return {camera.center.x + (2.0f * film.x - 1.0f) * camera.half_width,
            camera.center.y + (1.0f - 2.0f * film.y) * camera.half_height};
}

/// The inverse of `to_plane`.
Vec2f to_film(const auto& camera, Vec2f plane) {
    return {0.5f + 0.5f * (plane.x - camera.center.x) / camera.half_width,
            0.5f - 0.5f * (plane.y - camera.center.y) / camera.half_height};
}

const CameraPose& pose_of(const PinholeCamera& c) {
    return c.pose;
}
const CameraPose& pose_of(const ThinLensCamera& c) {
    return c.pinhole.pose;
}
const CameraPose& pose_of(const OrthographicCamera& c) {
    return c.pose;
}
const CameraPose& pose_of(const EquirectangularCamera& c) {
    return c.pose;
}
const CameraPose& pose_of(const FisheyeCamera& c) {
    return c.pose;
}

ClipRange& clip_of(PinholeCamera& c) {
    return c.clip;
}
ClipRange& clip_of(ThinLensCamera& c) {
    return c.pinhole.clip;
}
ClipRange& clip_of(OrthographicCamera& c) {
    return c.clip;
}
ClipRange& clip_of(EquirectangularCamera& c) {
    return c.clip;
}
ClipRange& clip_of(FisheyeCamera& c) {
    return c.clip;
}
const ClipRange& clip_of(const PinholeCamera& c) {
    return c.clip;
}
const ClipRange& clip_of(const ThinLensCamera& c) {
    return c.pinhole.clip;
}
const ClipRange& clip_of(const OrthographicCamera& c) {
    return c.clip;
}
const ClipRange& clip_of(const EquirectangularCamera& c) {
    return c.clip;
}
const ClipRange& clip_of(const FisheyeCamera& c) {
    return c.clip;
}

bool is_panoramic(const auto&) {
    return false;
}
bool is_panoramic(const EquirectangularCamera&) {
    return true;
}
bool is_panoramic(const FisheyeCamera&) {
    return true;
}

/// Returns how much deeper a metre along `direction` leads.
float depth_rate(const auto& camera, const Vec3f& direction) {
    return is_panoramic(camera) ? 1.0f : dot(direction, pose_of(camera).forward);
}

float depth_of(const auto& camera, const Vec3f& point) {
    const Vec3f to_point = point - pose_of(camera).position;
    return is_panoramic(camera) ? length(to_point) : dot(to_point, pose_of(camera).forward);
}

/// Returns `v` along the axes of a pose: right, up and forward.
Vec3f to_axes(const CameraPose& pose, const Vec3f& v) {
    return {dot(v, pose.right), dot(v, pose.up), dot(v, pose.forward)};
}

/// Bounds sines and cosines that densities are divided by, so that these stay finite at poles.
constexpr float kLeastSine = 1e-6f;

/// The density per solid angle at a latitude of this cosine.
float equirectangular_density(float cosine) {
    return 1.0f / (2.0f * kPi * kPi * std::max(cosine, kLeastSine));
}

/// The angle to the viewing direction that is seen in this distance from the middle of the circle.
float angle_at(const FisheyeCamera& camera, float radius) {
    if (camera.mapping == FisheyeMapping::Equidistant) return radius * camera.half_angle;
    return 2.0f * std::asin(std::min(1.0f, radius * std::sin(0.5f * camera.half_angle)));
}

/// The inverse of `angle_at`.
float radius_at(const FisheyeCamera& camera, float angle) {
    if (camera.mapping == FisheyeMapping::Equidistant) return angle / camera.half_angle;
    return std::sin(0.5f * angle) / std::sin(0.5f * camera.half_angle);
}

/// The share of the film per solid angle at `angle`, which the circle must see: r dr/dθ / sin θ over the film's area.
float fisheye_density(const FisheyeCamera& camera, float angle) {
    const float area = 4.0f * camera.half_width * camera.half_height;
    if (camera.mapping == FisheyeMapping::Equidistant) {
        const float stretch = angle > 1e-3f ? angle / std::max(std::sin(angle), kLeastSine) : 1.0f;
        return stretch / (camera.half_angle * camera.half_angle * area);
    }
    const float sine = std::sin(0.5f * camera.half_angle);
    return 1.0f / (4.0f * sine * sine * area);
}

/// The ray of `generate_ray`, from where the camera begins to show surfaces.
Ray clipped_ray(const auto& camera, Vec2f film, Vec2f lens) {
    Ray ray = camera.generate_ray(film, lens);
    if (const float start = clip_of(camera).start; start > 0.0f)
        ray.origin += ray.direction * (start / depth_rate(camera, ray.direction));
    return ray;
}

CameraConnection clipped_connection(const auto& camera, const Vec3f& point, Vec2f lens) {
    CameraConnection connection = camera.connect(point, lens);
    const ClipRange& clip = clip_of(camera);
    if (!(connection.importance_area > 0.0f) || (clip.start == 0.0f && std::isinf(clip.end))) return connection;
    const float depth = depth_of(camera, point);
    if (!(depth > clip.start && depth <= clip.end)) return {};
    connection.lens += (point - connection.lens) * (clip.start / depth);
    return connection;
}

void set_pose(PinholeCamera& c, const CameraPose& pose) {
    c.pose = pose;
}
void set_pose(ThinLensCamera& c, const CameraPose& pose) {
    c.pinhole.pose = pose;
}
void set_pose(OrthographicCamera& c, const CameraPose& pose) {
    c.pose = pose;
}
void set_pose(EquirectangularCamera& c, const CameraPose& pose) {
    c.pose = pose;
}
void set_pose(FisheyeCamera& c, const CameraPose& pose) {
    c.pose = pose;
}

std::optional<Mat4f> projection(const PinholeCamera& c) {
    return Mat4f{1.0f / c.half_width,
                 0,
                 0,
                 0,
                 0,
                 1.0f / c.half_height,
                 0,
                 0,
                 c.center.x / c.half_width,
                 c.center.y / c.half_height,
                 -1,
                 -1,
                 0,
                 0,
                 0,
                 0};
}
std::optional<Mat4f> projection(const ThinLensCamera& c) {
    return projection(c.pinhole);
}
std::optional<Mat4f> projection(const OrthographicCamera& c) {
    return Mat4f{
        1.0f / c.half_width,         0, 0, 0, 0, 1.0f / c.half_height, 0, 0, 0, 0, -1, 0, -c.center.x / c.half_width,
        -c.center.y / c.half_height, 0, 1};
}

std::optional<Mat4f> projection(const EquirectangularCamera&) {
    return {};
}
std::optional<Mat4f> projection(const FisheyeCamera&) {
    return {};
}

}  // namespace

CameraPose CameraPose::from_matrix(const Mat4f& to_world) {
    CameraPose pose;
    pose.position = transform_point(to_world, Vec3f(0.0f));
    pose.forward = normalize(transform_vector(to_world, {0.0f, 0.0f, -1.0f}));
    const Vec3f up = transform_vector(to_world, {0.0f, 1.0f, 0.0f});
    pose.right = normalize(cross(pose.forward, up));
    pose.up = cross(pose.right, pose.forward);
    return pose;
}

Ray PinholeCamera::generate_ray(Vec2f film, Vec2f) const {
    const Vec2f p = to_plane(*this, film);
    Ray ray;
    ray.origin = pose.position;
    ray.direction = normalize(pose.to_world({p.x, p.y, -1.0f}));
    return ray;
}

// The density of directions, 1 / (A cos³), times what a facing surface takes of them, 1 / d².
CameraConnection PinholeCamera::connect(const Vec3f& point, Vec2f) const {
    const Vec3f to_point = point - pose.position;
    const float depth = dot(to_point, pose.forward);
    if (!(depth > 0.0f)) return {};
    const float distance = length(to_point);
    const Vec2f plane{dot(to_point, pose.right) / depth, dot(to_point, pose.up) / depth};
    return {.lens = pose.position,
            .film = to_film(*this, plane),
            .importance_area = distance / (4.0f * half_width * half_height * depth * depth * depth)};
}

float PinholeCamera::pdf_solid_angle(const Vec3f& direction) const {
    const float cos_theta = dot(direction, pose.forward);
    if (cos_theta <= 0.0f) return 0.0f;
    const float x = dot(direction, pose.right) / cos_theta - center.x;
    const float y = dot(direction, pose.up) / cos_theta - center.y;
    if (std::abs(x) > half_width || std::abs(y) > half_height) return 0.0f;
    return 1.0f / (4.0f * half_width * half_height * cos_theta * cos_theta * cos_theta);
}

Vec2f Aperture::point(Vec2f u) const {
    if (blades == 0) {
        const Vec2f p = square_to_disk(u);
        return {p.x / ratio, p.y};
    }
    // Numbers in the middle lead to the middle of the lens, as they do for a disk.
    const Vec2f p = square_to_regular_polygon({u.x < 0.5f ? u.x + 0.5f : u.x - 0.5f, u.y}, blades);
    const float c = std::cos(rotation);
    const float s = std::sin(rotation);
    return {(c * p.x - s * p.y) / ratio, s * p.x + c * p.y};
}

Ray ThinLensCamera::generate_ray(Vec2f film, Vec2f lens) const {
    const Vec2f p = to_plane(pinhole, film);
    const Vec2f l = aperture.point(lens) * lens_radius;
    const CameraPose& pose = pinhole.pose;
    Ray ray;
    ray.origin = pose.position + pose.right * l.x + pose.up * l.y;
    const Vec3f focus = Vec3f(p.x, p.y, -1.0f) * focus_distance;
    ray.direction = normalize(pose.to_world(focus - Vec3f(l.x, l.y, 0.0f)));
    return ray;
}

// Seen from one point of the lens, directions have the density of the pinhole's: the plane of focus is its image plane,
// enlarged.
CameraConnection ThinLensCamera::connect(const Vec3f& point, Vec2f lens) const {
    const Vec2f l = aperture.point(lens) * lens_radius;
    PinholeCamera through = pinhole;
    through.pose.position += through.pose.right * l.x + through.pose.up * l.y;
    CameraConnection connection = through.connect(point, lens);
    // The ray meets the plane of focus beside where one through the middle of the lens would.
    connection.film +=
        Vec2f(0.5f * l.x / pinhole.half_width, -0.5f * l.y / pinhole.half_height) * (1.0f / focus_distance);
    return connection;
}

float ThinLensCamera::pdf_solid_angle(const Vec3f& direction) const {
    return pinhole.pdf_solid_angle(direction);
}

Ray OrthographicCamera::generate_ray(Vec2f film, Vec2f) const {
    const Vec2f p = to_plane(*this, film);
    Ray ray;
    ray.origin = pose.position + pose.right * p.x + pose.up * p.y;
    ray.direction = pose.forward;
    return ray;
}

CameraConnection OrthographicCamera::connect(const Vec3f& point, Vec2f) const {
    const Vec3f to_point = point - pose.position;
    const float depth = dot(to_point, pose.forward);
    if (!(depth > 0.0f)) return {};
    return {.lens = point - pose.forward * depth,
            .film = to_film(*this, {dot(to_point, pose.right), dot(to_point, pose.up)}),
            .importance_area = 1.0f / (4.0f * half_width * half_height)};
}

Ray EquirectangularCamera::generate_ray(Vec2f film, Vec2f) const {
    const float longitude = (2.0f * film.x - 1.0f) * kPi;
    const float latitude = (0.5f - film.y) * kPi;
    const float level = std::cos(latitude);
    Ray ray;
    ray.origin = pose.position;
    ray.direction =
        normalize(pose.to_world({std::sin(longitude) * level, std::sin(latitude), -std::cos(longitude) * level}));
    return ray;
}

CameraConnection EquirectangularCamera::connect(const Vec3f& point, Vec2f) const {
    const Vec3f v = to_axes(pose, point - pose.position);
    const float squared = length_squared(v);
    if (!(squared > 0.0f)) return {};
    const float level = std::hypot(v.x, v.z);
    return {.lens = pose.position,
            .film = {0.5f + 0.5f * kInvPi * std::atan2(v.x, v.z), 0.5f - kInvPi * std::atan2(v.y, level)},
            .importance_area = equirectangular_density(level / std::sqrt(squared)) / squared};
}

float EquirectangularCamera::pdf_solid_angle(const Vec3f& direction) const {
    const Vec3f v = to_axes(pose, direction);
    return equirectangular_density(std::hypot(v.x, v.z));
}

Ray FisheyeCamera::generate_ray(Vec2f film, Vec2f) const {
    const Vec2f p = to_plane(*this, film);
    const float radius = std::hypot(p.x, p.y);
    Ray ray;
    ray.origin = pose.position;
    ray.direction = pose.forward;
    if (radius > 1.0f) {
        ray.t_max = 0.0f;
        return ray;
    }
    const float angle = angle_at(*this, radius);
    const float across = radius > 0.0f ? std::sin(angle) / radius : 0.0f;
    ray.direction = normalize(pose.to_world({p.x * across, p.y * across, -std::cos(angle)}));
    return ray;
}

CameraConnection FisheyeCamera::connect(const Vec3f& point, Vec2f) const {
    const Vec3f v = to_axes(pose, point - pose.position);
    const float squared = length_squared(v);
    const float across = std::hypot(v.x, v.y);
    const float angle = std::atan2(across, v.z);
    if (!(squared > 0.0f && angle <= half_angle)) return {};
    const float scale = across > 0.0f ? radius_at(*this, angle) / across : 0.0f;
    return {.lens = pose.position,
            .film = to_film(*this, {v.x * scale, v.y * scale}),
            .importance_area = fisheye_density(*this, angle) / squared};
}

float FisheyeCamera::pdf_solid_angle(const Vec3f& direction) const {
    const CameraConnection connection = connect(pose.position + direction, {});
    const Vec2f& film = connection.film;
    const bool is_inside = film.x >= 0.0f && film.x <= 1.0f && film.y >= 0.0f && film.y <= 1.0f;
    return is_inside ? connection.importance_area : 0.0f;
}

// A pixel's solid angle is its area on the image plane times cos³; the plane's area is the reciprocal of that density.
RayCone PinholeCamera::pixel_cone(const Vec3f& direction, float pixel_area) const {
    const float cos_theta = std::max(0.0f, dot(direction, pose.forward));
    const float plane_area = 4.0f * half_width * half_height * pixel_area;
    return {0.0f, cos_theta * std::sqrt(plane_area * cos_theta)};
}

RayCone ThinLensCamera::pixel_cone(const Vec3f& direction, float pixel_area) const {
    return pinhole.pixel_cone(direction, pixel_area);
}

RayCone OrthographicCamera::pixel_cone(const Vec3f&, float pixel_area) const {
    return {std::sqrt(4.0f * half_width * half_height * pixel_area), 0.0f};
}

RayCone EquirectangularCamera::pixel_cone(const Vec3f& direction, float pixel_area) const {
    return {0.0f, std::sqrt(pixel_area / pdf_solid_angle(direction))};
}

RayCone FisheyeCamera::pixel_cone(const Vec3f& direction, float pixel_area) const {
    const Vec3f v = to_axes(pose, direction);
    return {0.0f, std::sqrt(pixel_area / fisheye_density(*this, std::atan2(std::hypot(v.x, v.y), v.z)))};
}

bool is_panoramic(const Camera& camera) {
    return std::visit([](const auto& c) { return is_panoramic(c); }, camera);
}

bool film_wraps(const Camera& camera) {
    return std::holds_alternative<EquirectangularCamera>(camera);
}

bool has_blind_film(const Camera& camera) {
    return std::holds_alternative<FisheyeCamera>(camera);
}

const CameraPose& pose_of(const Camera& camera) {
    return std::visit([](const auto& c) -> const CameraPose& { return pose_of(c); }, camera);
}

const ClipRange& clip_of(const Camera& camera) {
    return std::visit([](const auto& c) -> const ClipRange& { return clip_of(c); }, camera);
}

Camera without_far_clip(const Camera& camera) {
    Camera result = camera;
    std::visit([](auto& c) { clip_of(c).end = ClipRange{}.end; }, result);
    return result;
}

float camera_depth(const Camera& camera, const Vec3f& point) {
    return std::visit([&](const auto& c) { return depth_of(c, point); }, camera);
}

bool has_lens(const Camera& camera) {
    return std::visit([](const auto& c) { return c.has_lens(); }, camera);
}

Camera with_pose(const Camera& camera, const CameraPose& pose) {
    Camera result = camera;
    std::visit([&](auto& c) { set_pose(c, pose); }, result);
    return result;
}

Ray generate_ray(const Camera& camera, Vec2f film, Vec2f lens) {
    return std::visit([&](const auto& c) { return clipped_ray(c, film, lens); }, camera);
}

void generate_rays(const Camera& camera, std::span<const Vec2f> film, std::span<const Vec2f> lens,
                   std::span<Ray> rays) {
    const auto generate = [&](const auto& c) {
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = clipped_ray(c, film[i], lens[i]);
    };
    std::visit(generate, camera);
}

CameraConnection connect(const Camera& camera, const Vec3f& point, Vec2f lens) {
    return std::visit([&](const auto& c) { return clipped_connection(c, point, lens); }, camera);
}

float camera_pdf_solid_angle(const Camera& camera, const Vec3f& direction) {
    return std::visit([&](const auto& c) { return c.pdf_solid_angle(direction); }, camera);
}

RayCone pixel_cone(const Camera& camera, const Vec3f& direction, float pixel_area) {
    const auto cone_of = [&](const auto& c) {
        const RayCone cone = c.pixel_cone(direction, pixel_area);
        const float start = clip_of(c).start;
        return start > 0.0f ? cone.at(start / depth_rate(c, direction)) : cone;
    };
    return std::visit(cone_of, camera);
}

Mat4f world_to_camera(const Camera& camera) {
    const CameraPose& p = std::visit([](const auto& c) -> const CameraPose& { return pose_of(c); }, camera);
    const Mat4f to_world(p.right.x, p.right.y, p.right.z, 0, p.up.x, p.up.y, p.up.z, 0, -p.forward.x, -p.forward.y,
                         -p.forward.z, 0, p.position.x, p.position.y, p.position.z, 1);
    return to_world.inverse();
}

std::optional<Mat4f> world_to_screen(const Camera& camera) {
    const std::optional<Mat4f> to_screen = std::visit([](const auto& c) { return projection(c); }, camera);
    if (!to_screen) return {};
    return world_to_camera(camera) * *to_screen;
}

}  // namespace etendue
