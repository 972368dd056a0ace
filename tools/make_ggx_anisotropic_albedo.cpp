// Computes the tables of src/bsdf/ggx_anisotropic_albedo.cpp, as make_ggx_albedo.cpp does the isotropic ones. Run by
// the build.
//
// Usage: make_ggx_anisotropic_albedo OUTPUT.inc

#include "bsdf/ggx_anisotropic_albedo_layout.h"
#include "ggx_view.h"
#include "sampling/sobol.h"
#include "table_writer.h"

#include <memory>
#include <ostream>

namespace {

using namespace etendue;
using namespace etendue::ggx_anisotropic_layout;

constexpr std::uint32_t kSamples = 2048;

struct Tables {
    Table<kReflection> single;
    Table<kReflection> schlick_share;
    std::array<std::array<Table<kDielectric>, kEtas>, 2> dielectric;
    Averages<kReflection> single_average;
    Averages<kReflection> schlick_average;
    std::array<std::array<Averages<kDielectric>, kEtas>, 2> dielectric_average;
};

struct Albedo {
    float single;
    float schlick_share;
};

/// Mean weight G2 / G1 of light that visible normals reflect, plain and with Schlick's factor.
Albedo integrate_reflection(const GgxView& view) {
    double single = 0.0;
    double schlick = 0.0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3f h = view.normal(i);
        const float weight = view.weight_reflected(h);
        single += static_cast<double>(weight);
        schlick += static_cast<double>(weight * pow5(std::clamp(1.0f - dot(view.wo(), h), 0.0f, 1.0f)));
    }
    return {static_cast<float>(single / kSamples), static_cast<float>(schlick / single)};
}

/// The same normals serve every index of refraction.
std::array<std::array<double, kEtas>, 2> integrate_dielectric(const GgxView& view) {
    std::array<std::array<double, kEtas>, 2> sums{};
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3f h = view.normal(i);
        const float reflected = view.weight_reflected(h);
        for (std::size_t side = 0; side < 2; ++side) {
            for (std::size_t e = 0; e < kEtas; ++e) {
                const float outside = eta(static_cast<int>(e), kEtas);
                sums[side][e] +=
                    static_cast<double>(view.weight_of_interface(h, reflected, side == 0 ? outside : 1.0f / outside));
            }
        }
    }
    return sums;
}

/// Of what the lobes will look up, over a cosine-weighted quarter of the hemisphere.
template <Sizes S, typename Function>
float average(const Ggx& ggx, const Function& f) {
    constexpr std::uint32_t kDirections = 8192;
    double sum = 0.0;
    for (std::uint32_t i = 0; i < kDirections; ++i) {
        const Vec2f u = owen_sobol_2d(i, 2);
        const float sine = std::sqrt(u.x);
        const float phi = 0.5f * kPi * u.y;
        sum += static_cast<double>(f(
            position<S>(ggx.alpha_x, ggx.alpha_y, sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1.0f - u.x))));
    }
    return static_cast<float>(sum / kDirections);
}

/// Calls `visit(n, s, ggx)` for every pair of alphas of a table.
template <Sizes S, typename Visit>
void for_each_surface(const Visit& visit) {
    for (std::size_t n = 0; n < S.narrows; ++n) {
        for (std::size_t s = 0; s < S.strengths; ++s) {
            const float narrow = narrow_alpha<S>(static_cast<int>(n));
            visit(n, s, Ggx{wide_alpha<S>(narrow, static_cast<int>(s)), narrow});
        }
    }
}

/// Calls `visit(a, c, phi, seen)` for every direction of a table, where `seen` is the alpha that it sees.
template <Sizes S, typename Visit>
void for_each_direction(const Ggx& ggx, const Visit& visit) {
    for (std::size_t a = 0; a < S.angles; ++a) {
        const float phi = 0.5f * kPi * fraction(static_cast<int>(a), S.angles);
        const float seen = seen_alpha<S>(ggx.alpha_x, ggx.alpha_y, std::cos(phi), std::sin(phi));
        for (std::size_t c = 0; c < S.cosines; ++c) visit(a, c, phi, seen);
    }
}

void fill_reflection(Tables& tables) {
    for_each_surface<kReflection>([&](std::size_t n, std::size_t s, const Ggx& ggx) {
        for_each_direction<kReflection>(ggx, [&](std::size_t a, std::size_t c, float phi, float seen) {
            const auto node = static_cast<int>(c);
            tables.single[n][s][a][c] = integrate_reflection({ggx, phi, cosine<kReflection>(node, seen)}).single;
            tables.schlick_share[n][s][a][c] =
                integrate_reflection({ggx, phi, share_cosine<kReflection>(node)}).schlick_share;
        });
    });
    for_each_surface<kReflection>([&](std::size_t n, std::size_t s, const Ggx& ggx) {
        const auto single = [&](const Position& p) { return interpolate<kReflection>(tables.single, p, p.cosine); };
        tables.single_average[n][s] = average<kReflection>(ggx, single);
        tables.schlick_average[n][s] = average<kReflection>(ggx, [&](const Position& p) {
            return single(p) * interpolate<kReflection>(tables.schlick_share, p, p.share_cosine);
        });
    });
}

void fill_dielectric(Tables& tables) {
    for_each_surface<kDielectric>([&](std::size_t n, std::size_t s, const Ggx& ggx) {
        for_each_direction<kDielectric>(ggx, [&](std::size_t a, std::size_t c, float phi, float seen) {
            const auto sums = integrate_dielectric({ggx, phi, cosine<kDielectric>(static_cast<int>(c), seen)});
            for (std::size_t side = 0; side < 2; ++side)
                for (std::size_t e = 0; e < kEtas; ++e)
                    tables.dielectric[side][e][n][s][a][c] = static_cast<float>(sums[side][e] / kSamples);
        });
    });
    for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t e = 0; e < kEtas; ++e) {
            for_each_surface<kDielectric>([&](std::size_t n, std::size_t s, const Ggx& ggx) {
                tables.dielectric_average[side][e][n][s] = average<kDielectric>(ggx, [&](const Position& p) {
                    return interpolate<kDielectric>(tables.dielectric[side][e], p, p.cosine);
                });
            });
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    return write_table_file(argc, argv, "make_ggx_anisotropic_albedo", [](std::ostream& out) {
        const auto tables = std::make_unique<Tables>();
        fill_reflection(*tables);
        fill_dielectric(*tables);
        write_table(out, "Table<kReflection>", "kSingle", tables->single);
        write_table(out, "Table<kReflection>", "kSchlickShare", tables->schlick_share);
        write_table(out, "std::array<std::array<Table<kDielectric>, kEtas>, 2>", "kInterface", tables->dielectric);
        write_table(out, "Averages<kReflection>", "kSingleAverage", tables->single_average);
        write_table(out, "Averages<kReflection>", "kSchlickAverage", tables->schlick_average);
        write_table(out, "std::array<std::array<Averages<kDielectric>, kEtas>, 2>", "kInterfaceAverage",
                    tables->dielectric_average);
    });
}
