// The scene, compiled, in parts that integrators ask for by name. Immutable, so that any number of threads may ask.
#pragma once

#include "world/environment.h"
#include "world/hit.h"
#include "world/light_emitter.h"
#include "world/light_sampler.h"
#include "world/materials.h"
#include "world/media.h"
#include "world/scene_camera.h"
#include "world/scene_geometry.h"
#include "world/scene_traits.h"
#include "world/world_data.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace etendue {

/// Holds counts and sizes for reports.
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
    std::size_t light_bytes = 0;  ///< bytes of lights, of an environment's image and of the choice between lights
    std::size_t textures = 0;
    std::size_t missing_textures = 0;          ///< images that could not be read, which materials do without
    std::size_t texture_bytes = 0;             ///< held in memory: all of them, or tiles in the cache
    bool textures_cached = false;              ///< some did not fit, so that all come through a cache
    std::uint64_t texture_cache_budget = 0;    ///< bytes
    std::uint64_t failed_texture_lookups = 0;  ///< that met broken pixels in a file, up to now
    std::string first_texture_failure;
};

/// Keeps all parts of a compiled scene in one place, which they must not leave, as they refer to each other.
struct WorldParts {
    explicit WorldParts(WorldData from);
    ~WorldParts() = default;
    WorldParts(const WorldParts&) = delete;
    WorldParts& operator=(const WorldParts&) = delete;

    WorldData data;
    SceneTraits traits;  ///< found last, from all others
    Materials materials;
    SceneGeometry geometry;
    SceneCamera camera;
    Media media;
    LightSampler lights;
    LightEmitter emitters;
    Environment environment;
};

/// Is the scene, compiled: each part answers questions of one kind.
class World {
  public:
    explicit World(WorldData data);
    /// Takes the scene apart into what it was made of.
    [[nodiscard]] static WorldData take_data(World world) { return std::move(world.parts_->data); }

    /// Returns the answers to all yes/no questions.
    [[nodiscard]] const SceneTraits& traits() const { return parts_->traits; }
    /// Returns where surfaces are.
    [[nodiscard]] const SceneGeometry& geometry() const { return parts_->geometry; }
    /// Returns what surfaces are made of.
    [[nodiscard]] const Materials& materials() const { return parts_->materials; }
    /// Returns what fills the space between surfaces.
    [[nodiscard]] const Media& media() const { return parts_->media; }
    /// Returns what samples light that arrives at points.
    [[nodiscard]] const LightSampler& lights() const { return parts_->lights; }
    /// Returns what samples light that leaves lights.
    [[nodiscard]] const LightEmitter& emitters() const { return parts_->emitters; }
    /// Returns the light from infinitely far away.
    [[nodiscard]] const Environment& environment() const { return parts_->environment; }
    /// Returns the camera.
    [[nodiscard]] const SceneCamera& camera() const { return parts_->camera; }

    /// Returns SceneDesc::origin.
    [[nodiscard]] const Vec3d& origin() const { return parts_->data.origin; }
    /// Says how the working space sees single wavelengths.
    [[nodiscard]] const SpectralResponse& spectral_response() const { return parts_->data.response; }
    /// Counts and measures what the scene takes.
    [[nodiscard]] WorldStatistics statistics() const;

  private:
    std::unique_ptr<WorldParts> parts_;
};

/// Returns the version of the ray tracing library.
[[nodiscard]] std::string ray_tracer_version();

}  // namespace etendue
