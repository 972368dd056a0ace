#include "world/world.h"

#include "core/error.h"
#include "core/vector_bytes.h"
#include "light/light.h"
#include "world/contacts.h"
#include "world/embree_geometry_maker.h"

#include <utility>

namespace etendue {

WorldParts::WorldParts(WorldData from)
    : data(std::move(from)),
      materials(data),
      geometry(data, materials),
      camera(data, traits),
      media(data, geometry, camera),
      lights(data, materials),
      emitters(data, materials, media),
      environment(data) {
    traits = find_traits(data, media, lights, emitters);
    // A catcher shows what is infinitely far behind it, through which nothing of a medium around the camera would pass.
    if (traits.has_shadow_catchers && media.has_camera_in_medium(camera))
        throw SceneError({}, "the camera is in a medium, through which it cannot see materials that catch shadows");
}

World::World(WorldData data) : parts_(std::make_unique<WorldParts>(std::move(data))) {}

WorldStatistics World::statistics() const {
    const WorldData& data = parts_->data;
    WorldStatistics s;
    s.geometry_bytes = parts_->geometry.triangle_bytes();
    for (const Geometry& g : data.geometries) s.triangles += g.triangles.size();
    for (const Instance& instance : data.instances)
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
            s.instanced_triangles += data.geometries[instance.first_geometry + g].triangles.size();
    s.instance_bytes = vector_bytes(data.instances, data.motions, data.filling_of_body, data.body_of_slot);
    for (const TransformMotion& motion : data.motions) s.instance_bytes += vector_bytes(motion);
    s.material_bytes = parts_->materials.bytes() + vector_bytes(data.fillings);
    s.textures = data.textures.size();
    s.missing_textures = data.missing_textures;
    for (const Texture& texture : data.textures) s.texture_bytes += texture.bytes();
    if (data.texture_cache) {
        s.texture_bytes = static_cast<std::size_t>(data.texture_cache->bytes());
        s.textures_cached = true;
        s.texture_cache_budget = data.texture_cache->budget();
        s.failed_texture_lookups = data.texture_cache->failed_lookups();
        s.first_texture_failure = data.texture_cache->first_failure();
    }
    s.instances = data.instances.size();
    s.lights = data.lights.size();
    s.light_bytes = parts_->emitters.choice().bytes() + parts_->lights.tree().bytes() +
                    vector_bytes(data.lights, data.emitter_of_light, data.light_of_slot, data.size_of_slot);
    for (const Light& light : data.lights) s.light_bytes += light_bytes(light);
    for (const TransformMotion& motion : data.motion_of_light) s.light_bytes += sizeof(motion) + vector_bytes(motion);
    s.isa = data.bvh->instruction_set();
    s.bvh_bytes = data.bvh->bytes() + (data.clear_surfaces ? data.clear_surfaces->bytes() : 0) +
                  (data.contacts ? data.contacts->bytes() : 0);
    s.bvh_build_seconds = data.bvh->build_seconds();
    s.bvh_quality = bvh_quality();
    s.compile_phases = data.compile_phases;
    return s;
}

}  // namespace etendue
