#include "color/color_config.h"
#include "world/compile_parts.h"
#include "world/test_scene.h"

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

Material compile_one(const MaterialDesc& desc, const std::string& working_space = kGltfColorSpace) {
    SceneDesc scene = empty_scene();
    add_material(scene, desc);
    TextureCompiler textures(scene);
    WorldData data;
    data.from_rec709 = ColorConfig::built_in().matrix(kGltfColorSpace, working_space);
    compile_materials(scene, textures, data);
    return std::move(data.materials.front());
}

template <typename Lobe>
Lobe lobe_of(const MaterialDesc& desc) {
    return std::get<Lobe>(std::get<Bsdf>(compile_one(desc).model));
}

MaterialDesc with_override(decltype(MaterialDesc::override_model) model) {
    MaterialDesc desc;
    desc.override_model = std::move(model);
    return desc;
}

TEST(CompileMaterials, OverridesBecomeTheLobesTheyName) {
    EXPECT_EQ(lobe_of<Diffuse>(with_override(DiffuseDesc{{0.1f, 0.2f, 0.3f}})).albedo, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(lobe_of<SmoothDielectric>(with_override(DielectricDesc{1.33f, 0.0f})).ior, 1.33f);
    const auto frosted = lobe_of<RoughDielectric>(with_override(DielectricDesc{1.5f, 0.5f}));
    EXPECT_EQ(frosted.ior, 1.5f);
    EXPECT_FLOAT_EQ(frosted.alpha_x, 0.25f);
    EXPECT_FLOAT_EQ(lobe_of<RoughConductor>(with_override(ConductorDesc{"Au", 0.4f})).alpha, 0.16f);
    (void)lobe_of<SmoothConductor>(with_override(ConductorDesc{"", 0.0f}));
}

TEST(CompileMaterials, DielectricsKeepTheBaseColour) {
    for (const float roughness : {0.0f, 0.5f}) {
        const auto tint_in = [&](const Rgb& base_color, const std::string& space) {
            MaterialDesc desc = with_override(DielectricDesc{1.5f, roughness});
            desc.base_color = base_color;
            const Bsdf lobe = std::get<Bsdf>(compile_one(desc, space).model);
            return roughness > 0.0f ? std::get<RoughDielectric>(lobe).tint : std::get<SmoothDielectric>(lobe).tint;
        };
        EXPECT_EQ(tint_in({0.25f, 0.5f, 0.75f}, kGltfColorSpace), Rgb(0.25f, 0.5f, 0.75f));
        EXPECT_NEAR(tint_in({1.0f, 0.0f, 0.0f}, "ACEScg").r, 0.613f, 0.002f);
        EXPECT_EQ(tint_in(Rgb(1.0f), "ACEScg"), Rgb(1.0f)) << "white has no rounding";
    }
}

TEST(CompileMaterials, TheUnnamedMetalLosesNothingAndGoldIsYellow) {
    const auto reflectance = [](const char* metal) {
        const Bsdf mirror = lobe_of<SmoothConductor>(with_override(ConductorDesc{metal, 0.0f}));
        return sample_bsdf(mirror, {0, 0, 1}, 0.5f, {0.5f, 0.5f}, TransportMode::Radiance).weight;
    };
    EXPECT_EQ(reflectance(""), Rgb(1.0f));
    const Rgb gold = reflectance("Au");
    EXPECT_GT(gold.r, 0.9f);
    EXPECT_GT(gold.r, gold.g);
    EXPECT_GT(gold.g, gold.b + 0.2f);
}

TEST(CompileMaterials, UnknownMetalsAreRefused) {
    EXPECT_THROW((void)compile_one(with_override(ConductorDesc{"Unobtainium", 0.1f})), SceneError);
}

TEST(CompileMaterials, OverridesKeepAlphaEmissionAndSides) {
    MaterialDesc desc = with_override(DiffuseDesc{});
    desc.alpha_mode = AlphaMode::Mask;
    desc.alpha_cutoff = 0.25f;
    desc.base_alpha = 0.75f;
    desc.double_sided = true;
    desc.emissive = {1.0f, 0.5f, 0.0f};
    desc.emissive_strength = 4.0f;
    const Material material = compile_one(desc);
    EXPECT_EQ(material.alpha_test, AlphaTest::Mask);
    EXPECT_EQ(material.alpha_cutoff, 0.25f);
    EXPECT_EQ(material.alpha_factor, 0.75f);
    EXPECT_TRUE(material.emits);
    EXPECT_TRUE(material.emits_both_sides);
    EXPECT_NEAR(material.emission.r, 4.0f, 1e-5f);
    EXPECT_NEAR(material.emission.g, 2.0f, 1e-5f);
}

TEST(CompileMaterials, ColoursGoToTheWorkingSpace) {
    MaterialDesc desc = with_override(DiffuseDesc{{1.0f, 0.0f, 0.0f}});
    desc.emissive = Rgb(1.0f);
    const Material material = compile_one(desc, "ACEScg");
    const Rgb albedo = std::get<Diffuse>(std::get<Bsdf>(material.model)).albedo;
    // Rec.709 red lies inside ACEScg's triangle.
    EXPECT_NEAR(albedo.r, 0.613f, 0.002f);
    EXPECT_NEAR(albedo.g, 0.070f, 0.002f);
    EXPECT_NEAR(albedo.b, 0.021f, 0.002f);
    // White stays white.
    EXPECT_NEAR(material.emission.r, 1.0f, 1e-3f);
    EXPECT_NEAR(material.emission.b, 1.0f, 1e-3f);
}

TEST(CompileMaterials, BlackEmissionIsNone) {
    MaterialDesc desc;
    EXPECT_FALSE(compile_one(desc).emits);
    desc.emissive = Rgb(1.0f);
    desc.emissive_strength = 0.0f;
    EXPECT_FALSE(compile_one(desc).emits);
}

/// Holds a quad of plastic in front of the camera, and a texture of four texels for it.
class TexturedQuad {
  public:
    TexturedQuad() : path_(temporary_file("roughness.png")), scene_(empty_scene()) { material_.metallic = 0.0f; }
    TexturedQuad(const TexturedQuad&) = delete;
    TexturedQuad& operator=(const TexturedQuad&) = delete;
    ~TexturedQuad() { std::filesystem::remove(path_); }

    [[nodiscard]] MaterialDesc& material() { return material_; }
    [[nodiscard]] SceneDesc& scene() { return scene_; }
    /// Returns a texture whose last texel has these channels, and the others 0.5 in all.
    [[nodiscard]] TextureRef texture(const std::array<int, 4>& last) {
        constexpr std::array<int, 4> kHalf{128, 128, 128, 128};
        TextureRef ref;
        ref.texture = add_texture(scene_, path_, 2, {kHalf, kHalf, kHalf, last});
        return ref;
    }
    [[nodiscard]] bool is_specular() const {
        SceneDesc scene = scene_;
        add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, material_));
        return compile(std::move(scene)).traits().has_specular_surfaces;
    }

  private:
    std::filesystem::path path_;
    SceneDesc scene_;
    MaterialDesc material_;
};

TEST(SpecularMaterials, AreSmoothSomewhereByTheirTexture) {
    TexturedQuad smooth;
    EXPECT_FALSE(smooth.is_specular());
    smooth.material().metallic_roughness_texture = smooth.texture({255, 0, 255, 255});
    EXPECT_TRUE(smooth.is_specular());
    TexturedQuad rough;
    rough.material().metallic_roughness_texture = rough.texture({0, 255, 0, 0});
    EXPECT_FALSE(rough.is_specular());
    rough.scene().settings.texture_memory = 0;
    EXPECT_TRUE(rough.is_specular()) << "nothing is known of what a cache will read";
}

TEST(SpecularMaterials, AreSmoothByTheirGlossiness) {
    TexturedQuad glossy;
    glossy.material().glossiness = 1.0f;
    EXPECT_TRUE(glossy.is_specular());
    glossy.material().glossiness = 0.5f;
    EXPECT_FALSE(glossy.is_specular());
    glossy.material().glossiness = 1.0f;
    glossy.material().specular_color_texture = glossy.texture({255, 255, 255, 100});
    EXPECT_FALSE(glossy.is_specular());
    TexturedQuad somewhere;
    somewhere.material().glossiness = 1.0f;
    somewhere.material().specular_color_texture = somewhere.texture({0, 0, 0, 255});
    EXPECT_TRUE(somewhere.is_specular());
}

TEST(SpecularMaterials, AreSmoothByTheirCoat) {
    TexturedQuad coated;
    coated.material().clearcoat.factor = 1.0f;
    coated.material().clearcoat.roughness = 1.0f;
    EXPECT_FALSE(coated.is_specular());
    coated.material().clearcoat.roughness_texture = coated.texture({255, 0, 255, 255});
    EXPECT_TRUE(coated.is_specular());
    coated.material().clearcoat.factor = 0.0f;
    EXPECT_FALSE(coated.is_specular());
}

TEST(CompileMaterials, TexturesAreSharedByUseOnly) {
    SceneDesc scene = empty_scene();
    scene.textures.resize(2);
    TextureCompiler textures(scene);
    TextureRef first;
    first.texture.index = 0;
    TextureRef second;
    second.texture.index = 1;
    const auto color = textures.slot(first, TextureUse::Color).texture;
    EXPECT_EQ(textures.slot(first, TextureUse::Color).texture, color);
    EXPECT_NE(textures.slot(first, TextureUse::Data).texture, color);
    EXPECT_NE(textures.slot(second, TextureUse::Color).texture, color);
    EXPECT_FALSE(textures.slot(TextureRef{}, TextureUse::Color).valid());
}

}  // namespace

}  // namespace etendue::test
