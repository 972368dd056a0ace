// Computes the tables of src/bsdf/ggx_anisotropic_albedo.cpp, as make_ggx_albedo.cpp does the isotropic ones. Run by
// the build.
//
// Usage: make_ggx_anisotropic_albedo OUTPUT

#include "bsdf/ggx_anisotropic_albedo_layout.h"
#include "ggx_view.h"
#include "table_writer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace {

using namespace etendue;
using namespace etendue::ggx_anisotropic_layout;

constexpr std::uint32_t kSamples = 2048;

std::uint16_t encode(float value) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * kLargestValue));
}
std::uint16_t encode_missing(float missing) {
    return encode(std::sqrt(missing));
}

/// A surface turned so that a direction with azimuth `phi` sees given slopes.
struct Turned {
    Ggx ggx;
    float phi;

    explicit Turned(const Seen& seen) {
        // Principal axes of the slopes' covariance.
        const double u = static_cast<double>(seen.along) * static_cast<double>(seen.along);
        const double v = static_cast<double>(seen.across) * static_cast<double>(seen.across);
        const double own = static_cast<double>(seen.spread) * static_cast<double>(seen.spread);
        const double mixed = std::sqrt(u * v * (1.0 - own));
        const double wide = 0.5 * (u + v) + std::hypot(0.5 * (u - v), mixed);
        ggx = {static_cast<float>(std::sqrt(wide)), static_cast<float>(std::sqrt(u * v * own / wide))};
        phi = static_cast<float>(0.5 * std::atan2(2.0 * mixed, u - v));
    }
};

struct Sample {
    Vec2f u;
    float weight;  ///< they sum to one
};
/// The i-th point of a lattice that suits the periodic azimuth. Nearly smooth surfaces lose light at the few facets
/// that stand steep, with u.y near 1: most points are there.
Sample sample_at(std::uint32_t i) {
    constexpr double kGolden = 0.6180339887498949;
    const double turns = kGolden * i;
    const float rest = (static_cast<float>(i) + 0.5f) / kSamples;
    return {{static_cast<float>(turns - std::floor(turns)), 1.0f - rest * rest}, 2.0f * rest / kSamples};
}

/// Indices on the other side of an interface, and what is lost of the light that meets it. Laid out for vectors.
template <std::size_t Etas>
struct Losses {
    std::array<float, Etas> eta{};
    std::array<float, Etas> inverse{};
    std::array<float, Etas> grazing{};  ///< squared cosine of the refracted direction at grazing incidence
    std::array<float, Etas> lost{};

    void set(std::size_t i, float relative_eta) {
        eta[i] = relative_eta;
        inverse[i] = 1.0f / relative_eta;
        grazing[i] = (relative_eta - 1.0f) * (relative_eta + 1.0f) * inverse[i] * inverse[i];
    }

    /// Adds what is lost at the facets that `h` stands for; of what they reflect it is `lost_reflected`.
    void add(const GgxView& view, const Ggx& ggx, const Vec3f& h, float weight, float lost_reflected) {
        const Vec3f& wo = view.wo();
        const float o_h = std::max(1e-6f, dot(wo, h));
        const float wo_x = wo.x * ggx.alpha_x;
        const float wo_y = wo.y * ggx.alpha_y;
        const float h_x = h.x * ggx.alpha_x;
        const float h_y = h.y * ggx.alpha_y;
        const float masking = view.masking();
        for (std::size_t i = 0; i < Etas; ++i) {
            const float cos2_t = grazing[i] + o_h * o_h * inverse[i] * inverse[i];
            const float cos_t = std::sqrt(std::max(0.0f, cos2_t));
            // Both halves of the reflectance over one denominator: divisions take most of the time.
            const float parallel = eta[i] * o_h + cos_t;
            const float perpendicular = o_h + eta[i] * cos_t;
            const float p = (eta[i] * o_h - cos_t) * perpendicular;
            const float s = (o_h - eta[i] * cos_t) * parallel;
            const float both = parallel * perpendicular;
            const float bare = 0.5f * (p * p + s * s) / (both * both);
            const float reflected = cos2_t > 0.0f ? bare : 1.0f;
            const float along_h = o_h * inverse[i] - cos_t;
            const float z = h.z * along_h - wo.z * inverse[i];
            const float x = h_x * along_h - wo_x * inverse[i];
            const float y = h_y * along_h - wo_y * inverse[i];
            // Lambda / (masking + Lambda), with the square root's difference to one taken as a product.
            const float below = std::max(-z, 1e-15f);
            const float slope2 = x * x + y * y;
            const float sum = below + std::sqrt(below * below + slope2);
            const float lost_below = slope2 / (2.0f * masking * below * sum + slope2);
            const float lost_transmitted = z < 0.0f ? lost_below : 1.0f;
            lost[i] += weight * (reflected * lost_reflected + (1.0f - reflected) * lost_transmitted);
        }
    }
};

/// Fills what the tables hold of one direction.
void fill_direction(Tables& tables, const Seen& slopes, std::size_t block, std::size_t c) {
    const float cos_theta = cosine(static_cast<int>(c), slopes.along);
    const Turned turned(slopes);
    const GgxView view(turned.ggx, turned.phi, cos_theta);
    Losses<kEtasOutside> outside;
    for (int e = 0; e < kEtasOutside; ++e) outside.set(static_cast<std::size_t>(e), outside_eta(e, cos_theta, slopes));
    Losses<kEtasInside> inside;
    for (int e = 0; e < kEtasInside; ++e)
        inside.set(static_cast<std::size_t>(e), 1.0f / inside_eta(e, cos_theta, slopes));

    double lost = 0.0;
    double schlick = 0.0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Sample sample = sample_at(i);
        const Vec3f h = turned.ggx.sample_visible_normal(view.wo(), sample.u);
        const float lost_reflected = 1.0f - view.weight_reflected(h);
        lost += static_cast<double>(sample.weight * lost_reflected);
        schlick += static_cast<double>(sample.weight * (1.0f - lost_reflected) *
                                       pow5(std::clamp(1.0f - dot(view.wo(), h), 0.0f, 1.0f)));
        outside.add(view, turned.ggx, h, sample.weight, lost_reflected);
        inside.add(view, turned.ggx, h, sample.weight, lost_reflected);
    }
    tables.reflection[block][0][c] = encode_missing(static_cast<float>(lost));
    tables.schlick_share[block][0][c] = encode(static_cast<float>(schlick / (1.0 - lost)));
    for (std::size_t e = 0; e < kEtasOutside; ++e) tables.outside[block][e][c] = encode_missing(outside.lost[e]);
    for (std::size_t e = 0; e < kEtasInside; ++e) tables.inside[block][e][c] = encode_missing(inside.lost[e]);
}

void fill_directional(Tables& tables) {
    const auto fill_along = [&tables](std::size_t a) {
        for (std::size_t x = 0; x < kAcrosses; ++x)
            for (std::size_t s = 0; s < kSpreads; ++s) {
                const Seen slopes{slope(static_cast<int>(a), kAlongNodes), slope(static_cast<int>(x), kAcrossNodes),
                                  spread(static_cast<int>(s))};
                for (std::size_t c = 0; c < kCosines; ++c) fill_direction(tables, slopes, block_index(a, x, s), c);
            }
    };
    std::atomic<std::size_t> next{0};
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
        threads.emplace_back([&] {
            for (std::size_t a = next++; a < kAlongs; a = next++) fill_along(a);
        });
}

/// A direction, where the tables hold it, and what it counts in an average over a cosine-weighted hemisphere.
struct Direction {
    float cos_theta;
    Seen slopes;
    Position position;
    float weight;
};

/// A quarter of the hemisphere, with most cosines where most is missing (ggx_multiple.h) and most azimuths towards
/// what sees the narrow alpha.
std::vector<Direction> directions(float alpha_x, float alpha_y) {
    constexpr int kRings = 64;
    constexpr int kAzimuths = 32;
    const float b2 = 4.0f * alpha_x * alpha_y;
    const float range = std::log1p(1.0f / b2);
    std::vector<Direction> result;
    for (int i = 0; i < kRings; ++i) {
        const float spread2 = b2 * std::expm1((static_cast<float>(i) + 0.5f) / kRings * range);
        const float mu = std::sqrt(std::min(1.0f, spread2));
        const float sine = std::sqrt(1.0f - mu * mu);
        // d(mu²) of this ring's share of the density
        const float ring = (mu * mu + b2) * range / kRings;
        for (int j = 0; j < kAzimuths; ++j) {
            const float t = (static_cast<float>(j) + 0.5f) / kAzimuths;
            const float to_narrow = 0.5f * kPi * t * t;
            const float phi = alpha_x >= alpha_y ? 0.5f * kPi - to_narrow : to_narrow;
            const Seen slopes = seen({sine * std::cos(phi), sine * std::sin(phi), mu}, alpha_x, alpha_y);
            result.push_back({mu, slopes, position(slopes, mu), ring * 2.0f * t / kAzimuths});
        }
    }
    return result;
}

/// Of what the lobes will look up.
template <typename Function>
float average(const std::vector<Direction>& over, const Function& f) {
    double sum = 0.0;
    for (const Direction& d : over) sum += static_cast<double>(d.weight * f(d));
    return static_cast<float>(sum);
}

void fill_averages(Tables& tables) {
    for (std::size_t i = 0; i < kAverageAlphas; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            const auto over = directions(average_alpha(static_cast<int>(i)), average_alpha(static_cast<int>(j)));
            const auto both = [i, j](Averages& averages, float value) { averages[i][j] = averages[j][i] = value; };
            const auto lost = [&](const Direction& d) {
                return missing_from_root(interpolate(tables.reflection, d.position));
            };
            both(tables.reflection_average, std::log(average(over, lost)));
            both(tables.schlick_average, average(over, [&](const Direction& d) {
                     return (1.0f - lost(d)) * interpolate(tables.schlick_share, d.position);
                 }));
            for (std::size_t e = 0; e < kAverageEtas; ++e) {
                const float eta = average_eta(static_cast<int>(e));
                both(tables.interface_average[0][e], std::log(average(over, [&](const Direction& d) {
                         return missing(tables.outside, d.position, outside_place(eta, d.cos_theta, d.slopes));
                     })));
                both(tables.interface_average[1][e], std::log(average(over, [&](const Direction& d) {
                         return missing(tables.inside, d.position, inside_place(eta, d.cos_theta, d.slopes));
                     })));
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
