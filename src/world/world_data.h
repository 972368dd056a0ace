// All that compiling fills in, as plain data.
#pragma once

#include "bsdf/spectral_response.h"
#include "camera/camera.h"
#include "color/color_config.h"
#include "core/bounds.h"
#include "light/light.h"
#include "scene/accelerator_kind.h"
#include "texture/texture.h"
#include "world/body.h"
#include "world/geometry.h"
#include "world/material.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace etendue {

class Contacts;
class EmbreeScene;

/// Names a step of compiling, and says how long it took.
struct CompilePhase {
    std::string_view name;
    double seconds = 0.0;
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
    std::vector<TransformMotion> motions;  ///< motion of each instance that moves
    std::vector<Material> materials;
    std::unique_ptr<TextureCache> texture_cache;  ///< null if all textures are resident
    std::vector<Texture> textures;
    std::size_t missing_textures = 0;  ///< images that materials do without
    std::vector<Light> lights;
    std::vector<Emitter> emitter_of_light;     ///< emitter of each light
    std::vector<std::uint32_t> light_of_slot;  ///< light index of (instance, geometry), kNone if it is not sampled
    /// Holds for each light its motion from the frame in which `lights` has it (world/light_pose.h); empty for a light
    /// that stands still. The list is empty if no light moves.
    std::vector<TransformMotion> motion_of_light;
    bool has_unsampled_emitters = false;  ///< some surface that emits is none of `lights`
    std::uint32_t environment = kNone;    ///< index into `lights`
    bool environment_visible = true;      ///< to camera rays
    /// Lists the lights that rays meet which leave the scene: the environment, if there is one, and then the suns.
    std::vector<std::uint32_t> lights_met_afar;
    Camera camera;
    TransformMotion camera_motion;  ///< camera to world; empty if it stands still
    ColorMatrix from_rec709;        ///< linear Rec.709 to the working space
    XyzToWorking xyz_to_working{};
    SpectralResponse response;
    std::vector<Filling> fillings;               ///< filling of each material
    std::vector<std::uint32_t> filling_of_body;  ///< bodies by precedence, the first first
    std::vector<std::uint32_t> body_of_slot;     ///< body of (instance, geometry), or kNone; empty without bodies
    Bounds bounds;
    Vec3d origin{0.0};  ///< in the world that the scene's file describes; all else is relative to it
    /// Says what `SceneGeometry` asks for what rays meet.
    AcceleratorKind accelerator = AcceleratorKind::Embree;
    std::unique_ptr<EmbreeScene> bvh;
    std::unique_ptr<EmbreeScene> clear_surfaces;  ///< for `collect`; null if there are none
    std::unique_ptr<Contacts> contacts;           ///< null if no surfaces touch for which that matters
    /// Holds the diagonals of the bounds of every (instance, geometry), metres.
    std::vector<float> size_of_slot;
    /// Holds 1 for emitters that touch other emitters; empty without contacts.
    std::vector<std::uint8_t> shares_place_of_slot;
    /// Holds planes that take a ray clear of surfaces in which a lamp lies, for each lamp.
    std::vector<std::vector<Vec3f>> planes_of_light;
    std::vector<CompilePhase> compile_phases;

    WorldData();
    ~WorldData();
    WorldData(WorldData&&) noexcept;
    WorldData& operator=(WorldData&&) noexcept;

    /// Returns the radius of a sphere around all geometry, metres; 1 for an empty world.
    [[nodiscard]] float bounding_radius() const;
    /// Returns a sphere around all geometry, for light that comes from infinitely far away.
    [[nodiscard]] SceneSphere bounding_sphere() const { return {bounds.center(), bounding_radius()}; }
    /// Returns how the light of this index moves; null if it stands still.
    [[nodiscard]] const TransformMotion* motion_of(std::uint32_t light) const {
        return motion_of_light.empty() || motion_of_light[light].empty() ? nullptr : &motion_of_light[light];
    }
    /// Returns what takes a ray clear of surfaces that the light of this index lies in.
    [[nodiscard]] std::span<const Vec3f> planes_of(std::uint32_t light) const {
        return planes_of_light.empty() ? std::span<const Vec3f>() : planes_of_light[light];
    }
};

}  // namespace etendue
