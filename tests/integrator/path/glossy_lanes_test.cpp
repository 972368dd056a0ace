#include "integrator/path/glossy_lanes.h"

#include "support/random.h"
#include "world/scattering.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

/// A path on a surface, and what it asks of it.
struct Question {
    MetallicRoughness lobe;
    Frame frame;
    Vec3f geometric_normal, wo, light_wi;
    float u_lobe;
    Vec2f u;
};

Question make_question(Random& random) {
    const auto vec = [&] { return Vec3f(random.next(), random.next(), random.next()) * 2.0f - Vec3f(1.0f); };
    Question q;
    q.lobe.base = {random.next(), random.next(), random.next()};
    q.lobe.metallic = std::clamp(2.0f * random.next() - 0.5f, 0.0f, 1.0f);
    q.lobe.alpha_x = q.lobe.alpha_y = 0.05f + 0.95f * random.next();
    q.geometric_normal = normalize(vec());
    // Every other one is smooth: its normal leans.
    const float leaning = random.next() < 0.5f ? 0.0f : 0.3f;
    q.frame = Frame::from_normal(normalize(q.geometric_normal + vec() * leaning));
    q.wo = normalize(vec());
    q.light_wi = normalize(vec());
    q.u_lobe = random.next();
    q.u = {random.next(), random.next()};
    return q;
}

void ask(GlossyLanes& lanes, std::size_t lane, const Question& q) {
    lanes.set_lobe(lane, q.lobe);
    lanes.tangent.set(lane, q.frame.tangent);
    lanes.bitangent.set(lane, q.frame.bitangent);
    lanes.normal.set(lane, q.frame.normal);
    lanes.geometric_normal.set(lane, q.geometric_normal);
    lanes.wo.set(lane, q.wo);
    lanes.light_wi.set(lane, q.light_wi);
    lanes.u_lobe.set(lane, q.u_lobe);
    lanes.u_bsdf.set(lane, q.u);
}

using Bits = std::array<std::uint32_t, 11>;

Bits answer(const GlossyLanes& lanes, std::size_t l) {
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    return {bits(lanes.f_cos[l].r),          bits(lanes.f_cos[l].g),
            bits(lanes.f_cos[l].b),          bits(lanes.pdf[l]),
            bits(lanes.next_direction[l].x), bits(lanes.next_direction[l].y),
            bits(lanes.next_direction[l].z), bits(lanes.next_weight[l].r),
            bits(lanes.next_weight[l].g),    bits(lanes.next_weight[l].b),
            bits(lanes.next_pdf[l])};
}

// The reference is what all other surfaces go through.
TEST(GlossyLanes, ScatterAsThatOneSurfaceDoes) {
    Random random(37);
    constexpr std::size_t kCount = kBlockLanes - 3;
    GlossyLanes lanes;
    int scattered = 0;
    int dark = 0;
    int elsewhere = 0;
    for (int block = 0; block < 300; ++block) {
        std::vector<Question> questions;
        for (std::size_t l = 0; l < kCount; ++l) {
            questions.push_back(make_question(random));
            ask(lanes, l, questions[l]);
        }
        lanes.evaluate_and_sample(kCount);
        for (std::size_t l = 0; l < kCount; ++l) {
            const Question& q = questions[l];
            const Bsdf bsdf = q.lobe;
            const Scattering expected(bsdf, q.frame, q.geometric_normal, q.wo);
            // Grazing directions may fall on either side.
            const auto grazes = [&](const Vec3f& w) {
                return std::abs(dot(w, q.geometric_normal) * dot(w, q.frame.normal)) < 1e-3f;
            };
            if (grazes(q.wo)) continue;
            const BsdfValue value = expected.evaluate(q.light_wi, TransportMode::Radiance);
            dark += is_black(value.f_cos) ? 1 : 0;
            if (!grazes(q.light_wi)) {
                ASSERT_NEAR(lanes.f_cos[l].g, value.f_cos.g, 1e-4f * (1.0f + value.f_cos.g));
                ASSERT_NEAR(lanes.pdf[l], value.pdf_solid_angle, 1e-4f * (1.0f + value.pdf_solid_angle));
            }
            const BsdfSample sample = expected.sample(q.u_lobe, q.u, TransportMode::Radiance);
            if (grazes(lanes.next_direction[l]) || is_black(sample.weight)) continue;
            // Where the numbers for the lobe lie on a border, a rounding chooses another one.
            if (length(lanes.next_direction[l] - sample.wi) > 1e-3f) {
                ++elsewhere;
                continue;
            }
            ++scattered;
            ASSERT_NEAR(lanes.next_weight[l].g, sample.weight.g, 1e-3f * (1.0f + sample.weight.g));
            ASSERT_NEAR(lanes.next_pdf[l], sample.pdf_solid_angle, 1e-3f * (1.0f + sample.pdf_solid_angle));
        }
    }
    EXPECT_GT(scattered, 5'000);
    EXPECT_GT(dark, 5'000);
    EXPECT_LE(elsewhere, 2);
}

// Crops, resumed renders and other numbers of threads put other paths side by side.
TEST(GlossyLanes, DoNotDependOnTheirNeighbours) {
    Random random(41);
    for (int block = 0; block < 300; ++block) {
        std::array<Question, kBlockLanes> questions;
        for (Question& question : questions) question = make_question(random);
        GlossyLanes all;
        for (std::size_t l = 0; l < kBlockLanes; ++l) ask(all, l, questions[l]);
        all.evaluate_and_sample(kBlockLanes);
        // Turned around, among others that are all metals or all dielectrics, and no numbers in the lanes after them.
        constexpr std::size_t kCount = kBlockLanes - 5;
        GlossyLanes some;
        const float nan = std::numeric_limits<float>::quiet_NaN();
        for (std::size_t l = 0; l < kBlockLanes; ++l) {
            Question q = questions[kBlockLanes - 1 - l];
            if (l >= kCount) {
                q.wo = q.light_wi = Vec3f(nan);
                q.u_lobe = nan;
            } else if (l % 2 != 0) {
                q.lobe.metallic = block % 2 == 0 ? 0.0f : 1.0f;
                q.u_lobe = block % 2 == 0 ? 0.0f : 0.999f;
            }
            ask(some, l, q);
        }
        some.evaluate_and_sample(kCount);
        for (std::size_t l = 0; l < kCount; l += 2)
            ASSERT_EQ(answer(some, l), answer(all, kBlockLanes - 1 - l)) << block << ' ' << l;
    }
}

}  // namespace

}  // namespace etendue::test
