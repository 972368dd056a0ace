// Computes the tables of src/bsdf/ggx_albedo.cpp: directional albedos of single scattering on GGX surfaces, by
// averaging the weights of visible-normal samples over an Owen-scrambled Sobol' sequence, and their averages over the
// hemisphere. Run by the build.
//
// Usage: make_ggx_albedo OUTPUT

#include "bsdf/ggx_albedo_layout.h"
#include "ggx_view.h"
#include "sampling/sobol.h"
#include "table_writer.h"

#include <array>
#include <memory>

namespace {

using namespace etendue;
using namespace etendue::ggx_albedo_layout;

constexpr std::uint32_t kSamples = 4096;

float schlick_share(const GgxView& view) {
    double single = 0.0;
    double schlick = 0.0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3f h = view.normal_of_one_side(i);
        const float weight = view.weight_reflected(h);
        single += static_cast<double>(weight);
        schlick += static_cast<double>(weight * pow5(std::clamp(1.0f - dot(view.wo(), h), 0.0f, 1.0f)));
    }
    return static_cast<float>(schlick / single);
}

struct Directional {
    double single = 0.0;
    std::array<double, kEtasOutside> outside{};
    std::array<double, kEtasInside> inside{};
    std::array<double, kEtasOutside> total_only_outside{};
    std::array<double, kEtasInside> total_only_inside{};
};

/// The same normals serve every index of refraction.
Directional integrate(float alpha, float cos_theta) {
    const GgxView view(Ggx::isotropic(alpha), 0.0f, cos_theta);
    std::array<float, kEtasOutside> outside{};
    std::array<float, kEtasInside> inside{};
    for (int e = 0; e < kEtasOutside; ++e) outside[static_cast<std::size_t>(e)] = outside_eta(e, cos_theta, alpha);
    for (int e = 0; e < kEtasInside; ++e) inside[static_cast<std::size_t>(e)] = 1.0f / inside_eta(e, cos_theta, alpha);
    Directional sum;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3f h = view.normal_of_one_side(i);
        const float reflected = view.weight_reflected(h);
        sum.single += static_cast<double>(reflected);
        for (std::size_t e = 0; e < kEtasOutside; ++e) {
            const auto [fresnel, total_only] = view.weights_of_interface(h, reflected, outside[e]);
            sum.outside[e] += static_cast<double>(fresnel);
            sum.total_only_outside[e] += static_cast<double>(total_only);
        }
        for (std::size_t e = 0; e < kEtasInside; ++e) {
            const auto [fresnel, total_only] = view.weights_of_interface(h, reflected, inside[e]);
            sum.inside[e] += static_cast<double>(fresnel);
            sum.total_only_inside[e] += static_cast<double>(total_only);
        }
    }
    return sum;
}

void fill_directional(Tables& tables) {
    for (std::size_t a = 0; a < kAlphas; ++a) {
        const float row_alpha = alpha(static_cast<int>(a), kAlphas);
        for (std::size_t c = 0; c < kCosines; ++c) {
            const Directional sum = integrate(row_alpha, cosine(static_cast<float>(c), row_alpha));
            tables.single[a][c] = static_cast<float>(sum.single / kSamples);
            for (std::size_t e = 0; e < kEtasOutside; ++e) {
                tables.outside[e][a][c] = static_cast<float>(sum.outside[e] / kSamples);
                tables.total_only_outside[e][a][c] = static_cast<float>(sum.total_only_outside[e] / kSamples);
            }
            for (std::size_t e = 0; e < kEtasInside; ++e) {
                tables.inside[e][a][c] = static_cast<float>(sum.inside[e] / kSamples);
                tables.total_only_inside[e][a][c] = static_cast<float>(sum.total_only_inside[e] / kSamples);
            }
        }
    }
    for (std::size_t a = 0; a < kShareAlphas; ++a)
        for (std::size_t c = 0; c < kCosines; ++c)
            tables.schlick_share[a][c] = schlick_share(
                {Ggx::isotropic(alpha(static_cast<int>(a), kShareAlphas)), 0.0f, share_cosine(static_cast<int>(c))});
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
            const Place<float> c = place(cosine_coordinate(mu, row_alpha), kCosines);
            sum += static_cast<double>(f(mu, c)) * 2.0 * static_cast<double>(mu) * static_cast<double>(step);
        }
    }
    return static_cast<float>(sum);
}

void fill_averages(Tables& tables) {
    for (std::size_t i = 0; i < kAverageAlphas; ++i) {
        const float row_alpha = alpha(static_cast<int>(i), kAverageAlphas);
        const Place<float> a = place(alpha_coordinate(row_alpha, kAlphas), kAlphas);
        const auto single = [&](float, Place<float> c) { return interpolate(tables.single, a, c); };
        const Place share_a = place(alpha_coordinate(row_alpha, kShareAlphas), kShareAlphas);
        const auto schlick = [&](float mu, Place<float> c) {
            const Place share_c = place(share_cosine_coordinate(mu), kCosines);
            return single(mu, c) * interpolate(tables.schlick_share, share_a, share_c);
        };
        tables.single_average[i] = average(row_alpha, single);
        tables.schlick_average[i] = average(row_alpha, schlick);
        for (std::size_t e = 0; e < kAverageEtas; ++e) {
            const float eta = average_eta(static_cast<int>(e));
            const auto outside = [&](const auto& table) {
                return average(row_alpha, [&](float mu, Place<float> c) {
                    return interpolate(table, place(outside_coordinate(eta, mu, row_alpha), kEtasOutside), a, c);
                });
            };
            const auto inside = [&](const auto& table) {
                return average(row_alpha, [&](float mu, Place<float> c) {
                    return interpolate(table, place(inside_coordinate(eta, mu, row_alpha), kEtasInside), a, c);
                });
            };
            tables.dielectric_average[0][e][i] = outside(tables.outside);
            tables.dielectric_average[1][e][i] = inside(tables.inside);
            tables.total_only_average[0][e][i] = outside(tables.total_only_outside);
            tables.total_only_average[1][e][i] = inside(tables.total_only_inside);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto tables = std::make_unique<Tables>();
    fill_directional(*tables);
    fill_averages(*tables);
    return write_table_file(argc, argv, *tables);
}
