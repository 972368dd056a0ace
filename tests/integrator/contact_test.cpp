// Surfaces in one place: bodies that touch, glass on a floor, lamps flush with what they hang from. Integrators that
// agree say nothing here, since all may lose or make light alike; what they are held against is known: lossless bodies
// do not show in a white environment, an opaque floor lets nothing through, and a lamp shines as it would a little in
// front of what it touches. Each is tried along the axes, at odd angles, and far from the origin.
#include "integrator/closed_form.h"
#include "integrator/closed_form_scene.h"
#include "integrator/form_factors.h"
#include "integrator/integrator.h"
#include "world/test_scene.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {
namespace {

/// Where a scene is put.
struct Placing {
    std::string name;
    Mat4f to_world;
};

std::vector<Placing> placings() {
    Mat4f turned;
    turned.setEulerAngles(Vec3f(0.37f, -1.13f, 0.71f));
    const auto moved = [&](const Vec3f& by) {
        Mat4f m = turned;
        for (int i = 0; i < 3; ++i) m[3][i] = by[i];
        return m;
    };
    return {{"at the origin", Mat4f()},
            {"turned", turned},
            {"turned, 10 m away", moved({6.0f, -5.0f, 7.0f})},
            {"turned, 1 km away", moved({530.0f, -610.0f, 590.0f})}};
}

constexpr float kGaps[] = {0.0f, 1e-7f, 1e-6f, 1e-5f, 1e-4f, 1e-3f, 1e-2f};

void look_placed(SceneDesc& scene, const Placing& placing, const Vec3f& eye, const Vec3f& direction,
                 float half_width = 1e-4f) {
    look(scene, transform_point(placing.to_world, eye), normalize(transform_vector(placing.to_world, direction)),
         half_width);
}

MaterialDesc touching_glass(float ior, const VolumeDesc& volume = {.closed = true}) {
    MaterialDesc m;
    m.override_model = DielectricDesc{ior, 0.0f, volume};
    return m;
}

std::vector<Rgb> placed_pixels(const SceneDesc& scene, const std::string& integrator, const PathLengths& lengths,
                               std::uint32_t spp) {
    return render_pixels(scene, *make_integrator(integrator, {.lengths = lengths}), SampleSequence::Sobol, spp, 1,
                         "Linear Rec.709 (sRGB)");
}

Rgb placed_mean(const SceneDesc& scene, const std::string& integrator, const PathLengths& lengths, std::uint32_t spp) {
    double sum[3] = {};
    const std::vector<Rgb> pixels = placed_pixels(scene, integrator, lengths, spp);
    for (const Rgb& pixel : pixels) {
        sum[0] += static_cast<double>(pixel.r);
        sum[1] += static_cast<double>(pixel.g);
        sum[2] += static_cast<double>(pixel.b);
    }
    const double count = static_cast<double>(pixels.size());
    return {static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count), static_cast<float>(sum[2] / count)};
}

const PathLengths kAllBounces{.max_depth = 200, .roulette_depth = 1000};

/// Every pixel of a white environment seen through lossless bodies is white.
void expect_white(SceneDesc scene, const Placing& placing, const std::string& what) {
    set_environment(scene);
    look_placed(scene, placing, {0.65f, 0.07f, 4.0f}, normalize(Vec3f(0.03f, 0.05f, -1.0f)), 0.45f);
    for (const char* integrator : {"naive", "path", "bdpt"})
        for (const Rgb& pixel : placed_pixels(scene, integrator, kAllBounces, 2))
            ASSERT_NEAR(pixel.g, 1.0f, 1e-3f) << what << ", " << placing.name << ", " << integrator;
}

std::string with_gap(const std::string& what, float gap) {
    return what + ", " + std::to_string(gap * 1e6f) + " micrometres apart";
}

TEST(Contact, LosslessSlabsThatTouchDoNotShow) {
    for (const Placing& placing : placings())
        for (const float gap : kGaps)
            for (const float second_ior : {1.5f, 1.3f}) {
                SceneDesc scene;
                add(scene, box({-1.0f, -1.0f, -0.3f}, {1.0f, 1.0f, 0.0f}), touching_glass(1.5f), placing.to_world);
                // Wider than the other, so that part of its face touches nothing.
                add(scene, box({-1.5f, -1.2f, gap}, {1.5f, 1.2f, 0.4f}), touching_glass(second_ior), placing.to_world);
                expect_white(scene, placing, with_gap("two slabs", gap));
            }
}

TEST(Contact, AStackOfThreeLosslessSlabsDoesNotShow) {
    for (const Placing& placing : placings()) {
        SceneDesc scene;
        add(scene, box({-1.0f, -1.0f, -0.5f}, {1.0f, 1.0f, -0.2f}), touching_glass(1.5f), placing.to_world);
        add(scene, box({-1.0f, -1.0f, -0.2f}, {1.0f, 1.0f, 0.1f}), touching_glass(1.3f), placing.to_world);
        add(scene, box({-0.4f, -0.4f, 0.1f}, {0.4f, 0.4f, 0.6f}), touching_glass(1.7f), placing.to_world);
        expect_white(scene, placing, "a stack");
    }
}

/// Returns both as one mesh.
PrimitiveDesc joined(PrimitiveDesc mesh, const PrimitiveDesc& other) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
    return mesh;
}

TEST(Contact, LosslessSlabsOfOneMeshThatTouchDoNotShow) {
    for (const Placing& placing : placings()) {
        SceneDesc scene;
        add(scene,
            joined(box({-1.0f, -1.0f, -0.3f}, {1.0f, 1.0f, 0.0f}), box({-0.7f, -0.6f, 0.0f}, {0.9f, 1.2f, 0.4f})),
            touching_glass(1.5f), placing.to_world);
        expect_white(scene, placing, "one mesh");
    }
}

// The two faces of a window do not touch, however large the mesh is that it belongs to.
TEST(Contact, AWindowOfAWholeTownIsSeen) {
    const PrimitiveDesc window = box({-1.0f, -1.0f, -0.006f}, {1.0f, 1.0f, 0.0f});
    const MaterialDesc glass =
        touching_glass(1.5f, {.closed = true, .attenuation_color = Rgb(0.5f), .attenuation_distance = 0.006f});
    const auto seen = [&](const PrimitiveDesc& mesh) {
        SceneDesc scene;
        set_environment(scene);
        add(scene, mesh, glass);
        look(scene, {0.0f, 0.0f, 2.0f}, {0.0f, 0.0f, -1.0f}, 0.3f);
        return placed_mean(scene, "path", kAllBounces, 16).g;
    };
    const float alone = seen(window);
    EXPECT_LT(alone, 0.6f);
    EXPECT_NEAR(seen(joined(window, box({5000.0f, 0.0f, 0.0f}, {5001.0f, 1.0f, 1.0f}))), alone, 0.02f);
}

TEST(Contact, ALosslessCubeOnAWhiteTableDoesNotShow) {
    for (const Placing& placing : placings()) {
        SceneDesc scene;
        set_environment(scene);
        add(scene, box({-2.0f, -2.0f, -0.3f}, {2.0f, 2.0f, 0.0f}), diffuse(1.0f), placing.to_world);
        add(scene, box({-0.3f, -0.3f, 0.0f}, {0.3f, 0.3f, 0.5f}), touching_glass(1.5f), placing.to_world);
        look_placed(scene, placing, {0.13f, 0.07f, 4.0f}, normalize(Vec3f(0.03f, 0.05f, -1.0f)), 0.45f);
        // Light that is caught in the cube for long ends by roulette.
        for (const char* integrator : {"naive", "path", "bdpt"})
            EXPECT_NEAR(placed_mean(scene, integrator, {.max_depth = 1000, .roulette_depth = 1000}, 16).g, 1.0f, 5e-3f)
                << placing.name << ", " << integrator;
    }
}

/// A drink of which a share of the light passes, in a vessel that it fills.
SceneDesc filled_vessel(const Placing& placing, float overlap) {
    SceneDesc scene;
    set_environment(scene);
    add(scene, sphere({0.0f, 0.0f, 0.0f}, 1.0f, 3, Facing::Outwards), touching_glass(1.5f), placing.to_world);
    // The glass ends where its inner surface is; what fills that goes before.
    PrimitiveDesc hollow = sphere({0.0f, 0.0f, 0.0f}, 0.8f, 3, Facing::Inwards);
    PrimitiveDesc outside = sphere({0.0f, 0.0f, 0.0f}, 1.0f, 3, Facing::Outwards);
    const auto first = static_cast<std::uint32_t>(outside.positions.size());
    outside.positions.insert(outside.positions.end(), hollow.positions.begin(), hollow.positions.end());
    for (const auto& [a, b, c] : hollow.triangles) outside.triangles.push_back({a + first, b + first, c + first});
    outside.material = scene.meshes.back().primitives.front().material;
    scene.meshes.back().primitives.front() = outside;
    const VolumeDesc drink{
        .closed = true, .attenuation_color = {0.2f, 0.5f, 1.0f}, .attenuation_distance = 0.8f, .priority = 0};
    add(scene, sphere({0.0f, 0.0f, 0.0f}, 0.8f + overlap, 3, Facing::Outwards), touching_glass(1.33f, drink),
        placing.to_world);
    look_placed(scene, placing, {0.0f, 0.0f, 4.0f}, {0.0f, 0.0f, -1.0f}, 0.5f);
    return scene;
}

TEST(Contact, ADrinkThatFillsItsVesselIsSeenAsOneThatOverlapsIt) {
    const Rgb expected = placed_mean(filled_vessel(placings().front(), 1e-3f), "path", kAllBounces, 16);
    for (const Placing& placing : placings()) {
        for (const char* integrator : {"naive", "path", "bdpt"}) {
            const Rgb seen = placed_mean(filled_vessel(placing, 0.0f), integrator, kAllBounces, 16);
            const std::string where = placing.name + ", " + integrator;
            EXPECT_NEAR(seen.r, expected.r, 0.03f * expected.r) << where;
            EXPECT_NEAR(seen.g, expected.g, 0.03f * expected.g) << where;
            EXPECT_NEAR(seen.b, 1.0f, 5e-3f) << where;
        }
    }
}

// What is seen is reflected by the glass: by its upper face alone, or by both where there is air below it.
TEST(Contact, NoLightPassesAFloorThatGlassStandsOn) {
    constexpr float kOneFace = 0.04f;
    constexpr float kBothFaces = 2.0f * kOneFace / (1.0f + kOneFace);
    for (const Placing& placing : placings())
        for (const float gap : kGaps) {
            SceneDesc scene;
            set_environment(scene);
            add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 8.0f), diffuse(0.0f), placing.to_world);
            add(scene, box({-1.0f, gap, -1.0f}, {1.0f, 0.6f, 1.0f}), touching_glass(1.5f), placing.to_world);
            look_placed(scene, placing, {0.05f, 2.0f, 0.07f}, {0.0f, -1.0f, 0.0f}, 0.3f);
            for (const Rgb& pixel : placed_pixels(scene, "whitted", kAllBounces, 1)) {
                const bool is_near = std::abs(pixel.g - kOneFace) < std::abs(pixel.g - kBothFaces);
                ASSERT_NEAR(pixel.g, is_near ? kOneFace : kBothFaces, 2e-3f)
                    << with_gap(placing.name, gap) << ", whitted";
                if (gap == 0.0f) {
                    ASSERT_TRUE(is_near) << placing.name;
                }
                if (gap >= 1e-3f && placing.name != "turned, 1 km away") {
                    ASSERT_FALSE(is_near) << placing.name;
                }
            }
            // Five standard deviations of 4,096 samples of which 4 or 8 in a hundred find the environment.
            constexpr float kNoise = 0.021f;
            for (const char* integrator : {"naive", "path", "bdpt"}) {
                const float seen = placed_mean(scene, integrator, kAllBounces, 16).g;
                EXPECT_GT(seen, kOneFace - kNoise) << with_gap(placing.name, gap) << ", " << integrator;
                EXPECT_LT(seen, kBothFaces + kNoise) << with_gap(placing.name, gap) << ", " << integrator;
            }
        }
}

/// A smooth thin sheet that lets half of the light through.
MaterialDesc tinted_sheet() {
    MaterialDesc sheet;
    sheet.base_color = Rgb(0.5f);
    sheet.metallic = 0.0f;
    sheet.roughness = 0.0f;
    sheet.transmission = 1.0f;
    return sheet;
}

/// A square at y = 0 of `cells` × `cells` pairs of triangles.
PrimitiveDesc grid_facing_up(float size, int cells) {
    PrimitiveDesc grid;
    const auto columns = static_cast<std::uint32_t>(cells + 1);
    for (int z = 0; z <= cells; ++z)
        for (int x = 0; x <= cells; ++x) {
            const float step = size / static_cast<float>(cells);
            grid.positions.emplace_back(static_cast<float>(x) * step - size / 2, 0.0f,
                                        static_cast<float>(z) * step - size / 2);
        }
    for (std::uint32_t z = 0; z + 1 < columns; ++z)
        for (std::uint32_t x = 0; x + 1 < columns; ++x) {
            const std::uint32_t first = z * columns + x;
            grid.triangles.push_back({first, first + columns, first + 1});
            grid.triangles.push_back({first + 1, first + columns, first + columns + 1});
        }
    return grid;
}

TEST(Contact, ThinSheetsInOnePlaceAreAsManyAsThereAre) {
    const MaterialDesc sheet = tinted_sheet();
    for (const Placing& placing : placings()) {
        const auto seen_through = [&](float gap, int sheets) {
            SceneDesc scene;
            set_environment(scene);
            for (int i = 0; i < sheets; ++i)
                add(scene, quad_facing_up({0.0f, gap * static_cast<float>(i), 0.0f}, 3.0f), sheet, placing.to_world);
            look_placed(scene, placing, {0.0f, 2.0f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.3f);
            return placed_mean(scene, "whitted", kAllBounces, 1).g;
        };
        for (const int sheets : {1, 2, 3})
            EXPECT_NEAR(seen_through(0.0f, sheets), seen_through(0.1f, sheets), 2e-3f)
                << placing.name << ", " << sheets;
    }
}

// Instances of one mesh, small enough to be copied and large enough to be shared.
TEST(Contact, InstancesOfOneSheetInOnePlaceAreAsManyAsThereAre) {
    const MaterialDesc sheet = tinted_sheet();
    for (const int cells : {1, 40})
        for (const Placing& placing : placings()) {
            const auto seen_through = [&](float gap) {
                SceneDesc scene;
                set_environment(scene);
                add(scene, grid_facing_up(3.0f, cells), sheet, placing.to_world);
                InstanceDesc second = scene.instances.back();
                second.to_world = translation({0.0f, gap, 0.0f}) * placing.to_world;
                scene.instances.push_back(second);
                look_placed(scene, placing, {0.01f, 2.0f, 0.02f}, {0.0f, -1.0f, 0.0f}, 0.3f);
                return placed_mean(scene, "whitted", kAllBounces, 1).g;
            };
            EXPECT_NEAR(seen_through(0.0f), seen_through(0.1f), 2e-3f) << placing.name << ", " << cells;
        }
}

/// Makes a white wall in the plane z = `plane` and a tinted sheet on it; either of them may be the first of the file.
SceneDesc sheet_on_a_wall(float plane, bool sheet_is_first, float gap) {
    SceneDesc scene;
    set_environment(scene);
    const PrimitiveDesc wall = quad({0, 0, plane}, {2, 0, 0}, {0, 2, 0});
    const PrimitiveDesc sheet = quad({0, 0, plane + gap}, {2, 0, 0}, {0, 2, 0});
    const MaterialDesc white = diffuse(1.0f);
    if (sheet_is_first) add(scene, sheet, tinted_sheet());
    add(scene, wall, white);
    if (!sheet_is_first) add(scene, sheet, tinted_sheet());
    look(scene, {0.3f, 0.2f, plane + 3.0f}, normalize(Vec3f(-0.1f, -0.05f, -1.0f)), 0.1f);
    return scene;
}

// Coordinates of zero have no rounding, but distances along rays have.
TEST(Contact, ASheetOnAWallInAPlaneThroughZeroIsSeen) {
    const PathLengths lengths{.max_depth = 40};
    const float expected = placed_mean(sheet_on_a_wall(0.0f, true, 0.1f), "path", lengths, 256).g;
    for (const char* integrator : {"naive", "path", "bdpt"})
        for (const float plane : {0.0f, 1e-3f, 0.3f, 4.0f})
            for (const float gap : {0.0f, 1e-7f, 1e-6f})
                for (const bool sheet_is_first : {false, true})
                    EXPECT_NEAR(placed_mean(sheet_on_a_wall(plane, sheet_is_first, gap), integrator, lengths, 16).g,
                                expected, 0.02f)
                        << integrator << ", plane " << plane << ", " << with_gap("", gap) << sheet_is_first;
}

/// Makes a lamp on a sheet that transmits, in the plane z = `plane`, between two white walls.
SceneDesc lamp_on_a_sheet(float plane, bool sheet_is_first, float roughness) {
    SceneDesc scene;
    MaterialDesc sheet = tinted_sheet();
    sheet.base_color = Rgb(1.0f);
    sheet.roughness = roughness;
    const auto add_sheet = [&] { add(scene, quad({0, 0, plane}, {2, 0, 0}, {0, 2, 0}), sheet); };
    if (sheet_is_first) add_sheet();
    MaterialDesc lamp = diffuse(0.0f);
    lamp.emissive = Rgb(1.0f);
    lamp.emissive_strength = 5.0f;
    add(scene, quad({0, 0, plane}, {0.5f, 0, 0}, {0, 0.5f, 0}), lamp);
    if (!sheet_is_first) add_sheet();
    add(scene, quad({0, 0, plane - 1.0f}, {2, 0, 0}, {0, 2, 0}), diffuse(0.8f));
    add(scene, quad({0, 0, plane + 1.5f}, {2, 0, 0}, {0, -2, 0}), diffuse(0.8f));
    look(scene, {0.3f, 0.9f, plane + 1.4f}, normalize(Vec3f(0.1f, -0.05f, -1.0f)), 0.2f);
    return scene;
}

TEST(Contact, ALampOnASheetInAPlaneThroughZeroShinesBeforeIt) {
    const PathLengths lengths{.max_depth = 12};
    for (const float roughness : {0.0f, 0.3f}) {
        const float expected = placed_mean(lamp_on_a_sheet(3.7f, true, roughness), "path", lengths, 256).g;
        for (const bool sheet_is_first : {false, true})
            for (const char* integrator : {"path", "bdpt"})
                EXPECT_NEAR(placed_mean(lamp_on_a_sheet(0.0f, sheet_is_first, roughness), integrator, lengths, 64).g,
                            expected, 0.03f * expected)
                    << integrator << ", roughness " << roughness << ", " << sheet_is_first;
    }
}

/// A grey floor below a ceiling with a lamp in it, seen past the ceiling.
SceneDesc under_a_ceiling(const Placing& placing) {
    SceneDesc scene;
    add(scene, quad_facing_up({0.0f, 0.0f, 0.0f}, 4.0f), diffuse(kAlbedo), placing.to_world);
    look_placed(scene, placing, {1.0f, 0.7f, 0.0f}, {-1.0f, -0.7f, 0.0f}, 1e-3f);
    return scene;
}

constexpr PathLengths kDirectLight{.max_depth = 2};

void expect_floor_radiance(const SceneDesc& scene, double expected, const std::vector<std::string>& integrators,
                           const std::string& where) {
    for (const std::string& integrator : integrators) {
        const double seen = static_cast<double>(placed_mean(scene, integrator, kDirectLight, 64).g);
        EXPECT_NEAR(seen, expected, (integrator == "naive" ? 0.04 : 0.01) * expected) << where << ", " << integrator;
    }
}

void add_lamp_facing_down(SceneDesc& scene, const Placing& placing, float radiance) {
    add(scene, quad_facing_down({0.0f, 1.0f, 0.0f}, 1.0f), emitter(radiance), placing.to_world);
}

/// Radiance of the floor under a lamp of radiance 1 alone.
double radiance_under_a_lamp(const Placing& placing) {
    SceneDesc alone = under_a_ceiling(placing);
    add_lamp_facing_down(alone, placing, 1.0f);
    return static_cast<double>(placed_mean(alone, "path", kDirectLight, 256).g);
}

TEST(Contact, APanelFlushWithTheCeilingShines) {
    for (const Placing& placing : placings()) {
        const double expected = radiance_under_a_lamp(placing);
        for (const bool ceiling_first : {true, false}) {
            SceneDesc scene = under_a_ceiling(placing);
            const auto add_ceiling = [&] {
                add(scene, quad_facing_down({0.1f, 1.0f, 0.1f}, 3.0f), diffuse(0.5f), placing.to_world);
            };
            if (ceiling_first) add_ceiling();
            add_lamp_facing_down(scene, placing, 1.0f);
            if (!ceiling_first) add_ceiling();
            expect_floor_radiance(scene, expected, kFindDirectLight, placing.name);
        }
    }
}

TEST(Contact, OfTwoLampsInOnePlaceTheFirstShines) {
    for (const Placing& placing : placings()) {
        const double expected = radiance_under_a_lamp(placing);
        SceneDesc scene = under_a_ceiling(placing);
        add_lamp_facing_down(scene, placing, 1.0f);
        add_lamp_facing_down(scene, placing, 7.0f);
        expect_floor_radiance(scene, expected, kFindDirectLight, placing.name);
    }
}

TEST(Contact, LampsBackToBackShineEachToItsSide) {
    for (const Placing& placing : placings()) {
        const double expected = radiance_under_a_lamp(placing);
        SceneDesc scene = under_a_ceiling(placing);
        add(scene, quad_facing_up({0.0f, 1.0f, 0.0f}, 1.0f), emitter(7.0f), placing.to_world);
        add_lamp_facing_down(scene, placing, 1.0f);
        expect_floor_radiance(scene, expected, kFindDirectLight, placing.name);
    }
}

TEST(Contact, LampsAtAPointInASurfaceShineBeforeIt) {
    MaterialDesc pane;
    pane.metallic = 0.0f;
    pane.roughness = 0.4f;
    pane.transmission = 1.0f;
    for (const Placing& placing : placings())
        for (const MaterialDesc& ceiling : {diffuse(0.5f), pane, touching_glass(1.5f)})
            for (const LightType type : {LightType::Point, LightType::Spot}) {
                SceneDesc scene = under_a_ceiling(placing);
                const bool is_body = std::holds_alternative<DielectricDesc>(ceiling.override_model);
                add(scene,
                    is_body ? box({-1.0f, 1.0f, -1.0f}, {1.0f, 1.3f, 1.0f})
                            : quad_facing_down({0.1f, 1.0f, 0.1f}, 3.0f),
                    ceiling, placing.to_world);
                add_light(scene, type, 2.0f, transform_point(placing.to_world, {0.0f, 1.0f, 0.0f}),
                          normalize(transform_vector(placing.to_world, {0.0f, -1.0f, 0.0f})));
                expect_floor_radiance(scene, kRho * std::numbers::inv_pi * 2.0, kFindDeltaLights, placing.name);
            }
}

// Light paths, too, start before the surface.
TEST(Contact, LightPathsLeaveALampInACeiling) {
    for (const Placing& placing : placings()) {
        const auto lit_floor = [&](const std::string& integrator) {
            SceneDesc scene = under_a_ceiling(placing);
            scene.cameras.clear();
            look_placed(scene, placing, {0.0f, 0.9f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.5f);
            add(scene, quad_facing_down({0.1f, 1.0f, 0.1f}, 3.0f), diffuse(0.5f), placing.to_world);
            add_light(scene, LightType::Spot, 2.0f, transform_point(placing.to_world, {0.0f, 1.0f, 0.0f}),
                      normalize(transform_vector(placing.to_world, {0.0f, -1.0f, 0.0f})));
            return placed_mean(scene, integrator, kDirectLight, 256).g;
        };
        const float expected = lit_floor("path");
        EXPECT_GT(expected, 0.18f);
        EXPECT_NEAR(lit_floor("light"), expected, 0.02f * expected) << placing.name;
        EXPECT_NEAR(lit_floor("bdpt"), expected, 0.02f * expected) << placing.name;
    }
}

// A panel in one place with other surfaces lights the floor as it does alone, for light paths that start on it, too.
TEST(Contact, LightPathsLeavePanelsInOnePlace) {
    for (const Placing& placing : placings()) {
        const auto lit_floor = [&](const std::string& integrator, const std::function<void(SceneDesc&)>& add_more) {
            SceneDesc scene = under_a_ceiling(placing);
            scene.cameras.clear();
            look_placed(scene, placing, {0.0f, 0.9f, 0.0f}, {0.0f, -1.0f, 0.0f}, 0.5f);
            add_lamp_facing_down(scene, placing, 1.0f);
            add_more(scene);
            return placed_mean(scene, integrator, kDirectLight, 1024).g;
        };
        const float expected = lit_floor("path", [](SceneDesc&) {});
        const auto ceiling = [&](SceneDesc& scene) {
            add(scene, quad_facing_down({0.1f, 1.0f, 0.1f}, 3.0f), diffuse(0.5f), placing.to_world);
        };
        const auto same_lamp = [&](SceneDesc& scene) { add_lamp_facing_down(scene, placing, 7.0f); };
        const auto back = [&](SceneDesc& scene) {
            add(scene, quad_facing_up({0.0f, 1.0f, 0.0f}, 1.0f), emitter(7.0f), placing.to_world);
        };
        for (const std::function<void(SceneDesc&)>& more :
             {std::function<void(SceneDesc&)>(ceiling), std::function<void(SceneDesc&)>(same_lamp),
              std::function<void(SceneDesc&)>(back)})
            EXPECT_NEAR(lit_floor("light", more), expected, 0.02f * expected) << placing.name;
    }
}

// A camera on a wall looks from before it, or through it from behind: nothing it stands in is in its way.
TEST(Contact, ACameraInASurfaceLooksFromBeforeIt) {
    for (const Placing& placing : placings())
        for (const float side : {1.0f, -1.0f})
            for (const float lens_radius : {0.0f, 0.05f}) {
                SceneDesc scene;
                set_environment(scene);
                add(scene, parallelogram({0.1f, 0.05f, 0.0f}, {3.0f, 0.0f, 0.0f}, {0.0f, 3.0f, 0.0f}), diffuse(0.0f),
                    placing.to_world);
                look_placed(scene, placing, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, side}, 0.2f);
                scene.cameras[0].lens_radius = lens_radius;
                for (const char* integrator : {"path", "bdpt"})
                    for (const Rgb& pixel : placed_pixels(scene, integrator, kDirectLight, 2))
                        ASSERT_NEAR(pixel.g, 1.0f, 1e-3f) << placing.name << ", " << integrator << ", " << side;
            }
}

}  // namespace
}  // namespace etendue::test
