#include "bsdf/ggx.h"
#include "bsdf/measured_metals.h"
#include "world/compile_parts.h"

#include <algorithm>
#include <cmath>

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

Bsdf compile_dielectric(const DielectricDesc& desc) {
    if (is_smooth(desc.roughness)) return SmoothDielectric{desc.ior};
    return RoughDielectric::make(desc.ior, desc.roughness * desc.roughness);
}

/// Reflectance at normal incidence; KHR_materials_ior gives 0 the meaning of an infinite index.
float f0_from_ior(float ior) {
    if (ior == 0.0f) return 1.0f;
    const float root = (ior - 1.0f) / (ior + 1.0f);
    return root * root;
}

GltfModel compile_gltf(const MaterialDesc& desc, TextureCompiler& textures) {
    GltfModel model;
    model.base_color = desc.base_color;
    model.base_color_texture = textures.slot(desc.base_color_texture, TextureUse::Color);
    model.metallic = desc.metallic;
    model.roughness = desc.roughness;
    model.metallic_roughness_texture = textures.slot(desc.metallic_roughness_texture, TextureUse::Data);
    model.f0 = f0_from_ior(desc.ior);
    model.specular = desc.specular;
    model.specular_texture = textures.slot(desc.specular_texture, TextureUse::Data);
    model.specular_color = desc.specular_color;
    model.specular_color_texture = textures.slot(desc.specular_color_texture, TextureUse::Color);
    model.transmission = desc.transmission;
    model.transmission_texture = textures.slot(desc.transmission_texture, TextureUse::Data);
    return model;
}

void compile_alpha(const MaterialDesc& desc, TextureCompiler& textures, Material& material) {
    if (desc.alpha_mode == AlphaMode::Opaque) return;
    material.alpha_test = desc.alpha_mode == AlphaMode::Mask ? AlphaTest::Mask : AlphaTest::Blend;
    material.alpha_cutoff = desc.alpha_cutoff;
    material.alpha_factor = desc.base_alpha;
    material.alpha_texture = textures.slot(desc.base_color_texture, TextureUse::Color);
}

Material compile_material(const MaterialDesc& desc, const ColorMatrix& from_rec709, TextureCompiler& textures) {
    Material material;
    if (const auto* conductor = std::get_if<ConductorDesc>(&desc.override_model))
        material.model = compile_conductor(*conductor, from_rec709);
    else if (const auto* dielectric = std::get_if<DielectricDesc>(&desc.override_model))
        material.model = compile_dielectric(*dielectric);
    else if (const auto* diffuse = std::get_if<DiffuseDesc>(&desc.override_model))
        material.model = Bsdf(Diffuse{from_rec709(diffuse->albedo)});
    else
        material.model = compile_gltf(desc, textures);

    material.unlit = desc.unlit && std::holds_alternative<GltfModel>(material.model);
    compile_alpha(desc, textures, material);
    material.normal_texture = textures.slot(desc.normal_texture, TextureUse::Data);
    material.normal_scale = desc.normal_scale;

    const Rgb emission = desc.emissive * desc.emissive_strength;
    material.emits = max_component(emission) > 0.0f && !material.unlit;
    material.emits_both_sides = desc.double_sided;
    if (material.emits) {
        material.emission_texture = textures.slot(desc.emissive_texture, TextureUse::Color);
        material.emission = material.emission_texture.valid() ? emission : clamp_negative(from_rec709(emission));
    }
    return material;
}

}  // namespace

std::vector<Material> compile_materials(const SceneDesc& scene, const ColorMatrix& from_rec709,
                                        TextureCompiler& textures) {
    std::vector<Material> materials;
    materials.reserve(scene.materials.size());
    for (const MaterialDesc& desc : scene.materials) materials.push_back(compile_material(desc, from_rec709, textures));
    return materials;
}

}  // namespace etendue
