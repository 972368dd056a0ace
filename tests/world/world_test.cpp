// Light choice and emission: what a light's sample says must be what a ray that goes there finds (light transport rule
// 9), or multiple importance sampling is wrong.
#include "world/world.h"

#include "world/test_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// Two lamps of different power, placed so that a mirroring transform and an instance are among them.
struct LampCase {
    std::string name;
    bool two_sided = false;
    bool instanced = false;
    bool mirrored = false;
};

SceneDesc lamp_scene(const LampCase& c) {
    SceneDesc scene = empty_scene();
    MaterialDesc glow = emissive({3.0f, 2.0f, 1.0f});
    glow.double_sided = c.two_sided;
    PrimitiveDesc lamp = sphere(Vec3f(0.0f), 0.5f, 8);
    lamp.material = add_material(scene, glow);
    const auto mesh = add_mesh(scene, {lamp});
    Random random(31);
    const Mat4f to_world = random_transform(random, c.mirrored) * translation({0, 0, -3});
    place(scene, mesh, to_world);
    if (c.instanced) place(scene, mesh, translation({2, 1, -4}));
    glow.emissive_strength = 9.0f;
    add_object(scene, quad({-2, 0, -3}, {0, 0, 0.4f}, {0, 0.4f, 0}), add_material(scene, glow));
    return scene;
}

TEST(World, LightSamplesAndHitsAgree) {
    std::vector<LampCase> cases;
    for (const bool two_sided : {false, true})
        for (const bool instanced : {false, true})
            for (const bool mirrored : {false, true})
                cases.push_back({std::string(two_sided ? "two-sided" : "one-sided") +
                                     (instanced ? ", instanced" : ", baked") + (mirrored ? ", mirrored" : ""),
                                 two_sided, instanced, mirrored});
    for (const LampCase& c : cases) {
        SCOPED_TRACE(c.name);
        const World world = compile(lamp_scene(c));
        Random random(5);
        int lit = 0;
        int dark = 0;
        for (int i = 0; i < 3000; ++i) {
            const Vec3f from = random_direction(random) * 1.2f;
            const ChosenLight chosen =
                world.lights().sample(from, {random.next_2d(), random.next_2d(), random.next_2d()}, 0.0f);
            const LightSample& sample = chosen.sample;
            // What lies in between is another matter; start close to the sampled point.
            const float back = 0.02f * sample.distance;
            const Ray ray{.origin = from + sample.wi * (sample.distance - back), .direction = sample.wi};
            const Hit hit = intersect(world, ray);
            if (!hit.valid() || std::abs(hit.t - back) > 1e-3f) continue;  // grazing an edge
            if (hit.triangle != sample.triangle) continue;                 // a neighbour, at the silhouette
            const SurfacePoint point = world.geometry().surface_point(hit);
            const float cosine = abs_dot(point.geometric_normal, sample.wi);
            if (cosine < 0.02f) continue;
            EXPECT_EQ(world.materials().emission(point, -sample.wi), sample.radiance);
            const float pdf = world.lights().pdf_solid_angle(from, point, sample.wi, sample.distance, 0.0f);
            if (is_black(sample.radiance)) {
                ++dark;
                EXPECT_EQ(pdf, 0.0f);
            } else {
                ++lit;
                EXPECT_NEAR(pdf / sample.pdf_solid_angle, 1.0f, 2e-2f);
                EXPECT_GT(chosen.expected_samples, 0.0f);
            }
        }
        EXPECT_GT(lit, 500);
        // Of a closed lamp few samples are, since most that would be move to the opposite triangle.
        EXPECT_EQ(dark > 0, !c.two_sided);
        EXPECT_LT(dark, lit / 4);
    }
}

TEST(World, OneSidedEmittersAreDarkBehind) {
    for (const bool two_sided : {false, true}) {
        SceneDesc scene = empty_scene();
        MaterialDesc glow = emissive(Rgb(5.0f));
        glow.double_sided = two_sided;
        add_object(scene, quad(Vec3f(0.0f), {1, 0, 0}, {0, 1, 0}), add_material(scene, glow));
        const World world = compile(std::move(scene));
        for (const float side : {1.0f, -1.0f}) {
            const Vec3f from(0.1f, 0.2f, side);
            const Hit hit = intersect(world, Ray{.origin = from, .direction = {0, 0, -side}});
            const bool lit = two_sided || side > 0.0f;
            EXPECT_EQ(world.materials().emission(world.geometry().surface_point(hit), {0, 0, side}),
                      lit ? Rgb(5.0f) : Rgb(0.0f));
            EXPECT_EQ(
                is_black(world.lights().sample(from, {{0.5f, 0.5f}, {0.5f, 0.5f}, {0.3f, 0.6f}}, 0.0f).sample.radiance),
                !lit);
        }
    }
}

// Irradiance at a point from a textured, partly transparent emitter: once by light samples and once by rays over the
// hemisphere, as the two strategies of a path tracer see it. Tolerance: 4.5 standard errors.
TEST(World, BothStrategiesSeeTexturedAndTranslucentEmittersAlike) {
    const std::filesystem::path png = temporary_file("etendue-world-emitter.png");
    SceneDesc scene = empty_scene();
    MaterialDesc glow = emissive(Rgb(4.0f));
    // Bright where it lets half of the light through, dimmer where it is opaque, and a hole.
    const auto texture =
        add_texture(scene, png, 2, {{255, 255, 255, 128}, {90, 90, 90, 255}, {255, 255, 255, 0}, {160, 160, 160, 200}});
    glow.emissive_texture.texture = texture;
    glow.base_color_texture.texture = texture;
    glow.alpha_mode = AlphaMode::Blend;
    add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, glow));
    const World world = compile(std::move(scene));
    std::filesystem::remove(png);

    Random random(9);
    constexpr int kSamples = 60'000;
    struct Sum {
        double sum = 0.0;
        double squares = 0.0;
        void add(double x) { sum += x, squares += x * x; }
        [[nodiscard]] double mean() const { return sum / kSamples; }
        [[nodiscard]] double error() const { return std::sqrt((squares / kSamples - mean() * mean()) / kSamples); }
    };
    Sum by_light;
    Sum by_chance;
    for (int i = 0; i < kSamples; ++i) {
        const LightSample light =
            world.lights().sample(Vec3f(0.0f), {random.next_2d(), random.next_2d(), random.next_2d()}, 0.0f).sample;
        by_light.add(is_black(light.radiance)
                         ? 0.0
                         : static_cast<double>(light.radiance.g * -light.wi.z / light.pdf_solid_angle));
        const float z = random.next();  // uniform over the hemisphere around -z
        const float phi = 2.0f * kPi * random.next();
        const float r = std::sqrt(1.0f - z * z);
        Ray ray{.direction = {r * std::cos(phi), r * std::sin(phi), -z}};
        ray.alpha_key = static_cast<std::uint32_t>(i) * 2654435761u;
        const Hit hit = intersect(world, ray);
        by_chance.add(hit.valid()
                          ? static_cast<double>(
                                world.materials().emission(world.geometry().surface_point(hit), -ray.direction).g * z *
                                2.0f * kPi)
                          : 0.0);
    }
    EXPECT_GT(by_light.mean(), 0.1);
    EXPECT_NEAR(by_light.mean(), by_chance.mean(), 4.5 * std::hypot(by_light.error(), by_chance.error()));
}

TEST(World, LightsAreChosenByPower) {
    SceneDesc scene = empty_scene();
    // Both have a square metre; one is three times as bright. Power decides nine times in ten, an equal choice once.
    add_object(scene, quad({-2, 0, -3}, {0.5f, 0, 0}, {0, 0.5f, 0}), add_material(scene, emissive(Rgb(1.0f))));
    add_object(scene, quad({2, 0, -3}, {0.5f, 0, 0}, {0, 0.5f, 0}), add_material(scene, emissive(Rgb(3.0f))));
    const World world = compile(std::move(scene));
    Random random(3);
    int bright = 0;
    constexpr int kSamples = 10'000;
    for (int i = 0; i < kSamples; ++i) {
        const ChosenLight chosen =
            world.lights().sample(Vec3f(0.0f), {random.next_2d(), random.next_2d(), random.next_2d()}, 0.0f);
        const bool is_bright = chosen.sample.wi.x > 0.0f;
        EXPECT_NEAR(chosen.expected_samples, is_bright ? 0.7425f : 0.2575f, 1e-6f);
        bright += is_bright ? 1 : 0;
    }
    EXPECT_NEAR(bright, 0.725 * kSamples, 4.5 * std::sqrt(0.2 * kSamples));
}

TEST(World, MovingAWorldKeepsItWorking) {
    SceneDesc scene = empty_scene();
    MaterialDesc half = diffuse(Rgb(0.5f));
    half.alpha_mode = AlphaMode::Blend;
    half.base_alpha = 0.5f;
    add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, half));
    World first = compile(std::move(scene));
    const World second = std::move(first);
    int hits = 0;
    for (std::uint32_t key = 0; key < 64; ++key)
        hits += intersect(second, Ray{.alpha_key = key, .direction = {0, 0, -1}}).valid() ? 1 : 0;
    EXPECT_GT(hits, 10);
    EXPECT_LT(hits, 54);
}

TEST(World, TrianglesAreFetchedWhateverTheRaysHaveMet) {
    // More geometry than is thought to lie in a cache, one mesh with normals and one, placed twice, without.
    SceneDesc scene = empty_scene();
    Random random(5);
    const auto material = add_material(scene, diffuse(Rgb(0.5f)));
    PrimitiveDesc bare = soup(random, 30000, 0.1f);
    PrimitiveDesc smooth = soup(random, 30000, 0.1f);
    bare.normals.clear();
    smooth.normals.assign(smooth.positions.size(), Vec3f(0, 0, 1));
    bare.material = smooth.material = material;
    place(scene, add_mesh(scene, {smooth}), Mat4f());
    const auto shared = add_mesh(scene, {bare});
    for (int i = 0; i < 2; ++i) place(scene, shared, translation({0, 0, static_cast<float>(i)}));
    const World world = compile(std::move(scene));
    ASSERT_GT(world.statistics().geometry_bytes, std::size_t{2} << 20);
    std::vector<Hit> hits(65);  // every other one none
    for (std::size_t i = 0; i < hits.size(); i += 2) {
        const float x = static_cast<float>(i) / 64.0f - 0.5f;
        hits[i] = intersect(world, Ray{.origin = {x, 0.1f, 5}, .direction = {0, 0, -1}});
    }
    const auto is_valid = [](const Hit& hit) { return hit.valid(); };
    ASSERT_GT(std::ranges::count_if(hits, is_valid), 10);
    ASSERT_LT(std::ranges::count_if(hits, is_valid), 34);
    const std::vector<Hit> before = hits;
    world.geometry().fetch_triangles(hits);
    world.geometry().fetch_triangles({});
    for (std::size_t i = 0; i < hits.size(); ++i) EXPECT_EQ(hits[i].triangle, before[i].triangle);
}

TEST(World, ReportsItsRayTracer) {
    EXPECT_FALSE(ray_tracer_version().empty());
    EXPECT_FALSE(compile(empty_scene()).statistics().isa.empty());
}

TEST(World, UnlitSurfacesAreKnownWhereTheyAre) {
    SceneDesc scene = empty_scene();
    MaterialDesc sign;
    sign.unlit = true;
    const auto unlit = add_material(scene, sign);
    add_object(scene, quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    EXPECT_FALSE(compile(scene).traits().has_unlit_surfaces) << "no surface has that material";
    add_object(scene, quad({0, 0, -3}, {1, 0, 0}, {0, 1, 0}), unlit);
    EXPECT_TRUE(compile(scene).traits().has_unlit_surfaces);
    auto& override_model = scene.materials[static_cast<std::size_t>(unlit.index)].override_model;
    for (const MaterialModelDesc& model : {MaterialModelDesc(ConductorDesc{}), MaterialModelDesc(DielectricDesc{}),
                                           MaterialModelDesc(DiffuseDesc{}), MaterialModelDesc(SubsurfaceDesc{})}) {
        override_model = model;
        EXPECT_FALSE(compile(scene).traits().has_unlit_surfaces) << "render.json comes first: " << model.index();
    }
}

// In every form, baked and instanced, opaque, partly transparent and a pane.
TEST(World, RaysWithAnEndAtTheCameraPassWhatIsHiddenFromIt) {
    MaterialDesc opaque = diffuse(Rgb(0.5f));
    MaterialDesc veil = opaque;
    veil.alpha_mode = AlphaMode::Blend;
    veil.base_alpha = 0.999f;
    MaterialDesc pane;
    pane.transmission = 1.0f;
    pane.roughness = 0.0f;
    pane.metallic = 0.0f;
    Ray ray;
    ray.direction = {0, 0, -1};
    ray.t_max = 2.5f;
    for (MaterialDesc material : {opaque, veil, pane})
        for (const bool is_instance : {false, true}) {
            SceneDesc scene = empty_scene();
            material.visible_to_camera = false;
            PrimitiveDesc hidden = quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0});
            hidden.material = add_material(scene, material);
            const auto mesh = add_mesh(scene, {hidden});
            place(scene, mesh);
            if (is_instance) place(scene, mesh, translation({5, 0, 0}));
            add_object(scene, quad({0, 0, -3}, {1, 0, 0}, {0, 1, 0}), add_material(scene, opaque));
            const World world = compile(scene);
            EXPECT_TRUE(world.traits().hides_surfaces);
            for (const QueryForm form : {QueryForm::Single, QueryForm::Packet8, QueryForm::Packet16}) {
                const auto hit = [&](RayEnds ends) {
                    Ray far = ray;
                    far.t_max = 10.0f;
                    Hit found;
                    world.geometry().intersect({&far, 1}, {&found, 1}, Coherence::Coherent, form, ends);
                    return found;
                };
                EXPECT_FLOAT_EQ(hit(RayEnds::InScene).t, 2.0f);
                EXPECT_TRUE(world.materials().is_hidden_from_camera(hit(RayEnds::InScene)));
                EXPECT_FLOAT_EQ(hit(RayEnds::AtCamera).t, 3.0f);
                EXPECT_FALSE(world.materials().is_hidden_from_camera(hit(RayEnds::AtCamera)));
                const auto way = [&](RayEnds ends) {
                    std::uint8_t occluded = kFree;
                    world.geometry().occluded({&ray, 1}, {&occluded, 1}, form, ends);
                    return occluded;
                };
                EXPECT_EQ(way(RayEnds::InScene), material.transmission > 0.0f ? kPassesClear : kOccluded);
                EXPECT_EQ(way(RayEnds::AtCamera), kFree);
            }
            if (material.transmission > 0.0f) {
                EXPECT_LT(world.geometry().clear_transmittance(ray).r, 1.0f);
                EXPECT_EQ(world.geometry().clear_transmittance(ray, RayEnds::AtCamera), Rgb(1.0f));
            }
        }
}

// In every form, baked, instanced and mirrored, opaque, partly transparent and a pane.
TEST(World, RaysPassCulledBacksFromWhereTheEyeIsBehindThem) {
    MaterialDesc veil = diffuse(Rgb(0.5f));
    veil.alpha_mode = AlphaMode::Blend;
    veil.base_alpha = 0.999f;
    MaterialDesc pane;
    pane.transmission = 1.0f;
    pane.roughness = 0.0f;
    pane.metallic = 0.0f;
    for (const MaterialDesc& material : {diffuse(Rgb(0.5f)), veil, pane})
        for (const bool is_instance : {false, true})
            for (const float mirror : {1.0f, -1.0f}) {
                SceneDesc scene = empty_scene();
                scene.settings.cull_backfaces = true;
                PrimitiveDesc card = quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0});
                card.material = add_material(scene, material);
                const auto mesh = add_mesh(scene, {card});
                place(scene, mesh, scaling({mirror, 1.0f, 1.0f}));
                if (is_instance) place(scene, mesh, translation({5, 0, 0}));
                const World world = compile(scene);
                EXPECT_TRUE(world.traits().culls_backs);
                const Ray to_front{.direction = {0, 0, -1}};
                const Ray to_back{.origin = {0, 0, -4}, .direction = {0, 0, 1}, .t_max = 3.0f};
                for (const QueryForm form : {QueryForm::Single, QueryForm::Packet8, QueryForm::Packet16})
                    for (const RayEnds ends :
                         {RayEnds::InScene, RayEnds::AtCamera, RayEnds::ToCamera, RayEnds::FromLight}) {
                        const auto meets = [&](const Ray& ray) {
                            Hit found;
                            world.geometry().intersect({&ray, 1}, {&found, 1}, Coherence::Coherent, form, ends);
                            std::uint8_t occluded = kFree;
                            world.geometry().occluded({&ray, 1}, {&occluded, 1}, form, ends);
                            EXPECT_EQ(occluded != kFree, found.valid());
                            return found.valid();
                        };
                        EXPECT_EQ(meets(to_front), !follows_light(ends));
                        EXPECT_EQ(meets(to_back), follows_light(ends));
                    }
                if (material.transmission == 0.0f) continue;
                EXPECT_LT(world.geometry().clear_transmittance(to_front).r, 1.0f);
                EXPECT_EQ(world.geometry().clear_transmittance(to_back), Rgb(1.0f));
                EXPECT_LT(world.geometry().clear_transmittance(to_back, RayEnds::ToCamera).r, 1.0f);
            }
}

TEST(World, BacksAreSeenUnlessTheyAreToBeCulled) {
    SceneDesc scene = empty_scene();
    MaterialDesc glass;
    glass.override_model = DielectricDesc{.ior = 1.5f, .roughness = 0.0f};
    MaterialDesc both = diffuse(Rgb(0.5f));
    both.double_sided = true;
    for (const MaterialDesc& material : {diffuse(Rgb(0.5f)), glass, both})
        add_object(scene, sphere({0, 0, -5}, 1.0f, 4), add_material(scene, material));
    EXPECT_FALSE(compile(scene).traits().culls_backs);
    scene.settings.cull_backfaces = true;
    EXPECT_TRUE(compile(scene).traits().culls_backs);
    scene.materials[0] = glass;
    EXPECT_FALSE(compile(scene).traits().culls_backs) << "bodies, and what is double-sided";
}

// What is interpolated between equal numbers is that number, so that a mask at its cutoff has no pinholes.
TEST(World, AMaskAtItsCutoffIsWhole) {
    Random random(8);
    for (const float alpha : {0.3f, 0.7f, 0.45f}) {
        SceneDesc scene = empty_scene();
        MaterialDesc mask = diffuse(Rgb(0.5f));
        mask.alpha_mode = AlphaMode::Mask;
        mask.alpha_cutoff = alpha;
        PrimitiveDesc wall = quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0});
        wall.colors.assign(wall.positions.size(), Vec4f(1.0f, 1.0f, 1.0f, alpha));
        add_object(scene, wall, add_material(scene, mask));
        const World world = compile(std::move(scene));
        for (int i = 0; i < 1000; ++i) {
            const Vec2f at = random.next_2d();
            const Ray ray{.origin = {1.8f * at.x - 0.9f, 1.8f * at.y - 0.9f, 0.0f}, .direction = {0, 0, -1}};
            EXPECT_TRUE(intersect(world, ray).valid()) << alpha << ", " << at;
        }
    }
}

}  // namespace

}  // namespace etendue::test
