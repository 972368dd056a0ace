// What the look-ups of one bounce cost, apart from rays: lobes, and the choice of a light or a triangle.
//
// Google Benchmark's own options apply; for example --benchmark_filter=Lobe
#include "bsdf/bsdf.h"
#include "sampling/alias_table.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace {

using namespace etendue;

/// Enough different inputs that branches cannot be learnt, few enough to stay in the first-level cache.
constexpr std::size_t kInputs = 256;

struct Input {
    float u_lobe;
    Vec2f u;
    Vec3f wo;
};

std::vector<Input> inputs() {
    std::vector<Input> list(kInputs);
    std::uint32_t state = 1;
    const auto next = [&] {
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) * 0x1p-24f;
    };
    for (Input& input : list) {
        input = {next(), {next(), next()}, {}};
        const float z = 0.05f + 0.95f * next();
        input.wo = {std::sqrt(1.0f - z * z), 0.0f, z};
    }
    return list;
}

struct NamedLobe {
    const char* name;
    Bsdf lobe;
};

std::vector<NamedLobe> lobes() {
    return {{"diffuse", Diffuse{Rgb(0.5f)}},
            {"metallic_roughness",
             MetallicRoughness{.base = Rgb(0.5f), .metallic = 0.0f, .alpha_x = 0.25f, .alpha_y = 0.25f}},
            {"rough_conductor", RoughConductor{FresnelMetal::from_f0_f82(Rgb(0.9f), Rgb(0.8f)), 0.25f}},
            {"rough_dielectric", RoughDielectric::make(1.5f, 0.25f)},
            {"smooth_conductor", SmoothConductor{FresnelMetal::from_f0_f82(Rgb(0.9f), Rgb(0.8f))}},
            {"smooth_dielectric", SmoothDielectric{1.5f}}};
}

void sample_lobe(benchmark::State& state, const Bsdf& lobe) {
    const std::vector<Input> list = inputs();
    std::size_t i = 0;
    for (auto _ : state) {
        const Input& input = list[i++ % kInputs];
        benchmark::DoNotOptimize(sample_bsdf(lobe, input.wo, input.u_lobe, input.u, TransportMode::Radiance));
    }
}

void evaluate_lobe(benchmark::State& state, const Bsdf& lobe) {
    const std::vector<Input> list = inputs();
    std::size_t i = 0;
    for (auto _ : state) {
        const Input& input = list[i % kInputs];
        const Vec3f& wi = list[(i + 7) % kInputs].wo;
        ++i;
        benchmark::DoNotOptimize(evaluate_bsdf(lobe, input.wo, wi, TransportMode::Radiance));
    }
}

void choose_light(benchmark::State& state) {
    const std::vector<Input> list = inputs();
    std::vector<double> weights(static_cast<std::size_t>(state.range(0)));
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = static_cast<double>(i % 17 + 1);
    const AliasTable table(weights);
    std::size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(table.sample(list[i++ % kInputs].u));
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    for (const NamedLobe& named : lobes()) {
        benchmark::RegisterBenchmark((std::string("Lobe/sample/") + named.name).c_str(), sample_lobe, named.lobe);
        benchmark::RegisterBenchmark((std::string("Lobe/evaluate/") + named.name).c_str(), evaluate_lobe, named.lobe);
    }
    benchmark::RegisterBenchmark("AliasTable", choose_light)->Range(16, 1 << 20);
    benchmark::RunSpecifiedBenchmarks();
}
