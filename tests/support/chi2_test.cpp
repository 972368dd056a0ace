#include "support/chi2.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

// Density 2x on the unit square, sampled by inversion.
std::optional<Point> sample_ramp(Random& random) {
    const Vec2f u = random.next_2d();
    return Point{std::sqrt(static_cast<double>(u.x)), static_cast<double>(u.y)};
}

Vec3f sample_sphere(Random& random) {
    const Vec2f u = random.next_2d();
    const float z = 1.0f - 2.0f * u.x;
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return {r * std::cos(2.0f * kPi * u.y), r * std::sin(2.0f * kPi * u.y), z};
}

// A lobe around a direction in the x-z plane: density (kappa / 2 pi) exp(-kappa (1 - cos)) nearly.
struct NarrowLobe {
    double kappa;
    Vec3f axis;

    [[nodiscard]] std::optional<Vec3f> sample(Random& random) const {
        const Vec2f u = random.next_2d();
        const double one_minus_cos = -std::log(1.0 - static_cast<double>(u.x)) / kappa;
        const auto sine = static_cast<float>(std::sqrt(one_minus_cos * (2.0 - one_minus_cos)));
        const Vec3f tangent{axis.z, 0.0f, -axis.x};
        const float phi = 2.0f * kPi * u.y;
        return axis * static_cast<float>(1.0 - one_minus_cos) + tangent * (sine * std::cos(phi)) +
               Vec3f(0.0f, 1.0f, 0.0f) * (sine * std::sin(phi));
    }
    [[nodiscard]] double pdf(const Vec3f& w) const {
        const Vec3f difference = w - axis;
        const double one_minus_cos = 0.5 * static_cast<double>(length_squared(difference));
        return kappa / (2.0 * 3.14159265358979) * std::exp(-kappa * one_minus_cos);
    }
};

TEST(Sidak, LevelsMultiplyBackToTheFamilyLevel) {
    EXPECT_NEAR(1.0 - std::pow(1.0 - sidak_level(0.01, 100), 100.0), 0.01, 1e-12);
    EXPECT_DOUBLE_EQ(sidak_level(0.05, 1), 0.05);
}

TEST(Chi2Counts, MatchesAPublishedTable) {
    // The critical value for three degrees of freedom at 5% is 7.815 (any table of the distribution).
    const double each = std::sqrt(7.815 * 100.0 / 2.0);
    const std::vector<double> expected{100.0, 100.0, 100.0, 100.0};
    const std::vector<double> observed{100.0 + each, 100.0 - each, 100.0, 100.0};
    const Chi2Result result = chi2_counts(observed, expected);
    EXPECT_NEAR(result.statistic, 7.815, 1e-9);
    EXPECT_EQ(result.degrees_of_freedom, 3u);
    EXPECT_NEAR(result.p_value, 0.05, 1e-4);
}

TEST(Chi2Counts, PoolsCellsThatExpectLessThanFive) {
    const std::vector<double> expected{1.0, 50.0, 2.0, 1.0, 50.0, 1.5};
    const std::vector<double> observed{2.0, 50.0, 1.0, 1.0, 50.0, 1.5};
    EXPECT_EQ(chi2_counts(observed, expected).degrees_of_freedom, 2u);
    EXPECT_NEAR(chi2_counts(observed, expected).statistic, 0.0, 1e-12);
}

TEST(Chi2Counts, MergesAPoolThatIsStillSmallWithTheSmallestCell) {
    const std::vector<double> expected{1.0, 40.0, 60.0};
    const std::vector<double> observed{3.0, 38.0, 60.0};
    const Chi2Result result = chi2_counts(observed, expected);
    EXPECT_EQ(result.degrees_of_freedom, 1u);
    EXPECT_NEAR(result.statistic, 0.0, 1e-12);
}

TEST(Chi2Counts, FailsWhenSomethingFallsWhereTheDensityIsZero) {
    EXPECT_EQ(chi2_counts(std::array{100.0, 1.0}, std::array{100.0, 0.0}).p_value, 1.0)
        << "one stray sample is pooled with the smallest cell";
    EXPECT_LT(chi2_counts(std::array{100.0, 100.0, 100.0}, std::array{100.0, 100.0, 0.0}).p_value, 1e-10);
    EXPECT_EQ(chi2_counts(std::array{3.0}, std::array{0.0}).p_value, 0.0);
}

TEST(Chi2Counts, WritesBothHistograms) {
    const Chi2Result result =
        chi2_counts(std::array{30.0, 10.0}, std::array{20.0, 20.0}, std::array<std::string, 2>{"left", "right"});
    EXPECT_NE(result.str().find("left"), std::string::npos);
    EXPECT_NE(result.str().find("20.00"), std::string::npos);
}

TEST(RectSampler, AcceptsTheRightDensityAndFindsItsIntegral) {
    const SamplerCheck check = check_rect_sampler({}, sample_ramp, [](double x, double) { return 2.0 * x; });
    EXPECT_GT(check.chi2.p_value, 1e-3) << check.chi2.str();
    EXPECT_NEAR(check.pdf_integral, 1.0, 1e-9);
    EXPECT_EQ(check.hit_share, 1.0);
}

TEST(RectSampler, PValuesOfARightDensityAreUniform) {
    int below_half = 0;
    int below_tenth = 0;
    constexpr int kRuns = 400;
    for (int run = 0; run < kRuns; ++run) {
        const SamplerOptions options{
            .samples = 2000, .pilot_samples = 512, .seed = static_cast<std::uint32_t>(run), .cells_log2 = 4};
        const double p = check_rect_sampler(
                             {}, sample_ramp, [](double x, double) { return 2.0 * x; }, options)
                             .chi2.p_value;
        below_half += p < 0.5 ? 1 : 0;
        below_tenth += p < 0.1 ? 1 : 0;
    }
    // Four standard deviations of the binomial counts.
    EXPECT_NEAR(below_half, 200, 40);
    EXPECT_NEAR(below_tenth, 40, 24);
}

TEST(RectSampler, RejectsAWrongShapeAndAWrongFactor) {
    EXPECT_LT(check_rect_sampler({}, sample_ramp, [](double, double) { return 1.0; }).chi2.p_value, 1e-10);
    EXPECT_LT(check_rect_sampler({}, sample_ramp, [](double x, double) { return 1.9 * x; }).chi2.p_value, 1e-10);
    EXPECT_LT(check_rect_sampler({}, sample_ramp, [](double x, double) { return 2.1 * x; }).chi2.p_value, 1e-8);
}

TEST(RectSampler, RejectedSamplesAreWhatTheDensityLeavesOver) {
    const PointSampler with_rejection = [](Random& random) {
        const bool reject = random.next() < 0.3f;
        const std::optional<Point> p = sample_ramp(random);
        return reject ? std::nullopt : p;
    };
    const SamplerCheck right = check_rect_sampler({}, with_rejection, [](double x, double) { return 1.4 * x; });
    EXPECT_GT(right.chi2.p_value, 1e-3) << right.chi2.str();
    EXPECT_NEAR(right.hit_share, 0.7, 4.0 * right.hit_error);
    EXPECT_LT(check_rect_sampler({}, with_rejection, [](double x, double) { return 2.0 * x; }).chi2.p_value, 1e-10);
}

TEST(SphereSampler, AcceptsTheUniformDensity) {
    const double uniform = 1.0 / (4.0 * 3.14159265358979);
    const SamplerCheck check = check_sphere_sampler(sample_sphere, [=](const Vec3f&) { return uniform; });
    EXPECT_GT(check.chi2.p_value, 1e-3) << check.chi2.str();
    EXPECT_NEAR(check.pdf_integral, 1.0, 1e-9);
}

TEST(SphereSampler, ResolvesLobesDownToAThousandthOfARadian) {
    for (const double kappa : {1e2, 1e4, 1e6})
        for (const float x : {0.0f, 0.6f, 0.999f}) {
            SCOPED_TRACE(testing::Message() << "kappa " << kappa << ", x " << x);
            const NarrowLobe lobe{kappa, {x, 0.0f, std::sqrt(1.0f - x * x)}};
            const auto sampler = [&](Random& random) { return lobe.sample(random); };
            const SamplerCheck check = check_sphere_sampler(sampler, [&](const Vec3f& w) { return lobe.pdf(w); });
            EXPECT_GT(check.chi2.p_value, 1e-4) << check.chi2.str();
            EXPECT_NEAR(check.pdf_integral, 1.0, 1e-3);
            // A lobe five per cent wider is another one.
            const NarrowLobe wider{kappa / 1.1, lobe.axis};
            EXPECT_LT(check_sphere_sampler(sampler, [&](const Vec3f& w) { return wider.pdf(w); }).chi2.p_value, 1e-6);
        }
}

TEST(IntegrateSphere, IntegratesWhatTheGuideSamples) {
    const NarrowLobe lobe{1e4, {0.6f, 0.0f, 0.8f}};
    const auto sampler = [&](Random& random) { return lobe.sample(random); };
    EXPECT_NEAR(integrate_sphere(sampler, [&](const Vec3f& w) { return 3.0 * lobe.pdf(w); }), 3.0, 1e-3);
}

TEST(Integrate, FollowsAJump) {
    const auto disk = [](double x, double y) { return x * x + y * y < 1.0 ? 1.0 : 0.0; };
    EXPECT_NEAR(integrate(disk, {-1.0, 1.0, -1.0, 1.0}, 1e-6), 3.14159265, 5e-3);
}

}  // namespace

}  // namespace etendue::test
