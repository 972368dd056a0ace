#include "loader/gltf/gltf_builder.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace etendue {
namespace {

/// A triangle with texture coordinates and one material, three textures of one image, and `material`.
LoadedScene load_with_material(const char* material) {
    GltfBuilder builder;
    nlohmann::json& primitive = builder.add_triangle();
    const int uv = builder.floats({0, 0, 1, 0, 0, 1}, 2);
    primitive["attributes"]["TEXCOORD_0"] = uv;
    primitive["attributes"]["TEXCOORD_1"] = uv;
    primitive["material"] = 0;
    builder.json["materials"] = nlohmann::json::array({nlohmann::json::parse(material)});
    builder.json["images"] = {{{"uri", "a.png"}}};
    builder.json["textures"] = {
        {{"source", 0}, {"name", "t0"}}, {{"source", 0}, {"name", "t1"}}, {{"source", 0}, {"name", "t2"}}};
    const TempDir dir;
    builder.write(dir);
    dir.write("a.png", png_bytes());
    return inspect_scene(dir.path() / "scene.gltf");
}

const MaterialDesc& material_of(const LoadedScene& loaded) {
    EXPECT_FALSE(loaded.problems.has_errors()) << listing(loaded.problems);
    return loaded.scene.materials.at(0);
}

std::string texture_name(const LoadedScene& loaded, const TextureRef& ref) {
    return ref.valid() ? loaded.scene.textures.at(std::size_t(ref.texture.index)).name : "none";
}

TEST(Material, DefaultsAreTheSpecifications) {
    const LoadedScene loaded = load_with_material("{}");
    const MaterialDesc& m = material_of(loaded);
    EXPECT_EQ(m.base_color, Rgb(1.0f));
    EXPECT_EQ(m.base_alpha, 1.0f);
    EXPECT_EQ(m.metallic, 1.0f);
    EXPECT_EQ(m.roughness, 1.0f);
    EXPECT_EQ(m.emissive, Rgb(0.0f));
    EXPECT_EQ(m.emissive_strength, 1.0f);
    EXPECT_EQ(m.alpha_mode, AlphaMode::Opaque);
    EXPECT_EQ(m.alpha_cutoff, 0.5f);
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_EQ(m.transmission, 0.0f);
    EXPECT_FALSE(m.double_sided);
    EXPECT_FALSE(m.unlit);
    EXPECT_FALSE(m.base_color_texture.valid());
    EXPECT_TRUE(loaded.scene.images.empty());  // nothing that no material uses is opened
}

TEST(Material, LayersAreRead) {
    const LoadedScene loaded = load_with_material(R"({"extensions": {
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0},
            "clearcoatRoughnessFactor": 0.25, "clearcoatRoughnessTexture": {"index": 1},
            "clearcoatNormalTexture": {"index": 2, "scale": 0.5}},
        "KHR_materials_sheen": {"sheenColorFactor": [0.1, 0.2, 0.3], "sheenColorTexture": {"index": 1},
            "sheenRoughnessFactor": 0.75, "sheenRoughnessTexture": {"index": 2}},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.9, "iridescenceTexture": {"index": 0},
            "iridescenceIor": 1.8, "iridescenceThicknessMinimum": 50, "iridescenceThicknessMaximum": 900,
            "iridescenceThicknessTexture": {"index": 1}},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.6, "anisotropyRotation": 1.5,
            "anisotropyTexture": {"index": 2}},
        "KHR_materials_diffuse_roughness": {"diffuseRoughnessFactor": 0.3, "diffuseRoughnessTexture": {"index": 2}},
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.4,
            "diffuseTransmissionTexture": {"index": 0}, "diffuseTransmissionColorFactor": [1, 0.5, 0.25],
            "diffuseTransmissionColorTexture": {"index": 1}}}})");
    const MaterialDesc& m = material_of(loaded);
    EXPECT_EQ(m.clearcoat.factor, 0.5f);
    EXPECT_EQ(m.clearcoat.roughness, 0.25f);
    EXPECT_EQ(m.clearcoat.normal_scale, 0.5f);
    EXPECT_EQ(texture_name(loaded, m.clearcoat.texture), "t0");
    EXPECT_EQ(texture_name(loaded, m.clearcoat.roughness_texture), "t1");
    EXPECT_EQ(texture_name(loaded, m.clearcoat.normal_texture), "t2");
    EXPECT_EQ(m.sheen.color, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.sheen.roughness, 0.75f);
    EXPECT_EQ(texture_name(loaded, m.sheen.color_texture), "t1");
    EXPECT_EQ(texture_name(loaded, m.sheen.roughness_texture), "t2");
    EXPECT_EQ(m.iridescence.factor, 0.9f);
    EXPECT_EQ(m.iridescence.ior, 1.8f);
    EXPECT_EQ(m.iridescence.thickness_minimum_nm, 50.0f);
    EXPECT_EQ(m.iridescence.thickness_maximum_nm, 900.0f);
    EXPECT_EQ(texture_name(loaded, m.iridescence.texture), "t0");
    EXPECT_EQ(texture_name(loaded, m.iridescence.thickness_texture), "t1");
    EXPECT_EQ(m.anisotropy.strength, 0.6f);
    EXPECT_EQ(m.anisotropy.rotation, 1.5f);
    EXPECT_EQ(texture_name(loaded, m.anisotropy.texture), "t2");
    EXPECT_EQ(m.diffuse_roughness.factor, 0.3f);
    EXPECT_EQ(texture_name(loaded, m.diffuse_roughness.texture), "t2");
    EXPECT_EQ(m.diffuse_transmission.factor, 0.4f);
    EXPECT_EQ(m.diffuse_transmission.color, Rgb(1.0f, 0.5f, 0.25f));
    EXPECT_EQ(texture_name(loaded, m.diffuse_transmission.texture), "t0");
    EXPECT_EQ(texture_name(loaded, m.diffuse_transmission.color_texture), "t1");
}

TEST(Material, VolumesAreRead) {
    const LoadedScene loaded = load_with_material(R"({"extensions": {
        "KHR_materials_volume": {"thicknessFactor": 0.1, "attenuationDistance": 0.5, "attenuationColor": [1, 0.5, 0.25]},
        "KHR_materials_dispersion": {"dispersion": 2.5},
        "KHR_materials_volume_scatter": {"multiscatterColor": [0.5, 0.25, 0], "scatterAnisotropy": -0.5}}})");
    const VolumeDesc& volume = material_of(loaded).volume;
    EXPECT_TRUE(volume.closed);
    EXPECT_EQ(volume.attenuation_distance, 0.5f);
    EXPECT_EQ(volume.attenuation_color, Rgb(1.0f, 0.5f, 0.25f));
    EXPECT_EQ(volume.dispersion, 2.5f);
    EXPECT_EQ(volume.multiscatter_color, Rgb(0.5f, 0.25f, 0.0f));
    EXPECT_EQ(volume.scatter_anisotropy, -0.5f);
}

TEST(Material, ScatteringThatGoesStraightOnIsMovedIntoItsRange) {
    for (const char* g : {"1", "-1", "0.9995", "0.999"}) {
        const LoadedScene loaded =
            load_with_material((R"({"extensions": {"KHR_materials_volume": {"thicknessFactor": 1},
                "KHR_materials_volume_scatter": {"multiscatterColor": [1, 1, 1], "scatterAnisotropy": )" +
                                std::string(g) + "}}}")
                                   .c_str());
        EXPECT_EQ(std::abs(material_of(loaded).volume.scatter_anisotropy), kMostAnisotropic) << g;
        EXPECT_FALSE(validate(loaded.scene).has_errors()) << listing(validate(loaded.scene));
    }
}

TEST(Material, VolumesWithoutThicknessAreThinWalls) {
    for (const char* volume : {R"({})", R"({"thicknessFactor": 0, "attenuationDistance": 2})"}) {
        const LoadedScene loaded =
            load_with_material((R"({"extensions": {"KHR_materials_volume": )" + std::string(volume) + "}}").c_str());
        EXPECT_FALSE(material_of(loaded).volume.closed);
    }
    const LoadedScene loaded = load_with_material(
        R"({"extensions": {"KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0}}})");
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "attenuationDistance"));
    EXPECT_TRUE(std::isinf(material_of(loaded).volume.attenuation_distance));
}

TEST(Material, EverythingIsRead) {
    const LoadedScene loaded = load_with_material(R"({
        "name": "all",
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "baseColorTexture": {"index": 0},
            "metallicFactor": 0.5, "roughnessFactor": 0.6, "metallicRoughnessTexture": {"index": 1, "texCoord": 1}},
        "normalTexture": {"index": 2, "scale": -2}, "occlusionTexture": {"index": 1},
        "emissiveTexture": {"index": 1}, "emissiveFactor": [0.7, 0.8, 0.9],
        "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 30},
                       "KHR_materials_transmission": {"transmissionFactor": 0.5, "transmissionTexture": {"index": 2}},
                       "KHR_materials_specular": {"specularFactor": 0.25, "specularTexture": {"index": 0},
                                                  "specularColorFactor": [0.5, 1, 2],
                                                  "specularColorTexture": {"index": 1}},
                       "KHR_materials_ior": {"ior": 1.33}, "KHR_materials_unlit": {}}})");
    const MaterialDesc& m = material_of(loaded);
    EXPECT_EQ(m.name, "all");
    EXPECT_EQ(m.base_color, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.base_alpha, 0.4f);
    EXPECT_EQ(texture_name(loaded, m.base_color_texture), "t0");
    EXPECT_EQ(m.metallic, 0.5f);
    EXPECT_EQ(m.roughness, 0.6f);
    EXPECT_EQ(texture_name(loaded, m.metallic_roughness_texture), "t1");
    EXPECT_EQ(m.metallic_roughness_texture.texcoord, 1);
    EXPECT_EQ(texture_name(loaded, m.normal_texture), "t2");
    EXPECT_EQ(m.normal_scale, -2.0f);
    EXPECT_EQ(texture_name(loaded, m.emissive_texture), "t1");
    EXPECT_EQ(m.emissive, Rgb(0.7f, 0.8f, 0.9f));
    EXPECT_EQ(m.emissive_strength, 30.0f);
    EXPECT_EQ(m.specular, 0.25f);
    EXPECT_EQ(texture_name(loaded, m.specular_texture), "t0");
    EXPECT_EQ(m.specular_color, Rgb(0.5f, 1, 2)) << "above 1 is allowed";
    EXPECT_EQ(texture_name(loaded, m.specular_color_texture), "t1");
    EXPECT_EQ(m.alpha_mode, AlphaMode::Mask);
    EXPECT_EQ(m.alpha_cutoff, 0.25f);
    EXPECT_TRUE(m.double_sided);
    EXPECT_TRUE(m.unlit);
    EXPECT_EQ(m.ior, 1.33f);
    EXPECT_EQ(m.transmission, 0.5f);
    EXPECT_EQ(texture_name(loaded, m.transmission_texture), "t2");
    EXPECT_EQ(loaded.scene.images.size(), 1u);  // shared by the three
}

TEST(Material, SpecularGlossinessTakesThePlaceOfMetallicRoughness) {
    const LoadedScene loaded = load_with_material(R"({
        "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 0], "metallicFactor": 0.5, "roughnessFactor": 0.5,
            "metallicRoughnessTexture": {"index": 2}},
        "extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.1, 0.2, 0.3, 0.4],
            "diffuseTexture": {"index": 0}, "specularFactor": [0.5, 0.6, 0.7], "glossinessFactor": 0.9,
            "specularGlossinessTexture": {"index": 1, "texCoord": 1}}}})");
    const MaterialDesc& m = material_of(loaded);
    EXPECT_EQ(m.base_color, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.base_alpha, 0.4f);
    EXPECT_EQ(texture_name(loaded, m.base_color_texture), "t0");
    EXPECT_EQ(m.specular_color, Rgb(0.5f, 0.6f, 0.7f));
    EXPECT_EQ(texture_name(loaded, m.specular_color_texture), "t1");
    EXPECT_EQ(m.specular_color_texture.texcoord, 1);
    EXPECT_EQ(m.glossiness, 0.9f);
    EXPECT_EQ(m.metallic, 0.0f);
    EXPECT_EQ(m.roughness, 1.0f);
    EXPECT_EQ(m.ior, 0.0f);
    EXPECT_FALSE(m.metallic_roughness_texture.valid());
}

TEST(Material, SpecularGlossinessHasItsDefaults) {
    const LoadedScene loaded = load_with_material(R"({"extensions": {"KHR_materials_pbrSpecularGlossiness": {}}})");
    const MaterialDesc& m = material_of(loaded);
    EXPECT_EQ(m.base_color, Rgb(1.0f));
    EXPECT_EQ(m.base_alpha, 1.0f);
    EXPECT_EQ(m.specular_color, Rgb(1.0f));
    EXPECT_EQ(m.glossiness, 1.0f);
}

TEST(Material, TextureTransformsAndTheirTexcoord) {
    const LoadedScene loaded = load_with_material(R"({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform":
            {"offset": [0.1, 0.2], "rotation": 0.3, "scale": [2, 3], "texCoord": 1}}}},
        "emissiveTexture": {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": {}}},
        "extensions": {"KHR_materials_transmission": {"transmissionTexture": {"index": 0, "extensions":
            {"KHR_texture_transform": {"rotation": 1}}}}}})");
    const MaterialDesc& m = material_of(loaded);
    const TextureTransform& t = m.base_color_texture.transform;
    EXPECT_EQ(t.offset, Vec2f(0.1f, 0.2f));
    EXPECT_EQ(t.rotation, 0.3f);
    EXPECT_EQ(t.scale, Vec2f(2, 3));
    EXPECT_EQ(m.base_color_texture.texcoord, 1);
    EXPECT_EQ(m.emissive_texture.transform, TextureTransform{});
    EXPECT_EQ(m.emissive_texture.texcoord, 1);
    EXPECT_EQ(m.transmission_texture.transform.rotation, 1.0f);
}

TEST(Material, FactorsOutsideTheirRangeAreMovedIntoIt) {
    const LoadedScene loaded = load_with_material(R"({
        "pbrMetallicRoughness": {"baseColorFactor": [2, -1, 0.5, 1], "roughnessFactor": 7},
        "extensions": {"KHR_materials_ior": {"ior": 0.5}}})");
    const MaterialDesc& m = material_of(loaded);
    EXPECT_EQ(m.base_color, Rgb(1, 0, 0.5f));
    EXPECT_EQ(m.roughness, 1.0f);
    EXPECT_EQ(m.ior, 1.0f);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "outside [0, 1]", "/roughnessFactor"));
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "neither 0 nor at least 1", "/ior"));
}

TEST(Material, IorZeroIsKept) {
    EXPECT_EQ(material_of(load_with_material(R"({"extensions": {"KHR_materials_ior": {"ior": 0}}})")).ior, 0.0f);
}

TEST(Material, BrightEmissionBecomesStrength) {
    const LoadedScene loaded = load_with_material(R"({"emissiveFactor": [10, 5, 0]})");
    EXPECT_EQ(material_of(loaded).emissive, Rgb(1, 0.5f, 0));
    EXPECT_EQ(material_of(loaded).emissive_strength, 10.0f);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "emissive strength"));
}

TEST(Material, NegativeEmissionIsReportedAsItStands) {
    const LoadedScene loaded = load_with_material(R"({"emissiveFactor": [4, -3, 1]})");
    const MaterialDesc& material = material_of(loaded);
    EXPECT_EQ(material.emissive, Rgb(1.0f, 0.0f, 0.25f));
    EXPECT_EQ(material.emissive_strength, 4.0f);
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "-3 is outside", "/emissiveFactor"));
}

TEST(Material, TexcoordsBeyondOneAreIgnoredWithAWarning) {
    const LoadedScene loaded =
        load_with_material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 2}}})");
    EXPECT_FALSE(material_of(loaded).base_color_texture.valid());
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "texture coordinates 2", "/baseColorTexture"));
}

TEST(Material, MissingTexcoordsAreAWarning) {
    GltfBuilder builder;
    builder.add_triangle()["material"] = 0;
    builder.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
    builder.json["images"] = {{{"uri", "a.png"}}};
    builder.json["textures"] = {{{"source", 0}}};
    const TempDir dir;
    builder.write(dir);
    dir.write("a.png", png_bytes());
    const LoadedScene loaded = inspect_scene(dir.path() / "scene.gltf");
    EXPECT_FALSE(loaded.problems.has_errors());
    EXPECT_TRUE(has_problem(loaded.problems, Severity::Warning, "texture coordinates that a material needs"));
}

}  // namespace
}  // namespace etendue
