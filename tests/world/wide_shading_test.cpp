#include "bsdf/plain_metallic_roughness.h"
#include "core/wide.h"
#include "support/lanes.h"
#include "world/lane_scattering.h"
#include "world/scattering.h"
#include "world/section_ellipse.h"
#include "world/triangle_point.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

template <typename T, std::size_t N>
Imath::Vec3<T> vec(const std::array<T, N>& in, std::size_t first) {
    return {in[first], in[first + 1], in[first + 2]};
}

TEST(WideShading, PointsOfTrianglesAreThoseOfFloat) {
    EXPECT_LE((largest_lane_difference<14>(-1.0f, 1.0f,
                                           [](const auto& in) {
                                               const TrianglePoint point(vec(in, 0), vec(in, 3), vec(in, 6),
                                                                         Imath::Vec2(in[9], in[10]));
                                               const auto normal = usable_normal(vec(in, 11), normalize(vec(in, 0)));
                                               return std::array{point.position.x, point.position.y, point.position.z,
                                                                 point.extent.x,   point.extent.y,   point.extent.z,
                                                                 normal.x,         normal.y,         normal.z};
                                           })),
              4.0f);
    const Imath::Vec3<Wide> geometric(Wide(0.0f), Wide(0.6f), Wide(0.8f));
    const Imath::Vec3<Wide> flat = usable_normal(Imath::Vec3<Wide>(Wide(0.0f)), geometric);
    EXPECT_EQ(Vec3f(flat.x[0], flat.y[0], flat.z[0]), Vec3f(0.0f, 0.6f, 0.8f)) << "no normals at the vertices";
}

/// Returns f cos, its density and a sample of a diffuse surface whose normal leans away from the geometric normal.
template <typename T, typename Value>
std::array<T, 8> diffuse_values(const std::array<T, 14>& in, const Value& value) {
    const Imath::Vec3<T> geometric = normalize(vec(in, 0));
    const auto frame = BasicFrame<T>::from_normal(normalize(geometric + vec(in, 3) * T(0.3f)));
    return value(frame, geometric, normalize(vec(in, 6)), normalize(vec(in, 9)),
                 Imath::Vec2<T>(abs(in[12]), abs(in[13])));
}

TEST(WideShading, DiffuseSurfacesScatterAsTheLobeDoes) {
    const auto wide = [](const auto& frame, const auto& geometric, const auto& wo, const auto& wi, const auto& u) {
        const OrientedSurface surface(frame, geometric, wo, true);
        using T = std::remove_cvref_t<decltype(wo.x)>;
        const BasicDiffuse<T> lobe{BasicRgb<T>(T(0.7f), T(0.5f), T(0.3f))};
        const auto value = evaluate_diffuse(surface, lobe, surface.frame.to_local(wi), TransportMode::Radiance);
        const auto sample = sample_diffuse(surface, lobe, u, TransportMode::Radiance);
        return std::array{value.f_cos.r, value.f_cos.b, value.pdf_solid_angle, sample.wi.x,
                          sample.wi.y,   sample.wi.z,   sample.weight.g,       sample.pdf_solid_angle};
    };
    EXPECT_LE((largest_lane_difference<14>(-1.0f, 1.0f, [&](const auto& in) { return diffuse_values(in, wide); })),
              32.0f);

    // The reference is what all other lobes go through.
    const auto general = [](const Frame& frame, const Vec3f& geometric, const Vec3f& wo, const Vec3f& wi, Vec2f u) {
        const Bsdf lobe = Diffuse{Rgb(0.7f, 0.5f, 0.3f)};
        const Scattering scattering(lobe, frame, geometric, wo);
        const BsdfValue value = scattering.evaluate(wi, TransportMode::Radiance);
        const BsdfSample sample = scattering.sample(0.5f, u, TransportMode::Radiance);
        return std::array{value.f_cos.r, value.f_cos.b, value.pdf_solid_angle, sample.wi.x,
                          sample.wi.y,   sample.wi.z,   sample.weight.g,       sample.pdf_solid_angle};
    };
    Random random(21);
    int scattered = 0;
    for (int i = 0; i < 100'000; ++i) {
        std::array<float, 14> in{};
        for (float& number : in) number = 2.0f * random.next() - 1.0f;
        const auto expected = diffuse_values(in, general);
        const auto found = diffuse_values(in, wide);
        ASSERT_EQ(found[6] > 0.0f, expected[6] > 0.0f);
        for (const std::size_t o : {0u, 1u, 2u}) ASSERT_NEAR(found[o], expected[o], 1e-6f);
        // A ratio of cosines, which may be small.
        ASSERT_NEAR(found[6], expected[6], 1e-4f);
        if (expected[6] == 0.0f) continue;  // no sample
        ++scattered;
        // A root of what rounding leaves of 1 - x² - y².
        for (const std::size_t o : {3u, 4u, 5u, 7u}) ASSERT_NEAR(found[o], expected[o], 2e-5f);
    }
    EXPECT_GT(scattered, 50'000);
}

// A glossy surface that leans: the lanes' program against what all other lobes go through.
TEST(WideShading, GlossySurfacesScatterAsTheLobeDoes) {
    Random random(23);
    const auto vec3 = [&] { return Vec3f(random.next(), random.next(), random.next()) * 2.0f - Vec3f(1.0f); };
    int compared = 0;
    for (int i = 0; i < 100'000; ++i) {
        const Vec3f geometric = normalize(vec3());
        const Frame frame = Frame::from_normal(normalize(geometric + vec3() * 0.6f));
        const Vec3f wo = normalize(vec3());
        const Vec3f wi = normalize(vec3());
        const float alpha = 0.1f + 0.9f * random.next();
        const MetallicRoughness lobe{
            .base = {0.7f, 0.5f, 0.3f}, .metallic = 0.4f, .alpha_x = alpha, .alpha_y = alpha, .f0 = Rgb(0.04f)};
        const Bsdf bsdf = lobe;
        const float u_lobe = random.next();
        const Vec2f u = random.next_2d();
        const OrientedSurface<float> surface(frame, geometric, wo, true);
        const Scattering general(bsdf, frame, geometric, wo);
        // Roundings decide on borders.
        if (std::min(abs_dot(wo, geometric), abs_dot(wi, geometric)) < 1e-3f || general.wo_local().z < 1e-2f) continue;
        const auto [value, sample] =
            PlainMetallicRoughness<float>{lobe.base, lobe.metallic, alpha, lobe.f0, lobe.f90}.evaluate_and_sample(
                surface.leaning, surface.seen_from(), surface.frame.to_local(wi), u_lobe, u);
        const BsdfValue expected = general.evaluate(wi, TransportMode::Radiance);
        ASSERT_NEAR(value.f_cos.r, expected.f_cos.r, 1e-3f * (1.0f + expected.f_cos.r));
        ASSERT_NEAR(value.pdf_solid_angle, expected.pdf_solid_angle, 1e-3f * (1.0f + expected.pdf_solid_angle));
        const BsdfSample expected_sample = general.sample(u_lobe, u, TransportMode::Radiance);
        if (is_black(expected_sample.weight) || abs_dot(expected_sample.wi, geometric) < 1e-3f) continue;
        ++compared;
        ASSERT_NEAR(sample.weight.g, expected_sample.weight.g, 2e-3f * (1.0f + expected_sample.weight.g));
        ASSERT_LT(length(surface.frame.to_world(sample.wi) - expected_sample.wi), 1e-3f);
    }
    EXPECT_GT(compared, 50'000);
}

// Of rays along the normal, the direction in the plane is what is left of two nearly equal vectors.
TEST(WideShading, SectionsOfConesAreThoseOfFloat) {
    EXPECT_LE((largest_lane_difference<17>(
                  -1.0f, 1.0f,
                  [](const auto& in) {
                      using T = std::remove_cvref_t<decltype(in[0])>;
                      const Imath::Vec3<T> edge1 = vec(in, 0) + Imath::Vec3<T>(T(3.0f), T(0.0f), T(0.0f));
                      const Imath::Vec3<T> edge2 = vec(in, 3) + Imath::Vec3<T>(T(0.0f), T(3.0f), T(0.0f));
                      const Imath::Vec3<T> normal = normalize(cross(edge1, edge2));
                      const Imath::Vec3<T> towards = vec(in, 6) - normal * T(2.0f);
                      const SectionEllipse<T> ellipse(normalize(towards), abs(in[9]), normal);
                      const TextureEllipse<T> in_texture(ellipse, edge1, edge2, normal, Imath::Vec2<T>(in[10], in[11]),
                                                         Imath::Vec2<T>(in[12], in[13]));
                      return std::array{ellipse.along.x,    ellipse.across.z,    in_texture.along.x,
                                        in_texture.along.y, in_texture.across.x, in_texture.across.y};
                  })),
              128.0f);
    // A ray along the normal, where any diameter will do, and a triangle without an area.
    const Imath::Vec3<Wide> up(Wide(0.0f), Wide(0.0f), Wide(1.0f));
    const SectionEllipse<Wide> circle({Wide(0.0f), Wide(0.0f), Wide(-1.0f)}, Wide(0.5f), up);
    EXPECT_NEAR(length(circle.along)[0], 0.5f, 1e-6f);
    EXPECT_NEAR(length(circle.across)[0], 0.5f, 1e-6f);
    const TextureEllipse<Wide> nothing(circle, up, up, up, {Wide(1.0f), Wide(0.0f)}, {Wide(0.0f), Wide(1.0f)});
    EXPECT_EQ(nothing.along.x[0], 0.0f);
    EXPECT_EQ(nothing.across.y[0], 0.0f);
}

}  // namespace

}  // namespace etendue::test
