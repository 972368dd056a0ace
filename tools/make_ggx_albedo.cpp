// Computes the tables of src/bsdf/ggx_albedo.cpp: directional albedos of single scattering on GGX surfaces, by averaging
// the weights of visible-normal samples over an Owen-scrambled Sobol' sequence. Run by the build.
//
// Usage: make_ggx_albedo OUTPUT.inc

#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/ggx_albedo_layout.h"
#include "sampling/sobol.h"

namespace {

using namespace etendue;
using namespace etendue::ggx_albedo_layout;

constexpr std::uint32_t kSamples = 1024;

struct Setting {
    Ggx ggx;
    Vec3f wo;
};

// At the ends of the table the surface is smooth or seen edge-on; the limits are reached from just inside.
Setting setting(int alpha_node, int cosine_node) {
    const float a = std::max(alpha(alpha_node), 1e-4f);
    const float mu = std::max(cosine(cosine_node), 1e-4f);
    return {{a}, {std::sqrt(1.0f - mu * mu), 0.0f, mu}};
}

struct Reflection {
    double single = 0.0;
    double schlick = 0.0;
};

Reflection integrate_reflection(const Setting& s) {
    Reflection sum;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3f h = s.ggx.sample_visible_normal(s.wo, owen_sobol_2d(i, 1));
        const Vec3f wi = h * (2.0f * dot(s.wo, h)) - s.wo;
        if (wi.z <= 0.0f) continue;
        const float weight = s.ggx.g2(s.wo, wi) / s.ggx.g1(s.wo);
        sum.single += static_cast<double>(weight);
        sum.schlick += static_cast<double>(weight * pow5(std::clamp(1.0f - dot(s.wo, h), 0.0f, 1.0f)));
    }
    return {sum.single / kSamples, sum.schlick / kSamples};
}

double integrate_dielectric(const Setting& s, float eta) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3f h = s.ggx.sample_visible_normal(s.wo, owen_sobol_2d(i, 1));
        const float f = fresnel_dielectric(dot(s.wo, h), eta);
        const Vec3f reflected = h * (2.0f * dot(s.wo, h)) - s.wo;
        if (reflected.z > 0.0f) sum += static_cast<double>(f * s.ggx.g2(s.wo, reflected) / s.ggx.g1(s.wo));
        Vec3f refracted;
        if (refract(s.wo, h, eta, refracted) && refracted.z < 0.0f)
            sum += static_cast<double>((1.0f - f) * s.ggx.g2(s.wo, refracted) / s.ggx.g1(s.wo));
    }
    return sum / kSamples;
}

template <typename Value>
void write_slice(std::ostream& out, const Value& value) {
    char text[32];
    out << "{{";
    for (int a = 0; a < kAlphas; ++a) {
        out << (a == 0 ? "{{" : ",\n{{");
        for (int c = 0; c < kCosines; ++c) {
            std::snprintf(text, sizeof(text), "%s%.6ff", c == 0 ? "" : ",", value(setting(a, c)));
            out << text;
        }
        out << "}}";
    }
    out << "}}";
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: make_ggx_albedo OUTPUT.inc\n";
        return 2;
    }
    std::ofstream out(argv[1]);
    out << "const std::array<std::array<float, kCosines>, kAlphas> kSingle = ";
    write_slice(out, [](const Setting& s) { return integrate_reflection(s).single; });
    out << ";\nconst std::array<std::array<float, kCosines>, kAlphas> kSchlick = ";
    write_slice(out, [](const Setting& s) { return integrate_reflection(s).schlick; });
    out << ";\nconst std::array<std::array<std::array<std::array<float, kCosines>, kAlphas>, kEtas>, 2> kDielectric = {{";
    for (int side = 0; side < 2; ++side) {
        out << (side == 0 ? "{{" : ",{{");
        for (int e = 0; e < kEtas; ++e) {
            if (e > 0) out << ",\n";
            write_slice(out,
                        [&](const Setting& s) { return integrate_dielectric(s, side == 0 ? eta(e) : 1.0f / eta(e)); });
        }
        out << "}}";
    }
    out << "}};\n";
    out.flush();
    if (!out) {
        std::cerr << "make_ggx_albedo: cannot write " << argv[1] << "\n";
        return 1;
    }
    return 0;
}
