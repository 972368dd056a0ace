#include "core/position_error.h"
#include "world/compile_parts.h"
#include "world/contacts.h"
#include "world/light_pose.h"
#include "world/motion.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace etendue {

namespace {

/// The tables of the scene's profiles; lamps share them.
std::vector<std::shared_ptr<const IesProfile>> compile_profiles(const SceneDesc& scene) {
    std::vector<std::shared_ptr<const IesProfile>> profiles;
    profiles.reserve(scene.ies_profiles.size());
    for (const IesProfileDesc& desc : scene.ies_profiles)
        profiles.push_back(std::make_shared<const IesProfile>(desc.vertical, desc.horizontal, desc.candela));
    return profiles;
}

/// Returns the steps of the motion of a light without a surface, as far as they change its light; empty if it stands
/// still. Returns none if the light cannot follow its motion: a sun has a single direction, and other lights must move
/// rigidly.
std::optional<TransformMotion> motion_of_punctual(const LightDesc& desc) {
    TransformMotion motion = desc.motion;
    if (desc.type == LightType::Directional) {
        const auto axis = [](const Mat4f& m) { return Vec3f(m[2][0], m[2][1], m[2][2]); };
        constexpr float kLeastTurn = 1e-4f;  // radians
        const bool turns = std::ranges::any_of(
            motion, [&](const Mat4f& m) { return length(axis(m) - axis(motion.front())) > kLeastTurn; });
        return turns ? std::nullopt : std::optional<TransformMotion>(std::in_place);
    }
    // A point emits alike in all directions, so that only its place counts.
    if (desc.type == LightType::Point && !desc.profile)
        for (Mat4f& step : motion)
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) step[r][c] = r == c ? 1.0f : 0.0f;
    if (!motion.empty() && !rigid_motion(motion)) return std::nullopt;
    return motion;
}

/// `scale` turns the units of lamps into those of the image.
Light compile_punctual(const LightDesc& desc, const Mat4f& to_world,
                       std::span<const std::shared_ptr<const IesProfile>> profiles, float scale,
                       const ColorMatrix& from_rec709) {
    const Vec3f position = transform_point(to_world, Vec3f(0.0f));
    const Vec3f axis = normalize(transform_vector(to_world, {0.0f, 0.0f, -1.0f}));
    const Rgb intensity = clamp_negative(from_rec709(desc.color)) * (desc.intensity * scale);
    if (desc.type == LightType::Directional)
        return desc.angle > 0.0f ? Light(SunLight(axis, intensity, desc.angle))
                                 : Light(DirectionalLight{axis, intensity});

    const PointLight point{position, intensity};
    const SpotLight spot{position, axis, intensity, std::cos(desc.inner_cone_angle), std::cos(desc.outer_cone_angle)};
    const bool is_spot = desc.type == LightType::Spot;
    if (!desc.profile) return is_spot ? Light(spot) : Light(point);
    ProfileLight light;
    if (is_spot)
        light.lamp = spot;
    else
        light.lamp = point;
    light.frame = Frame::from_normal_and_tangent(-axis, transform_vector(to_world, {1.0f, 0.0f, 0.0f}));
    light.profile = profiles[static_cast<std::size_t>(desc.profile.index)];
    return light;
}

/// Returns the frame of a light of `instance` (world/light_pose.h).
Mat4f frame_of_lamp(const WorldData& data, const Instance& instance) {
    return instance.motion == kNone ? instance.to_world : frame_of(data.motions[instance.motion]);
}

std::vector<LightTriangle> world_triangles(const Geometry& geometry, const Instance& instance, const Mat4f& to_world) {
    std::vector<LightTriangle> triangles;
    triangles.reserve(geometry.triangles.size());
    for (const auto& t : geometry.triangles) {
        Vec3f p[3] = {geometry.positions[t[0]], geometry.positions[t[1]], geometry.positions[t[2]]};
        if (!instance.baked)
            for (Vec3f& corner : p) corner = transform_point(to_world, corner);
        triangles.push_back({p[0], p[1] - p[0], p[2] - p[0]});
    }
    return triangles;
}

Vec3f mesh_position_error(const WorldData& data, const Geometry& geometry, const Instance& instance) {
    Vec3f extent(0.0f);
    for (const Vec3f& p : geometry.positions) extent = max_components(extent, abs_components(p));
    if (instance.baked) return position_error(extent);
    Vec3f error = position_error(extent, instance.to_world);
    if (instance.motion != kNone)
        for (const Mat4f& step : data.motions[instance.motion])
            error = max_components(error, position_error(extent, step));
    return error;
}

Rgb mean_emission(const WorldData& data, const Material& material) {
    Rgb mean = material.emission;
    if (material.emission_texture.valid()) {
        const Texture& texture = data.textures[static_cast<std::size_t>(material.emission_texture.texture)];
        mean = clamp_negative(data.from_rec709(mean * texture.mean().rgb));
    }
    return mean;
}

/// Counts the emitting surfaces and triangles that are found by chance only, and why.
struct UnsampledEmitters {
    std::size_t skipped = 0;  ///< triangles beyond the limit
    std::size_t moving = 0;   ///< surfaces that deform, change their size or turn fast
    std::size_t uneven = 0;   ///< elliptic cylinders
};

/// Adds the light of what the geometry `index` of instance `i` emits, which fills `slot`. Returns false if its shape
/// cannot be sampled.
bool add_surface_light(std::size_t i, std::uint32_t index, std::uint32_t slot, WorldData& data) {
    const Instance& instance = data.instances[i];
    const Geometry& geometry = data.geometries[index];
    const Material& material = data.materials[geometry.material];
    const bool shares_place = !data.shares_place_of_slot.empty() && data.shares_place_of_slot[slot] != 0;
    const bool uniform = !material.emission_texture.valid() && material.alpha_test == AlphaTest::Opaque &&
                         !material.has_coat && !shares_place && material.beam.is_diffuse();
    // Rays from it and to it pass what touches it.
    const float reach = data.contacts ? 1.5f * data.contacts->reach(slot) : 0.0f;
    const Vec3f error = max_components(mesh_position_error(data, geometry, instance), Vec3f(reach));
    const Mat4f to_world = frame_of_lamp(data, instance);
    const auto light_number = static_cast<std::uint32_t>(data.lights.size());
    if (geometry.shape) {
        const ExactShape shape = geometry.shape->placed(to_world);
        if (!ShapeLight::can_be(shape)) return false;
        data.lights.emplace_back(ShapeLight(shape, material.emission, mean_emission(data, material),
                                            material.emits_both_sides, uniform, error, material.beam));
    } else {
        MeshLight light(world_triangles(geometry, instance, to_world), material.emission, mean_emission(data, material),
                        material.emits_both_sides, instance.mirrors, uniform, error, material.beam);
        if (!(light.area() > 0.0f)) return true;
        data.lights.emplace_back(std::move(light));
    }
    data.light_of_slot[slot] = light_number;
    data.emitter_of_light.push_back({.instance = static_cast<std::uint32_t>(i), .geometry = index});
    return true;
}

/// Gives the last light of `data` its motion, made by `rigid_motion`.
void set_motion_of_last_light(TransformMotion motion, WorldData& data) {
    data.motion_of_light.resize(data.lights.size());
    data.motion_of_light.back() = std::move(motion);
}

void note_unsampled(const UnsampledEmitters& unsampled, std::size_t most_triangles, ProblemList& problems) {
    if (unsampled.uneven > 0)
        problems.note({}, std::to_string(unsampled.uneven) +
                              " emissive elliptic cylinders will be found by chance only: small ones give noise. Scale "
                              "them evenly to have them sampled");
    if (unsampled.moving > 0)
        problems.note({}, std::to_string(unsampled.moving) +
                              " emissive surfaces deform, change their size or turn fast while the shutter is open and "
                              "will be found by chance only: small ones give noise");
    if (unsampled.skipped > 0)
        problems.warning({}, std::to_string(unsampled.skipped) + " emissive triangles are beyond the limit of " +
                                 std::to_string(most_triangles) +
                                 " for light sampling and will be found by chance only: expect noise");
}

void compile_mesh_lights(std::size_t most_triangles, WorldData& data, ProblemList& problems) {
    UnsampledEmitters unsampled;
    std::size_t triangle_count = 0;
    for (std::size_t i = 0; i < data.instances.size(); ++i) {
        const Instance& instance = data.instances[i];
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
            const std::uint32_t index = instance.first_geometry + g;
            const Geometry& geometry = data.geometries[index];
            if (!data.materials[geometry.material].emits || geometry.is_empty()) continue;
            std::optional<TransformMotion> motion;
            if (instance.motion != kNone) motion = rigid_motion(data.motions[instance.motion]);
            if ((instance.motion != kNone && !motion) || !geometry.motion.empty()) {
                ++unsampled.moving;
                continue;
            }
            if (triangle_count + geometry.triangles.size() > most_triangles) {
                unsampled.skipped += geometry.triangles.size();
                continue;
            }
            triangle_count += geometry.triangles.size();
            const std::size_t before = data.lights.size();
            if (!add_surface_light(i, index, instance.first_light_slot + g, data)) ++unsampled.uneven;
            if (motion && data.lights.size() > before) set_motion_of_last_light(std::move(*motion), data);
        }
    }
    data.has_unsampled_emitters = unsampled.moving > 0 || unsampled.skipped > 0 || unsampled.uneven > 0;
    note_unsampled(unsampled, most_triangles, problems);
}

}  // namespace

void compile_lights(const SceneDesc& scene, const ThreadPool& threads, WorldData& data, ProblemList& problems,
                    std::size_t most_triangles) {
    const auto profiles = compile_profiles(scene);
    const float scale = scene.settings.light_units == LightUnits::Radiometric ? 1.0f / kLumensPerWatt : 1.0f;
    std::size_t without_motion = 0;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const LightDesc& desc = scene.lights[i];
        if (!(desc.intensity > 0.0f) || !(max_component(desc.color) > 0.0f)) continue;
        const std::optional<TransformMotion> motion = motion_of_punctual(desc);
        if (!motion) ++without_motion;
        const bool moves = motion && !motion->empty();
        data.lights.push_back(
            compile_punctual(desc, moves ? frame_of(*motion) : desc.to_world, profiles, scale, data.from_rec709));
        if (moves) set_motion_of_last_light(*rigid_motion(*motion), data);
        data.emitter_of_light.push_back({.lamp = static_cast<std::uint32_t>(i)});
    }
    if (without_motion > 0)
        problems.note({}, std::to_string(without_motion) +
                              " suns that turn, or spots that turn fast, while the shutter is open keep the place and "
                              "the direction that they have in the middle of that time");
    compile_mesh_lights(most_triangles, data, problems);
    if (scene.environment.enabled) {
        data.environment = static_cast<std::uint32_t>(data.lights.size());
        data.environment_visible = scene.environment.visible_to_camera;
        data.lights.push_back(compile_environment(scene, data.from_rec709, threads, problems));
        data.emitter_of_light.emplace_back();
        data.lights_met_afar.push_back(data.environment);
    }
    if (!data.motion_of_light.empty()) data.motion_of_light.resize(data.lights.size());
    for (std::uint32_t light = 0; light < data.lights.size(); ++light)
        if (std::holds_alternative<SunLight>(data.lights[light])) data.lights_met_afar.push_back(light);
}

}  // namespace etendue
