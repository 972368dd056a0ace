// Images, textures and materials in the table of gltf_shape_table.cpp. To read another property, add its line.
#pragma once

#include "loader/gltf/gltf_shape_build.h"

namespace etendue::gltf_schema {

inline constexpr ShapeField kImageFields[] = {
    {"name", text()},
    {"uri", text()},
    {"mimeType", text()},
    {"bufferView", index_of("/bufferViews")},
};
inline constexpr Shape kImage = object(kImageFields);

inline constexpr std::int64_t kMagFilters[] = {9728, 9729};
inline constexpr std::int64_t kMinFilters[] = {9728, 9729, 9984, 9985, 9986, 9987};
inline constexpr std::int64_t kWraps[] = {33071, 33648, 10497};
inline constexpr ShapeField kSamplerFields[] = {
    {"name", text()},          {"magFilter", one_of(kMagFilters)}, {"minFilter", one_of(kMinFilters)},
    {"wrapS", one_of(kWraps)}, {"wrapT", one_of(kWraps)},
};
inline constexpr Shape kSampler = object(kSamplerFields);

inline constexpr ShapeField kWebpFields[] = {{"source", index_of("/images"), true}};
inline constexpr ShapeField kTextureExtensionFields[] = {{"EXT_texture_webp", object(kWebpFields)}};
inline constexpr ShapeField kTextureFields[] = {
    {"name", text()},
    {"sampler", index_of("/samplers")},
    {"source", index_of("/images")},
    {"extensions", object(kTextureExtensionFields)},
};
inline constexpr Shape kTexture = object(kTextureFields);

inline constexpr ShapeField kTextureTransformFields[] = {
    {"offset", array(kNumber, 2)},
    {"rotation", number()},
    {"scale", array(kNumber, 2)},
    {"texCoord", integer(0, kMaxInt)},
};
inline constexpr ShapeField kTextureInfoExtensionFields[] = {
    {"KHR_texture_transform", object(kTextureTransformFields)},
};
inline constexpr ShapeField kTextureInfoFields[] = {
    {"index", index_of("/textures"), true},
    {"texCoord", integer(0, kMaxInt)},
    {"scale", number()},     // normalTexture only
    {"strength", number()},  // occlusionTexture only
    {"extensions", object(kTextureInfoExtensionFields)},
};
inline constexpr Shape kTextureInfo = object(kTextureInfoFields);

inline constexpr ShapeField kMetallicRoughnessFields[] = {
    {"baseColorFactor", array(kNumber, 4)}, {"baseColorTexture", kTextureInfo},         {"metallicFactor", number()},
    {"roughnessFactor", number()},          {"metallicRoughnessTexture", kTextureInfo},
};
inline constexpr ShapeField kEmissiveStrengthFields[] = {{"emissiveStrength", number(0.0)}};
inline constexpr ShapeField kTransmissionFields[] = {
    {"transmissionFactor", number()},
    {"transmissionTexture", kTextureInfo},
};
inline constexpr ShapeField kSpecularFields[] = {
    {"specularFactor", number()},
    {"specularTexture", kTextureInfo},
    {"specularColorFactor", array(kNumber, 3)},
    {"specularColorTexture", kTextureInfo},
};
inline constexpr ShapeField kSpecularGlossinessFields[] = {
    {"diffuseFactor", array(kNumber, 4)},        {"diffuseTexture", kTextureInfo},
    {"specularFactor", array(kNumber, 3)},       {"glossinessFactor", number()},
    {"specularGlossinessTexture", kTextureInfo},
};
inline constexpr ShapeField kIorFields[] = {{"ior", number(0.0)}};
inline constexpr ShapeField kVolumeFields[] = {
    {"thicknessFactor", number(0.0)},
    {"thicknessTexture", kTextureInfo},
    {"attenuationDistance", number(0.0)},
    {"attenuationColor", array(kNumber, 3)},
};
inline constexpr ShapeField kDispersionFields[] = {{"dispersion", number(0.0)}};
inline constexpr ShapeField kVolumeScatterFields[] = {
    {"multiscatterColor", array(kNumber, 3)},
    {"scatterAnisotropy", number(-1.0, 1.0)},
};
inline constexpr ShapeField kDiffuseRoughnessFields[] = {
    {"diffuseRoughnessFactor", number()},
    {"diffuseRoughnessTexture", kTextureInfo},
};
inline constexpr ShapeField kDiffuseTransmissionFields[] = {
    {"diffuseTransmissionFactor", number()},
    {"diffuseTransmissionTexture", kTextureInfo},
    {"diffuseTransmissionColorFactor", array(kNumber, 3)},
    {"diffuseTransmissionColorTexture", kTextureInfo},
};
inline constexpr ShapeField kAnisotropyFields[] = {
    {"anisotropyStrength", number()},
    {"anisotropyRotation", number()},
    {"anisotropyTexture", kTextureInfo},
};
inline constexpr ShapeField kIridescenceFields[] = {
    {"iridescenceFactor", number()},
    {"iridescenceTexture", kTextureInfo},
    {"iridescenceIor", number(1.0)},
    {"iridescenceThicknessMinimum", number(0.0)},
    {"iridescenceThicknessMaximum", number(0.0)},
    {"iridescenceThicknessTexture", kTextureInfo},
};
inline constexpr ShapeField kSheenFields[] = {
    {"sheenColorFactor", array(kNumber, 3)},
    {"sheenColorTexture", kTextureInfo},
    {"sheenRoughnessFactor", number()},
    {"sheenRoughnessTexture", kTextureInfo},
};
inline constexpr ShapeField kClearcoatFields[] = {
    {"clearcoatFactor", number()},
    {"clearcoatTexture", kTextureInfo},
    {"clearcoatRoughnessFactor", number()},
    {"clearcoatRoughnessTexture", kTextureInfo},
    {"clearcoatNormalTexture", kTextureInfo},
};
inline constexpr ShapeField kMaterialExtensionFields[] = {
    {"KHR_materials_anisotropy", object(kAnisotropyFields)},
    {"KHR_materials_clearcoat", object(kClearcoatFields)},
    {"KHR_materials_diffuse_roughness", object(kDiffuseRoughnessFields)},
    {"KHR_materials_diffuse_transmission", object(kDiffuseTransmissionFields)},
    {"KHR_materials_dispersion", object(kDispersionFields)},
    {"KHR_materials_iridescence", object(kIridescenceFields)},
    {"KHR_materials_pbrSpecularGlossiness", object(kSpecularGlossinessFields)},
    {"KHR_materials_sheen", object(kSheenFields)},
    {"KHR_materials_volume", object(kVolumeFields)},
    {"KHR_materials_volume_scatter", object(kVolumeScatterFields)},
    {"KHR_materials_emissive_strength", object(kEmissiveStrengthFields)},
    {"KHR_materials_transmission", object(kTransmissionFields)},
    {"KHR_materials_ior", object(kIorFields)},
    {"KHR_materials_specular", object(kSpecularFields)},
    {"KHR_materials_unlit", object()},
};
inline constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
inline constexpr ShapeField kMaterialFields[] = {
    {"name", text()},
    {"pbrMetallicRoughness", object(kMetallicRoughnessFields)},
    {"normalTexture", kTextureInfo},
    {"occlusionTexture", kTextureInfo},
    {"emissiveTexture", kTextureInfo},
    {"emissiveFactor", array(kNumber, 3)},
    {"alphaMode", text(kAlphaModes)},
    {"alphaCutoff", number(0.0)},
    {"doubleSided", boolean()},
    {"extensions", object(kMaterialExtensionFields)},
};
inline constexpr Shape kMaterial = object(kMaterialFields);

}  // namespace etendue::gltf_schema
