// Footprints, curvature, the choice between the two ways to hold textures, and textures that are broken.
#include "image/jpeg.h"
#include "image/write.h"
#include "world/test_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// One quad of 2 × 2 metres around the origin that faces +Z, placed twice, so that it is an instance; the second far
/// away.
World placed_quad(const Mat4f& to_world) {
    SceneDesc scene = empty_scene();
    PrimitiveDesc primitive = quad(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0});
    primitive.uv0 = {{0.1f, 0.9f}, {1.3f, 0.7f}, {1.2f, -0.4f}, {0.0f, -0.2f}};
    primitive.uv1 = {{0, 5}, {5, 5}, {5, 0}, {0, 0}};
    primitive.material = add_material(scene, diffuse(Rgb(0.5f)));
    const auto mesh = add_mesh(scene, {std::move(primitive)});
    place(scene, mesh, to_world);
    place(scene, mesh, translation({1000, 0, 0}));
    return compile(std::move(scene));
}

/// How far out `offset` lies on the ellipse with these conjugate diameters: 1 is on it.
float ellipse_radius(const TextureFootprint& footprint, Vec2f offset) {
    const Vec2f a = footprint.diameter[0] * 0.5f;
    const Vec2f b = footprint.diameter[1] * 0.5f;
    const float determinant = a.x * b.y - a.y * b.x;
    return std::hypot(offset.x * b.y - offset.y * b.x, a.x * offset.y - a.y * offset.x) / std::abs(determinant);
}

// The rays on the surface of a cylinder around a ray meet the plane on the ellipse that the footprint says, in both
// sets of coordinates and under any transform.
TEST(TextureFootprintOfAPoint, IsWhereTheConeMeetsTheTriangle) {
    Random random(21);
    for (int i = 0; i < 200; ++i) {
        const Mat4f to_world = random_transform(random, i % 2 == 1);
        const World world = placed_quad(to_world);
        const Vec3f target =
            transform_point(to_world, {0.5f * random.next() - 0.6f, 0.4f * random.next() + 0.3f, 0.0f});
        Ray ray;
        ray.direction = random_direction(random);
        ray.origin = target - ray.direction * 3.0f;
        const Hit hit = intersect(world, ray);
        if (!hit.valid()) continue;
        const float width = 1e-3f;
        const SurfacePoint point = world.geometry().surface_point(hit, ray, {width - 0.5f * hit.t, 0.5f});
        if (std::abs(dot(ray.direction, point.geometric_normal)) < 0.05f) continue;
        const Frame around = Frame::from_normal(ray.direction);
        for (const float phase : {0.0f, 1.0f, 2.0f, 3.0f}) {
            Ray shifted = ray;
            shifted.origin += (around.tangent * std::cos(phase) + around.bitangent * std::sin(phase)) * (0.5f * width);
            const Hit beside = intersect(world, shifted);
            if (!beside.valid() || beside.triangle != hit.triangle) continue;
            const SurfacePoint there = world.geometry().surface_point(beside);
            for (std::size_t set = 0; set < 2; ++set)
                EXPECT_NEAR(ellipse_radius(point.footprint[set], there.uv[set] - point.uv[set]), 1.0f, 0.03f);
        }
    }
}

TEST(TextureFootprintOfAPoint, IsNothingWithoutWidth) {
    const World world = placed_quad(Mat4f());
    const Ray ray{.origin = {0.2f, 0.3f, 1.0f}, .direction = {0, 0, -1}};
    const Hit hit = intersect(world, ray);
    EXPECT_TRUE(world.geometry().surface_point(hit).footprint[0].is_point());
    EXPECT_TRUE(world.geometry().surface_point(hit, ray, {0.0f, 0.0f}).footprint[0].is_point());
    EXPECT_FALSE(world.geometry().surface_point(hit, ray, {0.0f, 0.01f}).footprint[0].is_point());
    // Behind a crossing the width is negative, and as wide.
    EXPECT_NEAR(world.geometry().surface_point(hit, ray, {0.01f, -0.03f}).footprint[1].diameter[0].x,
                world.geometry().surface_point(hit, ray, {0.02f, 0.0f}).footprint[1].diameter[0].x, 1e-6f);
}

TEST(TextureFootprintOfAPoint, StaysFiniteAtGrazingAngles) {
    const World world = placed_quad(Mat4f());
    for (const float height : {1e-2f, 1e-4f, 1e-6f}) {
        const Ray ray{.origin = {-0.9f, 0.05f, height}, .direction = normalize(Vec3f(1.0f, 0.0f, -height))};
        const Hit hit = intersect(world, ray);
        ASSERT_TRUE(hit.valid());
        const TextureFootprint footprint = world.geometry().surface_point(hit, ray, {1e-3f, 0.0f}).footprint[1];
        for (const Vec2f& diameter : footprint.diameter) {
            EXPECT_TRUE(std::isfinite(diameter.x) && std::isfinite(diameter.y));
            EXPECT_LT(std::hypot(diameter.x, diameter.y), 3.0f);
        }
    }
}

TEST(MeanCurvature, OfASphereIsOneOverItsRadius) {
    for (const float radius : {0.5f, 3.0f}) {
        SceneDesc scene = empty_scene();
        add_object(scene, sphere({0, 0, -10}, radius, 64), add_material(scene, diffuse(Rgb(0.5f))));
        add_object(scene, quad({0, 0, -20}, {9, 0, 0}, {0, 9, 0}), add_material(scene, diffuse(Rgb(0.5f))));
        const World world = compile(std::move(scene));
        const Hit ball = intersect(world, {.direction = {0, 0, -1}});
        EXPECT_NEAR(world.geometry().mean_curvature(ball), 1.0f / radius, 0.02f / radius);
        const Hit wall = intersect(world, {.origin = {5, 5, 0}, .direction = {0, 0, -1}});
        EXPECT_EQ(world.geometry().mean_curvature(wall), 0.0f);
    }
}

class TextureFiltering : public testing::Test {
  protected:
    /// A quad [-1, 1]² at z = -1 with `material`, whose texture is a checkerboard of single texels, 64 × 64.
    SceneDesc checkered(const MaterialDesc& material) {
        SceneDesc scene = empty_scene();
        std::vector<std::array<int, 4>> texels;
        for (int i = 0; i < 64 * 64; ++i) {
            const int value = (i % 64 + i / 64) % 2 == 0 ? 255 : 0;
            texels.push_back({value, value, value, value});
        }
        add_texture(scene, png_, 64, texels);
        add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, material));
        return scene;
    }
    static SurfacePoint point_of(const World& world, float x, float width) {
        const Ray ray{.origin = {x, 0.01f, 0}, .direction = {0, 0, -1}};
        return world.geometry().surface_point(intersect(world, ray), ray, {width, 0.0f});
    }
    static float base_of(const World& world, float x, float width) {
        const SurfacePoint point = point_of(world, x, width);
        Bsdf storage;
        return std::get<MetallicRoughness>(world.materials().bsdf(point, {0, 0, 1}, 0.0f, storage)).base.g;
    }
    void TearDown() override { std::filesystem::remove(png_); }

    std::filesystem::path png_ = temporary_file("etendue-world-filtering.png");
    static constexpr float kTexel = 2.0f / 64.0f;  ///< metres
    /// x at the centres of a white and of a black texel.
    static constexpr float kWhite = 1.5f * kTexel;
    static constexpr float kBlack = 0.5f * kTexel;
};

MaterialDesc textured_material() {
    MaterialDesc material;
    material.base_color_texture.texture = {0};
    return material;
}

TEST_F(TextureFiltering, ColoursAreAveragedOverTheFootprint) {
    const World world = compile(checkered(textured_material()));
    EXPECT_NE(base_of(world, kWhite, 0.0f), base_of(world, kBlack, 0.0f));
    EXPECT_EQ(base_of(world, kWhite, 0.9f * kTexel), base_of(world, kWhite, 0.0f));
    EXPECT_NEAR(base_of(world, kWhite, 2.0f * kTexel), 0.5f, 5e-3f);
    EXPECT_NEAR(base_of(world, kBlack, 2.0f * kTexel), 0.5f, 5e-3f);
}

// Of the checkerboard, a cut-out shows the white squares alone, a body's surface all of it.
TEST_F(TextureFiltering, ColoursOfCutOutsAreThoseOfWhatShows) {
    MaterialDesc material;
    material.metallic = 0.0f;
    material.base_color_texture.texture = {0};
    material.alpha_mode = AlphaMode::Mask;
    SceneDesc scene = checkered(material);
    scene.settings.texture_memory = 0;
    int seen = 0;
    for (const World& world : {compile(checkered(material)), compile(scene)})
        for (const float x : {kWhite, kBlack}) {
            if (!intersect(world, {.origin = {x, 0.01f, 0}, .direction = {0, 0, -1}}).valid()) continue;
            ++seen;
            for (const float width : {0.2f, 1.0f}) EXPECT_NEAR(base_of(world, x, width), 1.0f, 0.01f);
        }
    EXPECT_EQ(seen, 2);
    material.alpha_mode = AlphaMode::Blend;
    material.metallic = material.transmission = 1.0f;
    material.volume.closed = true;
    EXPECT_NEAR(base_of(compile(checkered(material)), kWhite, 1.0f), 0.5f, 0.01f);
}

TEST_F(TextureFiltering, TextureTransformsScaleTheFootprint) {
    MaterialDesc material = textured_material();
    material.base_color_texture.transform.scale = {16.0f, 16.0f};
    const World world = compile(checkered(material));
    EXPECT_NEAR(base_of(world, kWhite, kTexel / 8.0f), 0.5f, 5e-3f);
    EXPECT_NEAR(base_of(world, kWhite + 0.01f * kTexel, kTexel / 8.0f), 0.5f, 5e-3f);
}

TEST_F(TextureFiltering, SamplersThatForbidMipLevelsAreObeyed) {
    SceneDesc scene = checkered(textured_material());
    scene.textures[0].mip_filter = TextureMipFilter::None;
    const World world = compile(std::move(scene));
    EXPECT_EQ(base_of(world, kWhite, 64.0f * kTexel), base_of(world, kWhite, 0.0f));
}

// Light samples and hits must see one function, and rays must pass or stop whoever sends them.
TEST_F(TextureFiltering, EmissionAndOpacityAreNotFiltered) {
    MaterialDesc material = emissive(Rgb(2.0f));
    material.emissive_texture.texture = {0};
    material.alpha_mode = AlphaMode::Mask;
    material.base_color_texture.texture = {0};
    const World world = compile(checkered(material));
    for (const float x : {kWhite, kBlack}) {
        const Ray ray{.origin = {x, 0.01f, 0}, .direction = {0, 0, -1}};
        const Hit hit = intersect(world, ray);
        if (!hit.valid()) continue;
        const Vec3f eye(0, 0, 1);
        EXPECT_EQ(world.materials().emission(world.geometry().surface_point(hit, ray, {0.5f, 0.0f}), eye),
                  world.materials().emission(world.geometry().surface_point(hit), eye));
    }
    EXPECT_NE(intersect(world, {.origin = {kWhite, 0.01f, 0}, .direction = {0, 0, -1}}).valid(),
              intersect(world, {.origin = {kBlack, 0.01f, 0}, .direction = {0, 0, -1}}).valid());
}

TEST_F(TextureFiltering, TexturesAreResidentIfTheyFitAndCachedIfNot) {
    // RGBA with all mip levels.
    constexpr std::uint64_t kBytes = 4 * (64 * 64 + 32 * 32 + 16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1);
    SceneDesc scene = checkered(textured_material());
    scene.settings.texture_memory = kBytes;
    const World resident = compile(scene);
    EXPECT_EQ(resident.statistics().textures, 1u);
    EXPECT_EQ(resident.statistics().texture_bytes, kBytes);
    EXPECT_FALSE(resident.statistics().textures_cached);
    scene.settings.texture_memory = kBytes - 1;
    const World cached = compile(scene);
    EXPECT_TRUE(cached.statistics().textures_cached);
    EXPECT_EQ(cached.statistics().texture_cache_budget, kBytes - 1);
    for (const float width : {0.0f, 1.4f, 2.0f, 9.0f})
        for (const float x : {kWhite, kBlack, 0.3f, -0.7f})
            EXPECT_NEAR(base_of(cached, x, width * kTexel), base_of(resident, x, width * kTexel), 3.0f / 255.0f);
    EXPECT_GT(cached.statistics().texture_bytes, 0u);
    EXPECT_EQ(cached.statistics().failed_texture_lookups, 0u);
}

/// True if `problems` have a warning at `pointer` that has `text` in it.
bool warns(const ProblemList& problems, const std::string& pointer, const std::string& text) {
    return std::ranges::any_of(problems.all(), [&](const Problem& problem) {
        return problem.severity == Severity::Warning && problem.where.pointer == pointer &&
               problem.message.find(text) != std::string::npos;
    });
}

/// The checkered scene with its image cut off after `bytes`.
SceneDesc cut_off(SceneDesc scene, std::uintmax_t bytes) {
    scene.images[0].location = {"scene.gltf", "/images/0"};
    std::filesystem::resize_file(scene.images[0].path, bytes);
    return scene;
}

TEST_F(TextureFiltering, ABrokenImageIsAnErrorInBothWaysIfThatIsAskedFor) {
    SceneDesc scene = cut_off(checkered(textured_material()), 20);
    scene.settings.missing_textures = MissingTextures::Error;
    for (const std::uint64_t budget : {std::uint64_t{0}, std::uint64_t{1} << 30}) {
        scene.settings.texture_memory = budget;
        try {
            static_cast<void>(compile(scene));
            ADD_FAILURE() << "no error with a budget of " << budget;
        } catch (const SceneError& error) {
            EXPECT_NE(std::string(error.what()).find("scene.gltf#/images/0"), std::string::npos) << error.what();
        }
    }
}

TEST_F(TextureFiltering, MaterialsDoWithoutAnImageWhoseHeaderIsBroken) {
    MaterialDesc material = textured_material();
    material.base_color = Rgb(0.25f);
    SceneDesc scene = cut_off(checkered(material), 20);
    for (const std::uint64_t budget : {std::uint64_t{0}, std::uint64_t{1} << 30}) {
        scene.settings.texture_memory = budget;
        ProblemList problems;
        const World world = compile(scene, kGltfColorSpace, problems);
        EXPECT_EQ(world.statistics().missing_textures, 1u);
        EXPECT_EQ(base_of(world, kWhite, 0.0f), 0.25f);
        EXPECT_TRUE(warns(problems, "/images/0", "materials do without it"));
    }
}

/// Where the pixels of a PNG begin.
std::uintmax_t pixels_of(const std::filesystem::path& png) {
    std::ifstream stream(png, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    return bytes.find("IDAT") + 4;
}

// The header tells nothing of it: other textures have been decoded by then.
TEST_F(TextureFiltering, MaterialsDoWithoutAnImageWhosePixelsAreBroken) {
    MaterialDesc material;
    material.emissive = Rgb(1.0f);
    material.emissive_texture.texture = {0};
    material.base_color_texture.texture = {1};
    SceneDesc scene = checkered(material);
    const std::filesystem::path whole = temporary_file("etendue-whole-texture.png");
    (void)add_texture(scene, whole, 1, {{188, 188, 188, 255}});
    scene = cut_off(std::move(scene), pixels_of(png_) + 6);
    ProblemList problems;
    const World world = compile(scene, kGltfColorSpace, problems);
    std::filesystem::remove(whole);
    EXPECT_EQ(world.statistics().missing_textures, 1u);
    EXPECT_EQ(world.statistics().textures, 1u);
    EXPECT_NEAR(base_of(world, kWhite, 0.0f), 0.502886f, 1e-4f) << "the other texture is there";
    EXPECT_FALSE(world.traits().has_lights) << "nobody knows which part of the surface shines";
    EXPECT_TRUE(warns(problems, "/images/0", "materials do without it"));
}

TEST_F(TextureFiltering, ImagesThatEndEarlyAreShownAsFarAsTheyGo) {
    SceneDesc scene = empty_scene();
    Random random(3);
    std::vector<std::array<int, 4>> texels;
    texels.reserve(128 * 128);
    for (int i = 0; i < 128 * 128; ++i) texels.push_back({static_cast<int>(255.0f * random.next()), 0, 0, 255});
    MaterialDesc material;
    material.base_color_texture.texture = add_texture(scene, png_, 128, texels);
    scene.textures[0].filter = TextureFilter::Nearest;
    add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, material));
    const auto color_at = [](const World& world, float y) {
        const Hit hit = intersect(world, {.origin = {0.01f, y, 0}, .direction = {0, 0, -1}});
        Bsdf storage;
        return std::get<MetallicRoughness>(
                   world.materials().bsdf(world.geometry().surface_point(hit), {0, 0, 1}, 0.0f, storage))
            .base;
    };
    const World whole = compile(scene);
    scene = cut_off(std::move(scene), std::filesystem::file_size(png_) / 4 * 3);  // PNGs are decoded by 8 KiB
    ProblemList problems;
    const World cut = compile(scene, kGltfColorSpace, problems);
    EXPECT_TRUE(warns(problems, "/images/0", "is cut off or broken from row")) << problems.all().size();
    EXPECT_EQ(cut.statistics().missing_textures, 0u);
    for (const float y : {0.99f, 0.5f}) EXPECT_NEAR(color_at(cut, y).r, color_at(whole, y).r, 1e-5f) << y;
    EXPECT_EQ(color_at(cut, -0.99f), color_at(cut, -0.6f)) << "one row is repeated";
    EXPECT_GT(color_at(cut, -0.99f).r, 0.0f);
    scene.settings.missing_textures = MissingTextures::Error;
    EXPECT_THROW((void)compile(scene), SceneError);
}

TEST_F(TextureFiltering, JpegsThatEndEarlyAreShownWithAWarning) {
    const std::filesystem::path file = temporary_file("etendue-cut.jpg");
    ImageF image(64, 64, 3);
    Random random(5);
    std::ranges::generate(image.pixels, [&] { return random.next(); });
    const std::vector<unsigned char> jpeg = encode_jpeg(image, 90);
    for (const std::size_t missing : {std::size_t{0}, jpeg.size() / 8}) {
        SceneDesc scene = empty_scene();
        MaterialDesc material;
        material.base_color_texture.texture = add_texture(scene, file, 64, 64);
        scene.images[0].location = {"scene.gltf", "/images/0"};
        scene.images[0].path.clear();
        const auto bytes = std::as_bytes(std::span(jpeg)).first(jpeg.size() - missing);
        scene.images[0].encoded.assign(bytes.begin(), bytes.end());
        add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, material));
        ProblemList problems;
        const World world = compile(scene, kGltfColorSpace, problems);
        EXPECT_EQ(warns(problems, "/images/0", "ends early"), missing > 0);
        EXPECT_EQ(world.statistics().missing_textures, 0u);
    }
}

TEST_F(TextureFiltering, TexelsThatAreNoNumbersAreCounted) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const std::filesystem::path file = temporary_file("etendue-texels.exr");
    ImageF image(4, 1, 3);
    std::ranges::fill(image.pixels, 0.5f);
    image.pixel(1, 0)[0] = kInfinity;
    image.pixel(2, 0)[1] = -kInfinity;
    image.pixel(2, 0)[2] = std::numeric_limits<float>::quiet_NaN();
    write_image(file, image, {.depth = PixelDepth::Float});
    for (const std::uint64_t budget : {std::uint64_t{0}, std::uint64_t{1} << 30}) {
        SceneDesc scene = empty_scene();
        scene.settings.texture_memory = budget;
        MaterialDesc material = emissive(Rgb(1.0f));
        material.emissive_texture.texture = add_texture(scene, file, 4, 1);
        scene.images[0].location = {"scene.gltf", "/images/0"};
        scene.textures[0].filter = TextureFilter::Nearest;
        add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, material));
        ProblemList problems;
        const World world = compile(scene, kGltfColorSpace, problems);
        const auto emission_at = [&](float x) {
            const Hit hit = intersect(world, {.origin = {x, 0.1f, 0}, .direction = {0, 0, -1}});
            return world.materials().emission(world.geometry().surface_point(hit), {0, 0, 1});
        };
        EXPECT_EQ(emission_at(-0.25f), Rgb(65504.0f, 0.5f, 0.5f)) << budget;
        EXPECT_EQ(emission_at(0.25f), Rgb(0.5f, 0.0f, 0.0f)) << budget;
        // The cache reads pieces when they are asked for, and counts nothing.
        EXPECT_TRUE(warns(problems, "/images/0", "1 values of the image '")) << budget;
        EXPECT_TRUE(warns(problems, "/images/0", "2 values of the image '")) << budget;
    }
    std::filesystem::remove(file);
}

}  // namespace

}  // namespace etendue::test
