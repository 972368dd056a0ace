#include "world/world.h"

#include "bsdf/ggx.h"
#include "bsdf/widening.h"
#include "core/position_error.h"
#include "core/vector_bytes.h"
#include "world/cone_section.h"
#include "world/contacts.h"
#include "world/embree_scene.h"
#include "world/gltf_surface.h"
#include "world/interpolation.h"
#include "world/lookup.h"
#include "world/material_evaluation.h"
#include "world/motion.h"
#include "world/plain_lookups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace etendue {

namespace {

float opacity_callback(const void* data, std::uint32_t geometry, std::uint32_t triangle, Vec2f barycentric) {
    return evaluate_opacity(*static_cast<const WorldData*>(data), geometry, triangle, barycentric);
}

/// Is the middle of the time, [0, 1], in which the shutter is open.
constexpr float kMiddle = 0.5f;

float radius_of(const Bounds& bounds) {
    const float radius = 0.5f * length(bounds.size());
    return radius > 0.0f ? radius : 1.0f;
}

/// True if the material mirrors or refracts without roughness; textured roughness is taken not to reach zero.
bool is_specular(const Material& material) {
    if (material.unlit) return false;
    if (const Bsdf* constant = std::get_if<Bsdf>(&material.model)) return !has_non_delta(*constant);
    const GltfModel& model = std::get<GltfModel>(material.model);
    return model.roughness * model.roughness < kSmoothAlpha ||
           (model.layers && model.layers->clearcoat > 0.0f &&
            model.layers->clearcoat_roughness * model.layers->clearcoat_roughness < kSmoothAlpha);
}

/// True if what the model evaluates to depends on nothing about a point but its vertex colour. A coat has a normal of
/// its own, which differs from the base's by rounding at least.
bool is_uniform(const GltfModel& model) {
    return !model.is_textured() && !(model.layers && model.layers->clearcoat > 0.0f);
}

/// Evaluates the materials that are the same everywhere, once for all points.
void evaluate_uniform_materials(WorldData& data) {
    std::vector<bool> is_colored(data.materials.size());
    for (const Geometry& geometry : data.geometries)
        if (!geometry.colors.empty()) is_colored[geometry.material] = true;
    for (std::size_t i = 0; i < data.materials.size(); ++i) {
        Material& material = data.materials[i];
        const GltfModel* model = std::get_if<GltfModel>(&material.model);
        if (model != nullptr && is_uniform(*model) && !is_colored[i])
            material.uniform = evaluate_gltf_surface(data, *model, SurfacePoint{}, 0.0f, false);
    }
}

/// Most bytes of geometry and of the BVH over it that are expected to stay in a second-level cache. Less is not fetched
/// ahead.
constexpr std::size_t kCachedGeometry = std::size_t{2} << 20;

std::size_t geometry_bytes(const WorldData& data) {
    std::size_t bytes = 0;
    for (const Geometry& g : data.geometries) {
        bytes += vector_bytes(g.positions, g.normals, g.tangents, g.uv0, g.uv1, g.colors, g.triangles);
        for (const VertexStep& step : g.motion) bytes += vector_bytes(step.positions, step.normals);
    }
    return bytes;
}

/// The interface of a dielectric between other indices than it was made for.
Bsdf with_relative_ior(const Bsdf& bsdf, float relative_ior) {
    const auto* rough = std::get_if<RoughDielectric>(&bsdf);
    const Vec2f alpha = rough != nullptr ? Vec2f(rough->alpha_x, rough->alpha_y) : Vec2f(0.0f, 0.0f);
    return std::visit([](const auto& interface) { return Bsdf(interface); },
                      make_interface(relative_ior, alpha, Rgb(1.0f), {}));
}

}  // namespace

WorldData::WorldData() = default;
WorldData::~WorldData() = default;
WorldData::WorldData(WorldData&&) noexcept = default;
WorldData& WorldData::operator=(WorldData&&) noexcept = default;

World::World(WorldData data)
    : data_(std::make_unique<WorldData>(std::move(data))),
      selector_(data_->lights, radius_of(data_->bounds)),
      tree_(data_->lights, radius_of(data_->bounds)) {
    data_->bvh->set_opacity(opacity_callback, data_.get());
    if (data_->panes) data_->panes->set_opacity(opacity_callback, data_.get());
    if (data_->contacts) data_->contacts->set_opacity(opacity_callback, data_.get());
    chooses_lights_by_receiver_ =
        tree_.depends_on_receiver() || std::ranges::any_of(data_->lights, [](const Light& light) {
            const MeshLight* mesh = std::get_if<MeshLight>(&light);
            return mesh != nullptr && mesh->has_opposites();
        });
    has_far_triangles_ = geometry_bytes(*data_) + data_->bvh->bytes() > kCachedGeometry;
    evaluate_uniform_materials(*data_);
    plain_surfaces_ = find_plain_surfaces(*data_);
    has_motion_ = data_->bvh->has_motion() || !data_->camera_motion.empty();
    has_transparency_ = std::any_of(data_->materials.begin(), data_->materials.end(),
                                    [](const Material& m) { return m.alpha_test != AlphaTest::Opaque; });
    has_delta_lights_ = std::any_of(data_->lights.begin(), data_->lights.end(), is_delta_light);
    has_scattering_bodies_ = std::any_of(data_->fillings.begin(), data_->fillings.end(),
                                         [](const Filling& f) { return f.medium.scatters(); });
    if (has_bodies()) camera_interior_ = interior_at(generate_ray({0.5f, 0.5f}, {0.5f, 0.5f}, kMiddle).origin);
    // Without its walls, a body around the camera would have no end.
    if (!camera_interior_.is_empty()) data_->camera = without_far_clip(data_->camera);
    clips_far_ = !std::isinf(clip_of(data_->camera).end);
    if (has_bodies()) {
        // Where a ray starts that leaves the middle of the light on its front.
        const EmissionNumbers front{{0.5f, 0.5f}, {0.5f, 0.5f}, {0.25f, 0.5f}};
        for (const Light& light : data_->lights) {
            const EmissionSample middle = etendue::sample_emission(light, front, scene_sphere());
            light_interiors_.push_back(interior_at(middle.origin(middle.direction)));
        }
        has_lights_in_media_ = has_sampled_lights() &&
                               std::any_of(light_interiors_.begin(), light_interiors_.end(), [&](const Interior& i) {
                                   const HomogeneousMedium* around = medium(i);
                                   return around != nullptr && around->scatters();
                               });
    }
    const auto has_surface = [&](const auto& is_such) {
        return std::any_of(data_->geometries.begin(), data_->geometries.end(),
                           [&](const Geometry& g) { return is_such(data_->materials[g.material]); });
    };
    has_specular_surfaces_ = has_surface(is_specular);
    has_unlit_surfaces_ = has_surface([](const Material& material) { return material.unlit; });
    has_emitting_surfaces_ = has_surface([](const Material& material) { return material.emits; });
    for (const Light& light : data_->lights)
        if (const auto* mesh = std::get_if<MeshLight>(&light)) lamp_bounds_.push_back(mesh->bounds().box);
    constexpr std::size_t kMostBounds = 1024;
    if (lamp_bounds_.size() > kMostBounds) lamp_bounds_ = {data_->bounds};
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, QueryForm form) const {
    data_->bvh->occluded(rays, occluded, form);
}

void World::occluded(const RayColumns& rays, std::span<std::uint8_t> occluded, QueryForm form) const {
    data_->bvh->occluded(rays, occluded, form);
}

double World::replay(std::span<const Ray> rays, bool occlusion, Coherence coherence, QueryForm form) const {
    return data_->bvh->replay(rays, occlusion, coherence, form);
}

SurfacePoint World::surface_point(const Hit& hit) const {
    return make_surface_point(*data_, hit.instance, hit.geometry, hit.triangle, {hit.u, hit.v}, hit.time,
                              ConeSection{});
}

SurfacePoint World::surface_point(const Hit& hit, const Ray& ray, const RayCone& cone) const {
    if (hit.in_contact) {
        const Contact contact = data_->contacts->at(*data_, ray, hit);
        return contact_point(contact, contact.faces[0], ray, cone);
    }
    return make_surface_point(*data_, hit.instance, hit.geometry, hit.triangle, {hit.u, hit.v}, hit.time,
                              ConeSection{ray.direction, std::abs(cone.width_at(hit.t))});
}

HitCoordinates World::hit_coordinates(const Hit& hit, const PlainSurface& surface) const {
    const Geometry& geometry = data_->geometries[hit.geometry];
    const std::vector<Vec2f>& uv = surface.texcoord == 0 ? geometry.uv0 : geometry.uv1;
    if (uv.empty()) return {};
    const auto& triangle = geometry.triangles[hit.triangle];
    const Vec2f uv0 = uv[triangle[0]];
    return {uv0, uv[triangle[1]] - uv0, uv[triangle[2]] - uv0};
}

void World::add_lookups(const PlainSurface& surface, Vec2f uv, const TextureFootprint& footprint,
                        PlainLookups& lookups) const {
    for (const TextureSlot* slot :
         {&surface.textured->base_color_texture, &surface.textured->metallic_roughness_texture})
        if (slot->valid())
            lookups.add(data_->textures[static_cast<std::size_t>(slot->texture)], transform_point(*slot, uv),
                        transform_footprint(*slot, footprint));
}

MetallicRoughness World::lobe(const PlainSurface& surface, PlainLookups& lookups) const {
    const auto texel = [&](const TextureSlot& slot) { return slot.valid() ? lookups.take() : Rgb(1.0f); };
    const Rgb base_color = texel(surface.textured->base_color_texture);
    return surface.lobe(*data_, base_color, texel(surface.textured->metallic_roughness_texture));
}

void World::fetch_far_triangles(std::span<const Hit> hits) const {
    // First all that say where the vertices are, so that these, too, arrive together.
    for (const Hit& hit : hits)
        if (hit.valid()) __builtin_prefetch(&data_->geometries[hit.geometry].triangles[hit.triangle]);
    for (const Hit& hit : hits) {
        if (!hit.valid()) continue;
        const Geometry& geometry = data_->geometries[hit.geometry];
        for (const std::uint32_t vertex : geometry.triangles[hit.triangle]) {
            __builtin_prefetch(&geometry.positions[vertex]);
            if (!geometry.normals.empty()) __builtin_prefetch(&geometry.normals[vertex]);
        }
    }
}

float World::mean_curvature(const Hit& hit) const {
    return etendue::mean_curvature(*data_, hit);
}

const Bsdf& World::bsdf(const SurfacePoint& point, const Vec3f& wo, float relative_ior, Bsdf& storage) const {
    const Material& material = *point.material;
    if (const auto* model = std::get_if<GltfModel>(&material.model)) {
        // Only a body's interface depends on what is around it.
        const bool as_in_vacuum = !model->refracts || relative_ior == 0.0f || relative_ior == model->ior;
        if (material.uniform && as_in_vacuum && !point.has_spread_slopes()) return *material.uniform;
        storage = evaluate_gltf_surface(*data_, *model, point, relative_ior, dot(wo, point.geometric_normal) < 0.0f);
        return storage;
    }
    const Bsdf& constant = std::get<Bsdf>(material.model);
    // Compiled for vacuum around it.
    const bool as_compiled = relative_ior == 0.0f || relative_ior == data_->fillings[material.filling].ior;
    if (as_compiled && !point.has_spread_slopes()) return constant;
    storage = as_compiled ? constant : with_relative_ior(constant, relative_ior);
    if (point.has_spread_slopes()) storage = widened(storage, point.slope_variance);
    return storage;
}

Rgb World::emission(const SurfacePoint& point, const Vec3f& wo) const {
    const Material& material = *point.material;
    if (!material.emits) return {};
    const bool from_back = dot(wo, point.geometric_normal) <= 0.0f;
    if (!material.emits_both_sides && from_back) return {};
    Rgb emitted = evaluate_emission(*data_, material, point);
    if (material.has_coat) {
        const GltfModel& model = std::get<GltfModel>(material.model);
        emitted *= evaluate_clear_coat(*data_, *model.layers, point, false).passed(abs_dot(wo, point.coat_normal));
    }
    return emitted;
}

Rgb World::unlit_color(const SurfacePoint& point) const {
    return evaluate_base_color(*data_, std::get<GltfModel>(point.material->model), point);
}

float Crossing::relative_ior(float nm) const {
    return dispersed_ior(inside_ior, inside_dispersion, nm) / dispersed_ior(outside_ior, outside_dispersion, nm);
}

Crossing World::crossing(const SurfacePoint& point, const Interior& current) const {
    const std::uint32_t body = data_->body_of_slot[slot_of(*data_, point.instance, point.geometry)];
    Crossing crossing{.outside = current, .inside = current};
    crossing.outside.leave(body);
    crossing.inside = crossing.outside;
    crossing.inside.enter(body);
    crossing.is_hidden = crossing.inside.filling() != body;
    set_indices(body, crossing);
    return crossing;
}

void World::set_indices(std::uint32_t body, Crossing& crossing) const {
    const Filling& inside = data_->fillings[data_->filling_of_body[body]];
    crossing.inside_ior = inside.ior;
    crossing.inside_dispersion = inside.dispersion;
    if (const std::uint32_t around = crossing.outside.filling(); around != kNone) {
        const Filling& outside = data_->fillings[data_->filling_of_body[around]];
        crossing.outside_ior = outside.ior;
        crossing.outside_dispersion = outside.dispersion;
    }
}

const HomogeneousMedium* World::medium_within(const Interior& interior) const {
    const std::uint32_t body = interior.filling();
    const HomogeneousMedium& medium = data_->fillings[data_->filling_of_body[body]].medium;
    return medium.is_empty() ? nullptr : &medium;
}

Interior World::interior_at(const Vec3f& point) const {
    // A body that the ray leaves more often than it enters is one that it began in.
    constexpr int kMostBoundaries = 4096;
    std::map<std::uint32_t, int> left;
    Ray ray;
    ray.origin = point;
    ray.direction = {0.0f, 1.0f, 0.0f};
    ray.time = kMiddle;
    for (int i = 0; i < kMostBoundaries; ++i) {
        Hit hit;
        intersect({&ray, 1}, {&hit, 1}, Coherence::Incoherent, QueryForm::Single);
        if (!hit.valid()) break;
        const SurfacePoint surface = surface_point(hit, ray, RayCone{});
        if (hit.in_contact) {
            const Contact contact = data_->contacts->at(*data_, ray, hit);
            for (const std::uint32_t body : bodies_of(*data_, contact)) {
                const auto [is_entered, is_left] = passes(*data_, contact, body, ray.direction);
                left[body] += (is_left ? 1 : 0) - (is_entered ? 1 : 0);
            }
        } else if (is_boundary(surface)) {
            left[body_of(*data_, hit)] += dot(ray.direction, surface.geometric_normal) > 0.0f ? 1 : -1;
        }
        ray.origin = offset_origin(surface.position, surface.geometric_normal, surface.clearance, ray.direction);
    }
    Interior interior;
    for (const auto& [body, count] : left)
        if (count > 0) interior.enter(body);
    return interior;
}

ChosenLight World::sample_light(const LightTree::Choice& choice, const Vec3f& point, const LightNumbers& u) const {
    const Light& light = data_->lights[choice.light];
    ChosenLight chosen{sample_light_compensated(light, point, u.triangle, u.direction), choice.probability,
                       choice.light};
    LightSample& sample = chosen.sample;
    sample.pdf_solid_angle *= choice.probability;
    for (const Vec3f& plane : planes_of(choice.light)) sample.end += dot(plane, sample.wi) <= 0.0f ? plane : -plane;
    if (!is_black(sample.radiance) && has_uneven_emission(choice.light))
        sample.radiance = mesh_emission(choice.light, sample.triangle, sample.barycentric, -sample.wi);
    return chosen;
}

void World::sample_environment_light(std::span<const Vec2f> u, std::span<LightSample> samples) const {
    sample_environment_compensated(data_->lights[data_->environment], u, samples);
}

void World::choose_lights(std::span<const LightReceiver> receivers, std::span<const Vec2f> u,
                          std::span<LightTree::Choice> choices) const {
    tree_.sample(receivers, u, choices);
    for (const LightTree::Choice& choice : choices) __builtin_prefetch(&data_->lights[choice.light]);
}

bool World::has_uneven_emission(std::uint32_t light) const {
    const MeshLight* mesh = std::get_if<MeshLight>(&data_->lights[light]);
    return mesh != nullptr && !mesh->is_uniform();
}

Rgb World::mesh_emission(std::uint32_t light, std::uint32_t triangle, Vec2f barycentric, const Vec3f& direction) const {
    // Surfaces that move are no lights, so that any time will do.
    constexpr float kAnyTime = 0.0f;
    const Emitter& emitter = data_->emitter_of_light[light];
    const SurfacePoint point =
        make_surface_point(*data_, emitter.instance, emitter.geometry, triangle, barycentric, kAnyTime, ConeSection{});
    if (!is_foremost_emitter(point, barycentric, direction)) return {};
    return emission(point, direction) * evaluate_opacity(*data_, emitter.geometry, triangle, barycentric);
}

Emission World::sample_emission(Vec2f u_light, const EmissionNumbers& u, float time) const {
    const AliasTable::Choice choice = selector_.sample(u_light);
    Emission emission;
    emission.light = choice.index;
    emission.probability = choice.probability;
    EmissionSample& sample = emission.sample;
    sample = etendue::sample_emission(data_->lights[choice.index], u, scene_sphere());
    if (is_black(sample.radiance)) return emission;
    if (has_uneven_emission(choice.index))
        sample.radiance = mesh_emission(choice.index, sample.triangle, sample.barycentric, sample.direction);
    emission.weight = sample.weight() / choice.probability;
    emission.ray.origin = sample.origin(sample.direction);
    for (const Vec3f& plane : planes_of(choice.index))
        emission.ray.origin += dot(plane, sample.direction) >= 0.0f ? plane : -plane;
    emission.ray.direction = sample.direction;
    emission.ray.time = time;
    return emission;
}

SurfaceEmission World::surface_emission(const Emission& emission, const Vec3f& direction) const {
    const MeshLight* mesh = std::get_if<MeshLight>(&data_->lights[emission.light]);
    if (mesh == nullptr) return {};
    const EmissionSample& sample = emission.sample;
    const LightTriangle& t = mesh->triangle(sample.triangle);
    return {mesh_emission(emission.light, sample.triangle, sample.barycentric, direction),
            abs_dot(triangle_normal(t.edge1, t.edge2), direction)};
}

std::uint32_t World::light_at(const SurfacePoint& point) const {
    return data_->light_of_slot[slot_of(*data_, point.instance, point.geometry)];
}

float World::emitter_pdf_solid_angle(const LightReceiver& from, const SurfacePoint& point, const Vec3f& direction,
                                     float distance) const {
    const std::uint32_t light = light_at(point);
    if (light == kNone) return 0.0f;
    const float cos_light = -dot(direction, point.geometric_normal);
    return std::get<MeshLight>(data_->lights[light])
               .pdf_solid_angle(point.triangle, from.position, distance, cos_light) *
           light_probability(from, light);
}

float World::emitter_pdf_area(std::uint32_t light) const {
    return 1.0f / std::get<MeshLight>(data_->lights[light]).area();
}

float World::light_sample_gain(std::uint32_t light, std::uint32_t triangle, const Vec3f& point) const {
    const MeshLight* mesh = std::get_if<MeshLight>(&data_->lights[light]);
    return mesh != nullptr ? mesh->gain(triangle, point) : 1.0f;
}

Rgb World::environment_radiance(const Vec3f& direction) const {
    return has_environment() ? etendue::environment_radiance(data_->lights[data_->environment], direction) : Rgb();
}

float World::environment_pdf_solid_angle(const Vec3f& direction) const {
    if (!has_environment()) return 0.0f;
    return compensated_environment_pdf_solid_angle(data_->lights[data_->environment], direction);
}

void World::look_at_environment(std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen) const {
    etendue::look_at_environment(data_->lights[data_->environment], directions, seen);
}

float World::environment_emission_pdf_solid_angle(const Vec3f& direction) const {
    if (!has_environment()) return 0.0f;
    return etendue::environment_pdf_solid_angle(data_->lights[data_->environment], direction);
}

LightSample World::sample_environment(const Vec3f& point, Vec2f u) const {
    if (!has_environment()) return {};
    return etendue::sample_light(data_->lights[data_->environment], point, u, u);
}

Camera World::camera_at(float time) const {
    return with_pose(data_->camera, CameraPose::from_matrix(transform_at(data_->camera_motion, time)));
}

Ray World::generate_ray(Vec2f film, Vec2f lens, float time) const {
    Ray ray = data_->camera_motion.empty() ? etendue::generate_ray(data_->camera, film, lens)
                                           : etendue::generate_ray(camera_at(time), film, lens);
    ray.time = time;
    return ray;
}

void World::generate_rays(std::span<const Vec2f> film, std::span<const Vec2f> lens, std::span<const float> times,
                          std::span<Ray> rays) const {
    if (data_->camera_motion.empty()) {
        etendue::generate_rays(data_->camera, film, lens, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i].time = times[i];
    } else {
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = generate_ray(film[i], lens[i], times[i]);
    }
}

bool World::may_show_lamps(Vec2f least, Vec2f most) const {
    if (has_motion_ || has_lens() || is_panoramic(data_->camera) || has_unsampled_emitters())
        return has_emitting_surfaces_;
    const std::array<Vec2f, 4> corners{least, Vec2f(most.x, least.y), most, Vec2f(least.x, most.y)};
    const Ray middle = generate_ray((least + most) * 0.5f, Vec2f(0.5f, 0.5f), 0.0f);
    std::array<Ray, 4> rays;
    for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = generate_ray(corners[i], Vec2f(0.5f, 0.5f), 0.0f);
    // Planes through neighbouring corners' rays, whose normals point inwards.
    std::array<Vec3f, 4> normals;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Ray& next = rays[(i + 1) % rays.size()];
        const Vec3f normal = cross(rays[i].direction, next.origin + next.direction - rays[i].origin);
        normals[i] = dot(normal, middle.origin + middle.direction - rays[i].origin) < 0.0f ? -normal : normal;
    }
    return std::ranges::any_of(lamp_bounds_, [&](const Bounds& box) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Vec3f& n = normals[i];
            const Vec3f inmost{n.x < 0.0f ? box.min.x : box.max.x, n.y < 0.0f ? box.min.y : box.max.y,
                               n.z < 0.0f ? box.min.z : box.max.z};
            if (dot(n, inmost - rays[i].origin) < 0.0f) return false;
        }
        return true;
    });
}

CameraConnection World::connect_to_camera(const Vec3f& point, Vec2f lens, float time) const {
    return data_->camera_motion.empty() ? connect(data_->camera, point, lens) : connect(camera_at(time), point, lens);
}

float World::depth(const Vec3f& point, float time) const {
    return camera_depth(data_->camera_motion.empty() ? data_->camera : camera_at(time), point);
}

bool World::is_too_far(const Ray& ray, const Hit& hit) const {
    return hit.valid() && depth(ray.origin + ray.direction * hit.t, ray.time) > clip_of(data_->camera).end;
}

float World::bounding_radius() const {
    return radius_of(data_->bounds);
}

WorldStatistics World::statistics() const {
    WorldStatistics s;
    s.geometry_bytes = geometry_bytes(*data_);
    for (const Geometry& g : data_->geometries) s.triangles += g.triangles.size();
    for (const Instance& instance : data_->instances)
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
            s.instanced_triangles += data_->geometries[instance.first_geometry + g].triangles.size();
    s.instance_bytes = vector_bytes(data_->instances, data_->motions, data_->filling_of_body, data_->body_of_slot);
    for (const TransformMotion& motion : data_->motions) s.instance_bytes += vector_bytes(motion);
    s.material_bytes =
        vector_bytes(data_->materials, data_->fillings, plain_surfaces_.of_material, plain_surfaces_.of_geometry);
    s.textures = data_->textures.size();
    s.missing_textures = data_->missing_textures;
    for (const Texture& texture : data_->textures) s.texture_bytes += texture.bytes();
    if (data_->texture_cache) {
        s.texture_bytes = static_cast<std::size_t>(data_->texture_cache->bytes());
        s.textures_cached = true;
        s.texture_cache_budget = data_->texture_cache->budget();
        s.failed_texture_lookups = data_->texture_cache->failed_lookups();
        s.first_texture_failure = data_->texture_cache->first_failure();
    }
    s.instances = data_->instances.size();
    s.lights = data_->lights.size();
    s.light_bytes =
        selector_.bytes() + tree_.bytes() + vector_bytes(data_->lights, data_->emitter_of_light, data_->light_of_slot);
    for (const Light& light : data_->lights) s.light_bytes += light_bytes(light);
    s.isa = data_->bvh->instruction_set();
    s.bvh_bytes = data_->bvh->bytes() + (data_->panes ? data_->panes->bytes() : 0) +
                  (data_->contacts ? data_->contacts->bytes() : 0);
    s.bvh_build_seconds = data_->bvh->build_seconds();
    s.bvh_quality = EmbreeScene::quality();
    s.compile_phases = data_->compile_phases;
    return s;
}

}  // namespace etendue
