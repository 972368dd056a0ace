// What surfaces are made of.
#pragma once

#include "bsdf/bsdf.h"
#include "bsdf/metallic_roughness.h"
#include "texture/footprint.h"
#include "world/hit.h"
#include "world/plain_surface.h"
#include "world/surface_point.h"
#include "world/world_data.h"

#include <cstddef>
#include <cstdint>

namespace etendue {

class PlainLookups;

/// Answers how surfaces scatter and emit light: at one point, or many plain ones together (world/plain_surface.h).
class Materials {
  public:
    /// Evaluates the materials of `data` that are the same everywhere, and finds the plain surfaces; `data` has to stay
    /// where it is.
    explicit Materials(WorldData& data);

    /// Returns how the surface scatters light that is seen along `wo`; `storage` holds lobes that had to be evaluated
    /// there. `relative_ior` is that of a body's inside over its outside, 0 for the material's own against vacuum.
    [[nodiscard]] const Bsdf& bsdf(const SurfacePoint& point, const Vec3f& wo, float relative_ior, Bsdf& storage) const;
    /// Returns the radiance emitted towards `wo`, W/(m² sr).
    [[nodiscard]] Rgb emission(const SurfacePoint& point, const Vec3f& wo) const;
    /// Returns the colour of an unlit surface.
    [[nodiscard]] Rgb unlit_color(const SurfacePoint& point) const;

    /// Returns the material of a plain surface; null where the surface is not plain, or others touch it. The functions
    /// of world/triangle_point.h say what it is at a point.
    [[nodiscard]] const PlainSurface* plain_surface(const Hit& hit) const {
        return hit.in_contact ? nullptr : plain_surfaces_.of_geometry[hit.geometry];
    }
    /// Returns the lobe of a plain surface that is diffuse; else null.
    [[nodiscard]] const Bsdf* plain_bsdf(const Hit& hit) const {
        const PlainSurface* surface = plain_surface(hit);
        return surface != nullptr ? surface->diffuse : nullptr;
    }
    /// Adds what the textures of a plain `surface` are asked for at `uv` over `footprint`, those of its set.
    void add_lookups(const PlainSurface& surface, Vec2f uv, const TextureFootprint& footprint,
                     PlainLookups& lookups) const;
    /// Returns the lobe that added look-ups make, for one surface after the other in the order in which they were
    /// added.
    [[nodiscard]] MetallicRoughness lobe(const PlainSurface& surface, PlainLookups& lookups) const;

    /// Names the material at `hit` (valid); of no other use than that.
    [[nodiscard]] const Material* at(const Hit& hit) const {
        return &data_.materials[data_.geometries[hit.geometry].material];
    }
    /// Returns whether the surface at `hit` is there and hidden from the camera.
    [[nodiscard]] bool is_hidden_from_camera(const Hit& hit) const {
        return hit.valid() && !at(hit)->visible_to_camera;
    }
    /// Returns whether there is a surface at `hit`, in whose place the camera sees a shadow or a hole.
    [[nodiscard]] bool is_replaced(const Hit& hit) const { return hit.valid() && at(hit)->seen_as != SeenAs::Surface; }
    /// Returns the index of the material of `point`, as in the description.
    [[nodiscard]] std::uint32_t index(const SurfacePoint& point) const {
        return static_cast<std::uint32_t>(point.material - data_.materials.data());
    }
    /// Returns the index of the material of the surface at `hit` (valid), as in the description.
    [[nodiscard]] std::uint32_t index(const Hit& hit) const { return data_.geometries[hit.geometry].material; }
    /// Returns the bytes that materials take in memory, without textures.
    [[nodiscard]] std::size_t bytes() const;

  private:
    const WorldData& data_;
    PlainSurfaces plain_surfaces_;
};

}  // namespace etendue
