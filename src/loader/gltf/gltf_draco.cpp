#include "loader/gltf/gltf_draco.h"

#include "core/error.h"
#include "loader/gltf/draco_decoder.h"
#include "loader/gltf/gltf_value.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Largest value of an accessor's integers, by which normalised ones are divided.
float largest_integer(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return 127.0f;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 255.0f;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return 32767.0f;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 65535.0f;
        default:
            return 1.0f;
    }
}

/// One value for each point of the mesh. Empty if a value cannot be converted.
std::vector<float> point_values(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int components,
                                const tinygltf::Accessor& accessor) {
    std::vector<float> values(static_cast<std::size_t>(mesh.num_points()) * static_cast<std::size_t>(components));
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
        float* out = values.data() + point.value() * static_cast<std::size_t>(components);
        const draco::AttributeValueIndex index = attribute.mapped_index(point);
        if (!attribute.ConvertValue<float>(index, static_cast<std::int8_t>(components), out)) return {};
    }
    // Draco knows the type; whether integers are fractions is the accessor's to say.
    if (accessor.normalized && !attribute.normalized())
        for (float& value : values) value = std::max(-1.0f, value / largest_integer(accessor.componentType));
    return values;
}

}  // namespace

std::optional<DracoMesh> decode_draco(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                      AccessorReader& accessors, const SourceLocation& where, ProblemList& problems) {
    const auto fail = [&](const std::string& message) {
        problems.error(where, message);
        return std::nullopt;
    };
    const tinygltf::Value& extension = *find_extension(primitive.extensions, kDracoExtension);
    const auto bytes = accessors.copyable_view(integer_or(extension, "bufferView", -1), where);
    if (!bytes) return std::nullopt;
    std::unique_ptr<draco::Mesh> mesh;
    std::uint64_t asked = 0;
    try {
        mesh = decode_draco_mesh(*bytes, [&](std::uint64_t more) {
            asked += more;
            return accessors.has_room(more, where);
        });
    } catch (const IoError& error) {
        // What fails is charged, so that primitives cannot have it tried over and over.
        static_cast<void>(accessors.allocate(asked, 1, where));
        return fail(fmt::format("the Draco data cannot be decoded: {}", error.what()));
    }
    if (!mesh) return std::nullopt;

    DracoMesh result;
    if (!accessors.allocate(mesh->num_faces(), 3 * sizeof(std::uint32_t), where)) return std::nullopt;
    result.indices.reserve(std::size_t{3} * mesh->num_faces());
    for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
        for (const draco::PointIndex& point : mesh->face(face)) result.indices.push_back(point.value());

    std::string wrong_count;
    const tinygltf::Value& names = extension.Get("attributes");
    for (const std::string& name : names.Keys()) {
        const auto named = primitive.attributes.find(name);
        if (named == primitive.attributes.end()) continue;
        const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(named->second)];
        const int id = names.Get(name).GetNumberAsInt();
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        const int components = component_count(accessor);
        if (attribute == nullptr) return fail(fmt::format("the Draco data has no attribute {} for {}", id, name));
        if (components == 0 || attribute->num_components() != components)
            return fail(fmt::format("{} has {} components in the Draco data, but {} in its accessor", name,
                                    attribute->num_components(), components));
        if (accessor.count != mesh->num_points())
            wrong_count =
                fmt::format("the Draco data has {} vertices, which are taken, though the accessor of {} has {}",
                            mesh->num_points(), name, accessor.count);
        if (!accessors.allocate(mesh->num_points(), static_cast<std::uint64_t>(components) * sizeof(float), where))
            return std::nullopt;
        std::vector<float> values = point_values(*mesh, *attribute, components, accessor);
        if (values.empty()) return fail("the Draco data cannot be converted to numbers");
        result.attributes[name] = {std::move(values), components};
    }
    if (!wrong_count.empty()) problems.warning(where, wrong_count);
    return result;
}

}  // namespace etendue
