// All yes/no questions about a scene, answered once.
#pragma once

#include "world/world_data.h"

namespace etendue {

class LightEmitter;
class LightSampler;
class Media;

/// Answers what a scene has and needs, once it is compiled, so that integrators leave out what it does not need.
struct SceneTraits {
    bool has_textures = false;           ///< something is textured, so that rays need cones
    bool has_clear_surfaces = false;     ///< light goes straight through some surface: panes and clear bodies
    bool has_transparency = false;       ///< some surface lets rays through at random, so that they need alpha keys
    bool has_motion = false;             ///< something moves while the shutter is open, so that rays need times
    bool film_wraps = false;             ///< the camera sees all around: its film goes on beyond its edges
    bool has_blind_film = false;         ///< parts of the film see nothing: the t_max of rays from there is 0
    bool clips_far = false;              ///< the camera shows no surface beyond some depth
    bool has_lens = false;               ///< numbers for a point on the lens mean something
    bool has_specular_surfaces = false;  ///< some surface mirrors or refracts without any roughness
    bool has_unlit_surfaces = false;     ///< some surface shows its colour and neither scatters nor emits light
    bool has_emitting_surfaces = false;  ///< some surface emits light
    bool hides_surfaces = false;         ///< some surface is hidden from the camera
    bool replaces_surfaces = false;      ///< the camera sees a shadow or a hole in place of some surface
    bool has_shadow_catchers = false;    ///< the camera sees a shadow in place of some surface
    bool culls_backs = false;            ///< the eye does not see some surface from behind
    /// Is set if some of these move, are uneven shapes or are beyond the most triangles that are sampled.
    bool has_unsampled_emitters = false;

    bool has_bodies = false;             ///< there is something that light can be in
    bool has_scattering_bodies = false;  ///< light scatters in some bodies
    bool has_clear_bodies = false;       ///< the surfaces of some bodies bend no light, so that light samples pass them
    /// Is set if light samples may arrive in a medium that scatters: some light, or a part of it, may lie in one, or
    /// there are clear bodies.
    bool samples_lights_in_media = false;

    bool has_lights = false;          ///< some light sends out rays
    bool has_delta_lights = false;    ///< some light has no extent, so that no ray meets it by chance
    bool has_sampled_lights = false;  ///< samples of the BSDF do not find all light best; `LightSampler` is for these
    bool chooses_lights = false;      ///< there is more than one light for `LightSampler` to choose from
    bool chooses_lights_by_receiver = false;     ///< the choice of a light or of a place on it needs the receiver
    bool chooses_emitters = false;               ///< there is more than one light for `LightEmitter` to choose from
    bool has_environment = false;                ///< there is light from infinitely far away in every direction
    bool environment_visible_to_camera = false;  ///< camera rays that meet nothing show the environment
};

/// Answers the questions about a scene.
[[nodiscard]] SceneTraits find_traits(const WorldData& data, const Media& media, const LightSampler& lights,
                                      const LightEmitter& emitters);

}  // namespace etendue
