// The parts of the glTF 2.0 schema that are used here, as data. To read another property, add its line.

#include "loader/gltf/gltf_material_shape.h"
#include "loader/gltf/gltf_shape.h"
#include "loader/gltf/gltf_shape_build.h"
#include "scene/light_desc.h"

namespace etendue {

namespace {

using namespace gltf_schema;

// ---- buffers, views, accessors ----
// Placeholders that nothing reads may be empty, unlike in the schema.

constexpr ShapeField kMeshoptBufferFields[] = {{"fallback", boolean()}};
constexpr ShapeField kBufferExtensionFields[] = {
    {"EXT_meshopt_compression", object(kMeshoptBufferFields)},
    {"KHR_meshopt_compression", object(kMeshoptBufferFields)},
};
constexpr ShapeField kBufferFields[] = {
    {"name", text()},
    {"uri", text()},
    {"byteLength", integer(0, kMaxOffset), true},
    {"extensions", object(kBufferExtensionFields)},
};
constexpr Shape kBuffer = object(kBufferFields);

constexpr std::string_view kMeshoptModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr std::string_view kMeshoptFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"};
constexpr ShapeField kMeshoptViewFields[] = {
    {"buffer", index_of("/buffers"), true},
    {"byteOffset", integer(0, kMaxOffset)},
    {"byteLength", integer(0, kMaxOffset), true},
    {"byteStride", integer(2, 256), true},
    {"count", integer(0, kMaxVertices), true},
    {"mode", text(kMeshoptModes), true},
    {"filter", text(kMeshoptFilters)},
};
constexpr ShapeField kBufferViewExtensionFields[] = {
    {"EXT_meshopt_compression", object(kMeshoptViewFields)},
    {"KHR_meshopt_compression", object(kMeshoptViewFields)},
};
constexpr ShapeField kBufferViewFields[] = {
    {"name", text()},
    {"buffer", index_of("/buffers"), true},
    {"byteOffset", integer(0, kMaxOffset)},
    {"byteLength", integer(0, kMaxOffset), true},
    {"byteStride", integer(0, kMaxInt)},
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
    {"count", integer(0, kMaxInt), true},
    {"indices", object(kSparseIndicesFields), true},
    {"values", object(kSparseValuesFields), true},
};
constexpr ShapeField kAccessorFields[] = {
    {"name", text()},
    {"bufferView", index_of("/bufferViews")},
    {"byteOffset", integer(0, kMaxOffset)},
    {"componentType", one_of(kComponentTypes), true},
    {"normalized", boolean()},
    {"count", integer(0, kMaxVertices), true},
    {"type", text(kElementTypes), true},
    {"min", array(kNumber)},
    {"max", array(kNumber)},
    {"sparse", object(kSparseFields)},
};
constexpr Shape kAccessor = object(kAccessorFields);

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
    {"znear", number(), true},
    {"zfar", number()},
};
constexpr ShapeField kOrthographicFields[] = {
    {"xmag", number(), true},
    {"ymag", number(), true},
    {"znear", number(), true},
    {"zfar", number(), true},
};
constexpr ShapeField kCameraFields[] = {
    {"name", text()},
    {"type", text(kCameraTypes), true},
    {"perspective", object(kPerspectiveFields)},
    {"orthographic", object(kOrthographicFields)},
};
constexpr Shape kCamera = object(kCameraFields);

constexpr ShapeField kSpotFields[] = {
    {"innerConeAngle", number()},
    {"outerConeAngle", number()},
};
constexpr ShapeField kLightFields[] = {
    {"name", text()},
    {"type", text(kLightTypeNames), true},
    {"color", array(kNumber, 3)},
    {"intensity", number(0.0)},
    {"range", number()},
    {"spot", object(kSpotFields)},
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
constexpr Shape kCubeLevels = some(kCubeFaces);
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
