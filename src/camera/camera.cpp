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

ClipRange& clip_of(PinholeCamera& c) {
    return c.clip;
}
ClipRange& clip_of(ThinLensCamera& c) {
    return c.pinhole.clip;
}
ClipRange& clip_of(OrthographicCamera& c) {
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

/// How much deeper along the viewing direction a metre along `direction` leads.
float depth_rate(const auto& camera, const Vec3f& direction) {
    return dot(direction, pose_of(camera).forward);
}

float depth_of(const auto& camera, const Vec3f& point) {
    return dot(point - pose_of(camera).position, pose_of(camera).forward);
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

Mat4f projection(const PinholeCamera& c) {
    return {1.0f / c.half_width,
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
Mat4f projection(const ThinLensCamera& c) {
    return projection(c.pinhole);
}
Mat4f projection(const OrthographicCamera& c) {
    return {
        1.0f / c.half_width,         0, 0, 0, 0, 1.0f / c.half_height, 0, 0, 0, 0, -1, 0, -c.center.x / c.half_width,
        -c.center.y / c.half_height, 0, 1};
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

Mat4f world_to_screen(const Camera& camera) {
    return world_to_camera(camera) * std::visit([](const auto& c) { return projection(c); }, camera);
}

}  // namespace etendue
