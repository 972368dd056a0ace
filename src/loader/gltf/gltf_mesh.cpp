#include "loader/gltf/gltf_mesh.h"

#include "loader/gltf/gltf_draco.h"
#include "loader/gltf/gltf_value.h"
#include "loader/gltf/gltf_variants.h"
#include "loader/gltf/repair_log.h"
#include "loader/gltf/vertex_data.h"
#include "scene/material_textures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr AttributeFormat kPosition{3, 3, kNoIntegers, kAnyIntegers};
constexpr AttributeFormat kNormal{3, 3, kNoIntegers, kSignedFractions};
constexpr AttributeFormat kTangent{4, 4, kNoIntegers, kSignedFractions};
constexpr AttributeFormat kTexcoord{2, 2, kUnsignedFractions, kAnyIntegers};
constexpr AttributeFormat kColor{3, 4, kUnsignedFractions};
/// Colours as some exporters write them: fractions that are not marked as such.
constexpr AttributeFormat kWholeColor{
    .min_components = 3, .max_components = 4, .integers = kUnsigned, .as_fractions = true};

bool is_finite_uv(const Vec2f& uv) {
    return std::isfinite(uv.x) && std::isfinite(uv.y);
}

/// Reads one primitive. Nothing is returned if it cannot be rendered; why has then been reported.
class PrimitiveReader {
  public:
    PrimitiveReader(const GltfDocument& document, AccessorReader& accessors, RepairLog& repairs, ProblemList& problems)
        : document_(document), accessors_(accessors), repairs_(repairs), problems_(problems) {}

    /// Reads the primitive `source` and puts what deforms the primitive into `deformation`; returns nothing, with a
    /// problem reported, if the primitive cannot be rendered.
    std::optional<PrimitiveDesc> read(const tinygltf::Primitive& source, const SourceLocation& where,
                                      PrimitiveDeformation& deformation) {
        source_ = &source;
        where_ = where;
        if (!is_renderable()) return std::nullopt;
        draco_.reset();
        if (source.extensions.contains(kDracoExtension)) {
            draco_ = decode_draco(document_, source, accessors_, at(fmt::format("extensions/{}", kDracoExtension)),
                                  problems_);
            if (!draco_) return std::nullopt;
        }

        PrimitiveDesc result;
        result.location = where;
        if (!read_triangles(result, deformation) || !read_attributes(result)) return std::nullopt;
        if (!read_targets(deformation) || !read_influences(deformation)) return std::nullopt;
        repair_normals(result);
        repair_tangents(result);
        repair_texcoords(result);
        repair_colors(result);
        return result;
    }

  private:
    bool is_renderable() {
        if (source_->mode < TINYGLTF_MODE_TRIANGLES || source_->mode > TINYGLTF_MODE_TRIANGLE_FAN) {
            repairs_.add(Repair::NotTriangles, 1, where_);
            return false;
        }
        if (!source_->attributes.contains("POSITION")) {
            repairs_.add(Repair::NoPositions, 1, where_);
            return false;
        }
        return true;
    }

    [[nodiscard]] SourceLocation at(std::string_view member) const {
        return document_.at(fmt::format("{}/{}", where_.pointer, member));
    }

    /// True if the attribute is stored as integers that are not normalised. What does not exist is reported elsewhere.
    bool has_whole_numbers(const std::string& name) {
        const auto found = source_->attributes.find(name);
        if (found == source_->attributes.end() || found->second < 0 ||
            static_cast<std::size_t>(found->second) >= document_.model.accessors.size())
            return false;
        const tinygltf::Accessor& accessor = document_.model.accessors[static_cast<std::size_t>(found->second)];
        const bool is_small = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                              accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
        if (!is_small || accessor.normalized || draco_) return false;
        repairs_.add(Repair::WholeColors, 1, at("attributes/" + name));
        return true;
    }

    /// The attribute's values, if the primitive has it; `failed_` is set if it has and they cannot be read.
    std::optional<AttributeData> attribute(const std::string& name, const AttributeFormat& format) {
        const auto found = source_->attributes.find(name);
        if (found == source_->attributes.end()) return std::nullopt;
        const SourceLocation where = at("attributes/" + name);
        std::optional<AttributeData> data =
            draco_ && draco_->attributes.contains(name)
                ? decompressed(name, document_.model.accessors[static_cast<std::size_t>(found->second)], format, where)
                : accessors_.attribute(found->second, format, where);
        if (!data) {
            failed_ = true;
            return std::nullopt;
        }
        const std::size_t count = data->values.size() / static_cast<std::size_t>(data->components);
        if (vertex_count_ > 0 && count != vertex_count_) {
            problems_.error(where, fmt::format("{} values for {} vertices", count, vertex_count_));
            failed_ = true;
            return std::nullopt;
        }
        return data;
    }

    std::optional<AttributeData> decompressed(const std::string& name, const tinygltf::Accessor& accessor,
                                              const AttributeFormat& format, const SourceLocation& where) {
        if (!accessors_.check_format(accessor, format, where)) return std::nullopt;
        return std::move(draco_->attributes[name]);
    }

    /// Reads positions and triangles, checked, without degenerate triangles and unused vertices. Triangles that are
    /// flat until `deformation` moves their vertices are kept.
    bool read_triangles(PrimitiveDesc& result, PrimitiveDeformation& deformation) {
        failed_ = false;
        vertex_count_ = 0;
        const std::optional<AttributeData> data = attribute("POSITION", kPosition);
        if (!data) return false;
        vertex_count_ = data->values.size() / 3;
        std::vector<Vec3f> positions(vertex_count_);
        for (std::size_t i = 0; i < vertex_count_; ++i) {
            positions[i] = {data->values[3 * i], data->values[3 * i + 1], data->values[3 * i + 2]};
        }

        const std::optional<std::vector<std::uint32_t>> indices = read_indices();
        if (!indices || !check_indices(*indices)) return false;
        const auto mode = draco_ ? TriangleMode::List : static_cast<TriangleMode>(source_->mode);
        const bool is_list = mode == TriangleMode::List;
        if (is_list ? indices->size() % 3 != 0 : indices->size() < 3) repairs_.add(Repair::LeftoverIndices, 1, where_);

        result.triangles = assemble_triangles(*indices, mode);
        const std::size_t bad = std::erase_if(result.triangles, [&](const Triangle& triangle) {
            return !std::ranges::all_of(triangle, [&](std::uint32_t vertex) { return is_finite(positions[vertex]); });
        });
        repairs_.add(Repair::BadPositions, bad, at("attributes/POSITION"));
        // Strips are joined by triangles without an area on purpose.
        const bool is_deformed =
            !source_->targets.empty() || (!document_.skins.empty() && source_->attributes.contains("JOINTS_0"));
        const std::size_t removed =
            is_deformed ? std::erase_if(result.triangles,
                                        [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; })
                        : remove_degenerate_triangles(result.triangles, positions);
        deformation.has_flat_triangles = is_deformed && std::ranges::any_of(result.triangles, [&](const Triangle& t) {
                                             return is_degenerate(t, positions);
                                         });
        if (mode != TriangleMode::Strip) repairs_.add(Repair::DegenerateTriangles, removed, where_);
        if (result.triangles.empty()) {
            repairs_.add(Repair::EmptyPrimitives, 1, where_);
            return false;
        }
        kept_ = compact_vertices(result.triangles, vertex_count_);
        result.positions = gather(positions);
        return true;
    }

    std::optional<std::vector<std::uint32_t>> read_indices() {
        if (draco_) return std::move(draco_->indices);
        if (source_->indices >= 0) return accessors_.indices(source_->indices, at("indices"));
        std::vector<std::uint32_t> indices(vertex_count_);
        std::iota(indices.begin(), indices.end(), 0u);
        return indices;
    }

    /// True if all indices exist.
    bool check_indices(const std::vector<std::uint32_t>& indices) {
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (indices[i] < vertex_count_) continue;
            problems_.error(at("indices"), fmt::format("index {} is {}, but the primitive has {} vertices", i,
                                                       indices[i], vertex_count_));
            return false;
        }
        return true;
    }

    template <typename T>
    [[nodiscard]] std::vector<T> gather(const std::vector<T>& values) const {
        std::vector<T> result(kept_.size());
        for (std::size_t i = 0; i < kept_.size(); ++i) result[i] = values[kept_[i]];
        return result;
    }

    /// The values of the vertices that are kept, made from `components` floats each by `make`.
    template <typename T, typename Make>
    std::vector<T> gather(const std::optional<AttributeData>& data, const Make& make) const {
        if (!data) return {};
        std::vector<T> result(kept_.size());
        for (std::size_t i = 0; i < kept_.size(); ++i) {
            result[i] = make(data->values.data() + kept_[i] * static_cast<std::size_t>(data->components));
        }
        return result;
    }

    bool read_attributes(PrimitiveDesc& result) {
        const auto make_vec2 = [](const float* v) { return Vec2f(v[0], v[1]); };
        const auto make_vec3 = [](const float* v) { return Vec3f(v[0], v[1], v[2]); };
        const auto make_vec4 = [](const float* v) { return Vec4f(v[0], v[1], v[2], v[3]); };
        result.normals = gather<Vec3f>(attribute("NORMAL", kNormal), make_vec3);
        result.tangents = gather<Vec4f>(attribute("TANGENT", kTangent), make_vec4);
        result.uv0 = gather<Vec2f>(attribute("TEXCOORD_0", kTexcoord), make_vec2);
        result.uv1 = gather<Vec2f>(attribute("TEXCOORD_1", kTexcoord), make_vec2);
        const std::optional<AttributeData> colors =
            attribute("COLOR_0", has_whole_numbers("COLOR_0") ? kWholeColor : kColor);
        const bool has_alpha = colors && colors->components == 4;
        result.colors = gather<Vec4f>(
            colors, [has_alpha](const float* v) { return Vec4f(v[0], v[1], v[2], has_alpha ? v[3] : 1.0f); });
        return !failed_;
    }

    /// The displacements of the vertices that are kept; empty if the target has none.
    bool read_displacements(const std::map<std::string, int>& target, const std::string& name,
                            const SourceLocation& where, std::vector<Vec3f>& out) {
        const auto found = target.find(name);
        if (found == target.end()) return true;
        const std::optional<AttributeData> data =
            accessors_.attribute(found->second, {3, 3, kNoIntegers, kAnyIntegers}, where);
        if (!data) return false;
        if (data->values.size() != 3 * vertex_count_) {
            problems_.error(where,
                            fmt::format("{} displacements for {} vertices", data->values.size() / 3, vertex_count_));
            return false;
        }
        out = gather<Vec3f>(data, [](const float* v) { return Vec3f(v[0], v[1], v[2]); });
        std::size_t repaired = 0;
        for (Vec3f& d : out)
            if (!is_finite(d)) {
                d = Vec3f(0.0f);
                ++repaired;
            }
        if (repaired > 0)
            problems_.warning(where, fmt::format("{} displacements are not finite and are taken for 0", repaired));
        return true;
    }

    bool read_targets(PrimitiveDeformation& deformation) {
        for (std::size_t i = 0; i < source_->targets.size(); ++i) {
            const std::map<std::string, int>& target = source_->targets[i];
            MorphTarget& out = deformation.targets.emplace_back();
            const auto where = [&](const char* name) { return at(fmt::format("targets/{}/{}", i, name)); };
            if (!read_displacements(target, "POSITION", where("POSITION"), out.positions) ||
                !read_displacements(target, "NORMAL", where("NORMAL"), out.normals) ||
                !read_displacements(target, "TANGENT", where("TANGENT"), out.tangents))
                return false;
            for (const auto& [attribute, unused] : target)
                if (attribute.starts_with("COLOR_") || attribute.starts_with("TEXCOORD_"))
                    problems_.warning(
                        where(attribute.c_str()),
                        "morph targets move positions, normals and tangents only; these values are ignored");
        }
        return true;
    }

    /// JOINTS_n and WEIGHTS_n, as many sets as there are.
    bool read_influences(PrimitiveDeformation& deformation) {
        if (document_.skins.empty()) return true;
        constexpr std::size_t kSet = 4;
        std::vector<std::optional<AttributeData>> joints;
        std::vector<std::optional<AttributeData>> weights;
        for (std::size_t set = 0; source_->attributes.contains(fmt::format("JOINTS_{}", set)); ++set) {
            joints.push_back(attribute(fmt::format("JOINTS_{}", set), {4, 4, kUnsigned}));
            weights.push_back(attribute(fmt::format("WEIGHTS_{}", set), {4, 4, kUnsignedFractions}));
            if (failed_ || !joints.back() || !weights.back()) {
                if (!failed_) problems_.error(at("attributes"), fmt::format("JOINTS_{} has no WEIGHTS_{}", set, set));
                return false;
            }
        }
        std::size_t bad = 0;
        deformation.influences = kSet * joints.size();
        deformation.joints.reserve(kept_.size() * deformation.influences);
        deformation.weights.reserve(kept_.size() * deformation.influences);
        for (const std::uint32_t vertex : kept_) {
            for (std::size_t i = 0; i < deformation.influences; ++i) {
                const std::size_t value = std::size_t{vertex} * kSet + i % kSet;
                const float joint = joints[i / kSet]->values[value];
                const float weight = weights[i / kSet]->values[value];
                if (!(joint >= 0.0f) || !(joint <= 65535.0f)) {
                    problems_.error(at("attributes"), fmt::format("a joint of vertex {} is not valid", vertex));
                    return false;
                }
                const bool is_good = weight >= 0.0f && std::isfinite(weight);
                if (!is_good) ++bad;
                deformation.joints.push_back(static_cast<std::uint32_t>(joint));
                deformation.weights.push_back(is_good ? weight : 0.0f);
            }
        }
        repairs_.add(Repair::BadWeights, bad, at("attributes"));
        return true;
    }

    void repair_normals(PrimitiveDesc& p) {
        if (p.normals.empty()) {
            p.tangents.clear();  // the specification: tangents without normals are ignored
            return;
        }
        const std::size_t bad = normalize_normals(p.normals, p.triangles, p.positions);
        repairs_.add(Repair::BadNormals, bad, at("attributes/NORMAL"));
    }

    void repair_tangents(PrimitiveDesc& p) {
        if (normalize_tangents(p.tangents)) return;
        repairs_.add(Repair::BadTangents, 1, at("attributes/TANGENT"));
        p.tangents.clear();
    }

    void repair_texcoords(PrimitiveDesc& p) {
        for (std::vector<Vec2f>* uvs : {&p.uv0, &p.uv1}) {
            std::size_t bad = 0;
            for (Vec2f& uv : *uvs) {
                if (is_finite_uv(uv)) continue;
                uv = {0.0f, 0.0f};
                ++bad;
            }
            repairs_.add(Repair::BadTexcoords, bad,
                         at(uvs == &p.uv0 ? "attributes/TEXCOORD_0" : "attributes/TEXCOORD_1"));
        }
    }

    void repair_colors(PrimitiveDesc& p) {
        std::size_t bad = 0;
        for (Vec4f& color : p.colors) {
            bool good = true;
            for (float* v : {&color.x, &color.y, &color.z, &color.w}) {
                if (std::isfinite(*v) && *v >= 0.0f) continue;
                *v = std::isfinite(*v) ? 0.0f : 1.0f;
                good = false;
            }
            if (!good) ++bad;
        }
        repairs_.add(Repair::BadColors, bad, at("attributes/COLOR_0"));
    }

    const GltfDocument& document_;
    AccessorReader& accessors_;
    RepairLog& repairs_;
    ProblemList& problems_;

    // The primitive being read.
    const tinygltf::Primitive* source_ = nullptr;
    std::optional<DracoMesh> draco_;  ///< if it is compressed
    SourceLocation where_;
    std::size_t vertex_count_ = 0;     ///< count of its accessors; 0 until the positions are read
    std::vector<std::uint32_t> kept_;  ///< vertices that some triangle uses
    bool failed_ = false;
};

/// Counts primitives that their material's textures would sample without coordinates.
void check_texcoords(const PrimitiveDesc& p, const MaterialDesc& material, RepairLog& repairs) {
    bool missing = false;
    for_each_texture(material, [&](const TextureRef& ref, std::string_view) {
        if (ref.valid() && (ref.texcoord == 0 ? p.uv0 : p.uv1).empty()) missing = true;
    });
    repairs.add(Repair::MissingTexcoords, missing ? 1 : 0, p.location);
}

Handle<MaterialDesc> default_material(SceneDesc& scene, Handle<MaterialDesc>& cached, const std::string& file) {
    if (!cached) {
        cached.index = static_cast<std::int32_t>(scene.materials.size());
        scene.materials.emplace_back().location = {file, {}};
    }
    return cached;
}

}  // namespace

std::vector<MeshDeformation> read_meshes(const GltfDocument& document, AccessorReader& accessors, SceneDesc& scene,
                                         ProblemList& problems) {
    std::vector<MeshDeformation> deformations(document.model.meshes.size());
    scene.variants = read_variant_names(document.model);
    RepairLog repairs;
    PrimitiveReader reader(document, accessors, repairs, problems);
    Handle<MaterialDesc> default_handle;
    for (std::size_t m = 0; m < document.model.meshes.size(); ++m) {
        const tinygltf::Mesh& source = document.model.meshes[m];
        MeshDesc mesh;
        mesh.name = source.name;
        deformations[m].default_weights = source.weights;
        mesh.location = document.at(fmt::format("/meshes/{}", m));
        for (std::size_t i = 0; i < source.primitives.size(); ++i) {
            const SourceLocation where = document.at(fmt::format("/meshes/{}/primitives/{}", m, i));
            PrimitiveDeformation deformation;
            std::optional<PrimitiveDesc> primitive = reader.read(source.primitives[i], where, deformation);
            if (!primitive) continue;
            deformations[m].primitives.push_back(std::move(deformation));
            const int material = source.primitives[i].material;
            primitive->material =
                material >= 0 ? Handle<MaterialDesc>{material} : default_material(scene, default_handle, document.file);
            primitive->variants = read_variant_materials(source.primitives[i]);
            check_texcoords(*primitive, scene.materials[static_cast<std::size_t>(primitive->material.index)], repairs);
            mesh.primitives.push_back(std::move(*primitive));
        }
        scene.meshes.push_back(std::move(mesh));
    }
    repairs.report(problems);
    return deformations;
}

}  // namespace etendue
