// What the tables say is missing, against a second implementation; and its averages, against sums over what the tables
// say.
#include "bsdf/ggx_anisotropic_albedo.h"

#include "bsdf/ggx.h"
#include "support/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr double kPiDouble = std::numbers::pi;

struct Surface {
    double alpha_x, alpha_y;

    [[nodiscard]] double lambda(double x, double y, double z) const {
        return 0.5 * (std::hypot(1.0, alpha_x * x / z, alpha_y * y / z) - 1.0);
    }
};

struct Missing {
    double mirror = 0.0;
    double interface = 0.0;
};

/// In double precision, with visible normals after Dupuy and Benyoub (HPG 2023) over a golden-ratio lattice. Twice as
/// many samples change the result by less than 1e-3.
Missing reference(const Surface& surface, const Vec3f& w, double eta, int samples) {
    const double wx = static_cast<double>(w.x);
    const double wy = static_cast<double>(w.y);
    const double wz = static_cast<double>(w.z);
    const double scale = 1.0 / std::hypot(surface.alpha_x * wx, surface.alpha_y * wy, wz);
    const double sz = wz * scale;
    const double masking = 1.0 + surface.lambda(wx, wy, wz);
    const auto lost = [&](double x, double y, double z) {
        const double l = surface.lambda(x, y, z);
        return l / (masking + l);
    };
    Missing sum;
    for (int i = 0; i < samples; ++i) {
        double whole;
        const double phi = 2.0 * kPiDouble * std::modf(i * std::numbers::phi, &whole);
        const double z = (1.0 - (i + 0.5) / samples) * (1.0 + sz) - sz;
        const double sine = std::sqrt(std::max(0.0, 1.0 - z * z));
        const double x = surface.alpha_x * (sine * std::cos(phi) + surface.alpha_x * wx * scale);
        const double y = surface.alpha_y * (sine * std::sin(phi) + surface.alpha_y * wy * scale);
        const double length = std::hypot(x, y, z + sz);
        const double hx = x / length;
        const double hy = y / length;
        const double hz = (z + sz) / length;
        const double o_h = wx * hx + wy * hy + wz * hz;
        const double up = 2.0 * o_h * hz - wz;
        const double lost_up = up > 0.0 ? lost(2.0 * o_h * hx - wx, 2.0 * o_h * hy - wy, up) : 1.0;
        sum.mirror += lost_up;
        const double g2 = eta * eta - 1.0 + o_h * o_h;
        if (g2 <= 0.0) {
            sum.interface += lost_up;
            continue;
        }
        const double g = std::sqrt(g2);  // Walter et al. 2007, equation 22
        const double a = (g - o_h) / (g + o_h);
        const double b = (o_h * (g + o_h) - 1.0) / (o_h * (g - o_h) + 1.0);
        const double f = 0.5 * a * a * (1.0 + b * b);
        const double along = (o_h - g) / eta;
        const double down = along * hz - wz / eta;
        const double lost_down = down < 0.0 ? lost(along * hx - wx / eta, along * hy - wy / eta, down) : 1.0;
        sum.interface += f * lost_up + (1.0 - f) * lost_down;
    }
    return {sum.mirror / samples, sum.interface / samples};
}

struct View {
    float alpha_x, alpha_y, eta;
    Vec3f w;
};

float log_uniform(Random& random, float low, float high) {
    return low * std::pow(high / low, random.next());
}

/// Alphas and directions of all kinds. A third are grooves, one alpha above 0.7 and the other below 0.15; half have an
/// index close to that at which the grooves, or level facets, begin to reflect totally; half the cosines are grazing.
std::vector<View> views(int count) {
    constexpr std::array kCommonIndices{1.002f, 1.01f, 1.1f, 1.5f, 2.4f};
    Random random(7);
    std::vector<View> result;
    for (int i = 0; i < count; ++i) {
        const bool grooves = i % 3 == 0;
        View v{};
        v.alpha_x = i % 4 == 0 ? 1.0f : log_uniform(random, grooves ? 0.7f : kSmoothAlpha, 1.0f);
        v.alpha_y = i % 5 == 0 ? kSmoothAlpha : log_uniform(random, kSmoothAlpha, grooves ? 0.15f : 1.0f);
        const float phi = i % 5 < 2 ? std::atan(log_uniform(random, 1e-3f, 1e3f)) : 0.5f * kPi * random.next();
        const float t = random.next();
        const float cos_theta = i % 2 == 0 ? log_uniform(random, 0.02f, 1.0f) : 0.02f + 0.98f * t * t;
        const float sine = std::sqrt(1.0f - cos_theta * cos_theta);
        v.w = {sine * std::cos(phi), sine * std::sin(phi), cos_theta};
        v.eta = 1.0f + log_uniform(random, 0.002f, 8.0f);
        if (i % 7 == 0) v.eta = kCommonIndices[static_cast<std::size_t>(i) % kCommonIndices.size()];
        const float along_grooves = v.alpha_x < v.alpha_y ? v.w.x : v.w.y;
        const float off = 1.0f + (random.next() < 0.5f ? -1.0f : 1.0f) * log_uniform(random, 1e-3f, 0.3f);
        const float critical = i % 8 < 3 ? off / along_grooves : i % 8 == 3 ? 1.0f + off * (1.0f / sine - 1.0f) : 0.0f;
        if (critical >= 1.002f && critical <= 9.0f) v.eta = critical;
        if (random.next() < 0.5f) {
            std::swap(v.alpha_x, v.alpha_y);
            std::swap(v.w.x, v.w.y);
        }
        result.push_back(v);
    }
    return result;
}

struct Worst {
    double error = 0.0;
    std::string where;

    void add(double e, const View& v, double exact) {
        if (std::abs(e) <= std::abs(error)) return;
        error = e;
        where = std::to_string(e) + " of " + std::to_string(exact) + " at alphas " + std::to_string(v.alpha_x) + " " +
                std::to_string(v.alpha_y) + " eta " + std::to_string(v.eta) + " w " + std::to_string(v.w.x) + " " +
                std::to_string(v.w.y) + " " + std::to_string(v.w.z);
    }
};

/// The furnace's error is that of what is missing. A coarse estimate that differs much is repeated with more samples.
TEST(GgxAnisotropicAlbedo, TablesAgreeWithASecondImplementation) {
    constexpr int kViews = 10'000;
    constexpr int kCoarse = 1024;
    constexpr int kFine = 65'536;
    Worst mirror;
    Worst outside;
    Worst inside;
    for (const View& v : views(kViews)) {
        const Surface surface{static_cast<double>(v.alpha_x), static_cast<double>(v.alpha_y)};
        for (const bool from_outside : {true, false}) {
            const float eta = from_outside ? v.eta : 1.0f / v.eta;
            const auto of_mirror = 1.0 - static_cast<double>(ggx_anisotropic_albedo(v.w, v.alpha_x, v.alpha_y).single);
            const auto of_interface =
                static_cast<double>(ggx_anisotropic_dielectric_missing(v.w, v.alpha_x, v.alpha_y, eta));
            Missing exact = reference(surface, v.w, static_cast<double>(eta), kCoarse);
            if (std::abs(of_mirror - exact.mirror) > 2e-3 || std::abs(of_interface - exact.interface) > 2e-3)
                exact = reference(surface, v.w, static_cast<double>(eta), kFine);
            mirror.add(of_mirror - exact.mirror, v, exact.mirror);
            (from_outside ? outside : inside).add(of_interface - exact.interface, v, exact.interface);
        }
    }
    EXPECT_LE(std::abs(mirror.error), 5e-3) << mirror.where;
    EXPECT_LE(std::abs(outside.error), 5e-3) << outside.where;
    EXPECT_LE(std::abs(inside.error), 5e-3) << inside.where;
}

TEST(GgxAnisotropicAlbedo, AveragesAreThoseOfTheTables) {
    constexpr int kRings = 100;
    constexpr int kAzimuths = 40;
    Random random(3);
    for (int i = 0; i < 60; ++i) {
        const float alpha_x = i % 4 == 0 ? 1.0f : log_uniform(random, 0.01f, 1.0f);
        const float alpha_y = log_uniform(random, i % 2 == 0 ? 0.01f : kSmoothAlpha, 1.0f);
        const float eta = 1.0f + log_uniform(random, 0.002f, 8.0f);
        double mirror = 0.0;
        double outside = 0.0;
        double inside = 0.0;
        for (int r = 0; r < kRings; ++r) {
            // Most rings at grazing angles: mu = t³, and 2 mu dmu is the difference of its squares.
            const float low = std::pow(static_cast<float>(r) / kRings, 3.0f);
            const float high = std::pow(static_cast<float>(r + 1) / kRings, 3.0f);
            const float mu = 0.5f * (low + high);
            const float sine = std::sqrt(1.0f - mu * mu);
            for (int a = 0; a < kAzimuths; ++a) {
                const float phi = 0.5f * kPi * (static_cast<float>(a) + 0.5f) / kAzimuths;
                const Vec3f w{sine * std::cos(phi), sine * std::sin(phi), mu};
                const auto weight = static_cast<double>((high * high - low * low) / kAzimuths);
                mirror += weight * (1.0 - static_cast<double>(ggx_anisotropic_albedo(w, alpha_x, alpha_y).single));
                outside += weight * static_cast<double>(ggx_anisotropic_dielectric_missing(w, alpha_x, alpha_y, eta));
                inside +=
                    weight * static_cast<double>(ggx_anisotropic_dielectric_missing(w, alpha_x, alpha_y, 1.0f / eta));
            }
        }
        const auto expect_close = [&](double stored, double sum) {
            EXPECT_NEAR(stored / sum, 1.0, 0.015) << alpha_x << " " << alpha_y << " " << eta;
        };
        expect_close(1.0 - static_cast<double>(ggx_anisotropic_albedo_average(alpha_x, alpha_y).single), mirror);
        expect_close(static_cast<double>(ggx_anisotropic_dielectric_missing_average(alpha_x, alpha_y, eta)), outside);
        expect_close(static_cast<double>(ggx_anisotropic_dielectric_missing_average(alpha_x, alpha_y, 1.0f / eta)),
                     inside);
    }
}

// The last direction is rounded to a length above one.
TEST(GgxAnisotropicAlbedo, StaysWithinZeroAndOneToTheEndsOfItsRange) {
    for (const float alpha_x : {kSmoothAlpha, 0.5f, 1.0f})
        for (const float alpha_y : {kSmoothAlpha, 1.0f})
            for (const Vec3f& w : {Vec3f{0.0f, 0.0f, 1.0f}, Vec3f{1.0f, 0.0f, 0.0f}, Vec3f{0.0f, 1.0f, 0.0f},
                                   Vec3f{0.6f, 0.0f, 0.8f}, Vec3f{1e-4f, 1e-4f, 1.0000001f}}) {
                for (const float eta : {1.0f / 9.0f, 0.999f, 1.0f, 1.001f, 9.0f}) {
                    const float missing = ggx_anisotropic_dielectric_missing(w, alpha_x, alpha_y, eta);
                    EXPECT_TRUE(missing >= 0.0f && missing < 1.0f) << alpha_x << " " << alpha_y << " " << eta;
                }
                const GgxAlbedo albedo = ggx_anisotropic_albedo(w, alpha_x, alpha_y);
                EXPECT_TRUE(albedo.single > 0.0f && albedo.single <= 1.0f);
                EXPECT_TRUE(albedo.schlick >= 0.0f && albedo.schlick <= albedo.single);
            }
}

}  // namespace

}  // namespace etendue::test
