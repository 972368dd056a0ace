// Layers of the surfaces that camera rays meet, and of what their samples cost and how far they vary.
#include "integrator/agreement_render.h"
#include "integrator/closed_form_scene.h"
#include "wave/aov/layered_render.h"
#include "world/test_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

const std::vector<std::string> kAll{"path", "light", "bdpt", "whitted", "direct", "naive", "normals", "albedo"};

std::shared_ptr<const AovSet> layers_of(std::vector<FirstHitValue> values, std::vector<FirstHitValue> nearest) {
    auto aovs = std::make_shared<AovSet>();
    for (const FirstHitValue value : values) aovs->layout.values += first_hit_entry(value).channels.size();
    for (const FirstHitValue value : nearest) aovs->layout.nearest += first_hit_entry(value).channels.size();
    aovs->values = std::move(values);
    aovs->nearest = std::move(nearest);
    return aovs;
}

/// A room with few samples.
AgreementCase small_room(const std::string& name, std::uint32_t spp) {
    AgreementCase room = agreement_case(name);
    room.spp = spp;
    return room;
}

TEST(FirstHitTable, IsInTheOrderOfItsEnumeration) {
    for (std::size_t i = 0; i < first_hit_table().size(); ++i)
        EXPECT_EQ(static_cast<std::size_t>(first_hit_table()[i].value), i);
}

TEST(FirstHits, AreTheSameWhateverTheIntegrator) {
    const AgreementCase room = small_room("LampPlastic", 4);
    const World world = agreement_world(room);
    const auto aovs = layers_of({FirstHitValue::Normal, FirstHitValue::GeometricNormal, FirstHitValue::Albedo},
                                {FirstHitValue::Depth, FirstHitValue::Position, FirstHitValue::Uv,
                                 FirstHitValue::ObjectId, FirstHitValue::MaterialId});
    const RenderResult first = render_layers(world, "path", room, aovs, 1);
    for (const std::string& integrator : kAll) {
        const RenderResult other = render_layers(world, integrator, room, aovs, 1);
        EXPECT_EQ(other.film.resolve_values(0, aovs->layout.values), first.film.resolve_values(0, aovs->layout.values))
            << integrator;
        EXPECT_EQ(other.film.resolve_nearest(0, aovs->layout.nearest, 0.0f),
                  first.film.resolve_nearest(0, aovs->layout.nearest, 0.0f))
            << integrator;
    }
}

TEST(FirstHits, PositionsLieWhereTheirPixelsLook) {
    const AgreementCase room = small_room("LampDiffuse", 4);
    const World world = agreement_world(room);
    const auto aovs = layers_of({}, {FirstHitValue::Position, FirstHitValue::Depth, FirstHitValue::ObjectId});
    const Film film = render_layers(world, "path", room, aovs, 1).film;
    const std::vector<float> numbers = film.resolve_nearest(0, 5, -1.0f);
    std::size_t hits = 0;
    for (std::size_t p = 0; p < room.window.area(); ++p) {
        const float* const n = &numbers[5 * p];
        if (n[4] < 0.0f) continue;
        ++hits;
        const Vec3f position(n[0], n[1], n[2]);
        const Vec2f film_point = world.camera().connect(position, {0.5f, 0.5f}, 0.0f).film;
        const auto column = static_cast<float>(p % kAgreementWidth);
        const std::size_t line = p / kAgreementWidth;
        const auto row = static_cast<float>(line);
        // The box filter's samples lie within their pixel.
        EXPECT_NEAR(film_point.x * kAgreementWidth, column + 0.5f, 0.501f);
        EXPECT_NEAR(film_point.y * kAgreementHeight, row + 0.5f, 0.501f);
        EXPECT_NEAR(n[3], world.camera().depth(position, 0.0f), 1e-4f);
        EXPECT_GT(n[3], 0.0f);
        EXPECT_GE(n[4], 1.0f);
    }
    EXPECT_GT(hits, room.window.area() / 2);
}

TEST(FirstHits, NormalsFaceTheEyeAndAlbedosAreThoseOfTheMaterials) {
    const AgreementCase room = small_room("LampDiffuse", 4);
    const World world = agreement_world(room);
    const auto aovs =
        layers_of({FirstHitValue::GeometricNormal, FirstHitValue::AlbedoDiffuse, FirstHitValue::AlbedoSpecular},
                  {FirstHitValue::Position});
    const Film film = render_layers(world, "path", room, aovs, 1).film;
    const std::vector<float> means = film.resolve_values(0, 9);
    const std::vector<float> positions = film.resolve_nearest(0, 3, 0.0f);
    const std::vector<float> image = film.resolve();
    const Vec3f eye = world.camera().generate_ray({0.5f, 0.5f}, {0.5f, 0.5f}, 0.0f).origin;
    std::size_t inside = 0;
    std::size_t scattering = 0;
    for (std::size_t p = 0; p < room.window.area(); ++p) {
        const float* const m = &means[9 * p];
        const Vec3f normal(m[0], m[1], m[2]);
        if (length(normal) < 0.9999f) continue;  // edges between surfaces
        ++inside;
        const Vec3f position(positions[3 * p], positions[3 * p + 1], positions[3 * p + 2]);
        EXPECT_GT(dot(normal, eye - position), 0.0f);
        for (std::size_t c = 3; c < 6; ++c) EXPECT_LE(m[c], 1.0f + 1e-5f);
        scattering += m[4] > 0.1f ? 1 : 0;
        for (std::size_t c = 6; c < 9; ++c) EXPECT_EQ(m[c], 0.0f) << "diffuse surfaces have no specular albedo";
    }
    EXPECT_GT(inside, room.window.area() / 2);
    EXPECT_GT(scattering, room.window.area() / 2);
}

TEST(FirstHits, MistGrowsWithTheDistanceFromTheCamera) {
    AgreementCase room = small_room("LampDiffuse", 1);
    const Vec3f eye = agreement_world(room).camera().generate_ray({0.5f, 0.5f}, {0.5f, 0.5f}, 0.0f).origin;
    // Rays then begin at the near plane.
    room.make = [make = room.make](SceneDesc& scene) {
        make(scene);
        scene.cameras[0].clip.start = 0.2f;
    };
    const World world = agreement_world(room);
    for (const MistFalloff falloff : {MistFalloff::Quadratic, MistFalloff::Linear, MistFalloff::InverseQuadratic}) {
        const auto aovs = std::make_shared<AovSet>(*layers_of({FirstHitValue::Mist}, {FirstHitValue::Position}));
        aovs->mist = {.start = 2.5f, .depth = 1.0f, .falloff = falloff};
        const Film film = render_layers(world, "path", room, aovs, 1).film;
        // Sums begin where all is mist.
        const std::vector<float> mist = film.resolve_values(0, 1);
        const std::vector<float> positions = film.resolve_nearest(0, 3, 1e9f);
        std::size_t between = 0;
        for (std::size_t p = 0; p < room.window.area(); ++p) {
            const Vec3f position(positions[3 * p], positions[3 * p + 1], positions[3 * p + 2]);
            const float share = std::clamp((length(position - eye) - 2.5f) / 1.0f, 0.0f, 1.0f);
            const float expected = falloff == MistFalloff::Quadratic ? share * share
                                   : falloff == MistFalloff::Linear  ? share
                                                                     : std::sqrt(share);
            EXPECT_NEAR(1.0f + mist[p], expected, 2e-3f);
            between += share > 0.1f && share < 0.9f ? 1 : 0;
        }
        EXPECT_GT(between, 20u);
    }
}

// Interpolated normals change what light particles carry, and indices what radiance does: neither is of the albedo.
// Single samples of rough lobes weigh more than one; their means, of 512, do not.
TEST(FirstHits, NothingScattersMoreLightThanItGets) {
    for (const char* name : {"CoarseSmoothNormals", "SmoothGlass", "LampRoughGlass", "LampConductor", "LampPlastic"}) {
        const AgreementCase room = small_room(name, 128);
        const World world = agreement_world(room);
        const Film film = render_layers(world, "path", room, layers_of({FirstHitValue::Albedo}, {}), 1).film;
        float most = 0.0f;
        for (const float share : film.resolve_values(0, 3)) most = std::max(most, share);
        EXPECT_LE(most, 1.05f) << name;
        EXPECT_GT(most, 0.3f) << name;
    }
}

// What enters glass is scaled by its index, which is no loss: smooth glass gives back all that it gets, sample by
// sample. Rough glass does in the mean: of 3072 pixels with 16 samples of at most some two each, five deviations are
// below 0.02.
TEST(FirstHits, LosslessGlassHasAnAlbedoOfOne) {
    for (const float roughness : {0.0f, 0.3f}) {
        SceneDesc scene = empty_scene();
        scene.settings.film.width = kAgreementWidth;
        scene.settings.film.height = kAgreementHeight;
        MaterialDesc glass;
        glass.override_model = DielectricDesc{1.5f, roughness};
        add(scene, sphere({0, 0, -2}, 1.9f, 3, Facing::Outwards), glass);
        const World world = compile(std::move(scene));
        AgreementCase room{"Glass", {}};
        room.spp = 4;
        const std::vector<float> albedo =
            render_layers(world, "path", room, layers_of({FirstHitValue::Albedo}, {}), 1).film.resolve_values(0, 3);
        double mean = 0.0;
        for (const float share : albedo) {
            if (roughness == 0.0f) {
                EXPECT_NEAR(share, 1.0f, 1e-4f);
            }
            mean += static_cast<double>(share) / static_cast<double>(albedo.size());
        }
        EXPECT_NEAR(mean, 1.0, 0.02) << "roughness " << roughness;
    }
}

// Glass in water, which the camera is in, too: what the glass mirrors depends on both indices.
TEST(FirstHits, TheLayerAlbedoIsWhatTheIntegratorOfThatNameShows) {
    SceneDesc scene = empty_scene();
    scene.settings.film.width = kAgreementWidth;
    scene.settings.film.height = kAgreementHeight;
    MaterialDesc glass;
    glass.override_model = DielectricDesc{1.8f, 0.3f};
    MaterialDesc water;
    water.override_model = DielectricDesc{1.33f, 0.0f};
    add(scene, sphere({0, 0, -3}, 1.5f, 3, Facing::Outwards), glass);
    add(scene, sphere({0, 0, 0}, 9.0f, 3, Facing::Outwards), water);
    const World world = compile(std::move(scene));
    AgreementCase room{"GlassInWater", {}};
    room.spp = 4;
    const Film film = render_layers(world, "albedo", room, layers_of({FirstHitValue::Albedo}, {}), 1).film;
    const std::vector<float> layer = film.resolve_values(0, 3);
    const std::vector<float> image = film.resolve();
    for (std::size_t i = 0; i < layer.size(); ++i) EXPECT_NEAR(layer[i], image[i / 3 * 4 + i % 3], 1e-5f);
}

/// Returns the values in the middle pixel of a scene with a wall that faces the camera 2 m before it and is in
/// `places` while the shutter is open; `camera_way` is the camera's own.
std::vector<float> values_of_wall(std::span<const Vec3f> places, const Vec3f& camera_way,
                                  std::shared_ptr<const AovSet> aovs, const ClipDesc& clip = {}) {
    SceneDesc scene = empty_scene();
    scene.cameras.front().clip = clip;
    scene.settings.film.width = kAgreementWidth;
    scene.settings.film.height = kAgreementHeight;
    add_object(scene, quad({0, 0, -2}, {4, 0, 0}, {0, 4, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    const auto moved = [](const Vec3f& by) { return Mat4f(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, by.x, by.y, by.z, 1); };
    for (const Vec3f& place : places) scene.instances.back().motion.push_back(moved(place));
    if (length(camera_way) > 0.0f) scene.cameras.front().motion = {moved(camera_way * -0.5f), moved(camera_way * 0.5f)};
    const World world = compile(std::move(scene));
    AgreementCase room{"Wall", {}};
    room.spp = 16;
    const std::size_t count = aovs->layout.nearest;
    const Film film = render_layers(world, "path", room, std::move(aovs), 1).film;
    const std::vector<float> values = film.resolve_nearest(0, count, 99.0f);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(
                                             count * (kAgreementHeight / 2 * kAgreementWidth + kAgreementWidth / 2));
    return {middle, middle + static_cast<std::ptrdiff_t>(count)};
}

Vec2f motion_of_wall(const Vec3f& way, const Vec3f& camera_way) {
    std::vector<Vec3f> places;
    if (length(way) > 0.0f) places = {way * -0.5f, way * 0.5f};
    const std::vector<float> motion = values_of_wall(places, camera_way, layers_of({}, {FirstHitValue::Motion}));
    return {motion[0], motion[1]};
}

// A pixel at 1 m is as high and as wide as half the film there, tan(fov / 2), over half its rows.
TEST(FirstHits, MotionIsHowFarPixelsMoveWhileTheShutterIsOpen) {
    const SceneDesc scene = empty_scene();
    const float half_height = std::tan(0.5f * scene.cameras.front().yfov);
    const float pixels = 0.5f * kAgreementHeight / half_height / 2.0f;
    const float tolerance = 0.01f * pixels;
    const Vec2f right = motion_of_wall({0.4f, 0, 0}, Vec3f(0.0f));
    EXPECT_NEAR(right.x, 0.4f * pixels, tolerance);
    EXPECT_NEAR(right.y, 0.0f, tolerance);
    const Vec2f up = motion_of_wall({0, 0.2f, 0}, Vec3f(0.0f));
    EXPECT_NEAR(up.x, 0.0f, tolerance);
    EXPECT_NEAR(up.y, -0.2f * pixels, tolerance);
    const Vec2f camera = motion_of_wall(Vec3f(0.0f), {0.4f, 0, 0});
    EXPECT_NEAR(camera.x, -0.4f * pixels, tolerance);
    const Vec2f together = motion_of_wall({0.4f, 0, 0}, {0.4f, 0, 0});
    EXPECT_NEAR(together.x, 0.0f, tolerance);
    const Vec2f still = motion_of_wall(Vec3f(0.0f), Vec3f(0.0f));
    EXPECT_EQ(still.x, 0.0f);
    EXPECT_EQ(still.y, 0.0f);
}

// What the camera shows for a part of the shutter's time alone moves all the while: from 2.5 m to 1.5 m away it goes
// 0.4 m aside, of which the point in the middle has gone a share t.
TEST(FirstHits, MotionIsOfWhatTheCameraDoesNotShowAllTheTimeToo) {
    const float pixels = 0.5f * kAgreementHeight / std::tan(0.5f * empty_scene().cameras.front().yfov);
    const std::vector<Vec3f> places{Vec3f(-0.2f, 0, -0.5f), Vec3f(0.2f, 0, 0.5f)};
    const auto way = [&](float t) { return 0.4f * pixels * (t / 2.5f + (1.0f - t) / 1.5f); };
    const std::vector<float> motion =
        values_of_wall(places, Vec3f(0.0f), layers_of({}, {FirstHitValue::Motion}), {.start = 1.8f, .end = 2.2f});
    const float tolerance = 0.02f * pixels;
    EXPECT_GT(motion[0], way(0.7f) - tolerance);
    EXPECT_LT(motion[0], way(0.3f) + tolerance);
}

// Cycles gives (-4, -1, -8, -2) for a plane that goes 4 pixels to the right and 1 up until the frame, and twice as far
// in the next: what was before less what is, and what is less what comes.
TEST(FirstHits, VectorsAreThoseOfBlenderForWholeFrames) {
    const SceneDesc scene = empty_scene();
    const float pixels = 0.5f * kAgreementHeight / std::tan(0.5f * scene.cameras.front().yfov) / 2.0f;
    const std::vector<Vec3f> places{Vec3f(-4, -1, 0) * (0.25f / pixels), Vec3f(0.0f),
                                    Vec3f(8, 2, 0) * (0.25f / pixels)};
    auto aovs = std::make_shared<AovSet>(*layers_of({}, {FirstHitValue::Vector}));
    aovs->frames_of_shutter = 0.5f;
    const std::vector<float> found = values_of_wall(places, Vec3f(0.0f), aovs);
    const std::array<float, 4> expected{-4, -1, -8, -2};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i], 0.02f) << "channel " << i;
    for (const float number : values_of_wall({}, Vec3f(0.0f), aovs)) EXPECT_EQ(number, 0.0f);
}

TEST(RayCounts, AddUpToAllRays) {
    const AgreementCase room = small_room("LampPlastic", 4);
    const World world = agreement_world(room);
    auto aovs = std::make_shared<AovSet>();
    aovs->layout.has_ray_counts = true;
    for (const std::string& integrator : kAll) {
        const RenderResult result = render_layers(world, integrator, room, aovs, 1);
        double rays = 0.0;
        for (const float each : result.film.resolve_ray_counts()) rays += static_cast<double>(each);
        EXPECT_NEAR(rays * room.spp, static_cast<double>(result.counters.rays.total()), 1e-6 * rays * room.spp)
            << integrator;
    }
}

struct VarianceRun {
    std::string integrator;
    FilterShape filter;
};
void PrintTo(const VarianceRun& run, std::ostream* out) {
    *out << run.integrator;
}

class VarianceLayer : public testing::TestWithParam<VarianceRun> {};

// With independent samples the estimates have the variance over seeds as their mean. The tolerance is five times the
// deviation that was seen over sets of seeds. Weights of Mitchell's filter are of both signs.
TEST_P(VarianceLayer, IsTheVarianceOverSeeds) {
    constexpr std::uint32_t kSeeds = 64;
    const AgreementCase room = small_room("LampDiffuse", 16);
    const World world = agreement_world(room);
    const ThreadPool threads;
    const std::atomic<bool> stop{false};
    RenderOptions options = render_options(room);
    options.sequence = SampleSequence::Random;
    options.filter = PixelFilter(GetParam().filter);
    auto aovs = std::make_shared<AovSet>();
    aovs->layout.has_moments = true;
    options.aovs = aovs;
    std::vector<double> sums(3 * room.window.area(), 0.0);
    std::vector<double> squares(sums.size(), 0.0);
    double estimated = 0.0;
    for (options.seed = 0; options.seed < kSeeds; ++options.seed) {
        const auto integrator = make_integrator(GetParam().integrator, {.lengths = room.lengths});
        const Film film = render(world, *integrator, options, threads, stop, {}).film;
        const std::vector<float> image = film.resolve();
        for (std::size_t i = 0; i < sums.size(); ++i) {
            const auto value = static_cast<double>(image[i / 3 * 4 + i % 3]);
            sums[i] += value;
            squares[i] += value * value;
        }
        for (const float variance : film.resolve_variance()) estimated += static_cast<double>(variance) / kSeeds;
    }
    double seen = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) seen += (squares[i] - sums[i] * sums[i] / kSeeds) / (kSeeds - 1.0);
    EXPECT_NEAR(estimated / seen, 1.0, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Integrators, VarianceLayer,
                         testing::Values(VarianceRun{"path", FilterShape::Mitchell},
                                         VarianceRun{"path", FilterShape::BlackmanHarris},
                                         VarianceRun{"light", FilterShape::Box}, VarianceRun{"bdpt", FilterShape::Box}),
                         [](const auto& each) {
                             const bool is_wide = each.param.filter == FilterShape::BlackmanHarris;
                             return each.param.integrator + (is_wide ? "Wide" : "");
                         });

}  // namespace

}  // namespace etendue::test
