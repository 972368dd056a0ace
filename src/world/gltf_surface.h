// glTF's material at a point: textures looked up, and the lobe that its parameters ask for.
#pragma once

#include "bsdf/bsdf.h"
#include "world/surface_point.h"
#include "world/world_data.h"

namespace etendue {

/// `relative_ior` is the index inside over outside, 0 for the material's own against vacuum. `from_back`: seen from the
/// surface's back.
[[nodiscard]] Bsdf evaluate_gltf_surface(const WorldData& data, const GltfModel& model, const SurfacePoint& point,
                                         float relative_ior, bool from_back);

/// Sets what the texture of metalness and roughness changes, where it reads `texel`; (1, 1, 1) if there is none.
void set_metallic_roughness(const GltfModel& model, const Rgb& texel, MetallicRoughness& lobe);

/// Returns the base's alphas along x and y at `point`.
[[nodiscard]] Vec2f evaluate_alpha(const WorldData& data, const GltfModel& model, const SurfacePoint& point);

/// The clear coat alone.
[[nodiscard]] ClearCoat evaluate_clear_coat(const WorldData& data, const GltfLayers& layers, const SurfacePoint& point,
                                            bool from_back);

}  // namespace etendue
