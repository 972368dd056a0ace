#include "integrator/bdpt/diffuse_connections.h"

#include "integrator/bdpt/connection_lanes.h"
#include "support/random.h"
#include "wave/subpath/diffuse_lanes.h"
#include "wave/subpath/path_vertex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr std::size_t kCount = kBlockLanes - 3;
constexpr Rgb kDiffuseAlbedo(0.7f, 0.5f, 0.3f);

/// Of a number that may be large; grazing directions, where roundings decide, are left out by the caller.
bool is_near(float value, float expected) {
    return std::abs(value - expected) <= 2e-3f * std::abs(expected) + 1e-30f;
}

bool is_near(const Rgb& value, const Rgb& expected) {
    return is_near(value.r, expected.r) && is_near(value.g, expected.g) && is_near(value.b, expected.b);
}

/// Holds a vertex on a diffuse surface, in the form that single connections use and in that of lanes.
struct BothEnds {
    PathVertex vertex;
    DiffuseEnd end;
};

class DiffuseConnectionsIn : public testing::TestWithParam<Heuristic> {
  protected:
    Vec3f vec() { return Vec3f(random_.next(), random_.next(), random_.next()) * 2.0f - Vec3f(1.0f); }
    /// Of any of `count` orders of magnitude, around 1.
    float any_magnitude(float count) { return std::pow(10.0f, (random_.next() - 0.5f) * count); }

    /// As subpaths make them.
    std::array<BothEnds, kCount> make_ends(TransportMode mode) {
        DiffuseLanes lanes;
        std::array<BothEnds, kCount> ends;
        std::array<DiffuseEnd*, kCount> places;
        for (std::size_t l = 0; l < kCount; ++l) {
            HitTriangle triangle{vec(), vec(), vec(), Vec3f(0.0f)};
            // Every other one is smooth: its normal leans away from that of the triangle.
            if (l % 2 != 0) triangle.shading_normal = normalize(cross(triangle.edge1, triangle.edge2)) + vec() * 0.3f;
            lanes.set_hit(l, triangle, {0.5f * random_.next(), 0.5f * random_.next()});
            lanes.wo.set(l, normalize(vec()));
            lanes.albedo.set(l, kDiffuseAlbedo);
            PathVertex& vertex = ends[l].vertex;
            vertex.throughput = {random_.next(), random_.next(), random_.next()};
            vertex.densities = {static_cast<double>(any_magnitude(6.0f)), static_cast<double>(any_magnitude(6.0f))};
            lanes.throughput.set(l, vertex.throughput);
        }
        lanes.set_up_points(kCount);
        lanes.orient(kCount, mode);
        for (std::size_t l = 0; l < kCount; ++l) {
            PathVertex& vertex = ends[l].vertex;
            vertex.position = lanes.position[l];
            vertex.wo = lanes.wo[l];
            vertex.geometric_normal = lanes.geometric_normal[l];
            vertex.clearance = lanes.clearance[l];
            vertex.surface.emplace(diffuse_, lanes.surface(l));
            lanes.end_fewer.set(
                l, static_cast<float>(vertex.densities.fewer(raised_, static_cast<double>(lanes.reverse_pdf[l]))));
            places[l] = &ends[l].end;
        }
        lanes.store_ends(places);
        return ends;
    }
    /// True if roundings may have put a direction on another side, or moved the factor of importance, which knows no
    /// bound.
    static bool is_grazing(const PathVertex& vertex, const Vec3f& w) {
        constexpr float kGrazing = 0.02f;
        const Scattering& surface = *vertex.surface;
        return std::min({std::abs(surface.wo_local().z), std::abs(dot(vertex.wo, surface.geometric_normal())),
                         std::abs(dot(w, surface.geometric_normal())), std::abs(dot(w, surface.normal()))}) < kGrazing;
    }
    static void expect_ray(const Ray& ray, const Ray& expected) {
        EXPECT_LT(length(ray.origin - expected.origin), 1e-5f);
        EXPECT_LT(length(ray.direction - expected.direction), 1e-4f);
        EXPECT_NEAR(ray.t_max, expected.t_max, 1e-4f * expected.t_max);
    }

    Random random_{47};
    Bsdf diffuse_ = Diffuse{kDiffuseAlbedo};
    Raised raised_{GetParam()};
    WeightRule rule_{raised_, true};
};

TEST_P(DiffuseConnectionsIn, JoinSubpathsAsOneByOne) {
    BetweenLanes lanes;
    int connected = 0;
    for (int block = 0; block < 200; ++block) {
        auto eyes = make_ends(TransportMode::Radiance);
        auto lights = make_ends(TransportMode::Importance);
        for (std::size_t l = 0; l < kCount; ++l) {
            const double merged = 0.1 * static_cast<double>(l % 5);
            eyes[l].vertex.densities.merge_a = static_cast<float>(merged);
            lights[l].vertex.is_after_delta = l % 2 == 0;
            lanes.eye.set(l, eyes[l].end);
            lanes.light.set(l, lights[l].end);
            lanes.merged.set(l, lights[l].vertex.is_after_delta ? static_cast<float>(merged) : 0.0f);
            lanes.scale.set(l, 1.0f + static_cast<float>(l % 3));
        }
        lanes.connect(kCount, rule_);
        for (std::size_t l = 0; l < kCount; ++l) {
            const PathVertex& eye = eyes[l].vertex;
            const PathVertex& light = lights[l].vertex;
            const Vec3f to_light = light.position - eye.position;
            const float squared = length_squared(to_light);
            const Vec3f w = to_light * (1.0f / std::sqrt(squared));
            if (squared < 1e-2f || is_grazing(eye, w) || is_grazing(light, -w)) continue;
            const auto at_eye = eye.evaluate_both_ways(w, TransportMode::Radiance);
            const auto at_light = light.evaluate_both_ways(-w, TransportMode::Importance);
            const Rgb product = eye.throughput * at_eye.f_cos * at_light.f_cos * light.throughput;
            const Rgb brought = lanes.contribution[l];
            ASSERT_EQ(is_black(brought), is_black(product));
            if (is_black(product)) continue;
            ++connected;
            const auto weight =
                static_cast<float>(sums_between(raised_, eye, light, w, squared, at_eye, at_light).weight());
            ASSERT_TRUE(is_near(brought, product * (lanes.scale[l] * weight / squared)));
            expect_ray(lanes.ray(l), connecting_ray(eye.origin(w), light.origin(-w)));
        }
    }
    EXPECT_GT(connected, 1'000);
}

TEST_P(DiffuseConnectionsIn, ReachSamplesOfLightsAsOneByOne) {
    ToLightLanes lanes;
    const LightAim aim({{{0.5f, 0.5f, -0.5f}, 0.2f}, {{-4.0f, 1.0f, 2.0f}, 1.0f}});
    int lit = 0;
    for (int block = 0; block < 200; ++block) {
        const auto eyes = make_ends(TransportMode::Radiance);
        std::vector<MeshLight> lights;
        std::array<Vec2f, kCount> numbers;
        const Rgb radiance(3.0f, 2.0f, 1.0f);
        for (std::size_t l = 0; l < kCount; ++l) {
            lights.emplace_back(std::vector{LightTriangle{vec() * 3.0f, vec(), vec()}}, radiance, radiance, l % 3 == 0,
                                false, true, Vec3f(1e-6f));
            numbers[l] = random_.next_2d();
            lanes.eye.set(l, eyes[l].end);
            lanes.front.set(l, lights[l], {.triangle = 0, .gain = 1.0f, .u = numbers[l]});
            lanes.u.set(l, numbers[l]);
            lanes.radiance.set(l, radiance);
            lanes.probability.set(l, 0.25f);
            lanes.choice_ratio.set(l, 3.0f);
        }
        lanes.connect(kCount, rule_, aim);
        for (std::size_t l = 0; l < kCount; ++l) {
            const PathVertex& eye = eyes[l].vertex;
            const LightSample light = lights[l].sample(eye.position, {0.5f, 0.5f}, numbers[l]);
            if (light.distance < 0.1f || std::abs(light.cos_light) < 0.02f || is_grazing(eye, light.wi)) continue;
            const auto value = eye.evaluate_both_ways(light.wi, TransportMode::Radiance);
            const Rgb product = eye.throughput * value.f_cos * light.radiance;
            const Rgb brought = lanes.contribution[l];
            ASSERT_EQ(is_black(brought), is_black(product));
            if (is_black(product)) continue;
            ++lit;
            // The formulas of sums_of_light_sample, without a World.
            const float pdf = 0.25f * light.pdf_solid_angle;
            const float emission_pdf =
                aim.pdf_solid_angle(eye.position + light.wi * light.distance, lights[l].cone(light.triangle), -light.wi,
                                    lights[l].emission_pdf(-light.wi, light.cos_light, {}));
            const double from_light =
                static_cast<double>(emission_pdf * eye.cosine(light.wi) / (light.distance * light.distance));
            const double fewer = eye.densities.fewer(raised_, static_cast<double>(value.reverse_pdf_solid_angle));
            const auto weight =
                static_cast<float>(1.0 / (1.0 + raised_(static_cast<double>(value.pdf_solid_angle / pdf)) +
                                          raised_(3.0 * from_light) * fewer));
            ASSERT_TRUE(is_near(brought, product * (weight / pdf)));
            expect_ray(lanes.ray(l), shadow_ray(eye.origin(light.wi), light));
        }
    }
    EXPECT_GT(lit, 1'000);
}

TEST_P(DiffuseConnectionsIn, ReachTheLensAsOneByOne) {
    constexpr float kSamplesPerPath = 300.0f;
    ToCameraLanes lanes;
    int seen = 0;
    for (int block = 0; block < 200; ++block) {
        const auto lights = make_ends(TransportMode::Importance);
        std::array<Vec3f, kCount> lenses;
        std::array<float, kCount> importances;
        for (std::size_t l = 0; l < kCount; ++l) {
            lenses[l] = vec() * 3.0f;
            importances[l] = any_magnitude(4.0f);
            lanes.light.set(l, lights[l].end);
            lanes.lens.set(l, lenses[l]);
            lanes.w.set(l, normalize(lenses[l] - lights[l].vertex.position));
            lanes.importance.set(l, importances[l]);
        }
        lanes.connect(kCount, rule_, kSamplesPerPath);
        for (std::size_t l = 0; l < kCount; ++l) {
            const PathVertex& light = lights[l].vertex;
            const Vec3f w = lanes.w[l];
            if (is_grazing(light, w)) continue;
            const auto value = light.evaluate_both_ways(w, TransportMode::Importance);
            const Rgb brought = lanes.contribution[l];
            ASSERT_EQ(is_black(brought), is_black(value.f_cos));
            if (is_black(value.f_cos)) continue;
            ++seen;
            // The formula of sums_at_lens, without a job.
            const double from_eye = static_cast<double>(kSamplesPerPath * importances[l] * light.cosine(w));
            const double fewer = light.densities.fewer(raised_, static_cast<double>(value.reverse_pdf_solid_angle));
            const auto weight = static_cast<float>(1.0 / (1.0 + raised_(from_eye) * fewer));
            ASSERT_TRUE(is_near(brought, light.throughput * value.f_cos * (importances[l] * weight)));
            expect_ray(lanes.ray(l), connecting_ray(light.origin(w), lenses[l]));
        }
    }
    EXPECT_GT(seen, 1'000);
}

TEST_P(DiffuseConnectionsIn, CountInFullIfUnweighted) {
    rule_.weighted = false;
    const auto eyes = make_ends(TransportMode::Radiance);
    const auto lights = make_ends(TransportMode::Importance);
    for (std::size_t l = 0; l < kCount; ++l)
        EXPECT_EQ(connect_ends<float>(rule_, eyes[l].end, lights[l].end, 0.0f, 1.0f).weight, 1.0f);
}

// Vertices that lie in each other have densities beyond what floats hold.
TEST_P(DiffuseConnectionsIn, AreNumbersAtAnyDistance) {
    auto eyes = make_ends(TransportMode::Radiance);
    auto lights = make_ends(TransportMode::Importance);
    for (std::size_t l = 0; l < kCount; ++l) {
        DiffuseEnd& eye = eyes[l].end;
        DiffuseEnd& light = lights[l].end;
        // Face to face.
        eye.geometric_normal = eye.normal;
        light.geometric_normal = light.normal = -eye.normal;
        eye.position = Vec3f(0.0f);
        light.position = eye.normal * any_magnitude(30.0f);
        light.fewer = l % 2 == 0 ? 0.0f : any_magnitude(60.0f);
        eye.fewer = l % 3 == 0 ? 0.0f : any_magnitude(60.0f);
        const float weight = connect_ends<float>(rule_, eye, light, 0.0f, 1.0f).weight;
        EXPECT_GE(weight, 0.0f);
        EXPECT_LE(weight, 1.0f);
    }
}

INSTANTIATE_TEST_SUITE_P(Heuristics, DiffuseConnectionsIn, testing::Values(Heuristic::Power, Heuristic::Balance),
                         [](const auto& heuristic) {
                             return heuristic.param == Heuristic::Power ? "Power" : "Balance";
                         });

}  // namespace

}  // namespace etendue::test
