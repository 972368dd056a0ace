// The structures of accelerator/ against Embree: on scenes of the tree, on instances, and on what lets rays pass.
//
// ETENDUE_ACCELERATOR_SCENES=all takes all scenes of the tree in place of four, and ETENDUE_ACCELERATOR_RAYS says how
// many rays each of them gets in place of 3,000; `tools/test thorough` sets both.
#include "world/accelerated_scene.h"

#include "core/frame.h"
#include "core/position_error.h"
#include "loader/loader.h"
#include "world/test_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr AcceleratorKind kStructures[] = {AcceleratorKind::Bvh, AcceleratorKind::BvhMiddle, AcceleratorKind::BvhCounts,
                                           AcceleratorKind::KdTree, AcceleratorKind::Grid};

/// Makes rays from inside and outside of the scene, and from what those hit on to any direction, as paths go on.
std::vector<Ray> traced_rays(const World& world, std::size_t count) {
    Random random(9);
    const Bounds& bounds = world.geometry().bounds();
    std::vector<Ray> rays(count);
    for (std::size_t i = 0; i < count; ++i) {
        Ray& ray = rays[i];
        ray.alpha_key = static_cast<std::uint32_t>(random.next() * 0x1p24f) * 2654435761u;
        const Hit hit = i % 4 == 0 ? Hit{} : intersect(world, rays[i - 1]);
        ray.direction = random_direction(random);
        if (hit.valid()) {
            const SurfacePoint point = world.geometry().surface_point(hit);
            ray.origin = offset_origin(point.position, point.geometric_normal, point.clearance, ray.direction);
        } else {
            ray.origin =
                bounds.center() + random_direction(random) * (world.geometry().bounding_radius() * random.next());
        }
    }
    return rays;
}

/// Returns whether Embree gives the answer of `scene` to a ray that lies beside `ray` by no more than rounding can
/// tell, as it does where a ray passes an edge. It does not where the structure has lost a triangle, or lets rays
/// through.
bool is_answer_beside(const World& world, const AcceleratedScene& scene, const Ray& ray, bool occlusion) {
    constexpr int kRings = 4, kOfEachRing = 16;
    const Bounds& bounds = world.geometry().bounds();
    const float extent = max_abs(max_components(abs_components(bounds.min), abs_components(bounds.max)));
    const float error = kPositionError * std::max(extent, max_abs(ray.origin));
    const Frame frame = Frame::from_normal(ray.direction);
    const Hit ours = scene.closest(ray, RayEnds::InScene);
    const std::uint8_t our_occlusion = scene.occlusion(ray, RayEnds::InScene);
    for (int i = 0; i < kRings * kOfEachRing; ++i) {
        const float angle = 2.0f * kPi * static_cast<float>(i) / kOfEachRing;
        const float distance = error * static_cast<float>(1 + i / kOfEachRing) / kRings;
        Ray beside = ray;
        beside.origin += (frame.tangent * std::cos(angle) + frame.bitangent * std::sin(angle)) * distance;
        if (occlusion) {
            std::uint8_t answer = kFree;
            world.geometry().occluded({&beside, 1}, {&answer, 1});
            if (answer == our_occlusion) return true;
            continue;
        }
        const Hit theirs = intersect(world, beside);
        const bool is_same = theirs.instance == ours.instance && theirs.triangle == ours.triangle;
        if (theirs.valid() == ours.valid() && (is_same || std::abs(theirs.t - ours.t) <= error)) return true;
    }
    return false;
}

/// Counts the rays of which no ray beside them explains that `scene` and Embree differ.
std::size_t count_unexplained(const World& world, const AcceleratedScene& scene, std::span<const Ray> rays,
                              bool occlusion) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (scene.compare_with_embree(rays.subspan(i, 1), occlusion).differ > 0 &&
            !is_answer_beside(world, scene, rays[i], occlusion))
            ++count;
    return count;
}

/// Fails unless `kind` meets what Embree meets. In many rays, some pass an edge so closely that rounding decides.
void expect_agreement(const World& world, std::span<const Ray> rays, AcceleratorKind kind) {
    // The more rays, the flatter is the flattest angle at which one meets a surface, by which errors of single
    // precision grow: its cosine goes with one over the root of their number.
    const double grazing = std::sqrt(std::max(1.0, static_cast<double>(rays.size()) / 4000.0));
    const auto scene = world.geometry().accelerate(kind);
    for (const bool occlusion : {false, true}) {
        SCOPED_TRACE(std::string(accelerator_name(kind)) + (occlusion ? ", occlusion" : ", nearest"));
        const HitAgreement agreement = scene->compare_with_embree(rays, occlusion);
        EXPECT_LE(agreement.differ, rays.size() / 20'000);
        if (agreement.differ > 0) {
            EXPECT_EQ(count_unexplained(world, *scene, rays, occlusion), 0u);
        }
        EXPECT_LE(agreement.ties, rays.size() / 50);
        EXPECT_LT(agreement.largest_error, 2.0 * static_cast<double>(kPositionError) * grazing);
    }
}

const std::string kScenesOfTheTree = std::string(ETENDUE_SOURCE_DIR) + "/scenes/";

/// Returns the scenes that are asked for.
std::vector<std::string> scenes_to_compare() {
    const char* const asked = std::getenv("ETENDUE_ACCELERATOR_SCENES");
    if (asked == nullptr || std::string_view(asked) != "all")
        return {"cornell-box", "furnace", "caustic-prism", "diamond"};
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(kScenesOfTheTree))
        if (std::filesystem::exists(entry.path() / "scene.gltf")) names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

/// Returns how many rays each scene gets.
std::size_t rays_to_compare() {
    const char* const asked = std::getenv("ETENDUE_ACCELERATOR_RAYS");
    return asked == nullptr ? 3000 : static_cast<std::size_t>(std::clamp(std::atoi(asked), 1, 100'000'000));
}

/// Returns so many of `rays` that brute force makes no more than 10⁹ tests of a triangle, and none if they are few.
std::span<const Ray> rays_for_brute_force(const World& world, std::span<const Ray> rays) {
    if (rays.size() <= 3000) return {};
    RayWork work;
    const auto scene = world.geometry().accelerate(AcceleratorKind::BruteForce);
    (void)scene->closest(Ray{}, RayEnds::InScene, work);
    return rays.first(std::min<std::size_t>(rays.size(), 1'000'000'000 / std::max<std::uint64_t>(1, work.triangles)));
}

class AcceleratedSceneOfTheTree : public testing::TestWithParam<std::string> {};

TEST_P(AcceleratedSceneOfTheTree, IsMetWhereEmbreeMeetsIt) {
    const World world = compile(load_scene(kScenesOfTheTree + GetParam()).scene);
    const std::vector<Ray> rays = traced_rays(world, rays_to_compare());
    std::span<const Ray> of_brute_force;
    try {
        of_brute_force = rays_for_brute_force(world, rays);
    } catch (const SceneError& error) {
        GTEST_SKIP() << GetParam() << ": " << error.what();
    }
    for (const AcceleratorKind kind : kStructures) expect_agreement(world, rays, kind);
    if (!of_brute_force.empty()) expect_agreement(world, of_brute_force, AcceleratorKind::BruteForce);
}

INSTANTIATE_TEST_SUITE_P(Scenes, AcceleratedSceneOfTheTree, testing::ValuesIn(scenes_to_compare()));

/// Makes instances, plain and mirrored, of surfaces of which some let rays pass.
SceneDesc passing_scene() {
    Random random(11);
    SceneDesc scene = empty_scene();
    MaterialDesc half = diffuse(Rgb(0.5f));
    half.alpha_mode = AlphaMode::Blend;
    half.base_alpha = 0.5f;
    MaterialDesc hidden = diffuse(Rgb(0.5f));
    hidden.visible_to_camera = false;
    const Handle<MaterialDesc> materials[] = {add_material(scene, diffuse(Rgb(0.5f))), add_material(scene, half),
                                              add_material(scene, hidden)};
    for (const Handle<MaterialDesc> material : materials) {
        PrimitiveDesc primitive = soup(random, 40, 0.4f);
        primitive.material = material;
        const Handle<MeshDesc> mesh = add_mesh(scene, {primitive});
        place(scene, mesh);
        place(scene, mesh, random_transform(random, true));
    }
    return scene;
}

TEST(AcceleratedScene, LetsPassWhatEmbreeLetsPass) {
    const World world = compile(passing_scene());
    const std::vector<Ray> rays = traced_rays(world, 4000);
    for (const AcceleratorKind kind : kStructures) expect_agreement(world, rays, kind);
    expect_agreement(world, rays, AcceleratorKind::BruteForce);
}

/// Fails unless a World that is asked through `kind` answers as one with Embree does.
void expect_the_same_answers(SceneDesc scene, AcceleratorKind kind, std::span<const Ray> rays, RayEnds ends) {
    SceneDesc other = scene;
    other.settings.accelerator = kind;
    const World embree = compile(std::move(scene));
    const World world = compile(std::move(other));
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    std::vector<std::uint8_t> free(rays.size()), expected_free(rays.size());
    embree.geometry().intersect(rays, expected, Coherence::Incoherent, QueryForm::Best, ends);
    world.geometry().intersect(rays, hits, Coherence::Incoherent, QueryForm::Best, ends);
    embree.geometry().occluded(rays, expected_free, QueryForm::Best, ends);
    world.geometry().occluded(rays, free, QueryForm::Best, ends);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE(testing::Message() << accelerator_name(kind) << ", ray " << i);
        ASSERT_EQ(hits[i].instance, expected[i].instance);
        ASSERT_EQ(hits[i].triangle, expected[i].triangle);
        ASSERT_NEAR(hits[i].t, expected[i].t, 1e-5f);
        ASSERT_NEAR(hits[i].u, expected[i].u, 1e-3f);
        ASSERT_EQ(free[i], expected_free[i]);
    }
}

TEST(AcceleratedScene, IsWhatAWorldIsAskedThroughIfTheSettingsSaySo) {
    const std::vector<Ray> rays = traced_rays(compile(passing_scene()), 500);
    for (const RayEnds ends : {RayEnds::InScene, RayEnds::AtCamera}) {
        expect_the_same_answers(passing_scene(), AcceleratorKind::Grid, rays, ends);
        expect_the_same_answers(passing_scene(), AcceleratorKind::BruteForce, rays, ends);
    }
}

TEST(AcceleratedScene, SaysThatShadowRaysPassPanes) {
    SceneDesc scene = empty_scene();
    MaterialDesc pane;
    pane.base_color = Rgb(1.0f);
    pane.transmission = 1.0f;
    pane.roughness = 0.0f;
    pane.metallic = 0.0f;
    add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, pane));
    add_object(scene, quad({0, 0, -2}, {0.5f, 0, 0}, {0, 1, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    const std::vector<Ray> rays{{.origin = {0.7f, 0, 0}, .direction = {0, 0, -1}},
                                {.origin = {0.2f, 0, 0}, .direction = {0, 0, -1}},
                                {.origin = {1.2f, 0, 0}, .direction = {0, 0, -1}}};
    const World world = compile(SceneDesc(scene));
    std::vector<std::uint8_t> embree(rays.size());
    world.geometry().occluded(rays, embree);
    ASSERT_EQ(embree, (std::vector<std::uint8_t>{kPassesClear, kOccluded, kFree}));
    for (const AcceleratorKind kind : kStructures) expect_the_same_answers(scene, kind, rays, RayEnds::InScene);
}

TEST(AcceleratedScene, RefusesWhatMoves) {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    scene.instances[0].motion = {translation({0, 0, 0}), translation({1, 0, 0})};
    scene.settings.accelerator = AcceleratorKind::KdTree;
    try {
        (void)compile(std::move(scene));
        FAIL() << "it is built over something that moves";
    } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what()).find("something moves"), std::string::npos) << error.what();
    }
}

TEST(AcceleratedScene, OfAnEmptyWorldIsMissed) {
    const World world = compile(empty_scene());
    for (const AcceleratorKind kind : kStructures)
        EXPECT_FALSE(world.geometry().accelerate(kind)->closest(Ray{}, RayEnds::InScene).valid());
}

}  // namespace

}  // namespace etendue::test
