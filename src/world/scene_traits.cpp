#include "world/scene_traits.h"

#include "world/embree_scene.h"
#include "world/light_emitter.h"
#include "world/light_sampler.h"
#include "world/media.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace etendue {

SceneTraits find_traits(const WorldData& data, const Media& media, const LightSampler& lights,
                        const LightEmitter& emitters) {
    const auto has_surface = [&](const auto& is_such) {
        return std::ranges::any_of(data.geometries,
                                   [&](const Geometry& g) { return is_such(data.materials[g.material]); });
    };
    const auto needs_exact_point = [](const Light& light) {
        return of_surface_light(light, false, [](const auto& surface) { return surface.needs_exact_point(); });
    };
    SceneTraits traits;
    traits.has_textures = !data.textures.empty();
    traits.has_clear_surfaces = data.clear_surfaces != nullptr;
    traits.culls_backs = has_surface([](const Material& material) { return material.culls_back; });
    // Light passes culled surfaces, or meets them, at random.
    traits.has_transparency = traits.culls_backs || std::ranges::any_of(data.materials, [](const Material& m) {
                                  return m.alpha_test != AlphaTest::Opaque;
                              });
    traits.has_motion = data.bvh->has_motion() || !data.camera_motion.empty() || !data.motion_of_light.empty();
    traits.has_lens = has_lens(data.camera);
    traits.film_wraps = film_wraps(data.camera);
    traits.has_blind_film = has_blind_film(data.camera);
    traits.clips_far = !std::isinf(clip_of(data.camera).end);
    traits.has_specular_surfaces = has_surface([](const Material& material) { return material.is_specular; });
    traits.has_unlit_surfaces = has_surface([](const Material& material) { return material.unlit; });
    traits.has_emitting_surfaces = has_surface([](const Material& material) { return material.emits; });
    traits.hides_surfaces = has_surface([](const Material& material) { return !material.visible_to_camera; });
    traits.replaces_surfaces =
        has_surface([](const Material& material) { return material.seen_as != SeenAs::Surface; });
    traits.has_shadow_catchers =
        has_surface([](const Material& material) { return material.seen_as == SeenAs::Shadow; });
    traits.has_unsampled_emitters = data.has_unsampled_emitters;

    traits.has_bodies = !data.filling_of_body.empty();
    traits.has_scattering_bodies =
        std::ranges::any_of(data.fillings, [](const Filling& filling) { return filling.medium.scatters(); });
    traits.has_clear_bodies =
        has_surface([](const Material& material) { return material.is_clear && material.filling != kNone; });
    traits.has_lights = !emitters.choice().empty();
    traits.has_delta_lights = std::ranges::any_of(data.lights, is_delta_light);
    traits.has_sampled_lights = !lights.tree().empty();
    traits.chooses_lights = lights.tree().has_choice();
    traits.chooses_lights_by_receiver =
        lights.tree().depends_on_receiver() || std::ranges::any_of(data.lights, needs_exact_point);
    traits.chooses_emitters = emitters.choice().size() > 1;
    traits.has_environment = data.environment != kNone;
    traits.environment_visible_to_camera = data.environment_visible;
    traits.samples_lights_in_media =
        traits.has_sampled_lights && traits.has_clear_bodies && traits.has_scattering_bodies;
    if (traits.has_bodies && traits.has_sampled_lights)
        for (std::uint32_t light = 0; light < data.lights.size(); ++light) {
            const std::optional<Interior>& interior = media.light_interior(light);
            const HomogeneousMedium* around = interior ? media.within(*interior) : nullptr;
            if (interior ? around != nullptr && around->scatters() : traits.has_scattering_bodies)
                traits.samples_lights_in_media = true;
        }
    return traits;
}

}  // namespace etendue
