// Computes the tables of src/bsdf/ggx_albedo.cpp: directional albedos of single scattering on GGX surfaces, by
// averaging the weights of visible-normal samples over an Owen-scrambled Sobol' sequence, and their averages over the
// hemisphere. Run by the build.
//
// Usage: make_ggx_albedo OUTPUT.inc

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/ggx_albedo_layout.h"
#include "sampling/sobol.h"
#include "table_writer.h"

#include <array>
#include <memory>
#include <ostream>
#include <string>

namespace {

using namespace etendue;
using namespace etendue::ggx_albedo_layout;

constexpr std::uint32_t kSamples = 4096;

struct Tables {
    Slice single;
    ShareSlice schlick_share;
    std::array<std::array<Slice, kEtas>, 2> dielectric;
    Averages single_average;
    Averages schlick_average;
    std::array<std::array<Averages, kEtas>, 2> dielectric_average;
};

/// One surface seen from one direction.
class View {
  public:
    View(float alpha_of_row, float cos_theta) : ggx_(Ggx::isotropic(alpha_of_row)) {
        // Edge-on light is the limit from just above.
        const float mu = std::max(cos_theta, 1e-5f);
        wo_ = {std::sqrt(1.0f - mu * mu), 0.0f, mu};
        masking_ = 1.0f + ggx_.lambda(wo_);
    }

    [[nodiscard]] const Vec3f& wo() const { return wo_; }

    /// Normals on both sides of the plane of incidence scatter alike: half of them suffices.
    [[nodiscard]] Vec3f normal(std::uint32_t i) const {
        const Vec2f u = owen_sobol_2d(i, 1);
        return ggx_.sample_visible_normal(wo_, {0.5f * u.x, u.y});
    }

    /// The weight G2 / G1 of light that leaves along `wi`.
    [[nodiscard]] float weight(const Vec3f& wi) const { return masking_ / (masking_ + ggx_.lambda(wi)); }

    [[nodiscard]] float weight_reflected(const Vec3f& h) const {
        const Vec3f wi = h * (2.0f * dot(wo_, h)) - wo_;
        return wi.z > 0.0f ? weight(wi) : 0.0f;
    }

  private:
    Ggx ggx_;
    Vec3f wo_{0.0f};
    float masking_;
};

float schlick_share(const View& view) {
    double single = 0.0;
    double schlick = 0.0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3f h = view.normal(i);
        const float weight = view.weight_reflected(h);
        single += static_cast<double>(weight);
        schlick += static_cast<double>(weight * pow5(std::clamp(1.0f - dot(view.wo(), h), 0.0f, 1.0f)));
    }
    return static_cast<float>(schlick / single);
}

struct Directional {
    double single = 0.0;
    std::array<std::array<double, kEtas>, 2> dielectric{};
};

/// The same normals serve every index of refraction.
Directional integrate(const View& view) {
    Directional sum;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3f h = view.normal(i);
        const float o_h = dot(view.wo(), h);
        const float reflected = view.weight_reflected(h);
        sum.single += static_cast<double>(reflected);
        for (std::size_t side = 0; side < 2; ++side) {
            for (std::size_t e = 0; e < kEtas; ++e) {
                const float outside = eta(static_cast<int>(e));
                const float relative = side == 0 ? outside : 1.0f / outside;
                const float f = fresnel_dielectric(o_h, relative);
                Vec3f wi;
                const bool refracts = refract(view.wo(), h, relative, wi) && wi.z < 0.0f;
                sum.dielectric[side][e] +=
                    static_cast<double>(f * reflected + (refracts ? (1.0f - f) * view.weight(wi) : 0.0f));
            }
        }
    }
    return sum;
}

void fill_directional(Tables& tables) {
    for (std::size_t a = 0; a < kAlphas; ++a) {
        const float row_alpha = alpha(static_cast<int>(a), kAlphas);
        for (std::size_t c = 0; c < kCosines; ++c) {
            const Directional sum = integrate({row_alpha, cosine(static_cast<float>(c), row_alpha)});
            tables.single[a][c] = static_cast<float>(sum.single / kSamples);
            for (std::size_t side = 0; side < 2; ++side)
                for (std::size_t e = 0; e < kEtas; ++e)
                    tables.dielectric[side][e][a][c] = static_cast<float>(sum.dielectric[side][e] / kSamples);
        }
    }
    for (std::size_t a = 0; a < kShareAlphas; ++a)
        for (std::size_t c = 0; c < kCosines; ++c)
            tables.schlick_share[a][c] =
                schlick_share({alpha(static_cast<int>(a), kShareAlphas), share_cosine(static_cast<int>(c))});
}

/// 2 ∫ f(mu) mu dmu of an interpolated function: what the lobes divide by must be the average of what they look up. `f`
/// takes mu and its place in the row. Steps are even in mu between two nodes, and exact in mu dmu.
template <typename Function>
float average(float row_alpha, const Function& f) {
    constexpr int kSteps = 32;
    double sum = 0.0;
    for (int node = 0; node + 1 < kCosines; ++node) {
        const float first = cosine(static_cast<float>(node), row_alpha);
        const float step = (cosine(static_cast<float>(node + 1), row_alpha) - first) / kSteps;
        for (int i = 0; i < kSteps; ++i) {
            const float mu = first + (static_cast<float>(i) + 0.5f) * step;
            const Place c = place(cosine_coordinate(mu, row_alpha), kCosines);
            sum += static_cast<double>(f(mu, c)) * 2.0 * static_cast<double>(mu) * static_cast<double>(step);
        }
    }
    return static_cast<float>(sum);
}

void fill_averages(Tables& tables) {
    for (std::size_t i = 0; i < kAverageAlphas; ++i) {
        const float row_alpha = alpha(static_cast<int>(i), kAverageAlphas);
        const Place a = place(alpha_coordinate(row_alpha, kAlphas), kAlphas);
        const auto single = [&](float, Place c) { return interpolate(tables.single, a, c); };
        const Place share_a = place(alpha_coordinate(row_alpha, kShareAlphas), kShareAlphas);
        const auto schlick = [&](float mu, Place c) {
            const Place share_c = place(share_cosine_coordinate(mu), kCosines);
            return single(mu, c) * interpolate(tables.schlick_share, share_a, share_c);
        };
        tables.single_average[i] = average(row_alpha, single);
        tables.schlick_average[i] = average(row_alpha, schlick);
        for (std::size_t side = 0; side < 2; ++side)
            for (std::size_t e = 0; e < kEtas; ++e)
                tables.dielectric_average[side][e][i] =
                    average(row_alpha, [&](float, Place c) { return interpolate(tables.dielectric[side][e], a, c); });
    }
}

}  // namespace

int main(int argc, char** argv) {
    return write_table_file(argc, argv, "make_ggx_albedo", [](std::ostream& out) {
        const auto tables = std::make_unique<Tables>();
        fill_directional(*tables);
        fill_averages(*tables);
        write_table(out, "Slice", "kSingle", tables->single);
        write_table(out, "ShareSlice", "kSchlickShare", tables->schlick_share);
        write_table(out, "std::array<std::array<Slice, kEtas>, 2>", "kDielectric", tables->dielectric);
        write_table(out, "Averages", "kSingleAverage", tables->single_average);
        write_table(out, "Averages", "kSchlickAverage", tables->schlick_average);
        write_table(out, "std::array<std::array<Averages, kEtas>, 2>", "kDielectricAverage",
                    tables->dielectric_average);
    });
}
