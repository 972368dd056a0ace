#include "bsdf/bsdf.h"
#include "bsdf/dielectric_body.h"
#include "bsdf/ggx.h"
#include "bsdf/measured_metals.h"
#include "world/compile_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace etendue {

namespace {

/// Perceptual roughness to alpha; below what is visible the lobe is a delta.
bool is_smooth(float roughness) {
    return roughness * roughness < kSmoothAlpha;
}

Bsdf compile_conductor(const ConductorDesc& desc, const ColorMatrix& from_rec709) {
    FresnelMetal fresnel;
    if (!desc.metal.empty()) {
        const std::optional<MetalReflectance> metal = measured_metal(desc.metal);
        if (!metal) throw SceneError({}, "no measured metal is named '" + desc.metal + "'");
        fresnel = FresnelMetal::from_f0_f82(from_rec709(metal->f0), from_rec709(metal->f82));
    }
    if (is_smooth(desc.roughness)) return SmoothConductor{fresnel};
    return RoughConductor{fresnel, desc.roughness * desc.roughness};
}

/// Compiles a dielectric with a constant base colour, which tints light that passes the surface.
Bsdf compile_dielectric(const DielectricDesc& desc, const Rgb& base_color, const ColorMatrix& from_rec709) {
    // White is white in every space, but for rounding.
    const Rgb tint = base_color == Rgb(1.0f) ? base_color : clamp_unit(from_rec709(base_color));
    if (is_smooth(desc.roughness) || !bends_light(desc.ior)) return SmoothDielectric{.ior = desc.ior, .tint = tint};
    RoughDielectric rough = RoughDielectric::make(desc.ior, desc.roughness * desc.roughness);
    rough.tint = tint;
    return rough;
}

Bsdf compile_diffuse(const DiffuseDesc& desc, const ColorMatrix& from_rec709) {
    const Rgb albedo = from_rec709(desc.albedo);
    if (desc.roughness > 0.0f) return RoughDiffuse{albedo, desc.roughness};
    return Diffuse{albedo};
}

/// Reflectance at normal incidence; KHR_materials_ior gives 0 the meaning of an infinite index.
float f0_from_ior(float ior) {
    if (ior == 0.0f) return 1.0f;
    const float root = (ior - 1.0f) / (ior + 1.0f);
    return root * root;
}

std::optional<GltfLayers> compile_layers(const MaterialDesc& desc, TextureCompiler& textures) {
    const bool any = desc.diffuse_roughness.factor > 0.0f || desc.diffuse_transmission.factor > 0.0f ||
                     desc.anisotropy.strength > 0.0f || desc.iridescence.factor > 0.0f || !is_black(desc.sheen.color) ||
                     desc.clearcoat.factor > 0.0f;
    if (!any) return std::nullopt;
    GltfLayers layers;
    layers.diffuse_roughness = desc.diffuse_roughness.factor;
    layers.diffuse_roughness_texture = textures.slot(desc.diffuse_roughness.texture, TextureUse::Data);
    layers.diffuse_transmission = desc.diffuse_transmission.factor;
    layers.diffuse_transmission_texture = textures.slot(desc.diffuse_transmission.texture, TextureUse::Data);
    layers.diffuse_transmission_color = desc.diffuse_transmission.color;
    layers.diffuse_transmission_color_texture =
        textures.slot(desc.diffuse_transmission.color_texture, TextureUse::Color);
    layers.anisotropy = desc.anisotropy.strength;
    layers.anisotropy_texture = textures.slot(desc.anisotropy.texture, TextureUse::Data);
    layers.iridescence = desc.iridescence.factor;
    layers.iridescence_texture = textures.slot(desc.iridescence.texture, TextureUse::Data);
    layers.film_ior = desc.iridescence.ior;
    layers.film_thickness_minimum_nm = desc.iridescence.thickness_minimum_nm;
    layers.film_thickness_maximum_nm = desc.iridescence.thickness_maximum_nm;
    layers.film_thickness_texture = textures.slot(desc.iridescence.thickness_texture, TextureUse::Data);
    layers.sheen_color = desc.sheen.color;
    layers.sheen_color_texture = textures.slot(desc.sheen.color_texture, TextureUse::Color);
    layers.sheen_roughness = desc.sheen.roughness;
    layers.sheen_roughness_texture = textures.slot(desc.sheen.roughness_texture, TextureUse::Data);
    layers.clearcoat = desc.clearcoat.factor;
    layers.clearcoat_texture = textures.slot(desc.clearcoat.texture, TextureUse::Data);
    layers.clearcoat_roughness = desc.clearcoat.roughness;
    layers.clearcoat_roughness_texture = textures.slot(desc.clearcoat.roughness_texture, TextureUse::Data);
    return layers;
}

/// A surface that reflects like a dielectric and lets everything else in and out at random angles.
GltfModel compile_subsurface(const SubsurfaceDesc& desc) {
    GltfModel model;
    model.metallic = 0.0f;
    model.roughness = desc.roughness;
    model.f0 = f0_from_ior(desc.ior);
    model.specular = desc.ior > 1.0f ? 1.0f : 0.0f;
    model.layers.emplace();
    model.layers->diffuse_transmission = 1.0f;
    return model;
}

/// Compiles a dielectric whose base colour varies by texture or vertex colours; it becomes glass of the glTF model.
GltfModel compile_varied_dielectric(const DielectricDesc& desc, const MaterialDesc& material,
                                    TextureCompiler& textures) {
    GltfModel model;
    model.base_color = material.base_color;
    model.base_color_texture = textures.slot(material.base_color_texture, TextureUse::Color);
    model.metallic = 0.0f;
    model.roughness = desc.roughness;
    model.f0 = f0_from_ior(desc.ior);
    model.transmission = 1.0f;
    model.refracts = true;
    model.ior = desc.ior;
    return model;
}

GltfModel compile_gltf(const MaterialDesc& desc, TextureUse base_use, TextureCompiler& textures) {
    GltfModel model;
    model.base_color = desc.base_color;
    model.base_color_texture = textures.slot(desc.base_color_texture, base_use);
    model.metallic = desc.metallic;
    model.roughness = desc.roughness;
    model.metallic_roughness_texture = textures.slot(desc.metallic_roughness_texture, TextureUse::Data);
    model.f0 = f0_from_ior(desc.ior);
    model.specular = desc.specular;
    model.specular_texture = textures.slot(desc.specular_texture, TextureUse::Data);
    model.specular_color = desc.specular_color;
    model.specular_color_texture = textures.slot(desc.specular_color_texture, TextureUse::Color);
    model.glossiness = desc.glossiness;
    model.transmission = desc.transmission;
    model.transmission_texture = textures.slot(desc.transmission_texture, TextureUse::Data);
    // An infinite index reflects everything.
    model.refracts = desc.volume.closed && desc.ior > 0.0f && desc.alpha_mode != AlphaMode::Mask;
    model.ior = desc.ior;
    model.layers = compile_layers(desc, textures);
    return model;
}

void compile_alpha(const MaterialDesc& desc, TextureCompiler& textures, Material& material) {
    material.alpha_test = desc.alpha_mode == AlphaMode::Mask ? AlphaTest::Mask : AlphaTest::Blend;
    material.alpha_cutoff = desc.alpha_cutoff;
    material.alpha_factor = desc.base_alpha;
    material.alpha_texture = textures.slot(desc.base_color_texture, TextureUse::ColorByAlpha);
}

Beam compile_beam(const BeamDesc& desc) {
    switch (desc.kind) {
        case BeamDesc::Kind::Panel:
            return Beam::panel(desc.spread);
        case BeamDesc::Kind::Spot:
            return Beam::spot(desc.inner_cone_angle, desc.outer_cone_angle);
        case BeamDesc::Kind::Diffuse:
            break;
    }
    return {};
}

/// Compiles a material; `is_colored` says whether meshes that use it have vertex colours.
Material compile_material(const MaterialDesc& desc, bool is_colored, const ColorMatrix& from_rec709,
                          TextureCompiler& textures) {
    Material material;
    // Rays that a filter lets through would not know that they are in a body; what passes its surface is transmission.
    const bool has_alpha = desc.alpha_mode != AlphaMode::Opaque && !compile_filling(desc, from_rec709);
    if (const auto* conductor = std::get_if<ConductorDesc>(&desc.override_model))
        material.model = compile_conductor(*conductor, from_rec709);
    else if (const auto* dielectric = std::get_if<DielectricDesc>(&desc.override_model);
             dielectric != nullptr && (is_colored || desc.base_color_texture.valid()))
        material.model = compile_varied_dielectric(*dielectric, desc, textures);
    else if (dielectric != nullptr)
        material.model = compile_dielectric(*dielectric, desc.base_color, from_rec709);
    else if (const auto* diffuse = std::get_if<DiffuseDesc>(&desc.override_model))
        material.model = compile_diffuse(*diffuse, from_rec709);
    else if (const auto* subsurface = std::get_if<SubsurfaceDesc>(&desc.override_model))
        material.model = compile_subsurface(*subsurface);
    else
        material.model = compile_gltf(desc, has_alpha ? TextureUse::ColorByAlpha : TextureUse::Color, textures);

    material.unlit = desc.unlit && std::holds_alternative<std::monostate>(desc.override_model);
    if (has_alpha) compile_alpha(desc, textures, material);
    if (const auto* model = std::get_if<GltfModel>(&material.model))
        material.is_clear = !material.unlit && model->transmission > 0.0f && model->metallic < 1.0f &&
                            (model->refracts ? !bends_light(model->ior) : is_smooth(model->roughness));
    if (const auto* dielectric = std::get_if<DielectricDesc>(&desc.override_model))
        material.is_clear = !bends_light(dielectric->ior);
    material.normal_texture = textures.slot(desc.normal_texture, TextureUse::NormalMap);
    material.normal_scale = desc.normal_scale;

    if (std::holds_alternative<std::monostate>(desc.override_model)) {
        material.has_coat = desc.clearcoat.factor > 0.0f;
        if (material.has_coat) {
            material.coat_normal_texture = textures.slot(desc.clearcoat.normal_texture, TextureUse::NormalMap);
            material.coat_normal_scale = desc.clearcoat.normal_scale;
        }
        material.is_anisotropic = desc.anisotropy.strength > 0.0f;
        material.anisotropy_texture = textures.slot(desc.anisotropy.texture, TextureUse::Data);
        material.anisotropy_rotation = desc.anisotropy.rotation;
    }

    const Rgb emission = desc.emissive * desc.emissive_strength;
    material.emits = max_component(emission) > 0.0f && !material.unlit;
    material.emits_both_sides = desc.double_sided;
    material.beam = compile_beam(desc.beam);
    material.visible_to_camera = desc.visible_to_camera;
    material.seen_as = desc.seen_as;
    if (material.emits) {
        material.emission_texture = textures.slot(desc.emissive_texture, TextureUse::Color);
        material.emission = material.emission_texture.valid() ? emission : clamp_negative(from_rec709(emission));
    }
    return material;
}

/// Finds the least roughness of materials; looks at each texture once.
class LeastRoughness {
  public:
    explicit LeastRoughness(const WorldData& data) : data_(data) {}

    [[nodiscard]] float of_base(const GltfModel& model) {
        if (is_smooth(model.roughness)) return model.roughness;
        if (model.glossiness)
            return model.roughness * (1.0f - *model.glossiness * range(model.specular_color_texture).greatest.alpha);
        return model.roughness * range(model.metallic_roughness_texture).least.rgb.g;
    }
    [[nodiscard]] float of_coat(const GltfLayers& layers) {
        if (is_smooth(layers.clearcoat_roughness)) return layers.clearcoat_roughness;
        return layers.clearcoat_roughness * range(layers.clearcoat_roughness_texture).least.rgb.g;
    }

  private:
    [[nodiscard]] TexelRange range(const TextureSlot& slot) {
        const Texel black{Rgb(0.0f), 0.0f}, white{Rgb(1.0f), 1.0f};
        if (!slot.valid()) return {white, white};
        auto known = ranges_.find(slot.texture);
        if (known == ranges_.end())
            known = ranges_.emplace(slot.texture, data_.textures[static_cast<std::size_t>(slot.texture)].range()).first;
        return known->second.value_or(TexelRange{black, white});
    }

    const WorldData& data_;
    std::map<std::int32_t, std::optional<TexelRange>> ranges_;  ///< by texture
};

/// Returns for each material of the scene whether any mesh that uses it has vertex colours.
std::vector<bool> find_colored_materials(const SceneDesc& scene) {
    std::vector<bool> is_colored(scene.materials.size(), false);
    for (const MeshDesc& mesh : scene.meshes)
        for (const PrimitiveDesc& primitive : mesh.primitives)
            if (primitive.material.valid() && !primitive.colors.empty())
                is_colored[static_cast<std::size_t>(primitive.material.index)] = true;
    return is_colored;
}

bool is_specular(const Material& material, LeastRoughness& roughness) {
    if (material.unlit) return false;
    if (const Bsdf* constant = std::get_if<Bsdf>(&material.model))
        return !has_non_delta(*constant) && !material.is_clear;
    const GltfModel& model = std::get<GltfModel>(material.model);
    const bool mirrors = model.refracts ? bends_light(model.ior) : model.specular > 0.0f;
    if (material.is_clear && !model.layers && model.transmission == 1.0f && !mirrors && model.metallic == 0.0f)
        return false;  // light goes straight on
    return is_smooth(roughness.of_base(model)) ||
           (model.layers && model.layers->clearcoat > 0.0f && is_smooth(roughness.of_coat(*model.layers)));
}

}  // namespace

void compile_materials(const SceneDesc& scene, TextureCompiler& textures, WorldData& data) {
    data.materials.clear();
    data.fillings.clear();
    data.materials.reserve(scene.materials.size());
    const std::vector<bool> is_colored = find_colored_materials(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const MaterialDesc& desc = scene.materials[i];
        data.materials.push_back(compile_material(desc, is_colored[i], data.from_rec709, textures));
        const std::optional<Filling> filling = compile_filling(desc, data.from_rec709);
        // A body that paths enter and do not leave would fill the space behind it.
        data.materials.back().culls_back = scene.settings.cull_backfaces && !desc.double_sided && !filling;
        if (!filling) continue;
        data.materials.back().filling = static_cast<std::uint32_t>(data.fillings.size());
        data.fillings.push_back(*filling);
    }
}

void find_specular_materials(WorldData& data) {
    LeastRoughness roughness(data);
    for (Material& material : data.materials) material.is_specular = is_specular(material, roughness);
}

}  // namespace etendue
