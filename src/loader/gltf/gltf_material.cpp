#include "loader/gltf/gltf_material.h"

#include "loader/gltf/gltf_value.h"

#include <algorithm>
#include <string>
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

    /// Reads the texture reference under `key` in `extension`, whose content tinygltf leaves as it is; no texture if
    /// `extension` has no such key.
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
            // Negative ones stay, for the warning to show them as they are in the file.
            for (double& channel : emissive)
                if (channel > 0.0) channel /= brightest;
        }
        result.emissive = {factor(emissive[0], "emissiveFactor"), factor(emissive[1], "emissiveFactor"),
                           factor(emissive[2], "emissiveFactor")};
        if (source.emissiveTexture.index >= 0 && !result.emissive_texture.valid())
            leave_out_texture(result.emissive_texture, result);
    }

    void read_extensions(const ExtensionMap& extensions, MaterialDesc& result) {
        result.unlit = find_extension(extensions, "KHR_materials_unlit") != nullptr;
        const auto read = [&](const std::string& name, void (MaterialReader::*reader)(const Value&, MaterialDesc&)) {
            const Value* extension = find_extension(extensions, name);
            if (extension == nullptr) return;
            extension_ = "extensions/" + name;
            (this->*reader)(*extension, result);
        };
        read("KHR_materials_emissive_strength", &MaterialReader::read_emissive_strength);
        read("KHR_materials_ior", &MaterialReader::read_ior);
        read("KHR_materials_specular", &MaterialReader::read_specular);
        read("KHR_materials_transmission", &MaterialReader::read_transmission);
        read("KHR_materials_diffuse_roughness", &MaterialReader::read_diffuse_roughness);
        read("KHR_materials_diffuse_transmission", &MaterialReader::read_diffuse_transmission);
        read("KHR_materials_volume", &MaterialReader::read_volume);
        read("KHR_materials_dispersion", &MaterialReader::read_dispersion);
        read("KHR_materials_volume_scatter", &MaterialReader::read_volume_scatter);
        read("KHR_materials_anisotropy", &MaterialReader::read_anisotropy);
        read("KHR_materials_iridescence", &MaterialReader::read_iridescence);
        read("KHR_materials_sheen", &MaterialReader::read_sheen);
        read("KHR_materials_clearcoat", &MaterialReader::read_clearcoat);
        // In place of what the file has for programs that do not know the extension.
        if (!result.unlit) read("KHR_materials_pbrSpecularGlossiness", &MaterialReader::read_specular_glossiness);
    }

    /// A factor in [0, 1] of the extension that is being read.
    float unit(const Value& extension, const std::string& key, double fallback) {
        return factor(number_or(extension, key, fallback), extension_ + "/" + key);
    }
    Rgb unit_color(const Value& extension, const std::string& key, double fallback) {
        const auto channel = [&](int i) {
            return factor(element_or(extension, key, i, fallback), extension_ + "/" + key);
        };
        return {channel(0), channel(1), channel(2)};
    }
    TextureRef extension_texture(const Value& extension, const std::string& key) {
        return texture(extension, key, extension_ + "/" + key);
    }
    static float plain(const Value& extension, const std::string& key, double fallback) {
        return static_cast<float>(number_or(extension, key, fallback));
    }

    void read_emissive_strength(const Value& strength, MaterialDesc& result) {
        result.emissive_strength *= plain(strength, "emissiveStrength", 1.0);
    }

    void read_ior(const Value& ior, MaterialDesc& result) {
        result.ior = plain(ior, "ior", 1.5);
        if (result.ior == 0.0f || result.ior >= 1.0f) return;
        problems_.warning(at(extension_ + "/ior"),
                          fmt::format("{} is neither 0 nor at least 1; 1 is used", result.ior));
        result.ior = 1.0f;
    }

    void read_specular(const Value& specular, MaterialDesc& result) {
        result.specular = unit(specular, "specularFactor", 1.0);
        result.specular_texture = extension_texture(specular, "specularTexture");
        // Above 1 is allowed: the product with the reflectance is what is clamped.
        const auto channel = [&](int i) {
            return static_cast<float>(std::max(0.0, element_or(specular, "specularColorFactor", i, 1.0)));
        };
        result.specular_color = {channel(0), channel(1), channel(2)};
        result.specular_color_texture = extension_texture(specular, "specularColorTexture");
    }

    void read_specular_glossiness(const Value& extension, MaterialDesc& result) {
        result.base_color = unit_color(extension, "diffuseFactor", 1.0);
        result.base_alpha = factor(element_or(extension, "diffuseFactor", 3, 1.0), extension_ + "/diffuseFactor");
        result.base_color_texture = extension_texture(extension, "diffuseTexture");
        result.specular_color = unit_color(extension, "specularFactor", 1.0);
        result.specular_color_texture = extension_texture(extension, "specularGlossinessTexture");
        result.glossiness = unit(extension, "glossinessFactor", 1.0);
        if (extension.Has("specularGlossinessTexture") && !result.specular_color_texture.valid())
            leave_out_texture(result.specular_color_texture, result);
        result.metallic = 0.0f;
        result.roughness = 1.0f;
        result.metallic_roughness_texture = {};
        result.ior = 0.0f;
        result.specular = 1.0f;
        result.specular_texture = {};
    }

    void read_transmission(const Value& transmission, MaterialDesc& result) {
        result.transmission = unit(transmission, "transmissionFactor", 0.0);
        result.transmission_texture = extension_texture(transmission, "transmissionTexture");
    }

    void read_diffuse_roughness(const Value& extension, MaterialDesc& result) {
        result.diffuse_roughness.factor = unit(extension, "diffuseRoughnessFactor", 0.0);
        result.diffuse_roughness.texture = extension_texture(extension, "diffuseRoughnessTexture");
    }

    void read_diffuse_transmission(const Value& extension, MaterialDesc& result) {
        DiffuseTransmissionDesc& desc = result.diffuse_transmission;
        desc.factor = unit(extension, "diffuseTransmissionFactor", 0.0);
        desc.texture = extension_texture(extension, "diffuseTransmissionTexture");
        desc.color = unit_color(extension, "diffuseTransmissionColorFactor", 1.0);
        desc.color_texture = extension_texture(extension, "diffuseTransmissionColorTexture");
    }

    void read_volume(const Value& volume, MaterialDesc& result) {
        // The thickness is for renderers that do not trace rays; only that there is one says that the mesh is closed.
        result.volume.closed = number_or(volume, "thicknessFactor", 0.0) > 0.0;
        result.volume.attenuation_color = unit_color(volume, "attenuationColor", 1.0);
        if (!volume.Has("attenuationDistance")) return;
        const float distance = plain(volume, "attenuationDistance", 0.0);
        if (distance > 0.0f) {
            result.volume.attenuation_distance = distance;
        } else {
            problems_.warning(at(extension_ + "/attenuationDistance"),
                              "must be above 0 and is ignored: nothing is attenuated");
        }
    }

    void read_dispersion(const Value& dispersion, MaterialDesc& result) {
        result.volume.dispersion = plain(dispersion, "dispersion", 0.0);
    }

    void read_volume_scatter(const Value& scatter, MaterialDesc& result) {
        result.volume.multiscatter_color = unit_color(scatter, "multiscatterColor", 0.0);
        result.volume.scatter_anisotropy =
            std::clamp(plain(scatter, "scatterAnisotropy", 0.0), -kMostAnisotropic, kMostAnisotropic);
    }

    void read_anisotropy(const Value& anisotropy, MaterialDesc& result) {
        result.anisotropy.strength = unit(anisotropy, "anisotropyStrength", 0.0);
        result.anisotropy.rotation = plain(anisotropy, "anisotropyRotation", 0.0);
        result.anisotropy.texture = extension_texture(anisotropy, "anisotropyTexture");
    }

    void read_iridescence(const Value& iridescence, MaterialDesc& result) {
        IridescenceDesc& desc = result.iridescence;
        desc.factor = unit(iridescence, "iridescenceFactor", 0.0);
        desc.texture = extension_texture(iridescence, "iridescenceTexture");
        desc.ior = plain(iridescence, "iridescenceIor", 1.3);
        desc.thickness_minimum_nm = plain(iridescence, "iridescenceThicknessMinimum", 100.0);
        desc.thickness_maximum_nm = plain(iridescence, "iridescenceThicknessMaximum", 400.0);
        desc.thickness_texture = extension_texture(iridescence, "iridescenceThicknessTexture");
    }

    void read_sheen(const Value& sheen, MaterialDesc& result) {
        result.sheen.color = unit_color(sheen, "sheenColorFactor", 0.0);
        result.sheen.color_texture = extension_texture(sheen, "sheenColorTexture");
        result.sheen.roughness = unit(sheen, "sheenRoughnessFactor", 0.0);
        result.sheen.roughness_texture = extension_texture(sheen, "sheenRoughnessTexture");
    }

    void read_clearcoat(const Value& clearcoat, MaterialDesc& result) {
        ClearcoatDesc& desc = result.clearcoat;
        desc.factor = unit(clearcoat, "clearcoatFactor", 0.0);
        desc.texture = extension_texture(clearcoat, "clearcoatTexture");
        desc.roughness = unit(clearcoat, "clearcoatRoughnessFactor", 0.0);
        desc.roughness_texture = extension_texture(clearcoat, "clearcoatRoughnessTexture");
        desc.normal_texture = extension_texture(clearcoat, "clearcoatNormalTexture");
        if (clearcoat.Has("clearcoatNormalTexture"))
            desc.normal_scale = plain(clearcoat.Get("clearcoatNormalTexture"), "scale", 1.0);
    }

    TextureReader& textures_;
    ProblemList& problems_;
    SourceLocation where_;
    std::string extension_;  ///< the one being read, as a pointer below the material
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
