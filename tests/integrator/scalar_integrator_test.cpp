// What the base of integrators that trace one sample after the other does for them.
#include "integrator/scalar_integrator.h"

#include "integrator/render_tile.h"
#include "world/test_scene.h"

#include <functional>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

using Li = std::function<EyeLight(const World& world, const EyeSample& sample, const Hit& hit)>;

class AnyScalar final : public ScalarIntegrator {
  public:
    explicit AnyScalar(Li li) : ScalarIntegrator({}, Shows::NoLight), li_(std::move(li)) {}

    [[nodiscard]] EyeLight li(const World& world, const EyeSample& sample, const Hit& hit) const override {
        return li_(world, sample, hit);
    }

  private:
    Li li_;
};

World wall() {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({0, 0, -2}, {5, 0, 0}, {0, 5, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    return compile(std::move(scene));
}

TEST(ScalarIntegrator, CountsRaysByKind) {
    const TileResult result =
        render_tile(wall(), AnyScalar([](const World& world, const EyeSample& sample, const Hit& hit) {
                        EyePath path = begin_at_eye(world, sample);
                        EXPECT_EQ(nearest_hit(world, path).t, hit.t) << "the camera ray is traced before";
                        path.rays = 2;
                        EXPECT_EQ(nearest_hit(world, path).t, hit.t);
                        for (int i = 0; i < 3; ++i)
                            EXPECT_EQ(visibility(world, sample.ray, sample.tracer), Rgb(0.0f)) << "the wall";
                        return EyeLight{};
                    }),
                    2);
    const RaysByKind& rays = result.counters.rays;
    EXPECT_EQ(rays[RayKind::Primary], result.counters.samples);
    EXPECT_EQ(rays[RayKind::Bounce], result.counters.samples);
    EXPECT_EQ(rays[RayKind::Shadow], 3 * result.counters.samples);
    EXPECT_EQ(rays.total(), 5 * result.counters.samples);
}

TEST(ScalarIntegrator, AddsAllLightAndAlpha) {
    const TileResult result = render_tile(wall(), AnyScalar([](const World&, const EyeSample&, const Hit&) {
                                              return EyeLight{Rgb(1.0f), Rgb(2.0f), 0.25f};
                                          }),
                                          2);
    EXPECT_EQ(result.mean, Rgb(3.0f));
    EXPECT_EQ(result.alpha, 0.25);
}

TEST(ScalarIntegrator, DropsWhatIsNoNumber) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const TileResult result =
        render_tile(wall(), AnyScalar([](const World&, const EyeSample& sample, const Hit&) {
                        return EyeLight{Rgb(sample.numbers.key.index == 1 ? kNaN : 1.0f), Rgb(), 1.0f};
                    }),
                    4);
    EXPECT_EQ(result.mean, Rgb(1.0f)) << "of the samples that were kept";
    ASSERT_EQ(4 * result.counters.dropped, result.counters.samples);
    EXPECT_EQ(result.counters.first_dropped.front().sample, 1u);
}

}  // namespace

}  // namespace etendue::test
