#include "world/materials.h"

#include "bsdf/widening.h"
#include "core/vector_bytes.h"
#include "world/gltf_surface.h"
#include "world/lookup.h"
#include "world/material_evaluation.h"
#include "world/plain_lookups.h"

#include <cstddef>
#include <variant>
#include <vector>

namespace etendue {

namespace {

/// True if what the model evaluates to depends on nothing about a point but its vertex colour. A coat has a normal of
/// its own, which differs from the base's by rounding at least.
bool is_uniform(const GltfModel& model) {
    return !model.is_textured() && !(model.layers && model.layers->clearcoat > 0.0f);
}

/// Evaluates the materials that are the same everywhere, once for all points. Lobes keep pointers into `data`.
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

/// The interface of a dielectric between other indices than it was made for.
Bsdf with_relative_ior(const Bsdf& bsdf, float relative_ior) {
    const auto* rough = std::get_if<RoughDielectric>(&bsdf);
    const Vec2f alpha = rough != nullptr ? Vec2f(rough->alpha_x, rough->alpha_y) : Vec2f(0.0f, 0.0f);
    const auto* smooth = std::get_if<SmoothDielectric>(&bsdf);
    const Rgb tint = rough != nullptr ? rough->tint : smooth != nullptr ? smooth->tint : Rgb(1.0f);
    return std::visit([](const auto& interface) { return Bsdf(interface); },
                      make_interface(relative_ior, alpha, tint, {}));
}

}  // namespace

Materials::Materials(WorldData& data) : data_(data) {
    evaluate_uniform_materials(data);
    plain_surfaces_ = find_plain_surfaces(data);
}

const Bsdf& Materials::bsdf(const SurfacePoint& point, const Vec3f& wo, float relative_ior, Bsdf& storage) const {
    const Material& material = *point.material;
    if (const auto* model = std::get_if<GltfModel>(&material.model)) {
        // Only a body's interface depends on what is around it.
        const bool as_in_vacuum = !model->refracts || relative_ior == 0.0f || relative_ior == model->ior;
        if (material.uniform && as_in_vacuum && !point.has_spread_slopes()) return *material.uniform;
        storage = evaluate_gltf_surface(data_, *model, point, relative_ior, dot(wo, point.geometric_normal) < 0.0f);
        return storage;
    }
    const Bsdf& constant = std::get<Bsdf>(material.model);
    // Compiled for vacuum around it.
    const bool as_compiled = relative_ior == 0.0f || relative_ior == data_.fillings[material.filling].ior;
    if (as_compiled && !point.has_spread_slopes()) return constant;
    storage = as_compiled ? constant : with_relative_ior(constant, relative_ior);
    if (point.has_spread_slopes()) storage = widened(storage, point.slope_variance);
    return storage;
}

Rgb Materials::emission(const SurfacePoint& point, const Vec3f& wo) const {
    const Material& material = *point.material;
    if (!material.emits) return {};
    const bool from_back = dot(wo, point.geometric_normal) <= 0.0f;
    if (!material.emits_both_sides && from_back) return {};
    Rgb emitted = evaluate_emission(data_, material, point) * material.beam.factor(abs_dot(wo, point.geometric_normal));
    if (material.has_coat) {
        const GltfModel& model = std::get<GltfModel>(material.model);
        emitted *= evaluate_clear_coat(data_, *model.layers, point, false).passed(abs_dot(wo, point.coat_normal));
    }
    return emitted;
}

Rgb Materials::unlit_color(const SurfacePoint& point) const {
    return evaluate_base_color(data_, std::get<GltfModel>(point.material->model), point);
}

void Materials::add_lookups(const PlainSurface& surface, Vec2f uv, const TextureFootprint& footprint,
                            PlainLookups& lookups) const {
    for (const TextureSlot* slot :
         {&surface.textured->base_color_texture, &surface.textured->metallic_roughness_texture})
        if (slot->valid())
            lookups.add(data_.textures[static_cast<std::size_t>(slot->texture)], transform_point(*slot, uv),
                        transform_footprint(*slot, footprint));
}

MetallicRoughness Materials::lobe(const PlainSurface& surface, PlainLookups& lookups) const {
    const auto texel = [&](const TextureSlot& slot) { return slot.valid() ? lookups.take() : Rgb(1.0f); };
    const Rgb base_color = texel(surface.textured->base_color_texture);
    return surface.lobe(data_, base_color, texel(surface.textured->metallic_roughness_texture));
}

std::size_t Materials::bytes() const {
    return vector_bytes(data_.materials, plain_surfaces_.of_material, plain_surfaces_.of_geometry);
}

}  // namespace etendue
