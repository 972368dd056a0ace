#include "loader/gltf/gltf_material.h"

#include "loader/gltf/gltf_value.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

using tinygltf::ExtensionMap;
using tinygltf::Value;

TextureTransform read_transform(const Value& extension) {
    TextureTransform transform;
    transform.offset = {static_cast<float>(element_or(extension, "offset", 0, 0.0)),
                        static_cast<float>(element_or(extension, "offset", 1, 0.0))};
    transform.rotation = static_cast<float>(number_or(extension, "rotation", 0.0));
    transform.scale = {static_cast<float>(element_or(extension, "scale", 0, 1.0)),
                       static_cast<float>(element_or(extension, "scale", 1, 1.0))};
    return transform;
}

/// Reads one material.
class MaterialReader {
  public:
    MaterialReader(TextureReader& textures, ProblemList& problems) : textures_(textures), problems_(problems) {}

    MaterialDesc read(const tinygltf::Material& source, const SourceLocation& where) {
        where_ = where;
        MaterialDesc result;
        result.name = source.name;
        result.location = where;
        read_metallic_roughness(source.pbrMetallicRoughness, result);
        result.normal_texture = texture(source.normalTexture, "normalTexture");
        result.normal_scale = static_cast<float>(source.normalTexture.scale);
        read_emission(source, result);
        result.double_sided = source.doubleSided;
        result.alpha_cutoff = static_cast<float>(source.alphaCutoff);
        result.alpha_mode = source.alphaMode == "MASK"    ? AlphaMode::Mask
                            : source.alphaMode == "BLEND" ? AlphaMode::Blend
                                                          : AlphaMode::Opaque;
        read_extensions(source.extensions, result);
        return result;
    }

  private:
    [[nodiscard]] SourceLocation at(std::string_view member) const {
        return {where_.file, fmt::format("{}/{}", where_.pointer, member)};
    }

    /// `value` as it is, or its nearest neighbour in [0, 1] and a warning.
    float factor(double value, std::string_view member) {
        if (value >= 0.0 && value <= 1.0) return static_cast<float>(value);
        problems_.warning(at(member), fmt::format("{} is outside [0, 1] and is moved to its end", value));
        return static_cast<float>(std::clamp(value, 0.0, 1.0));
    }

    TextureRef texture(int index, int texcoord, const Value* transform, std::string_view member) {
        TextureRef ref;
        if (index < 0) return ref;
        if (transform != nullptr) {
            ref.transform = read_transform(*transform);
            texcoord = integer_or(*transform, "texCoord", texcoord);
        }
        if (texcoord > 1) {
            problems_.warning(at(member),
                              fmt::format("the texture is ignored: it uses texture coordinates {}, but only "
                                          "0 and 1 are supported",
                                          texcoord));
            return {};
        }
        ref.texcoord = texcoord;
        ref.texture = textures_.texture(index);
        return ref;
    }

    /// For tinygltf's three kinds of texture references.
    template <typename Info>
    TextureRef texture(const Info& info, std::string_view member) {
        return texture(info.index, info.texCoord, find_extension(info.extensions, "KHR_texture_transform"), member);
    }

    /// The same for a reference inside an extension, which tinygltf leaves as it is.
    TextureRef texture(const Value& extension, const std::string& key, std::string_view member) {
        if (!extension.Has(key)) return {};
        const Value& info = extension.Get(key);
        const Value* transform = nullptr;
        if (info.Has("extensions") && info.Get("extensions").Has("KHR_texture_transform")) {
            transform = &info.Get("extensions").Get("KHR_texture_transform");
        }
        return texture(integer_or(info, "index", -1), integer_or(info, "texCoord", 0), transform, member);
    }

    void read_metallic_roughness(const tinygltf::PbrMetallicRoughness& source, MaterialDesc& result) {
        if (const std::vector<double>& base = source.baseColorFactor; base.size() == 4) {
            constexpr std::string_view kMember = "pbrMetallicRoughness/baseColorFactor";
            result.base_color = {factor(base[0], kMember), factor(base[1], kMember), factor(base[2], kMember)};
            result.base_alpha = factor(base[3], kMember);
        }
        result.metallic = factor(source.metallicFactor, "pbrMetallicRoughness/metallicFactor");
        result.roughness = factor(source.roughnessFactor, "pbrMetallicRoughness/roughnessFactor");
        result.base_color_texture = texture(source.baseColorTexture, "pbrMetallicRoughness/baseColorTexture");
        result.metallic_roughness_texture =
            texture(source.metallicRoughnessTexture, "pbrMetallicRoughness/metallicRoughnessTexture");
    }

    void read_emission(const tinygltf::Material& source, MaterialDesc& result) {
        result.emissive_texture = texture(source.emissiveTexture, "emissiveTexture");
        if (source.emissiveFactor.size() != 3) return;
        std::array<double, 3> emissive{source.emissiveFactor[0], source.emissiveFactor[1], source.emissiveFactor[2]};
        const double brightest = *std::ranges::max_element(emissive);
        // Files from before KHR_materials_emissive_strength say so when they mean a bright light.
        if (brightest > 1.0) {
            problems_.warning(at("emissiveFactor"), "factors above 1 are taken as emissive strength");
            result.emissive_strength = static_cast<float>(brightest);
            for (double& channel : emissive) channel /= brightest;
        }
        result.emissive = {factor(emissive[0], "emissiveFactor"), factor(emissive[1], "emissiveFactor"),
                           factor(emissive[2], "emissiveFactor")};
    }

    void read_extensions(const ExtensionMap& extensions, MaterialDesc& result) {
        result.unlit = find_extension(extensions, "KHR_materials_unlit") != nullptr;
        if (const Value* strength = find_extension(extensions, "KHR_materials_emissive_strength")) {
            result.emissive_strength *= static_cast<float>(number_or(*strength, "emissiveStrength", 1.0));
        }
        if (const Value* transmission = find_extension(extensions, "KHR_materials_transmission")) {
            constexpr std::string_view kMember = "extensions/KHR_materials_transmission";
            result.transmission = factor(number_or(*transmission, "transmissionFactor", 0.0), kMember);
            result.transmission_texture = texture(*transmission, "transmissionTexture", kMember);
        }
        if (const Value* specular = find_extension(extensions, "KHR_materials_specular"))
            read_specular(*specular, result);
        if (const Value* ior = find_extension(extensions, "KHR_materials_ior")) {
            result.ior = static_cast<float>(number_or(*ior, "ior", 1.5));
            if (result.ior != 0.0f && result.ior < 1.0f) {
                problems_.warning(at("extensions/KHR_materials_ior/ior"),
                                  fmt::format("{} is neither 0 nor at least 1; 1 is used", result.ior));
                result.ior = 1.0f;
            }
        }
    }

    void read_specular(const Value& specular, MaterialDesc& result) {
        constexpr std::string_view kMember = "extensions/KHR_materials_specular";
        result.specular = factor(number_or(specular, "specularFactor", 1.0), kMember);
        result.specular_texture = texture(specular, "specularTexture", kMember);
        // Above 1 is allowed: the product with the reflectance is what is clamped.
        const auto channel = [&](int i) {
            return static_cast<float>(std::max(0.0, element_or(specular, "specularColorFactor", i, 1.0)));
        };
        result.specular_color = {channel(0), channel(1), channel(2)};
        result.specular_color_texture = texture(specular, "specularColorTexture", kMember);
    }

    TextureReader& textures_;
    ProblemList& problems_;
    SourceLocation where_;
};

}  // namespace

void read_materials(const GltfDocument& document, TextureReader& textures, SceneDesc& scene, ProblemList& problems) {
    MaterialReader reader(textures, problems);
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
        const SourceLocation where = document.at(fmt::format("/materials/{}", i));
        scene.materials.push_back(reader.read(document.model.materials[i], where));
    }
}

}  // namespace etendue
