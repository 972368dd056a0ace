#include "scene/setting.h"
#include "scene/transform.h"
#include "scene/validate_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue {

namespace {

/// Most of a camera's shift, in views: what is beyond would be nothing but rounding.
constexpr double kMostShift = 100.0;
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

void validate_crop(const RenderSettings& settings, ProblemList& problems) {
    const FilmSettings& film = settings.film;
    if (!film.crop) return;
    const PixelRect window = film.window();
    const PixelRect around{-film.width, -film.height, 2 * film.width, 2 * film.height};
    if (!window.empty() && intersection(window, around) != window)
        problems.error(
            settings.at("/crop"),
            fmt::format("the crop window [{}, {}, {}, {}] goes farther beyond the image of {} x {} than that "
                        "is large",
                        window.x0, window.y0, window.x1, window.y1, film.width, film.height));
}

void validate_overscan(const RenderSettings& settings, ProblemList& problems) {
    const FilmSettings& film = settings.film;
    if (!(film.overscan >= 0.0f && film.overscan <= static_cast<float>(kMostSide))) return;
    if (film.overscan >= 1.0f && film.overscan != std::trunc(film.overscan))
        problems.error(settings.at("/film/overscan"),
                       fmt::format("overscan is {}, but must be a whole number of pixels, or below 1", film.overscan));
    else if (film.frame().x0 < -std::min(film.width, film.height))
        problems.error(settings.at("/film/overscan"),
                       fmt::format("overscan is {} pixels, more than the image of {} x {} has", -film.frame().x0,
                                   film.width, film.height));
}

void validate_camera_name(const SceneDesc& scene, ProblemList& problems) {
    const std::string& name = scene.settings.camera;
    if (name.empty() || find_camera(scene, name) != nullptr) return;
    problems.error(scene.settings.at("/camera"),
                   fmt::format("there is no camera '{}'; {}", name, name_hint(name, camera_names(scene))));
}

void validate_variant(const SceneDesc& scene, ProblemList& problems) {
    const std::string& name = scene.settings.variant;
    if (name.empty() || std::ranges::find(scene.variants, name) != scene.variants.end()) return;
    const std::vector<std::string_view> names(scene.variants.begin(), scene.variants.end());
    problems.error(scene.settings.at("/variant"),
                   fmt::format("there is no material variant '{}'; {}", name, name_hint(name, names)));
}

/// Checks each setting by itself, as the table says.
void validate_ranges(const RenderSettings& settings, ProblemList& problems) {
    for (const Setting& setting : settings_table())
        if (const auto problem = problem_with(setting, setting.place.read(settings)))
            problems.error(settings.at(std::string(setting.pointer)),
                           fmt::format("{} {}", setting.pointer.substr(setting.pointer.rfind('/') + 1), *problem));
}

bool is_ascending(const std::vector<float>& values) {
    return std::ranges::adjacent_find(values, [](float a, float b) { return !(a < b); }) == values.end();
}

void validate_profile(const IesProfileDesc& profile, ProblemList& problems) {
    const auto& [name, vertical, horizontal, candela, where] = profile;
    constexpr float kTolerance = 1e-5f;
    const bool angles = vertical.size() >= 2 && horizontal.size() >= 2 && is_ascending(vertical) &&
                        is_ascending(horizontal) && vertical.front() >= 0.0f && vertical.back() <= kPi + kTolerance &&
                        horizontal.front() == 0.0f && std::abs(horizontal.back() - 2.0f * kPi) <= kTolerance;
    if (!angles) problems.error(where, "the angles of the IES profile do not ascend through [0, pi] and [0, 2 pi]");
    if (candela.size() != vertical.size() * horizontal.size())
        problems.error(where, fmt::format("the IES profile has {} values for {} x {} directions", candela.size(),
                                          vertical.size(), horizontal.size()));
    if (!std::ranges::all_of(candela, [](float c) { return c >= 0.0f && std::isfinite(c); }))
        problems.error(where, "the IES profile has an intensity that is negative or not finite");
}

/// Checks what panoramic cameras have, and says what they have not.
void validate_panorama(const CameraDesc& camera, ProblemList& problems) {
    const SourceLocation& where = camera.location;
    if (camera.type != CameraType::Equirectangular && camera.type != CameraType::Fisheye) return;
    if (camera.lens_radius > 0.0f)
        problems.warning(where, "a panoramic camera has no depth of field: its lens radius is ignored");
    if (camera.type == CameraType::Equirectangular) {
        if (camera.shift != Vec2f(0.0f, 0.0f))
            problems.error(where, "an equirectangular camera has no shift: turn it instead");
        return;
    }
    constexpr float kTurn = 2.0f * kPi;
    if (!(camera.fov > 0.0f && camera.fov <= kTurn))
        problems.error(where, fmt::format("fov is {}, but must be in (0, 2 pi]", camera.fov));
    if (!(camera.circle > 0.0f && std::isfinite(camera.circle)))
        problems.error(where, fmt::format("the circle is {} of the image, but must be above 0", camera.circle));
}

/// Checks shift, clipping and aperture.
void check_view(const CameraDesc& camera, ProblemList& problems) {
    const SourceLocation& where = camera.location;
    for (const float share : {camera.shift.x, camera.shift.y})
        check_range(static_cast<double>(share), -kMostShift, kMostShift, "shift", where, problems);
    const ClipDesc& clip = camera.clip;
    if (!(clip.start >= 0.0f && std::isfinite(clip.start) && clip.end > clip.start))
        problems.error(where,
                       fmt::format("the clipping is from {} to {}, but must be from at least 0 to more than that",
                                   clip.start, clip.end));
    const ApertureDesc& aperture = camera.aperture;
    if (aperture.blades != 0 &&
        (aperture.blades < ApertureDesc::kLeastBlades || aperture.blades > ApertureDesc::kMostBlades))
        problems.error(where, fmt::format("blades is {}, but must be 0 or in [{}, {}]", aperture.blades,
                                          ApertureDesc::kLeastBlades, ApertureDesc::kMostBlades));
    if (!std::isfinite(aperture.rotation)) problems.error(where, "the rotation of the blades is not finite");
    if (!(aperture.ratio > 0.0f && std::isfinite(aperture.ratio)))
        problems.error(where, fmt::format("the aperture ratio is {}, but must be above 0", aperture.ratio));
}

}  // namespace

void validate_cameras(const SceneDesc& scene, ProblemList& problems) {
    for (const CameraDesc& camera : scene.cameras) {
        const SourceLocation& where = camera.location;
        if (camera.type == CameraType::Perspective && !(camera.yfov > 0.0f && camera.yfov < kPi)) {
            problems.error(where, fmt::format("yfov is {}, but must be in (0, pi)", camera.yfov));
        }
        if (camera.type == CameraType::Orthographic && !(camera.ymag > 0.0f && std::isfinite(camera.ymag))) {
            problems.error(where, fmt::format("ymag is {}, but must be finite and above 0", camera.ymag));
        }
        validate_panorama(camera, problems);
        check_range(static_cast<double>(camera.aspect_ratio), 0.0, kUnbounded, "aspect ratio", where, problems);
        check_range(static_cast<double>(camera.lens_radius), 0.0, kUnbounded, "lens radius", where, problems);
        if (!(camera.focus_distance > 0.0f && std::isfinite(camera.focus_distance))) {
            problems.error(where, fmt::format("focus distance is {}, but must be above 0", camera.focus_distance));
        }
        check_view(camera, problems);
        if (!is_invertible(camera.to_world)) {
            problems.error(where, "the camera's transform is singular, not affine or not finite");
        }
        check_motion(camera.motion, where, problems);
    }
}

void validate_lights(const SceneDesc& scene, ProblemList& problems) {
    for (const IesProfileDesc& profile : scene.ies_profiles) validate_profile(profile, problems);
    for (const LightDesc& light : scene.lights) {
        const SourceLocation& where = light.location;
        check_range(light.color, 0.0, kUnbounded, "light colour", where, problems);
        check_range(static_cast<double>(light.intensity), 0.0, kUnbounded, "light intensity", where, problems);
        if (!is_invertible(light.to_world)) {
            problems.error(where, "the light's transform is singular, not affine or not finite");
        } else {
            check_motion(light.motion, where, problems);
        }
        if (light.profile) {
            check_handle(light.profile, scene.ies_profiles, "IES profile", where, problems);
            if (light.type == LightType::Directional)
                problems.error(where, "a directional light has no position from which an IES profile could shine");
        }
        if (!(light.angle >= 0.0f && light.angle < kPi))
            problems.error(where, fmt::format("the sun's angle is {}, but must be in [0, pi)", light.angle));
        if (light.type == LightType::Spot) check_cones(light.inner_cone_angle, light.outer_cone_angle, where, problems);
    }
    const EnvironmentDesc& environment = scene.environment;
    if (!environment.enabled) return;
    if (environment.cube) {
        for (const Handle<ImageDesc>& face : environment.cube->faces)
            check_handle(face, scene.images, "image", environment.location, problems);
        check_range(static_cast<double>(environment.cube->intensity), 0.0, kUnbounded, "environment intensity",
                    environment.location, problems);
        if (!is_invertible(environment.cube->to_world))
            problems.error(environment.location, "the cube map's transform is singular, not affine or not finite");
    }
    check_range(environment.color, 0.0, kUnbounded, "environment colour", environment.location, problems);
    check_range(static_cast<double>(environment.scale), 0.0, kUnbounded, "environment scale", environment.location,
                problems);
    if (const Rgb radiance = environment.color * environment.scale; std::isinf(max_component(radiance)))
        problems.error(environment.location, "the environment's colour times its scale is infinite");
    check_range(static_cast<double>(environment.rotation), -std::numeric_limits<float>::max(), kUnbounded,
                "environment rotation", environment.location, problems);
}

void validate_settings(const SceneDesc& scene, ProblemList& problems) {
    const RenderSettings& settings = scene.settings;
    const IntegratorSettings& integrator = settings.integrator;
    validate_ranges(settings, problems);
    if (integrator.type.empty()) problems.error(settings.at("/integrator/type"), "the integrator has no name");
    if (integrator.lengths.min_depth > integrator.lengths.max_depth) {
        // Where either was set last: the command line is read after render.json.
        const bool is_option = settings.options.contains("/integrator/min_depth");
        problems.error(settings.at(is_option ? "/integrator/min_depth" : "/integrator/max_depth"),
                       fmt::format("min_depth {} is above max_depth {}: no path would be kept",
                                   integrator.lengths.min_depth, integrator.lengths.max_depth));
    }
    if (integrator.strategy) {
        if (const Strategy& strategy = *integrator.strategy; strategy != kMerges && !strategy.exists())
            problems.error(settings.at("/integrator/strategy"),
                           fmt::format("there is no strategy {},{}: s >= 0 vertices from the light and t >= 1 from the "
                                       "eye make a path of s + t - 1 >= 1 edges",
                                       strategy.s, strategy.t));
    }
    if (!integrator.weighted && !integrator.strategy)
        problems.error(settings.at("/integrator/weighted"),
                       "strategies without weights sum to more than the image; one of them can be shown without "
                       "weights: name it as strategy");
    validate_crop(settings, problems);
    validate_overscan(settings, problems);
    validate_camera_name(scene, problems);
    validate_variant(scene, problems);
}

}  // namespace etendue
