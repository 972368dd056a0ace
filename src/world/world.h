// The scene, compiled: geometry in Embree, materials, lights and a camera. Immutable, so that any number of threads may
// query it; queries come in batches, because that is what makes them fast (docs/optimisation.md).
#pragma once

#include "bsdf/bsdf.h"
#include "bsdf/spectral_response.h"
#include "camera/camera.h"
#include "core/bounds.h"
#include "core/ray.h"
#include "core/ray_columns.h"
#include "core/ray_cone.h"
#include "light/light.h"
#include "light/light_tree.h"
#include "texture/texture.h"
#include "world/body.h"
#include "world/geometry.h"
#include "world/interpolation.h"
#include "world/material.h"
#include "world/plain_surface.h"
#include "world/surface_point.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

class Contacts;
class EmbreeScene;
class PlainLookups;
struct Contact;
struct ContactFace;

/// The nearest surface along a ray. 28 bytes.
struct Hit {
    float t = 0.0f;            ///< metres along the ray
    float u = 0.0f, v = 0.0f;  ///< barycentric coordinates of the second and third vertex
    std::uint32_t triangle = 0;
    std::uint32_t geometry : 31 = 0;
    std::uint32_t in_contact : 1 = 0;  ///< there are other surfaces in this place (world/contacts.h)
    std::uint32_t instance = kNone;    ///< kNone if nothing was hit
    float time = 0.0f;                 ///< the time of the ray: what moves is hit where it was then

    [[nodiscard]] bool valid() const { return instance != kNone; }
};

/// Says what is known about the rays of a batch; decides how they are traced, not what they hit.
enum class Coherence {
    Coherent,    ///< neighbours have similar origins and directions: camera rays
    Incoherent,  ///< anything else
};

/// Answers to a ray that asks whether something is in the way.
inline constexpr std::uint8_t kFree = 0, kOccluded = 1, kPassesPanes = 2;

/// How a batch goes through Embree. The default is what measured best for its coherence; benchmarks compare.
enum class QueryForm { Best, Single, Packet8, Packet16 };

/// Names a step of compiling, and says how long it took.
struct CompilePhase {
    std::string_view name;
    double seconds = 0.0;
};

/// Counts and sizes for reports.
struct WorldStatistics {
    std::size_t triangles = 0;            ///< stored, each shared mesh once
    std::size_t instanced_triangles = 0;  ///< counted as seen, shared meshes as often as they are placed
    std::size_t instances = 0;
    std::size_t lights = 0;
    std::string isa;  ///< the widest instruction set that rays are traced with here
    std::size_t bvh_bytes = 0;
    double bvh_build_seconds = 0.0;
    std::vector<CompilePhase> compile_phases;  ///< in their order, the BVH among them
    std::string bvh_quality;                   ///< how it is built, in words
    std::size_t geometry_bytes = 0;
    std::size_t instance_bytes = 0;  ///< where meshes are placed, how they move, and what bodies they bound
    std::size_t material_bytes = 0;
    std::size_t light_bytes = 0;  ///< of lights, the image of an environment included, and of the choice between them
    std::size_t textures = 0;
    std::size_t missing_textures = 0;          ///< images that could not be read, which materials do without
    std::size_t texture_bytes = 0;             ///< held in memory: all of them, or tiles in the cache
    bool textures_cached = false;              ///< some did not fit, so that all come through a cache
    std::uint64_t texture_cache_budget = 0;    ///< bytes
    std::uint64_t failed_texture_lookups = 0;  ///< that met broken pixels in a file, up to now
    std::string first_texture_failure;
};

/// Says what a light is: a surface, one of the scene's lights without one, or neither, the environment.
struct Emitter {
    std::uint32_t instance = kNone;
    std::uint32_t geometry = kNone;
    std::uint32_t lamp = kNone;  ///< index into SceneDesc::lights
};

/// Everything `compile_world` fills in; the World makes it immutable.
struct WorldData {
    std::vector<Geometry> geometries;
    std::vector<Instance> instances;
    std::vector<TransformMotion> motions;  ///< of the instances that move
    std::vector<Material> materials;
    std::unique_ptr<TextureCache> texture_cache;  ///< null if all textures are resident
    std::vector<Texture> textures;
    std::size_t missing_textures = 0;  ///< images that materials do without
    std::vector<Light> lights;
    std::vector<Emitter> emitter_of_light;     ///< what each light is
    std::vector<std::uint32_t> light_of_slot;  ///< light index of (instance, geometry), kNone if it is not sampled
    bool has_unsampled_emitters = false;       ///< some surface that emits is none of `lights`
    std::uint32_t environment = kNone;         ///< index into `lights`
    bool environment_visible = true;           ///< to camera rays
    Camera camera;
    TransformMotion camera_motion;  ///< camera to world; empty if it stands still
    ColorMatrix from_rec709;        ///< linear Rec.709 to the working space
    XyzToWorking xyz_to_working{};
    SpectralResponse response;
    std::vector<Filling> fillings;               ///< of materials
    std::vector<std::uint32_t> filling_of_body;  ///< bodies by precedence, the first first
    std::vector<std::uint32_t> body_of_slot;     ///< body of (instance, geometry), or kNone; empty without bodies
    Bounds bounds;
    Vec3d origin{0.0};  ///< in the world that the scene's file describes; all else is relative to it
    std::unique_ptr<EmbreeScene> bvh;
    std::unique_ptr<EmbreeScene> panes;  ///< for `collect`; null if there are none
    std::unique_ptr<Contacts> contacts;  ///< null if no surfaces touch for which that matters
    std::vector<std::uint8_t>
        shares_place_of_slot;  ///< 1 for emitters that touch other emitters; empty without contacts
    std::vector<std::vector<Vec3f>>
        planes_of_light;  ///< of each lamp, what takes a ray clear of surfaces that it lies in
    std::vector<CompilePhase> compile_phases;

    WorldData();
    ~WorldData();
    WorldData(WorldData&&) noexcept;
    WorldData& operator=(WorldData&&) noexcept;
};

/// A light chosen for a point, with the choice in its density.
struct ChosenLight {
    LightSample sample;  ///< pdf_solid_angle includes the choice
    /// Counts the samples of this light that are expected: the chance of choosing it, times the light samples that are
    /// taken.
    float expected_samples = 0;
    std::uint32_t light = kNone;
};

/// The beginning of a light subpath.
struct Emission {
    Ray ray;
    Rgb weight;  ///< radiance and cosine over the densities of origin, direction and choice
    EmissionSample sample;
    std::uint32_t light = kNone;
    float probability = 0;  ///< of choosing this light
};

/// Emission of a point of a lamp in one direction.
struct SurfaceEmission {
    Rgb radiance;         ///< W/(m² sr)
    float cosine = 0.0f;  ///< between the direction and the surface's normal, >= 0
};

/// Holds the random numbers that a light sample is made from, each in [0, 1)².
struct LightNumbers {
    Vec2f light;      ///< which light
    Vec2f triangle;   ///< of a mesh light, which triangle
    Vec2f direction;  ///< where on it, or from where
};

/// A triangle that was hit, with the normal that its vertices' make there; zero where it is flat.
struct HitTriangle {
    Vec3f p0, edge1, edge2;
    Vec3f shading_normal;
};

/// Holds the texture coordinates of a triangle's first vertex, and their differences to those of the others; zero where
/// the triangle has none.
struct HitCoordinates {
    Vec2f uv0{0.0f, 0.0f}, edge1{0.0f, 0.0f}, edge2{0.0f, 0.0f};
};

class World {
  public:
    explicit World(WorldData data);
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// Nearest hit of each ray; `hits` is as long as `rays`.
    void intersect(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                   QueryForm form = QueryForm::Best) const;
    void intersect(const RayColumns& rays, std::span<Hit> hits, Coherence coherence,
                   QueryForm form = QueryForm::Best) const;
    /// kOccluded where something but panes lies within (0, t_max], else kPassesPanes or kFree; `occluded` is as long as
    /// `rays`.
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, QueryForm form = QueryForm::Best) const;
    void occluded(const RayColumns& rays, std::span<std::uint8_t> occluded, QueryForm form = QueryForm::Best) const;
    /// Share of light that passes the panes between the ends of `ray`, which may be anything along which nothing else
    /// lies.
    [[nodiscard]] Rgb pane_transmittance(const Ray& ray) const;
    /// True if some surface is a pane.
    [[nodiscard]] bool has_panes() const { return data_->panes != nullptr; }
    /// Seconds that bare Embree takes to trace `rays`, without what it takes to hand them over or to look at what they
    /// hit: the ceiling for any renderer. `occlusion`: whether they only ask if something is in the way.
    [[nodiscard]] double replay(std::span<const Ray> rays, bool occlusion, Coherence coherence, QueryForm form) const;

    /// The surface at `hit` (valid), whose textures are read at a point. Rays that go on from it may meet others that
    /// touch it.
    [[nodiscard]] SurfacePoint surface_point(const Hit& hit) const;
    /// The surface at `hit`, whose textures are filtered for `ray`, which hit it, with `cone` around it. Rays that go
    /// on from it start beyond all surfaces that touch it.
    [[nodiscard]] SurfacePoint surface_point(const Hit& hit, const Ray& ray, const RayCone& cone) const;
    /// Material of a plain surface; null where the surface is not plain, or others touch it. The functions of
    /// world/triangle_point.h say what it is at a point.
    [[nodiscard]] const PlainSurface* plain_surface(const Hit& hit) const {
        return hit.in_contact ? nullptr : plain_surfaces_.of_geometry[hit.geometry];
    }
    /// Returns the lobe of a plain surface that is matte; else null.
    [[nodiscard]] const Bsdf* plain_bsdf(const Hit& hit) const {
        const PlainSurface* surface = plain_surface(hit);
        return surface != nullptr ? surface->matte : nullptr;
    }
    [[nodiscard]] HitTriangle hit_triangle(const Hit& hit) const {
        const Geometry& geometry = data_->geometries[hit.geometry];
        const auto& triangle = geometry.triangles[hit.triangle];
        const Vec3f& p0 = geometry.positions[triangle[0]];
        return {p0, geometry.positions[triangle[1]] - p0, geometry.positions[triangle[2]] - p0,
                geometry.normals.empty() ? Vec3f(0.0f) : interpolate(geometry.normals, triangle, {hit.u, hit.v})};
    }
    /// Returns the texture coordinates of the triangle that was hit, of the set that the textures of `surface` follow.
    [[nodiscard]] HitCoordinates hit_coordinates(const Hit& hit, const PlainSurface& surface) const;
    /// Has the triangles of a few `hits`, some of which may be no hits, fetched from memory at once, where there are so
    /// many in the scene that they are in no cache. Whoever looks at them next would else wait for each by itself.
    void fetch_triangles(std::span<const Hit> hits) const {
        if (has_far_triangles_) fetch_far_triangles(hits);
    }
    /// Names a plain surface; of no other use than that.
    [[nodiscard]] const Material* material(const Hit& hit) const {
        return &data_->materials[data_->geometries[hit.geometry].material];
    }
    /// Adds what the textures of a plain `surface` are asked for at `uv` over `footprint`, those of its set.
    void add_lookups(const PlainSurface& surface, Vec2f uv, const TextureFootprint& footprint,
                     PlainLookups& lookups) const;
    /// The lobe that they make, for one surface after the other in the order in which they were added.
    [[nodiscard]] MetallicRoughness lobe(const PlainSurface& surface, PlainLookups& lookups) const;
    /// Returns the mean curvature of the surface at `hit` (valid), 1/m, positive where its front is convex; for
    /// `RayCone`s that are mirrored there.
    [[nodiscard]] float mean_curvature(const Hit& hit) const;
    /// False if nothing is textured, so that rays need no cones.
    [[nodiscard]] bool has_textures() const { return !data_->textures.empty(); }
    /// How the surface scatters light that is seen along `wo`; `storage` holds lobes that had to be evaluated there.
    /// `relative_ior` is that of a body's inside over its outside, 0 for the material's own against vacuum.
    [[nodiscard]] const Bsdf& bsdf(const SurfacePoint& point, const Vec3f& wo, float relative_ior, Bsdf& storage) const;
    /// Radiance emitted towards `wo`, W/(m² sr).
    [[nodiscard]] Rgb emission(const SurfacePoint& point, const Vec3f& wo) const;
    /// Colour of an unlit surface.
    [[nodiscard]] Rgb unlit_color(const SurfacePoint& point) const;

    /// False if there is nothing that light can be in.
    [[nodiscard]] bool has_bodies() const { return !data_->filling_of_body.empty(); }
    /// True if light scatters in some bodies.
    [[nodiscard]] bool has_scattering_bodies() const { return has_scattering_bodies_; }
    /// True if some light, at least a part of it, lies in a medium that scatters.
    [[nodiscard]] bool has_lights_in_media() const { return has_lights_in_media_; }
    /// True if the surface is that of a body.
    [[nodiscard]] bool is_boundary(const SurfacePoint& point) const { return point.material->filling != kNone; }
    /// A ray from within `current` at a boundary that nothing touches.
    [[nodiscard]] Crossing crossing(const SurfacePoint& point, const Interior& current) const;
    /// A boundary that others touch, where `ray`, which comes from within `current` with `cone` around it, has hit it.
    /// `point` becomes the surface that bounds what fills the space.
    [[nodiscard]] Crossing contact_crossing(SurfacePoint& point, const Interior& current, const Hit& hit,
                                            const Ray& ray, const RayCone& cone) const;
    /// Returns the medium of the body that fills the space within `interior`, null in vacuum and where that body's
    /// medium is empty.
    [[nodiscard]] const HomogeneousMedium* medium(const Interior& interior) const {
        return interior.is_empty() ? nullptr : medium_within(interior);
    }
    /// The bodies that `point` is in in the middle of the shutter, found by a ray through all that lies above it.
    [[nodiscard]] Interior interior_at(const Vec3f& point) const;
    /// Returns the bodies that the camera is in.
    [[nodiscard]] const Interior& camera_interior() const { return camera_interior_; }
    /// How the working space sees single wavelengths.
    [[nodiscard]] const SpectralResponse& spectral_response() const { return data_->response; }

    /// True if anything moves while the shutter is open, so that rays need times.
    [[nodiscard]] bool has_motion() const { return has_motion_; }
    /// False if every surface stops all light, so that rays need no alpha keys.
    [[nodiscard]] bool has_transparency() const { return has_transparency_; }
    [[nodiscard]] bool has_lights() const { return !selector_.empty(); }
    /// True if some light has no extent, in space or in direction, so that no ray meets it by chance.
    [[nodiscard]] bool has_delta_lights() const { return has_delta_lights_; }
    /// True if some surface mirrors or refracts without any roughness.
    [[nodiscard]] bool has_specular_surfaces() const { return has_specular_surfaces_; }
    /// True if some surface shows its colour to the eye and neither scatters nor emits light.
    [[nodiscard]] bool has_unlit_surfaces() const { return has_unlit_surfaces_; }
    /// True if some surface emits light.
    [[nodiscard]] bool has_emitting_surfaces() const { return has_emitting_surfaces_; }
    /// False if no camera ray through the part of the film from `least` to `most` can meet a surface that emits light.
    [[nodiscard]] bool may_show_lamps(Vec2f least, Vec2f most) const;
    /// True if some surface that emits is met by chance only: it moves while the shutter is open, or is beyond the most
    /// triangles that are sampled.
    [[nodiscard]] bool has_unsampled_emitters() const { return data_->has_unsampled_emitters; }
    /// False if samples of the BSDF find all light best by themselves: there are no lights, or none but an environment
    /// that is the same everywhere. `sample_light` and `choose_light` must not be called then.
    [[nodiscard]] bool has_sampled_lights() const { return !tree_.empty(); }
    /// Light arriving at `receiver` from a light chosen for it by the light tree. Of an environment it finds only what
    /// is brighter than its mean: to be combined with samples of the BSDF, by `environment_pdf_solid_angle`.
    [[nodiscard]] ChosenLight sample_light(const LightReceiver& receiver, const LightNumbers& u) const {
        return sample_light(choose_light(receiver, u.light), receiver.position, u);
    }
    /// False if `choose_light` needs no numbers, as there is but one light.
    [[nodiscard]] bool chooses_lights() const { return tree_.has_choice(); }
    /// False if `sample_emission` has no choice, as there is at most one light.
    [[nodiscard]] bool chooses_emitters() const { return selector_.size() > 1; }
    /// True if the choice of a light, or of a triangle of one, depends on what it is for.
    [[nodiscard]] bool chooses_lights_by_receiver() const { return chooses_lights_by_receiver_; }
    /// Chooses a light for `receiver` by the light tree: the first half of `sample_light`.
    [[nodiscard]] LightTree::Choice choose_light(const LightReceiver& receiver, Vec2f u) const {
        return tree_.sample(receiver, u);
    }
    /// Chooses a light for each of many receivers, and fetches these lights from memory besides.
    void choose_lights(std::span<const LightReceiver> receivers, std::span<const Vec2f> u,
                       std::span<LightTree::Choice> choices) const;
    /// Samples light from what was chosen: the second half of `sample_light`.
    [[nodiscard]] ChosenLight sample_light(const LightTree::Choice& choice, const Vec3f& point,
                                           const LightNumbers& u) const;
    /// The mesh light of this index if it shines evenly, else null.
    [[nodiscard]] const MeshLight* even_mesh_light(std::uint32_t light) const {
        const MeshLight* mesh = std::get_if<MeshLight>(&data_->lights[light]);
        return mesh != nullptr && mesh->is_uniform() ? mesh : nullptr;
    }
    /// Samples the environment, which there has to be, as `sample_light` does once the environment is chosen, as many
    /// times at once as there are `samples`; their densities are without the choice.
    void sample_environment_light(std::span<const Vec2f> u, std::span<LightSample> samples) const;
    /// Probability with which `sample_light` chooses the light of this index for `receiver`.
    [[nodiscard]] float light_probability(const LightReceiver& receiver, std::uint32_t light) const {
        return tree_.probability(receiver, light);
    }
    /// Probability with which `sample_emission` chooses the light of this index.
    [[nodiscard]] float emission_probability(std::uint32_t light) const { return selector_.probability(light); }
    /// Samples a ray that leaves a light, chosen by power with `u_light` in [0, 1)²; the ray has the given time.
    [[nodiscard]] Emission sample_emission(Vec2f u_light, const EmissionNumbers& u, float time) const;
    /// Evaluates the light that leaves the starting point of `emission` along `direction`; black without a surface.
    [[nodiscard]] SurfaceEmission surface_emission(const Emission& emission, const Vec3f& direction) const;
    /// True if rays can meet the light of this index by chance.
    [[nodiscard]] bool can_be_hit(std::uint32_t light) const { return !is_delta_light(data_->lights[light]); }
    [[nodiscard]] bool is_at_infinity(std::uint32_t light) const {
        return etendue::is_at_infinity(data_->lights[light]);
    }
    /// Returns the density of `direction` for rays of `sample_emission` from a given point of the light of this index,
    /// 1/sr, or for a light at infinity, whose direction is given, that of where they pass, 1/m² across it. `cos_light`
    /// is the cosine between the direction and the normal of the light's front.
    [[nodiscard]] float emission_pdf(std::uint32_t light, const Vec3f& direction, float cos_light) const {
        return etendue::emission_pdf(data_->lights[light], direction, cos_light, scene_sphere());
    }
    /// Says what the light of this index is.
    [[nodiscard]] const Emitter& emitter(std::uint32_t light) const { return data_->emitter_of_light[light]; }
    /// Index of the material of `point`, as in the description.
    [[nodiscard]] std::uint32_t material_index(const SurfacePoint& point) const {
        return static_cast<std::uint32_t>(point.material - data_->materials.data());
    }
    /// Index of the material of the surface at `hit` (valid), as in the description.
    [[nodiscard]] std::uint32_t material_index(const Hit& hit) const {
        return data_->geometries[hit.geometry].material;
    }
    /// Distance of `point` from the camera as it is at `time`, metres along its viewing direction.
    [[nodiscard]] float depth(const Vec3f& point, float time) const;
    /// The light that the surface at `point` belongs to; kNone if it is not sampled.
    [[nodiscard]] std::uint32_t light_at(const SurfacePoint& point) const;
    /// Index of the environment, kNone if there is none.
    [[nodiscard]] std::uint32_t environment() const { return data_->environment; }
    /// The bodies that a ray starts in that leaves a light.
    [[nodiscard]] Interior light_interior(const Emission& emission) const {
        return planes_of(emission.light).empty() ? light_interiors_[emission.light] : interior_at(emission.ray.origin);
    }
    /// Density, choice included, with which `sample_light` for `from` would have picked the direction that hit the
    /// emitter `point` at `distance`. 0 if it is no sampled light. `from` means nothing unless the World
    /// `chooses_lights_by_receiver`.
    [[nodiscard]] float emitter_pdf_solid_angle(const LightReceiver& from, const SurfacePoint& point,
                                                const Vec3f& direction, float distance) const;

    /// Density per area, 1/m², without the choice, with which `sample_emission` picks a point of the mesh light of this
    /// index.
    [[nodiscard]] float emitter_pdf_area(std::uint32_t light) const;
    /// How many times as densely `sample_light` at `point` picks the points of this triangle of the light of this index
    /// as `sample_emission` does, both without the choice; 1 for lights that are no meshes.
    [[nodiscard]] float light_sample_gain(std::uint32_t light, std::uint32_t triangle, const Vec3f& point) const;

    [[nodiscard]] bool has_environment() const { return data_->environment != kNone; }
    [[nodiscard]] Rgb environment_radiance(const Vec3f& direction) const;
    /// Density with which `sample_light` picks `direction`, without the choice of the environment; zero where that is
    /// dimmer than its mean.
    [[nodiscard]] float environment_pdf_solid_angle(const Vec3f& direction) const;
    /// Fills `seen` with the environment's radiance and the density of `sample_environment_light` along as many
    /// `directions` at once; there has to be an environment.
    void look_at_environment(std::span<const Vec3f> directions, std::span<EnvironmentRadiance> seen) const;
    /// Density with which `sample_emission` and `sample_environment` pick `direction`, without the choice of the
    /// environment; zero only where the environment is black.
    [[nodiscard]] float environment_emission_pdf_solid_angle(const Vec3f& direction) const;
    /// Light arriving at `point` from all of the environment, where nothing but light samples looks for it. `u` in
    /// [0, 1)².
    [[nodiscard]] LightSample sample_environment(const Vec3f& point, Vec2f u) const;
    [[nodiscard]] bool environment_visible_to_camera() const { return data_->environment_visible; }

    /// Returns SceneDesc::origin.
    [[nodiscard]] const Vec3d& origin() const { return data_->origin; }
    /// Returns the camera as it is in the middle of the shutter.
    [[nodiscard]] const Camera& camera() const { return data_->camera; }
    /// False if numbers for a point on the lens mean nothing.
    [[nodiscard]] bool has_lens() const { return etendue::has_lens(data_->camera); }
    /// Returns true if the camera sees all around, so that its film goes on beyond its edges (see camera/camera.h).
    [[nodiscard]] bool film_wraps() const { return etendue::film_wraps(data_->camera); }
    /// Returns true if rays may come from parts of the film that see nothing; their t_max is 0.
    [[nodiscard]] bool has_blind_film() const { return etendue::has_blind_film(data_->camera); }
    /// Returns true if the camera shows no surface beyond some depth.
    [[nodiscard]] bool clips_far() const { return clips_far_; }
    /// Returns true if `hit`, which the eye sees along `ray`, lies farther than the camera shows.
    [[nodiscard]] bool is_too_far(const Ray& ray, const Hit& hit) const;
    /// How the camera as it is at `time` sees `point` through the lens point made from `lens` in [0, 1)².
    [[nodiscard]] CameraConnection connect_to_camera(const Vec3f& point, Vec2f lens, float time) const;
    /// The ray of the camera as it is at `time`, through film point `film` and the lens point made from `lens`, all in
    /// [0, 1); the ray has that time.
    [[nodiscard]] Ray generate_ray(Vec2f film, Vec2f lens, float time) const;
    /// Generates a ray for each of many film points, lens points and times, as `generate_ray` does; all spans have one
    /// length.
    void generate_rays(std::span<const Vec2f> film, std::span<const Vec2f> lens, std::span<const float> times,
                       std::span<Ray> rays) const;
    [[nodiscard]] const Bounds& bounds() const { return data_->bounds; }
    /// Returns the radius of a sphere around all geometry, metres; 1 for an empty world.
    [[nodiscard]] float bounding_radius() const;
    [[nodiscard]] WorldStatistics statistics() const;

  private:
    /// Puts the surfaces that rays meet in place of those that they hit, where several touch.
    template <typename Batch>
    void settle_contacts(const Batch& rays, std::span<Hit> hits) const;
    [[nodiscard]] SurfacePoint contact_point(const Contact& contact, const ContactFace& face, const Ray& ray,
                                             const RayCone& cone) const;
    void set_indices(std::uint32_t body, Crossing& crossing) const;
    /// See WorldData::planes_of_light.
    [[nodiscard]] std::span<const Vec3f> planes_of(std::uint32_t light) const {
        return data_->planes_of_light.empty() ? std::span<const Vec3f>() : data_->planes_of_light[light];
    }
    /// False if another emitter in the same place hides this one towards `direction`.
    [[nodiscard]] bool is_foremost_emitter(const SurfacePoint& point, Vec2f barycentric, const Vec3f& direction) const;
    /// True if light `index` is a mesh whose radiance depends on the place.
    [[nodiscard]] bool has_uneven_emission(std::uint32_t light) const;
    /// Radiance of a point of a mesh light towards `direction`.
    [[nodiscard]] Rgb mesh_emission(std::uint32_t light, std::uint32_t triangle, Vec2f barycentric,
                                    const Vec3f& direction) const;
    [[nodiscard]] Camera camera_at(float time) const;
    void fetch_far_triangles(std::span<const Hit> hits) const;
    /// Returns the medium within an interior that is not empty, null if the body that fills it has none.
    [[nodiscard]] const HomogeneousMedium* medium_within(const Interior& interior) const;
    [[nodiscard]] SceneSphere scene_sphere() const { return {data_->bounds.center(), bounding_radius()}; }

    // On the heap, so that Embree's callbacks keep their pointer to it when a World is moved.
    std::unique_ptr<WorldData> data_;
    LightSelector selector_;  ///< chooses lights for emission
    LightTree tree_;          ///< chooses lights for a point
    bool chooses_lights_by_receiver_ = false;
    bool has_far_triangles_ = false;
    bool has_motion_ = false;
    bool has_transparency_ = false;
    bool has_delta_lights_ = false;
    bool has_specular_surfaces_ = false;
    bool has_unlit_surfaces_ = false;
    bool has_emitting_surfaces_ = false;
    std::vector<Bounds> lamp_bounds_;  ///< of surfaces that emit, while they stay where they are
    bool has_scattering_bodies_ = false;
    bool has_lights_in_media_ = false;
    PlainSurfaces plain_surfaces_;
    Interior camera_interior_;
    bool clips_far_ = false;
    std::vector<Interior> light_interiors_;  ///< of each light; only if there are bodies
};

/// Returns the version of the ray tracing library.
[[nodiscard]] std::string ray_tracer_version();

}  // namespace etendue
