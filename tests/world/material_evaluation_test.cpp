#include "world/material_evaluation.h"

#include "world/test_scene.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

double srgb_to_linear(int value) {
    const double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

class MaterialEvaluation : public testing::Test {
  protected:
    Handle<TextureDesc> texture(int width, const std::vector<std::array<int, 4>>& texels) {
        const std::filesystem::path png =
            temporary_file("etendue-world-material-" + std::to_string(files_.size()) + ".png");
        files_.push_back(png);
        const auto handle = add_texture(scene_, png, width, texels);
        scene_.textures.back().filter = TextureFilter::Nearest;
        return handle;
    }
    /// Returns a scene without surfaces that has the textures so far.
    [[nodiscard]] SceneDesc scene_of_textures() const {
        SceneDesc scene = empty_scene();
        scene.images = scene_.images;
        scene.textures = scene_.textures;
        return scene;
    }
    World world_with(const MaterialDesc& material) {
        surface_.material = add_material(scene_, material);
        place(scene_, add_mesh(scene_, {surface_}));
        return compile(scene_);
    }
    /// The lobe at (x, y) of the quad [-1, 1]² at z = -1; u and v of its texture run right and down.
    static MetallicRoughness lobe_at(const World& world, float x, float y) {
        const Hit hit = intersect(world, Ray{.origin = {x, y, 0}, .direction = {0, 0, -1}});
        EXPECT_TRUE(hit.valid());
        Bsdf storage;
        return std::get<MetallicRoughness>(
            world.materials().bsdf(world.geometry().surface_point(hit), {0.0f, 0.0f, 1.0f}, 0.0f, storage));
    }
    void TearDown() override {
        for (const std::filesystem::path& file : files_) std::filesystem::remove(file);
    }

    SceneDesc scene_ = empty_scene();
    PrimitiveDesc surface_ = quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0});
    std::vector<std::filesystem::path> files_;
};

TEST_F(MaterialEvaluation, BaseColourIsFactorTimesTextureTimesVertexColour) {
    surface_.colors.assign(4, {0.5f, 1.0f, 0.25f, 1.0f});
    MaterialDesc material;
    material.base_color = {0.8f, 0.6f, 1.0f};
    material.base_color_texture.texture = texture(1, {{188, 100, 20, 255}});
    const MetallicRoughness lobe = lobe_at(world_with(material), 0.1f, 0.1f);
    EXPECT_NEAR(lobe.base.r, 0.8 * 0.5 * srgb_to_linear(188), 1e-5);
    EXPECT_NEAR(lobe.base.g, 0.6 * srgb_to_linear(100), 1e-5);
    EXPECT_NEAR(lobe.base.b, 0.25 * srgb_to_linear(20), 1e-5);
}

TEST_F(MaterialEvaluation, RoughnessIsGreenAndMetallicBlueAndNeitherIsColour) {
    MaterialDesc material;
    material.roughness = 0.9f;
    material.metallic = 0.5f;
    material.metallic_roughness_texture.texture = texture(1, {{255, 128, 64, 255}});
    const MetallicRoughness lobe = lobe_at(world_with(material), 0.1f, 0.1f);
    const float roughness = 0.9f * 128.0f / 255.0f;
    EXPECT_NEAR(lobe.alpha_x, roughness * roughness, 1e-5f);
    EXPECT_NEAR(lobe.metallic, 0.5f * 64.0f / 255.0f, 1e-5f);
}

TEST_F(MaterialEvaluation, TransmissionIsRedAndTheIndexGivesF0) {
    MaterialDesc material;
    material.metallic = 0.0f;
    material.ior = 1.33f;
    material.transmission = 0.8f;
    material.transmission_texture.texture = texture(1, {{128, 255, 255, 255}});
    const MetallicRoughness lobe = lobe_at(world_with(material), 0.1f, 0.1f);
    EXPECT_NEAR(lobe.transmission, 0.8f * 128.0f / 255.0f, 1e-5f);
    EXPECT_NEAR(lobe.f0.g, std::pow(0.33f / 2.33f, 2.0f), 1e-6f);
}

// KHR_materials_specular: f0 = min(0.04 colour, 1) factor, f90 = factor; the factor's texture is in alpha.
TEST_F(MaterialEvaluation, SpecularTintsAndWeakensTheReflection) {
    MaterialDesc material;
    material.metallic = 0.0f;
    material.specular = 0.8f;
    material.specular_texture.texture = texture(1, {{255, 0, 0, 128}});
    material.specular_color = {0.5f, 1.0f, 100.0f};
    const MetallicRoughness lobe = lobe_at(world_with(material), 0.1f, 0.1f);
    const float factor = 0.8f * 128.0f / 255.0f;
    EXPECT_NEAR(lobe.f90, factor, 1e-5f);
    EXPECT_NEAR(lobe.f0.r, 0.02f * factor, 1e-5f);
    EXPECT_NEAR(lobe.f0.g, 0.04f * factor, 1e-5f);
    EXPECT_NEAR(lobe.f0.b, factor, 1e-5f);
}

/// A material of KHR_materials_pbrSpecularGlossiness, as the loader makes it.
MaterialDesc specular_glossiness(const Rgb& diffuse, const Rgb& specular, float glossiness) {
    MaterialDesc material;
    material.base_color = diffuse;
    material.metallic = 0.0f;
    material.ior = 0.0f;
    material.specular_color = specular;
    material.glossiness = glossiness;
    return material;
}

TEST_F(MaterialEvaluation, SpecularGlossinessIsReadAtEachTexel) {
    MaterialDesc material = specular_glossiness({0.8f, 0.5f, 0.2f}, {0.9f, 0.6f, 0.3f}, 0.75f);
    material.specular_color_texture.texture = texture(2, {{200, 150, 100, 51}, {60, 255, 30, 204}});
    material.base_color_texture.texture = texture(1, {{188, 188, 188, 255}});
    const World world = world_with(material);
    const std::array<std::array<int, 4>, 2> texels{{{200, 150, 100, 51}, {60, 255, 30, 204}}};
    for (const std::size_t i : {0u, 1u}) {
        const MetallicRoughness lobe = lobe_at(world, i == 0 ? -0.5f : 0.5f, 0.1f);
        const Rgb specular(static_cast<float>(0.9 * srgb_to_linear(texels[i][0])),
                           static_cast<float>(0.6 * srgb_to_linear(texels[i][1])),
                           static_cast<float>(0.3 * srgb_to_linear(texels[i][2])));
        const float diffuse = static_cast<float>(srgb_to_linear(188)) * (1.0f - max_component(specular));
        const float roughness = 1.0f - 0.75f * static_cast<float>(texels[i][3]) / 255.0f;
        for (const std::size_t c : {0u, 1u, 2u}) {
            EXPECT_NEAR((&lobe.f0.r)[c], (&specular.r)[c], 1e-5f) << i;
            EXPECT_NEAR((&lobe.base.r)[c], (&material.base_color.r)[c] * diffuse, 1e-5f) << i;
        }
        EXPECT_NEAR(lobe.alpha_x, roughness * roughness, 1e-5f) << i;
        EXPECT_EQ(lobe.alpha_y, lobe.alpha_x);
        EXPECT_EQ(lobe.f90, 1.0f);
        EXPECT_EQ(lobe.metallic, 0.0f);
    }
}

// A mirror reflects F0 + (1 - F0) (1 - cos)^5, and what is below is c_diff times what that lets through at both ends.
TEST_F(MaterialEvaluation, SpecularGlossinessScattersAsItsFormulaSays) {
    const Rgb diffuse(0.8f, 0.5f, 0.2f);
    const Rgb specular(0.7f, 0.4f, 0.1f);
    const MetallicRoughness lobe = lobe_at(world_with(specular_glossiness(diffuse, specular, 1.0f)), 0.1f, 0.1f);
    const auto fresnel = [](double f0, double cosine) { return f0 + (1.0 - f0) * std::pow(1.0 - cosine, 5.0); };
    const double average = 0.7 + 0.3 / 21.0;
    for (const float o : {0.2f, 0.6f, 1.0f}) {
        const Vec3f wo(std::sqrt(1.0f - o * o), 0.0f, o);
        DeltaList deltas;
        lobe.add_deltas(wo, deltas);
        ASSERT_NE(deltas.begin(), deltas.end());
        for (const std::size_t c : {0u, 1u, 2u}) {
            const double f0 = static_cast<double>((&specular.r)[c]);
            EXPECT_NEAR((&deltas.begin()->weight.r)[c], fresnel(f0, static_cast<double>(o)), 1e-5) << o;
            for (const float i : {0.3f, 0.9f}) {
                const double passed = (1.0 - fresnel(0.7, static_cast<double>(o))) *
                                      (1.0 - fresnel(0.7, static_cast<double>(i))) / (1.0 - average);
                const double c_diff = static_cast<double>((&diffuse.r)[c]) * (1.0 - 0.7);
                const Rgb value = lobe.evaluate_parts(wo, {0.0f, std::sqrt(1.0f - i * i), i}).diffuse;
                EXPECT_NEAR((&value.r)[c], c_diff * passed * static_cast<double>(i) / static_cast<double>(kPi), 1e-5)
                    << o << ' ' << i;
            }
        }
    }
}

TEST_F(MaterialEvaluation, AnIndexOfZeroReflectsEverything) {
    MaterialDesc material;
    material.ior = 0.0f;
    EXPECT_EQ(lobe_at(world_with(material), 0.1f, 0.1f).f0, Rgb(1.0f));
}

TEST_F(MaterialEvaluation, TheSecondCoordinatesAreUsedWhereAskedFor) {
    surface_.uv1.assign(4, {0.75f, 0.5f});
    MaterialDesc material;
    material.base_color_texture.texture = texture(2, {{0, 0, 0, 255}, {255, 255, 255, 255}});
    material.base_color_texture.texcoord = 1;
    EXPECT_EQ(lobe_at(world_with(material), -0.5f, 0.0f).base, Rgb(1.0f));
}

TEST_F(MaterialEvaluation, TheFirstRowOfTheImageIsAtTheTop) {
    MaterialDesc material;
    material.base_color_texture.texture =
        texture(2, {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {0, 0, 0, 255}});
    const World world = world_with(material);
    EXPECT_EQ(lobe_at(world, -0.5f, 0.5f).base, Rgb(1, 0, 0));
    EXPECT_EQ(lobe_at(world, 0.5f, 0.5f).base, Rgb(0, 1, 0));
    EXPECT_EQ(lobe_at(world, -0.5f, -0.5f).base, Rgb(0, 0, 1));
    EXPECT_EQ(lobe_at(world, 0.5f, -0.5f).base, Rgb(0, 0, 0));
}

// The example of KHR_texture_transform's text: "utilizes only the lower left quadrant of the source image, rotated
// clockwise 90 degrees".
TEST_F(MaterialEvaluation, TextureTransformsDoWhatTheExtensionsExampleSays) {
    std::vector<std::array<int, 4>> texels(16, {0, 0, 0, 255});
    // The lower left quadrant of 4 × 4: red and green over blue and white.
    texels[8] = {255, 0, 0, 255};
    texels[9] = {0, 255, 0, 255};
    texels[12] = {0, 0, 255, 255};
    texels[13] = {255, 255, 255, 255};
    MaterialDesc material;
    material.base_color_texture.texture = texture(4, texels);
    material.base_color_texture.transform = {{0.0f, 1.0f}, kPi / 2.0f, {0.5f, 0.5f}};
    const World world = world_with(material);
    // Turned clockwise, the left column becomes the top row, its lower end first.
    EXPECT_EQ(lobe_at(world, -0.5f, 0.5f).base, Rgb(0, 0, 1));
    EXPECT_EQ(lobe_at(world, 0.5f, 0.5f).base, Rgb(1, 0, 0));
    EXPECT_EQ(lobe_at(world, -0.5f, -0.5f).base, Rgb(1, 1, 1));
    EXPECT_EQ(lobe_at(world, 0.5f, -0.5f).base, Rgb(0, 1, 0));
}

TEST_F(MaterialEvaluation, TextureTransformsScaleBeforeTheyShift) {
    MaterialDesc material;
    material.base_color_texture.texture = texture(2, {{255, 0, 0, 255}, {0, 255, 0, 255}});
    material.base_color_texture.transform.offset = {0.5f, 0.0f};
    material.base_color_texture.transform.scale = {0.25f, 1.0f};
    const World world = world_with(material);
    // u' = 0.25 u + 0.5 stays in the right half.
    for (const float x : {-0.9f, 0.0f, 0.9f}) EXPECT_EQ(lobe_at(world, x, 0.0f).base, Rgb(0, 1, 0));
}

TEST_F(MaterialEvaluation, EmissionTexturesAreColour) {
    MaterialDesc material = emissive(Rgb(6.0f, 3.0f, 0.0f));
    material.emissive_texture.texture = texture(2, {{0, 0, 0, 255}, {188, 188, 188, 255}});
    const World world = world_with(material);
    const auto emission_at = [&](float x) {
        const Hit hit = intersect(world, Ray{.origin = {x, 0, 0}, .direction = {0, 0, -1}});
        return world.materials().emission(world.geometry().surface_point(hit), {0, 0, 1});
    };
    EXPECT_EQ(emission_at(-0.5f), Rgb(0.0f));
    EXPECT_NEAR(emission_at(0.5f).r, 6.0 * srgb_to_linear(188), 1e-4);
    EXPECT_NEAR(emission_at(0.5f).g, 3.0 * srgb_to_linear(188), 1e-4);
    EXPECT_EQ(emission_at(0.5f).b, 0.0f);
}

TEST_F(MaterialEvaluation, UnlitSurfacesShowTheirBaseColourAndEmitNothing) {
    MaterialDesc material;
    material.unlit = true;
    material.base_color = {0.2f, 0.4f, 0.6f};
    material.emissive = Rgb(1.0f);
    const World world = world_with(material);
    const Hit hit = intersect(world, Ray{.direction = {0, 0, -1}});
    const SurfacePoint point = world.geometry().surface_point(hit);
    EXPECT_TRUE(point.material->unlit);
    EXPECT_NEAR(world.materials().unlit_color(point).g, 0.4f, 1e-6f);
    EXPECT_TRUE(is_black(world.materials().emission(point, {0, 0, 1})));
    EXPECT_FALSE(world.traits().has_lights);
}

TEST_F(MaterialEvaluation, LayersTakeTheirChannels) {
    MaterialDesc material;
    material.metallic = 0.0f;
    material.roughness = 0.5f;
    material.clearcoat.factor = 0.8f;
    material.clearcoat.texture.texture = texture(1, {{128, 255, 255, 255}});
    material.clearcoat.roughness = 0.9f;
    material.clearcoat.roughness_texture.texture = texture(1, {{255, 64, 255, 255}});
    material.sheen.color = {0.5f, 0.5f, 0.5f};
    material.sheen.color_texture.texture = texture(1, {{188, 255, 0, 255}});
    material.sheen.roughness = 0.8f;
    material.sheen.roughness_texture.texture = texture(1, {{255, 255, 255, 128}});
    material.iridescence.factor = 0.9f;
    material.iridescence.texture.texture = texture(1, {{64, 255, 255, 255}});
    material.iridescence.thickness_texture.texture = texture(1, {{255, 128, 255, 255}});
    material.diffuse_transmission.factor = 0.6f;
    material.diffuse_transmission.texture.texture = texture(1, {{255, 255, 255, 128}});
    material.diffuse_roughness.factor = 0.5f;
    material.diffuse_roughness.texture.texture = texture(1, {{64, 255, 255, 255}});
    material.anisotropy.strength = 0.7f;
    material.anisotropy.texture.texture = texture(1, {{255, 128, 128, 255}});
    const World world = world_with(material);
    const Hit hit = intersect(world, Ray{.origin = {0.1f, 0.1f, 0}, .direction = {0, 0, -1}});
    Bsdf storage;
    const auto& surface = std::get<LayeredSurface>(
        world.materials().bsdf(world.geometry().surface_point(hit), {0.0f, 0.0f, 1.0f}, 0.0f, storage));
    constexpr float kHalf = 128.0f / 255.0f;
    constexpr float kQuarter = 64.0f / 255.0f;
    EXPECT_NEAR(surface.coat.strength, 0.8f * kHalf, 1e-5f);
    EXPECT_NEAR(surface.coat.alpha, 0.81f * kQuarter * kQuarter, 1e-5f);
    EXPECT_NEAR(surface.sheen.color.r, 0.5 * srgb_to_linear(188), 1e-5);
    EXPECT_NEAR(surface.sheen.alpha, 0.64f * kHalf * kHalf, 1e-5f);
    const auto& base = std::get<MetallicRoughness>(surface.base);
    EXPECT_NEAR(base.film.strength, 0.9f * kQuarter, 1e-5f);
    EXPECT_NEAR(base.film.thickness_nm, 100.0f + 300.0f * kHalf, 1e-3f);
    EXPECT_NEAR(base.diffuse_transmission, 0.6f * kHalf, 1e-5f);
    EXPECT_NEAR(base.diffuse_roughness, 0.5f * kQuarter, 1e-5f);
    const float strength = 0.7f * kHalf;
    EXPECT_NEAR(base.alpha_x, 0.25f + 0.75f * strength * strength, 1e-5f);
    EXPECT_NEAR(base.alpha_y, 0.25f, 1e-6f);
}

TEST_F(MaterialEvaluation, AnisotropyTurnsTheFrame) {
    MaterialDesc material;
    material.anisotropy.strength = 0.5f;
    material.anisotropy.rotation = kPi / 6.0f;
    surface_.tangents.assign(4, {1.0f, 0.0f, 0.0f, 1.0f});
    const World world = world_with(material);
    const Hit hit = intersect(world, Ray{.origin = {0.1f, 0.1f, 0}, .direction = {0, 0, -1}});
    const Frame frame = world.geometry().surface_point(hit).shading;
    EXPECT_NEAR(frame.tangent.x, std::cos(kPi / 6.0f), 1e-5f);
    EXPECT_NEAR(frame.tangent.y, std::sin(kPi / 6.0f), 1e-5f);
}

TEST_F(MaterialEvaluation, ACoatDoesNotShowTheReliefBelowIt) {
    surface_.tangents.assign(4, {1.0f, 0.0f, 0.0f, 1.0f});
    MaterialDesc material;
    material.clearcoat.factor = 1.0f;
    material.normal_texture.texture = texture(1, {{200, 128, 230, 255}});
    const World world = world_with(material);
    const Hit hit = intersect(world, Ray{.origin = {0.1f, 0.1f, 0}, .direction = {0, 0, -1}});
    const SurfacePoint point = world.geometry().surface_point(hit);
    EXPECT_GT(point.shading.normal.x, 0.3f);
    EXPECT_NEAR(point.coat_normal.z, 1.0f, 1e-6f);
}

/// Whether the quad's lobe at its middle was made for that point, rather than once for all points.
bool is_made_for_the_point(const World& world, float relative_ior) {
    Bsdf storage;
    const Hit hit = intersect(world, Ray{.origin = {0.1f, 0.1f, 0}, .direction = {0, 0, -1}});
    return &world.materials().bsdf(world.geometry().surface_point(hit), {0.0f, 0.0f, 1.0f}, relative_ior, storage) ==
           &storage;
}

TEST_F(MaterialEvaluation, WhatIsTheSameEverywhereIsEvaluatedOnce) {
    MaterialDesc material;
    material.base_color = {0.8f, 0.6f, 0.1f};
    material.roughness = 0.6f;
    material.metallic = 0.3f;
    material.specular = 0.7f;
    material.iridescence.factor = 0.5f;
    const World world = world_with(material);
    EXPECT_FALSE(is_made_for_the_point(world, 0.0f));
    const MetallicRoughness lobe = lobe_at(world, 0.1f, 0.1f);
    EXPECT_EQ(lobe.base, material.base_color);
    EXPECT_FLOAT_EQ(lobe.alpha_x, 0.36f);
    EXPECT_EQ(lobe.metallic, 0.3f);
    EXPECT_EQ(lobe.f90, 0.7f);
    EXPECT_EQ(lobe.film.strength, 0.5f);
    // Converts with the world's matrix, as a lobe does that vertex colours have made for its point.
    SceneDesc colored = empty_scene();
    PrimitiveDesc white = quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0});
    white.colors.assign(4, {0.5f, 1.0f, 1.0f, 1.0f});
    add_object(colored, white, add_material(colored, material));
    const World varied = compile(colored);
    EXPECT_TRUE(is_made_for_the_point(varied, 0.0f));
    EXPECT_EQ(lobe.film.reflectance(lobe.f0, 0.5f), lobe_at(varied, 0.1f, 0.1f).film.reflectance(lobe.f0, 0.5f));
}

TEST_F(MaterialEvaluation, WhatVariesWithVertexColoursIsEvaluatedAtEachPoint) {
    surface_.colors = {
        {1.0f, 0.0f, 0.0f, 1.0f}, {1.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 1.0f, 0.0f, 1.0f}, {0.0f, 1.0f, 0.0f, 1.0f}};
    const World world = world_with({});
    EXPECT_TRUE(is_made_for_the_point(world, 0.0f));
    EXPECT_FALSE(lobe_at(world, 0.1f, 0.9f).base == lobe_at(world, 0.1f, -0.9f).base);
}

TEST_F(MaterialEvaluation, WhatVariesWithATextureIsEvaluatedAtEachPoint) {
    MaterialDesc material;
    material.transmission_texture.texture = texture(1, {{128, 0, 0, 255}});
    EXPECT_TRUE(is_made_for_the_point(world_with(material), 0.0f));
}

// As glTF's glass does, wherever the colour comes from and whatever is around it.
TEST_F(MaterialEvaluation, DielectricsKeepTheBaseColour) {
    MaterialDesc glass;
    glass.base_color = {0.9f, 0.6f, 0.3f};
    glass.metallic = 0.0f;
    glass.transmission = 1.0f;
    glass.volume.closed = true;
    const Handle<TextureDesc> paint = texture(1, {{188, 100, 20, 255}});
    for (const bool has_texture : {false, true})
        for (const bool has_colors : {false, true})
            for (const float roughness : {0.0f, 0.5f}) {
                glass.base_color_texture.texture = has_texture ? paint : Handle<TextureDesc>();
                surface_.colors.assign(has_colors ? 4 : 0, {0.5f, 1.0f, 0.25f, 1.0f});
                glass.roughness = roughness;
                MaterialDesc dielectric = glass;
                dielectric.transmission = 0.0f;
                dielectric.override_model = DielectricDesc{1.5f, roughness};
                for (const float relative_ior : {0.0f, 1.2f}) {
                    const auto tint_of = [&](const MaterialDesc& material) {
                        scene_ = scene_of_textures();
                        const World world = world_with(material);
                        const Hit hit = intersect(world, Ray{.origin = {0.1f, 0.1f, 0}, .direction = {0, 0, -1}});
                        Bsdf storage;
                        const Bsdf& lobe = world.materials().bsdf(world.geometry().surface_point(hit), {0, 0, 1},
                                                                  relative_ior, storage);
                        return roughness > 0.0f ? std::get<RoughDielectric>(lobe).tint
                                                : std::get<SmoothDielectric>(lobe).tint;
                    };
                    const Rgb tint = tint_of(dielectric);
                    const Rgb expected = tint_of(glass);
                    EXPECT_LT(expected.b, 0.31f);
                    EXPECT_NEAR(tint.r, expected.r, 1e-6f) << has_texture << has_colors << roughness << relative_ior;
                    EXPECT_NEAR(tint.g, expected.g, 1e-6f) << has_texture << has_colors << roughness << relative_ior;
                    EXPECT_NEAR(tint.b, expected.b, 1e-6f) << has_texture << has_colors << roughness << relative_ior;
                }
            }
}

TEST_F(MaterialEvaluation, ABodysInterfaceIsEvaluatedForWhatIsAroundIt) {
    MaterialDesc material;
    material.transmission = 1.0f;
    material.metallic = 0.0f;
    material.roughness = 0.0f;
    material.ior = 1.5f;
    material.volume.closed = true;
    const World world = world_with(material);
    EXPECT_FALSE(is_made_for_the_point(world, 1.5f));
    EXPECT_TRUE(is_made_for_the_point(world, 1.2f));
    Bsdf storage;
    const Hit hit = intersect(world, Ray{.origin = {0.1f, 0.1f, 0}, .direction = {0, 0, -1}});
    const auto ior = [&](float relative) {
        return std::get<SmoothDielectric>(
                   world.materials().bsdf(world.geometry().surface_point(hit), {0, 0, 1}, relative, storage))
            .ior;
    };
    EXPECT_EQ(ior(1.5f), 1.5f);
    EXPECT_EQ(ior(1.2f), 1.2f);
}

}  // namespace

}  // namespace etendue::test
