#include "loader/gltf/gltf_variants.h"

#include "loader/gltf/gltf_value.h"

#include <cstdint>

namespace etendue {

std::vector<std::string> read_variant_names(const tinygltf::Model& model) {
    std::vector<std::string> names;
    if (const tinygltf::Value* variants = find_extension(model.extensions, "KHR_materials_variants"))
        for_each_element(*variants, "variants", [&](const tinygltf::Value& variant) {
            names.push_back(variant.Get("name").Get<std::string>());
        });
    return names;
}

std::vector<VariantMaterial> read_variant_materials(const tinygltf::Primitive& source) {
    std::vector<VariantMaterial> result;
    const tinygltf::Value* extension = find_extension(source.extensions, "KHR_materials_variants");
    if (extension == nullptr) return result;
    for_each_element(*extension, "mappings", [&](const tinygltf::Value& mapping) {
        const Handle<MaterialDesc> material{integer_or(mapping, "material", 0)};
        for_each_element(mapping, "variants", [&](const tinygltf::Value& variant) {
            result.push_back({static_cast<std::uint32_t>(variant.GetNumberAsInt()), material});
        });
    });
    return result;
}

}  // namespace etendue
