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

/// Returns what a camera has its pose and its clipping from: of a thin lens, its pinhole.
auto& body_of(auto& camera) {
    if constexpr (requires { camera.pinhole; })
        return camera.pinhole;
    else
        return camera;
}

/// Returns how much deeper a metre along `direction` leads.
float depth_rate(const auto& camera, const Vec3f& direction) {
    const auto& body = body_of(camera);
    return body.kPanoramic ? 1.0f : dot(direction, body.pose.forward);
}

float depth_of(const auto& camera, const Vec3f& point) {
    const auto& body = body_of(camera);
    const Vec3f to_point = point - body.pose.position;
    return body.kPanoramic ? length(to_point) : dot(to_point, body.pose.forward);
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
    if (const float start = body_of(camera).clip.start; start > 0.0f)
        ray.origin += ray.direction * (start / depth_rate(camera, ray.direction));
    return ray;
}

CameraConnection clipped_connection(const auto& camera, const Vec3f& point, Vec2f lens) {
    CameraConnection connection = camera.connect(point, lens);
    const ClipRange& clip = body_of(camera).clip;
    if (!(connection.importance_area > 0.0f) || (clip.start == 0.0f && std::isinf(clip.end))) return connection;
    const float depth = depth_of(camera, point);
    if (!(depth > clip.start && depth <= clip.end)) return {};
    connection.lens += (point - connection.lens) * (clip.start / depth);
    return connection;
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

std::optional<Vec2f> PinholeCamera::project(const Vec3f& point) const {
    const Vec3f to_point = point - pose.position;
    const float depth = dot(to_point, pose.forward);
    if (!(depth > 0.0f)) return {};
    return to_film(*this, Vec2f(dot(to_point, pose.right) / depth, dot(to_point, pose.up) / depth));
}

// The density of directions, 1 / (A cos³), times what a facing surface takes of them, 1 / d².
CameraConnection PinholeCamera::connect(const Vec3f& point, Vec2f) const {
    const std::optional<Vec2f> film = project(point);
    if (!film) return {};
    const Vec3f to_point = point - pose.position;
    const float depth = dot(to_point, pose.forward);
    const float distance = length(to_point);
    return {.lens = pose.position,
            .film = *film,
            .importance_area = distance / (4.0f * half_width * half_height * depth * depth * depth)};
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

std::optional<Vec2f> ThinLensCamera::project(const Vec3f& point) const {
    return pinhole.project(point);
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

Ray OrthographicCamera::generate_ray(Vec2f film, Vec2f) const {
    const Vec2f p = to_plane(*this, film);
    Ray ray;
    ray.origin = pose.position + pose.right * p.x + pose.up * p.y;
    ray.direction = pose.forward;
    return ray;
}

std::optional<Vec2f> OrthographicCamera::project(const Vec3f& point) const {
    const Vec3f to_point = point - pose.position;
    return to_film(*this, Vec2f(dot(to_point, pose.right), dot(to_point, pose.up)));
}

CameraConnection OrthographicCamera::connect(const Vec3f& point, Vec2f) const {
    const float depth = depth_of(*this, point);
    if (!(depth > 0.0f)) return {};
    return {.lens = point - pose.forward * depth,
            .film = *project(point),
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

std::optional<Vec2f> EquirectangularCamera::project(const Vec3f& point) const {
    const Vec3f v = to_axes(pose, point - pose.position);
    if (!(length_squared(v) > 0.0f)) return {};
    return Vec2f(0.5f + 0.5f * kInvPi * std::atan2(v.x, v.z), 0.5f - kInvPi * std::atan2(v.y, std::hypot(v.x, v.z)));
}

CameraConnection EquirectangularCamera::connect(const Vec3f& point, Vec2f) const {
    const std::optional<Vec2f> film = project(point);
    if (!film) return {};
    const Vec3f v = to_axes(pose, point - pose.position);
    const float squared = length_squared(v);
    return {.lens = pose.position,
            .film = *film,
            .importance_area = equirectangular_density(std::hypot(v.x, v.z) / std::sqrt(squared)) / squared};
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

std::optional<Vec2f> FisheyeCamera::project(const Vec3f& point) const {
    const Vec3f v = to_axes(pose, point - pose.position);
    if (!(length_squared(v) > 0.0f)) return {};
    const float across = std::hypot(v.x, v.y);
    const float scale = across > 0.0f ? radius_at(*this, std::atan2(across, v.z)) / across : 0.0f;
    return to_film(*this, Vec2f(v.x * scale, v.y * scale));
}

CameraConnection FisheyeCamera::connect(const Vec3f& point, Vec2f) const {
    const Vec3f v = to_axes(pose, point - pose.position);
    const float angle = std::atan2(std::hypot(v.x, v.y), v.z);
    const std::optional<Vec2f> film = project(point);
    if (!film || !(angle <= half_angle)) return {};
    return {.lens = pose.position, .film = *film, .importance_area = fisheye_density(*this, angle) / length_squared(v)};
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
    const Vec3f v = to_axes(pose, direction);
    return {0.0f, std::sqrt(pixel_area / equirectangular_density(std::hypot(v.x, v.z)))};
}

RayCone FisheyeCamera::pixel_cone(const Vec3f& direction, float pixel_area) const {
    const Vec3f v = to_axes(pose, direction);
    return {0.0f, std::sqrt(pixel_area / fisheye_density(*this, std::atan2(std::hypot(v.x, v.y), v.z)))};
}

bool is_panoramic(const Camera& camera) {
    return std::visit([](const auto& c) { return body_of(c).kPanoramic; }, camera);
}

bool film_wraps(const Camera& camera) {
    return std::holds_alternative<EquirectangularCamera>(camera);
}

bool has_blind_film(const Camera& camera) {
    return std::holds_alternative<FisheyeCamera>(camera);
}

const CameraPose& pose_of(const Camera& camera) {
    return std::visit([](const auto& c) -> const CameraPose& { return body_of(c).pose; }, camera);
}

const ClipRange& clip_of(const Camera& camera) {
    return std::visit([](const auto& c) -> const ClipRange& { return body_of(c).clip; }, camera);
}

float camera_depth(const Camera& camera, const Vec3f& point) {
    return std::visit([&](const auto& c) { return depth_of(c, point); }, camera);
}

bool has_lens(const Camera& camera) {
    return std::visit([](const auto& c) { return c.has_lens(); }, camera);
}

Camera with_pose(const Camera& camera, const CameraPose& pose) {
    Camera result = camera;
    std::visit([&](auto& c) { body_of(c).pose = pose; }, result);
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

Bounds bounds_of_origins(const Camera& camera) {
    const auto bound = [](const auto& c) {
        const auto& body = body_of(c);
        Bounds bounds;
        if (body.kPanoramic) {
            bounds.extend(body.pose.position - Vec3f(body.clip.start));
            bounds.extend(body.pose.position + Vec3f(body.clip.start));
        } else {
            for (const float x : {-0.5f, 1.5f})
                for (const float y : {-0.5f, 1.5f}) bounds.extend(clipped_ray(body, {x, y}, {0.5f, 0.5f}).origin);
        }
        if constexpr (requires { c.lens_radius; }) {
            // What is clipped begins between the lens and the film point's place in focus, or beyond that.
            const float scale = std::max(1.0f, std::abs(1.0f - body.clip.start / c.focus_distance));
            const Vec3f reach(c.lens_radius * scale * std::max(1.0f, 1.0f / c.aperture.ratio));
            bounds.extend(bounds.min - reach);
            bounds.extend(bounds.max + reach);
        }
        return bounds;
    };
    return std::visit(bound, camera);
}

std::optional<Vec2f> project(const Camera& camera, const Vec3f& point) {
    return std::visit([&](const auto& c) { return c.project(point); }, camera);
}

CameraConnection connect(const Camera& camera, const Vec3f& point, Vec2f lens) {
    return std::visit([&](const auto& c) { return clipped_connection(c, point, lens); }, camera);
}

RayCone pixel_cone(const Camera& camera, const Vec3f& direction, float pixel_area) {
    const auto cone_of = [&](const auto& c) {
        const RayCone cone = c.pixel_cone(direction, pixel_area);
        const float start = body_of(c).clip.start;
        return start > 0.0f ? cone.at(start / depth_rate(c, direction)) : cone;
    };
    return std::visit(cone_of, camera);
}

Mat4f world_to_camera(const Camera& camera) {
    const CameraPose& p = pose_of(camera);
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
