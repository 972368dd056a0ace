// Computes the tables of src/bsdf/ggx_anisotropic_albedo.cpp, as make_ggx_albedo.cpp does the isotropic ones. Run by
// the build.
//
// Usage: make_ggx_anisotropic_albedo OUTPUT.inc

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/ggx_anisotropic_albedo_layout.h"
#include "sampling/sobol.h"
#include "table_writer.h"

#include <memory>
#include <ostream>

namespace {

using namespace etendue;
using namespace etendue::ggx_anisotropic_layout;

constexpr std::uint32_t kSamples = 2048;

struct Tables {
    Table single;
    Table schlick_share;
    Averages single_average;
    Averages schlick_average;
};

struct Albedo {
    float single;
    float schlick_share;
};

/// Mean weight G2 / G1 of light that visible normals reflect, plain and with Schlick's factor.
Albedo integrate(const Ggx& ggx, float phi, float cos_theta) {
    // Edge-on light is the limit from just above.
    const float mu = std::max(cos_theta, 1e-5f);
    const float sine = std::sqrt(1.0f - mu * mu);
    const Vec3f wo{sine * std::cos(phi), sine * std::sin(phi), mu};
    const float masking = 1.0f + ggx.lambda(wo);
    double single = 0.0;
    double schlick = 0.0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3f h = ggx.sample_visible_normal(wo, owen_sobol_2d(i, 1));
        const float o_h = dot(wo, h);
        const Vec3f wi = h * (2.0f * o_h) - wo;
        if (wi.z <= 0.0f) continue;
        const float weight = masking / (masking + ggx.lambda(wi));
        single += static_cast<double>(weight);
        schlick += static_cast<double>(weight * pow5(std::clamp(1.0f - o_h, 0.0f, 1.0f)));
    }
    return {static_cast<float>(single / kSamples), static_cast<float>(schlick / single)};
}

/// Of what the lobes will look up, over a cosine-weighted quarter of the hemisphere.
template <typename Function>
float average(float wide, float narrow, const Function& f) {
    constexpr std::uint32_t kDirections = 8192;
    double sum = 0.0;
    for (std::uint32_t i = 0; i < kDirections; ++i) {
        const Vec2f u = owen_sobol_2d(i, 2);
        const float sine = std::sqrt(u.x);
        const float phi = 0.5f * kPi * u.y;
        sum += static_cast<double>(
            f(position(wide, narrow, sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1.0f - u.x))));
    }
    return static_cast<float>(sum / kDirections);
}

void fill_directional(Tables& tables, std::size_t n, std::size_t s) {
    const float narrow = narrow_alpha(static_cast<int>(n));
    const float wide = wide_alpha(narrow, static_cast<int>(s));
    for (std::size_t a = 0; a < kAngles; ++a) {
        const float phi = 0.5f * kPi * fraction(static_cast<int>(a), kAngles);
        const float seen = seen_alpha(wide, narrow, std::cos(phi), std::sin(phi));
        for (std::size_t c = 0; c < kCosines; ++c) {
            const auto node = static_cast<int>(c);
            tables.single[n][s][a][c] = integrate({wide, narrow}, phi, cosine(node, seen)).single;
            tables.schlick_share[n][s][a][c] = integrate({wide, narrow}, phi, share_cosine(node)).schlick_share;
        }
    }
}

void fill_averages(Tables& tables, std::size_t n, std::size_t s) {
    const float narrow = narrow_alpha(static_cast<int>(n));
    const float wide = wide_alpha(narrow, static_cast<int>(s));
    const auto single = [&](const Position& p) { return interpolate(tables.single, p, p.cosine); };
    tables.single_average[n][s] = average(wide, narrow, single);
    tables.schlick_average[n][s] = average(wide, narrow, [&](const Position& p) {
        return single(p) * interpolate(tables.schlick_share, p, p.share_cosine);
    });
}

void fill(Tables& tables) {
    for (std::size_t n = 0; n < kNarrows; ++n)
        for (std::size_t s = 0; s < kStrengths; ++s) fill_directional(tables, n, s);
    for (std::size_t n = 0; n < kNarrows; ++n)
        for (std::size_t s = 0; s < kStrengths; ++s) fill_averages(tables, n, s);
}

}  // namespace

int main(int argc, char** argv) {
    return write_table_file(argc, argv, "make_ggx_anisotropic_albedo", [](std::ostream& out) {
        const auto tables = std::make_unique<Tables>();
        fill(*tables);
        write_table(out, "Table", "kSingle", tables->single);
        write_table(out, "Table", "kSchlickShare", tables->schlick_share);
        write_table(out, "Averages", "kSingleAverage", tables->single_average);
        write_table(out, "Averages", "kSchlickAverage", tables->schlick_average);
    });
}
