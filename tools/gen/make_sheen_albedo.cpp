// Computes the tables of src/bsdf/sheen.cpp: the directional albedo of the Charlie model, which passes one at grazing
// angles, and that of the lobe which is held below one. Run by the build.
//
// Usage: make_sheen_albedo OUTPUT

#include "bsdf/charlie.h"
#include "bsdf/sheen_albedo_layout.h"
#include "table_writer.h"

#include <memory>

namespace {

using namespace etendue;
using namespace etendue::sheen_albedo_layout;

/// Integral over wi of `scale(wi.z)` f cos, by a product rule whose steps shrink towards the horizon and towards the
/// plane of incidence, where the lobe of smooth cloth is.
template <typename Scale>
float integrate(const Charlie& charlie, float cos_o, const Scale& scale) {
    constexpr int kSteps = 96;
    // Edge-on light is the limit from just above.
    const float mu = std::max(cos_o, 1e-4f);
    const Vec3f wo{std::sqrt(1.0f - mu * mu), 0.0f, mu};
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const float t = (static_cast<float>(i) + 0.5f) / kSteps;
        const float z = t * t * t;
        const float sine = std::sqrt(1.0f - z * z);
        const double dz = 3.0 * static_cast<double>(t * t) / kSteps;
        double ring = 0.0;
        for (int j = 0; j < kSteps; ++j) {
            const float phi = kPi * (static_cast<float>(j) + 0.5f) / kSteps;
            ring += static_cast<double>(charlie.f_cos(wo, {sine * std::cos(phi), sine * std::sin(phi), z}));
        }
        sum += ring * static_cast<double>(scale(z)) * dz * 2.0 * static_cast<double>(kPi) / kSteps;
    }
    return static_cast<float>(sum);
}

void fill(Tables& tables) {
    for (std::size_t a = 0; a < kAlphas; ++a) {
        const Charlie charlie{alpha(static_cast<int>(a))};
        for (std::size_t c = 0; c < kCosines; ++c)
            tables.unbounded[a][c] = integrate(charlie, cosine(static_cast<int>(c)), [](float) { return 1.0f; });
    }
    for (std::size_t a = 0; a < kAlphas; ++a) {
        const float row_alpha = alpha(static_cast<int>(a));
        const auto row = alpha_place(row_alpha);
        for (std::size_t c = 0; c < kCosines; ++c) {
            const float cos_o = cosine(static_cast<int>(c));
            const float unbounded_o = interpolate(tables.unbounded, row, cosine_place(cos_o));
            tables.bounded[a][c] = integrate(Charlie{row_alpha}, cos_o, [&](float cos_i) {
                return 1.0f / std::max({1.0f, unbounded_o, interpolate(tables.unbounded, row, cosine_place(cos_i))});
            });
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto tables = std::make_unique<Tables>();
    fill(*tables);
    return write_table_file(argc, argv, *tables);
}
