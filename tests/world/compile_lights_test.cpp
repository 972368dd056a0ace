#include "color/color_config.h"
#include "image/write.h"
#include "world/compile_parts.h"
#include "world/test_scene.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

LightDesc punctual(LightType type, float intensity) {
    LightDesc light;
    light.type = type;
    light.intensity = intensity;
    return light;
}

TEST(CompileLights, PunctualLightsTakePlaceAndAxisFromTheirNode) {
    Random random(4);
    // Scale, shear and mirroring must not change how bright they are.
    for (const bool mirrored : {false, true}) {
        const Mat4f to_world = random_transform(random, mirrored);
        const Vec3f position = transform_point(to_world, Vec3f(0.0f));
        const Vec3f axis = normalize(transform_vector(to_world, {0, 0, -1}));
        for (const LightType type : {LightType::Point, LightType::Spot, LightType::Directional}) {
            SceneDesc scene = empty_scene();
            LightDesc light = punctual(type, 6.0f);
            light.color = {1.0f, 0.5f, 0.25f};
            light.to_world = to_world;
            scene.lights.push_back(light);
            const World world = compile(std::move(scene));
            const ChosenLight chosen =
                world.lights().sample(position + axis * 2.0f, {{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}}, 0.0f);
            EXPECT_EQ(chosen.expected_samples, 1.0f);
            EXPECT_TRUE(chosen.sample.is_delta);
            EXPECT_GT(dot(chosen.sample.wi, -axis), 0.99999f);
            const float expected = type == LightType::Directional ? 6.0f : 6.0f / 4.0f;
            EXPECT_NEAR(chosen.sample.radiance.r, expected, 1e-4f);
            EXPECT_NEAR(chosen.sample.radiance.b, 0.25f * expected, 1e-4f);
        }
    }
}

TEST(CompileLights, SpotsKeepTheirFullIntensityHoweverNarrow) {
    for (const float outer : {1.5f, 0.3f, 0.02f, 0.005f})
        for (const float inner : {0.0f, 0.5f, 0.999f}) {
            SceneDesc scene = empty_scene();
            LightDesc light = punctual(LightType::Spot, 3.0f);
            light.outer_cone_angle = outer;
            light.inner_cone_angle = inner * outer;
            scene.lights.push_back(light);
            const World world = compile(std::move(scene));
            EXPECT_NEAR(world.lights()
                            .sample(Vec3f(0, 0, -1), {{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}}, 0.0f)
                            .sample.radiance.g,
                        3.0f, 1e-3f)
                << "outer " << outer << ", inner share " << inner;
        }
}

// 683.002 lm/W divides lamps; surfaces and environments are what they are.
TEST(CompileLights, RadiometricUnitsDivideLampsOnly) {
    for (const LightType type : {LightType::Point, LightType::Spot, LightType::Directional}) {
        SceneDesc scene = empty_scene();
        scene.lights.push_back(punctual(type, 6.0f));
        const auto seen = [](const SceneDesc& s) {
            return compile(s)
                .lights()
                .sample(Vec3f(0, 0, -1), {{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}}, 0.0f)
                .sample.radiance.g;
        };
        EXPECT_FLOAT_EQ(seen(scene), 6.0f);
        scene.settings.light_units = LightUnits::Radiometric;
        EXPECT_FLOAT_EQ(seen(scene), 6.0f / 683.002f);
    }
    SceneDesc scene = empty_scene();
    scene.settings.light_units = LightUnits::Radiometric;
    scene.environment.enabled = true;
    add_object(scene, quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0}), add_material(scene, emissive(Rgb(3.0f))));
    const World world = compile(std::move(scene));
    EXPECT_EQ(world.environment().radiance(world.environment().light(), {0, 1, 0}), Rgb(1.0f));
    Ray ray;
    ray.direction = {0, 0, -1};
    const Hit hit = intersect(world, ray);
    ASSERT_TRUE(hit.valid());
    EXPECT_EQ(world.materials().emission(world.geometry().surface_point(hit), {0, 0, 1}), Rgb(3.0f));
}

TEST(CompileLights, ProfilesFollowTheAxesOfTheirLight) {
    SceneDesc scene = empty_scene();
    // Bright downwards (local -Z), and half as bright sideways at 90 degrees, which is local +Y.
    const float quarter = 0.5f * kPi;
    scene.ies_profiles.push_back({"lamp",
                                  {0.0f, quarter, kPi},
                                  {0.0f, quarter, 2.0f * quarter, 4.0f * quarter},
                                  {100, 0, 0, 100, 50, 0, 100, 0, 0, 100, 0, 0},
                                  {}});
    Random random(7);
    for (const LightType type : {LightType::Point, LightType::Spot}) {
        LightDesc light = punctual(type, 2.0f);
        light.outer_cone_angle = quarter;
        light.inner_cone_angle = 0.99f * quarter;
        light.profile.index = 0;
        light.to_world.rotate(Vec3f(random.next(), random.next(), random.next()) * 6.0f);
        light.to_world[3][0] = 4.0f;
        scene.lights = {light};
        const World world = compile(scene);
        EXPECT_TRUE(world.traits().has_delta_lights);
        const auto seen_at = [&](const Vec3f& local) {
            return world.lights()
                .sample(transform_point(light.to_world, local), {{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}}, 0.0f)
                .sample.radiance.g;
        };
        EXPECT_NEAR(seen_at({0, 0, -2}), 200.0f / 4.0f, 1e-2f);
        EXPECT_NEAR(seen_at({0, 0, 2}), 0.0f, 1e-4f);
        EXPECT_NEAR(seen_at({0, -1, 0}), 0.0f, 1e-3f);
        // A spot light's cone ends where this one is.
        EXPECT_NEAR(seen_at({0, 1, 0.01f}), type == LightType::Point ? 100.0f : 0.0f, 2.0f);
    }
}

TEST(CompileLights, LightsThatAreOffAreLeftOut) {
    SceneDesc scene = empty_scene();
    scene.lights.push_back(punctual(LightType::Point, 0.0f));
    LightDesc black = punctual(LightType::Directional, 1.0f);
    black.color = Rgb(0.0f);
    scene.lights.push_back(black);
    EXPECT_FALSE(compile(scene).traits().has_lights);
    scene.lights.push_back(punctual(LightType::Point, 1.0f));
    EXPECT_EQ(compile(std::move(scene)).statistics().lights, 1u);
}

TEST(CompileLights, EveryInstanceOfAnEmitterIsALight) {
    SceneDesc scene = empty_scene();
    const auto glow = add_material(scene, emissive(Rgb(1.0f)));
    PrimitiveDesc lamp = quad(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0});
    lamp.material = glow;
    PrimitiveDesc stand = quad(Vec3f(0.0f), {1, 0, 0}, {0, 0, 1});
    stand.material = add_material(scene, diffuse(Rgb(0.5f)));
    const auto mesh = add_mesh(scene, {stand, lamp});
    for (const float x : {0.0f, 5.0f, 10.0f}) place(scene, mesh, translation({x, 0, 0}));
    EXPECT_EQ(compile(std::move(scene)).statistics().lights, 3u);
}

TEST(CompileLights, EmittersThatAreNotSampledAreKnown) {
    SceneDesc scene = empty_scene();
    const auto glow = add_material(scene, emissive(Rgb(1.0f)));
    for (const float x : {0.0f, 5.0f}) add_object(scene, quad({x, 0, -2}, {1, 0, 0}, {0, 1, 0}), glow);
    EXPECT_FALSE(compile(scene).traits().has_unsampled_emitters);
    // Each has two triangles.
    for (const std::size_t most : {4u, 3u, 1u}) {
        SceneDesc limited = scene;
        WorldData data;
        TextureCompiler textures(limited);
        const ThreadPool threads(1);
        compile_materials(limited, textures, data);
        compile_geometry(limited, threads, 0, data);
        ProblemList problems;
        compile_lights(limited, threads, data, problems, most);
        EXPECT_EQ(data.lights.size(), most / 2);
        EXPECT_EQ(data.has_unsampled_emitters, most < 4);
        EXPECT_EQ(problems.all().size(), most < 4 ? 1u : 0u);
    }
    Mat4f grown;
    grown.setScale(Vec3f(1.5f));
    scene.instances.front().motion = {Mat4f(), grown};
    EXPECT_TRUE(compile(scene).traits().has_unsampled_emitters);
}

TEST(CompileLights, ConstantEnvironmentsAreColourTimesScale) {
    SceneDesc scene = empty_scene();
    scene.environment.enabled = true;
    scene.environment.color = {1.0f, 0.5f, 0.25f};
    scene.environment.scale = 4.0f;
    const World world = compile(std::move(scene));
    ASSERT_TRUE(world.traits().has_environment);
    EXPECT_EQ(world.environment().radiance(world.environment().light(), {0, 1, 0}), Rgb(4.0f, 2.0f, 1.0f));
    EXPECT_NEAR(world.environment().emission_pdf_solid_angle(world.environment().light(), {0, 1, 0}),
                1.0f / (4.0f * kPi), 1e-6f);
    // Beside samples of the BSDF it needs none of its own.
    EXPECT_TRUE(world.traits().has_lights);
    EXPECT_FALSE(world.traits().has_sampled_lights);
    EXPECT_EQ(world.environment().pdf_solid_angle(world.environment().light(), {0, 1, 0}), 0.0f);
    EXPECT_EQ(world.environment().sample_all(Vec3f(0.0f), {0.2f, 0.7f}).radiance, Rgb(4.0f, 2.0f, 1.0f));
}

TEST(CompileLights, DisabledEnvironmentsAreNone) {
    const World world = compile(empty_scene());
    EXPECT_FALSE(world.traits().has_environment);
    EXPECT_TRUE(is_black(world.environment().radiance(world.environment().light(), {0, 1, 0})));
    EXPECT_EQ(world.environment().pdf_solid_angle(world.environment().light(), {0, 1, 0}), 0.0f);
    EXPECT_EQ(world.environment().emission_pdf_solid_angle(world.environment().light(), {0, 1, 0}), 0.0f);
}

TEST(CompileLights, EnvironmentImagesAreTintedScaledAndTurned) {
    const std::filesystem::path file = temporary_file("etendue-world-environment.exr");
    // Four columns; what lies right of the middle is lit: towards -Z and turning to +X.
    ImageF image(4, 2, 3);
    for (int y = 0; y < 2; ++y)
        for (float& value : image.pixel(2, y)) value = 2.0f;
    write_image(file, image, {.depth = PixelDepth::Float});
    SceneDesc scene = empty_scene();
    scene.environment.enabled = true;
    scene.environment.image = file;
    scene.environment.color = {1.0f, 0.5f, 0.0f};
    scene.environment.scale = 3.0f;
    const Vec3f lit = normalize(Vec3f(1, 0, -1));
    {
        const World world = compile(scene);
        EXPECT_NEAR(world.environment().radiance(world.environment().light(), lit).r, 6.0f, 1e-4f);
        EXPECT_NEAR(world.environment().radiance(world.environment().light(), lit).g, 3.0f, 1e-4f);
        EXPECT_EQ(world.environment().radiance(world.environment().light(), lit).b, 0.0f);
        EXPECT_NEAR(world.environment().radiance(world.environment().light(), -lit).r, 0.0f, 1e-4f);
    }
    // A quarter turn counter-clockwise seen from above takes -Z to -X, and +X to -Z.
    scene.environment.rotation = kPi / 2.0f;
    const World world = compile(scene);
    EXPECT_NEAR(world.environment().radiance(world.environment().light(), normalize(Vec3f(-1, 0, -1))).r, 6.0f, 1e-4f);
    EXPECT_NEAR(world.environment().radiance(world.environment().light(), lit).r, 0.0f, 1e-4f);
    std::filesystem::remove(file);
    EXPECT_THROW((void)compile(scene), SceneError);
}

TEST(CompileLights, RadianceImagesAreEnvironmentsToo) {
    const std::filesystem::path file = temporary_file("etendue-world-environment.hdr");
    // Four columns of two rows, the third one lit: mantissas of a half with the exponent of 8.
    std::ofstream stream(file, std::ios::binary);
    stream << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 4; ++column) stream.write(column == 2 ? "\x80\x80\x80\x84" : "\0\0\0\0", 4);
    stream.close();
    SceneDesc scene = empty_scene();
    scene.environment.enabled = true;
    scene.environment.image = file;
    scene.environment.scale = 0.5f;
    scene.environment.rotation = kPi;
    const World world = compile(std::move(scene));
    EXPECT_NEAR(world.environment().radiance(world.environment().light(), normalize(Vec3f(-1, 0, 1))).g, 4.0f, 0.05f);
    EXPECT_NEAR(world.environment().radiance(world.environment().light(), normalize(Vec3f(1, 0, -1))).g, 0.0f, 1e-4f);
    std::filesystem::remove(file);
}

}  // namespace

}  // namespace etendue::test
