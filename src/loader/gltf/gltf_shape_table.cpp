// The parts of the glTF 2.0 schema that are used here, as data. To read another property, add its line.

#include "loader/gltf/gltf_shape.h"

#include <cfloat>

namespace etendue {

namespace {

using namespace std::string_view_literals;

constexpr double kMaxInt = 2147483647.0;
constexpr double kMaxOffset = 9007199254740992.0;  // 2^53, exact in JSON
constexpr double kMaxVertices = 4294967294.0;      // so that every index fits 32 bits

constexpr Shape text(std::span<const std::string_view> allowed = {}) {
    return {.kind = Shape::Kind::Text, .texts = allowed};
}
constexpr Shape boolean() {
    return {.kind = Shape::Kind::Boolean};
}
constexpr Shape integer(double min, double max) {
    return {.kind = Shape::Kind::Integer, .min = min, .max = max};
}
constexpr Shape one_of(std::span<const std::int64_t> allowed) {
    return {.kind = Shape::Kind::Integer, .min = -kMaxInt, .max = kMaxInt, .integers = allowed};
}
constexpr Shape index_of(std::string_view target) {
    return {.kind = Shape::Kind::Integer, .target = target};
}
constexpr Shape number(double min = -FLT_MAX, double max = FLT_MAX) {
    return {.kind = Shape::Kind::Number, .min = min, .max = max};
}
constexpr Shape array(const Shape& element) {
    return {.kind = Shape::Kind::Array, .element = &element};
}
constexpr Shape array(const Shape& element, std::size_t length) {
    return {.kind = Shape::Kind::Array, .min_length = length, .max_length = length, .element = &element};
}
constexpr Shape map(const Shape& element) {
    return {.kind = Shape::Kind::Map, .element = &element};
}
template <std::size_t N>
constexpr Shape object(const ShapeField (&fields)[N]) {
    return {.kind = Shape::Kind::Object, .fields = fields, .field_count = N};
}
constexpr Shape object() {
    return {.kind = Shape::Kind::Object};
}

constexpr Shape kText = text();
constexpr Shape kNumber = number();

// ---- buffers, views, accessors ----

constexpr ShapeField kMeshoptBufferFields[] = {{"fallback", boolean()}};
constexpr ShapeField kBufferExtensionFields[] = {{"EXT_meshopt_compression", object(kMeshoptBufferFields)}};
constexpr ShapeField kBufferFields[] = {
    {"name", text()},
    {"uri", text()},
    {"byteLength", integer(1, kMaxOffset), true},
    {"extensions", object(kBufferExtensionFields)},
};
constexpr Shape kBuffer = object(kBufferFields);

constexpr std::string_view kMeshoptModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr std::string_view kMeshoptFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
constexpr ShapeField kMeshoptViewFields[] = {
    {"buffer", index_of("/buffers"), true},
    {"byteOffset", integer(0, kMaxOffset)},
    {"byteLength", integer(1, kMaxOffset), true},
    {"byteStride", integer(2, 256), true},
    {"count", integer(1, kMaxVertices), true},
    {"mode", text(kMeshoptModes), true},
    {"filter", text(kMeshoptFilters)},
};
constexpr ShapeField kBufferViewExtensionFields[] = {{"EXT_meshopt_compression", object(kMeshoptViewFields)}};
constexpr ShapeField kBufferViewFields[] = {
    {"name", text()},
    {"buffer", index_of("/buffers"), true},
    {"byteOffset", integer(0, kMaxOffset)},
    {"byteLength", integer(1, kMaxOffset), true},
    {"byteStride", integer(4, 252)},
    {"target", integer(0, kMaxInt)},
    {"extensions", object(kBufferViewExtensionFields)},
};
constexpr Shape kBufferView = object(kBufferViewFields);

constexpr std::int64_t kComponentTypes[] = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr std::int64_t kIndexTypes[] = {5121, 5123, 5125};
constexpr std::string_view kElementTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};

constexpr ShapeField kSparseIndicesFields[] = {
    {"bufferView", index_of("/bufferViews"), true},
    {"byteOffset", integer(0, kMaxInt)},
    {"componentType", one_of(kIndexTypes), true},
};
constexpr ShapeField kSparseValuesFields[] = {
    {"bufferView", index_of("/bufferViews"), true},
    {"byteOffset", integer(0, kMaxInt)},
};
constexpr ShapeField kSparseFields[] = {
    {"count", integer(1, kMaxInt), true},
    {"indices", object(kSparseIndicesFields), true},
    {"values", object(kSparseValuesFields), true},
};
constexpr ShapeField kAccessorFields[] = {
    {"name", text()},
    {"bufferView", index_of("/bufferViews")},
    {"byteOffset", integer(0, kMaxOffset)},
    {"componentType", one_of(kComponentTypes), true},
    {"normalized", boolean()},
    {"count", integer(1, kMaxVertices), true},
    {"type", text(kElementTypes), true},
    {"min", array(kNumber)},
    {"max", array(kNumber)},
    {"sparse", object(kSparseFields)},
};
constexpr Shape kAccessor = object(kAccessorFields);

// ---- images, textures, materials ----

constexpr ShapeField kImageFields[] = {
    {"name", text()},
    {"uri", text()},
    {"mimeType", text()},
    {"bufferView", index_of("/bufferViews")},
};
constexpr Shape kImage = object(kImageFields);

constexpr std::int64_t kMagFilters[] = {9728, 9729};
constexpr std::int64_t kMinFilters[] = {9728, 9729, 9984, 9985, 9986, 9987};
constexpr std::int64_t kWraps[] = {33071, 33648, 10497};
constexpr ShapeField kSamplerFields[] = {
    {"name", text()},          {"magFilter", one_of(kMagFilters)}, {"minFilter", one_of(kMinFilters)},
    {"wrapS", one_of(kWraps)}, {"wrapT", one_of(kWraps)},
};
constexpr Shape kSampler = object(kSamplerFields);

constexpr ShapeField kWebpFields[] = {{"source", index_of("/images"), true}};
constexpr ShapeField kTextureExtensionFields[] = {{"EXT_texture_webp", object(kWebpFields)}};
constexpr ShapeField kTextureFields[] = {
    {"name", text()},
    {"sampler", index_of("/samplers")},
    {"source", index_of("/images")},
    {"extensions", object(kTextureExtensionFields)},
};
constexpr Shape kTexture = object(kTextureFields);

constexpr ShapeField kTextureTransformFields[] = {
    {"offset", array(kNumber, 2)},
    {"rotation", number()},
    {"scale", array(kNumber, 2)},
    {"texCoord", integer(0, kMaxInt)},
};
constexpr ShapeField kTextureInfoExtensionFields[] = {
    {"KHR_texture_transform", object(kTextureTransformFields)},
};
constexpr ShapeField kTextureInfoFields[] = {
    {"index", index_of("/textures"), true},
    {"texCoord", integer(0, kMaxInt)},
    {"scale", number()},     // normalTexture only
    {"strength", number()},  // occlusionTexture only
    {"extensions", object(kTextureInfoExtensionFields)},
};
constexpr Shape kTextureInfo = object(kTextureInfoFields);

constexpr ShapeField kMetallicRoughnessFields[] = {
    {"baseColorFactor", array(kNumber, 4)}, {"baseColorTexture", kTextureInfo},         {"metallicFactor", number()},
    {"roughnessFactor", number()},          {"metallicRoughnessTexture", kTextureInfo},
};
constexpr ShapeField kEmissiveStrengthFields[] = {{"emissiveStrength", number(0.0)}};
constexpr ShapeField kTransmissionFields[] = {
    {"transmissionFactor", number()},
    {"transmissionTexture", kTextureInfo},
};
constexpr ShapeField kSpecularFields[] = {
    {"specularFactor", number()},
    {"specularTexture", kTextureInfo},
    {"specularColorFactor", array(kNumber, 3)},
    {"specularColorTexture", kTextureInfo},
};
constexpr ShapeField kIorFields[] = {{"ior", number(0.0)}};
constexpr ShapeField kVolumeFields[] = {
    {"thicknessFactor", number(0.0)},
    {"thicknessTexture", kTextureInfo},
    {"attenuationDistance", number(0.0)},
    {"attenuationColor", array(kNumber, 3)},
};
constexpr ShapeField kDispersionFields[] = {{"dispersion", number(0.0)}};
constexpr ShapeField kVolumeScatterFields[] = {
    {"multiscatterColor", array(kNumber, 3)},
    {"scatterAnisotropy", number(-1.0, 1.0)},
};
constexpr ShapeField kDiffuseTransmissionFields[] = {
    {"diffuseTransmissionFactor", number()},
    {"diffuseTransmissionTexture", kTextureInfo},
    {"diffuseTransmissionColorFactor", array(kNumber, 3)},
    {"diffuseTransmissionColorTexture", kTextureInfo},
};
constexpr ShapeField kAnisotropyFields[] = {
    {"anisotropyStrength", number()},
    {"anisotropyRotation", number()},
    {"anisotropyTexture", kTextureInfo},
};
constexpr ShapeField kIridescenceFields[] = {
    {"iridescenceFactor", number()},
    {"iridescenceTexture", kTextureInfo},
    {"iridescenceIor", number(1.0)},
    {"iridescenceThicknessMinimum", number(0.0)},
    {"iridescenceThicknessMaximum", number(0.0)},
    {"iridescenceThicknessTexture", kTextureInfo},
};
constexpr ShapeField kSheenFields[] = {
    {"sheenColorFactor", array(kNumber, 3)},
    {"sheenColorTexture", kTextureInfo},
    {"sheenRoughnessFactor", number()},
    {"sheenRoughnessTexture", kTextureInfo},
};
constexpr ShapeField kClearcoatFields[] = {
    {"clearcoatFactor", number()},
    {"clearcoatTexture", kTextureInfo},
    {"clearcoatRoughnessFactor", number()},
    {"clearcoatRoughnessTexture", kTextureInfo},
    {"clearcoatNormalTexture", kTextureInfo},
};
constexpr ShapeField kMaterialExtensionFields[] = {
    {"KHR_materials_anisotropy", object(kAnisotropyFields)},
    {"KHR_materials_clearcoat", object(kClearcoatFields)},
    {"KHR_materials_diffuse_transmission", object(kDiffuseTransmissionFields)},
    {"KHR_materials_dispersion", object(kDispersionFields)},
    {"KHR_materials_iridescence", object(kIridescenceFields)},
    {"KHR_materials_sheen", object(kSheenFields)},
    {"KHR_materials_volume", object(kVolumeFields)},
    {"KHR_materials_volume_scatter", object(kVolumeScatterFields)},
    {"KHR_materials_emissive_strength", object(kEmissiveStrengthFields)},
    {"KHR_materials_transmission", object(kTransmissionFields)},
    {"KHR_materials_ior", object(kIorFields)},
    {"KHR_materials_specular", object(kSpecularFields)},
    {"KHR_materials_unlit", object()},
};
constexpr std::string_view kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr ShapeField kMaterialFields[] = {
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
constexpr Shape kMaterial = object(kMaterialFields);

// ---- meshes, nodes, scenes ----

constexpr Shape kAccessorIndex = index_of("/accessors");
constexpr Shape kAttributes = map(kAccessorIndex);
constexpr Shape kDracoId = integer(0, kMaxInt);
constexpr ShapeField kDracoFields[] = {
    {"bufferView", index_of("/bufferViews"), true},
    {"attributes", map(kDracoId), true},
};
constexpr Shape kVariantIndex = index_of("/extensions/KHR_materials_variants/variants");
constexpr ShapeField kVariantMappingFields[] = {
    {"material", index_of("/materials"), true},
    {"variants", array(kVariantIndex), true},
};
constexpr Shape kVariantMapping = object(kVariantMappingFields);
constexpr ShapeField kPrimitiveVariantsFields[] = {{"mappings", array(kVariantMapping), true}};
constexpr ShapeField kPrimitiveExtensionFields[] = {
    {"KHR_draco_mesh_compression", object(kDracoFields)},
    {"KHR_materials_variants", object(kPrimitiveVariantsFields)},
};
constexpr ShapeField kPrimitiveFields[] = {
    {"attributes", kAttributes, true},    {"indices", index_of("/accessors")},
    {"material", index_of("/materials")}, {"mode", integer(0, 6)},
    {"targets", array(kAttributes)},      {"extensions", object(kPrimitiveExtensionFields)},
};
constexpr Shape kPrimitive = object(kPrimitiveFields);
constexpr ShapeField kMeshFields[] = {
    {"name", text()},
    {"primitives", array(kPrimitive), true},
    {"weights", array(kNumber)},
};
constexpr Shape kMesh = object(kMeshFields);

constexpr Shape kNodeIndex = index_of("/nodes");
constexpr ShapeField kNodeLightFields[] = {{"light", index_of("/extensions/KHR_lights_punctual/lights"), true}};
constexpr ShapeField kInstancingFields[] = {{"attributes", kAttributes, true}};
constexpr ShapeField kNodeProfileFields[] = {
    {"light", index_of("/extensions/EXT_lights_ies/lights"), true},
    {"multiplier", number(0.0)},
    {"color", array(kNumber, 3)},
};
constexpr ShapeField kVisibilityFields[] = {{"visible", boolean()}};
constexpr ShapeField kNodeExtensionFields[] = {
    {"EXT_lights_ies", object(kNodeProfileFields)},
    {"EXT_mesh_gpu_instancing", object(kInstancingFields)},
    {"KHR_lights_punctual", object(kNodeLightFields)},
    {"KHR_node_visibility", object(kVisibilityFields)},
};
constexpr ShapeField kNodeFields[] = {
    {"name", text()},
    {"children", array(kNodeIndex)},
    {"mesh", index_of("/meshes")},
    {"camera", index_of("/cameras")},
    {"skin", index_of("/skins")},
    {"matrix", array(kNumber, 16)},
    {"translation", array(kNumber, 3)},
    {"rotation", array(kNumber, 4)},
    {"scale", array(kNumber, 3)},
    {"weights", array(kNumber)},
    {"extensions", object(kNodeExtensionFields)},
};
constexpr Shape kNode = object(kNodeFields);

constexpr ShapeField kSceneEnvironmentFields[] = {
    {"light", index_of("/extensions/EXT_lights_image_based/lights"), true},
};
constexpr ShapeField kSceneExtensionFields[] = {{"EXT_lights_image_based", object(kSceneEnvironmentFields)}};
constexpr ShapeField kSceneFields[] = {
    {"name", text()},
    {"nodes", array(kNodeIndex)},
    {"extensions", object(kSceneExtensionFields)},
};
constexpr Shape kScene = object(kSceneFields);

// ---- cameras and lights ----

constexpr std::string_view kCameraTypes[] = {"perspective", "orthographic"};
constexpr ShapeField kPerspectiveFields[] = {
    {"yfov", number(), true},
    {"aspectRatio", number(0.0)},
    {"znear", number()},
    {"zfar", number()},
};
constexpr ShapeField kOrthographicFields[] = {
    {"xmag", number(), true},
    {"ymag", number(), true},
    {"znear", number()},
    {"zfar", number()},
};
constexpr ShapeField kCameraFields[] = {
    {"name", text()},
    {"type", text(kCameraTypes), true},
    {"perspective", object(kPerspectiveFields)},
    {"orthographic", object(kOrthographicFields)},
};
constexpr Shape kCamera = object(kCameraFields);

constexpr std::string_view kLightTypes[] = {"point", "spot", "directional"};
constexpr ShapeField kSpotFields[] = {
    {"innerConeAngle", number()},
    {"outerConeAngle", number()},
};
constexpr ShapeField kLightFields[] = {
    {"name", text()},    {"type", text(kLightTypes), true}, {"color", array(kNumber, 3)}, {"intensity", number(0.0)},
    {"range", number()}, {"spot", object(kSpotFields)},
};
constexpr Shape kLight = object(kLightFields);
constexpr ShapeField kLightsFields[] = {{"lights", array(kLight), true}};
constexpr ShapeField kProfileFields[] = {
    {"name", text()},
    {"uri", text()},
    {"mimeType", text()},
    {"bufferView", index_of("/bufferViews")},
};
constexpr Shape kProfile = object(kProfileFields);
constexpr ShapeField kProfilesFields[] = {{"lights", array(kProfile), true}};
constexpr Shape kImageIndex = index_of("/images");
constexpr Shape kCubeFaces = array(kImageIndex, 6);
constexpr Shape kCubeLevels = {.kind = Shape::Kind::Array, .min_length = 1, .element = &kCubeFaces};
constexpr ShapeField kImageLightFields[] = {
    {"name", text()},
    {"rotation", array(kNumber, 4)},
    {"intensity", number(0.0)},
    {"specularImages", kCubeLevels, true},
    {"specularImageSize", integer(1, kMaxInt), true},
};
constexpr Shape kImageLight = object(kImageLightFields);
constexpr ShapeField kImageLightsFields[] = {{"lights", array(kImageLight), true}};
constexpr ShapeField kVariantFields[] = {{"name", text(), true}};
constexpr Shape kVariant = object(kVariantFields);
constexpr ShapeField kVariantsFields[] = {{"variants", array(kVariant), true}};
constexpr ShapeField kDocumentExtensionFields[] = {
    {"EXT_lights_ies", object(kProfilesFields)},
    {"EXT_lights_image_based", object(kImageLightsFields)},
    {"KHR_lights_punctual", object(kLightsFields)},
    {"KHR_materials_variants", object(kVariantsFields)},
};

// ---- animations and skins ----

constexpr std::string_view kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr ShapeField kAnimationSamplerFields[] = {
    {"input", index_of("/accessors"), true},
    {"output", index_of("/accessors"), true},
    {"interpolation", text(kInterpolations)},
};
constexpr Shape kAnimationSampler = object(kAnimationSamplerFields);
constexpr ShapeField kAnimationPointerFields[] = {{"pointer", text(), true}};
constexpr ShapeField kTargetExtensionFields[] = {{"KHR_animation_pointer", object(kAnimationPointerFields)}};
constexpr ShapeField kTargetFields[] = {
    {"node", index_of("/nodes")},
    {"path", text(), true},
    {"extensions", object(kTargetExtensionFields)},
};
constexpr ShapeField kChannelFields[] = {
    {"sampler", integer(0, kMaxInt), true},
    {"target", object(kTargetFields), true},
};
constexpr Shape kChannel = object(kChannelFields);
constexpr ShapeField kAnimationFields[] = {
    {"name", text()},
    {"samplers", array(kAnimationSampler), true},
    {"channels", array(kChannel), true},
};
constexpr Shape kAnimation = object(kAnimationFields);
constexpr ShapeField kSkinFields[] = {
    {"inverseBindMatrices", index_of("/accessors")},
    {"joints", array(kNodeIndex), true},
};
constexpr Shape kSkin = object(kSkinFields);

// ---- the document ----

constexpr ShapeField kAssetFields[] = {
    {"version", text(), true},
    {"minVersion", text()},
};
constexpr ShapeField kDocumentFields[] = {
    {"asset", object(kAssetFields), true},
    {"extensionsUsed", array(kText)},
    {"extensionsRequired", array(kText)},
    {"buffers", array(kBuffer)},
    {"bufferViews", array(kBufferView)},
    {"accessors", array(kAccessor)},
    {"images", array(kImage)},
    {"samplers", array(kSampler)},
    {"textures", array(kTexture)},
    {"materials", array(kMaterial)},
    {"meshes", array(kMesh)},
    {"cameras", array(kCamera)},
    {"nodes", array(kNode)},
    {"scenes", array(kScene)},
    {"skins", array(kSkin)},
    {"animations", array(kAnimation)},
    {"scene", index_of("/scenes")},
    {"extensions", object(kDocumentExtensionFields)},
};
constexpr Shape kDocument = object(kDocumentFields);

}  // namespace

const Shape& gltf_shape() {
    return kDocument;
}

}  // namespace etendue
