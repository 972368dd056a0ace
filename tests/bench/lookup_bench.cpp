// What the look-ups of one bounce cost, apart from rays: lobes, textures, and the choice of a light or a triangle.
//
// Google Benchmark's own options apply; for example --benchmark_filter=Lobe
#include "bsdf/bsdf.h"
#include "image/write.h"
#include "sampling/alias_table.h"
#include "texture/texture.h"
#include "texture/texture_lookups.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

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

/// A picture of 2048 × 2048 texels in colour, as a file while this lives.
class TextureFile {
  public:
    TextureFile() {
        ImageF image(2048, 2048, 3);
        std::uint32_t state = 1;
        for (float& value : image.pixels) {
            state = state * 1664525u + 1013904223u;
            value = static_cast<float>(state >> 24) / 255.0f;
        }
        write_image(path_, image, {.depth = PixelDepth::UInt8});
    }
    ~TextureFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    TextureFile(const TextureFile&) = delete;
    TextureFile& operator=(const TextureFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_ =
        std::filesystem::temp_directory_path() / ("etendue-bench-" + std::to_string(getpid()) + ".png");
};

constexpr float kTexel = 1.0f / 2048.0f;

/// A walk of points that are a few texels apart, as neighbouring paths are.
std::vector<Vec2f> walk() {
    std::vector<Vec2f> points;
    for (const Input& input : inputs()) points.push_back(input.u * (200.0f * kTexel));
    return points;
}

/// Of `long_axis` by `short_axis` texels.
TextureFootprint ellipse(float long_axis, float short_axis) {
    return {{{long_axis * kTexel * 0.8f, long_axis * kTexel * 0.6f},
             {-short_axis * kTexel * 0.6f, short_axis * kTexel * 0.8f}}};
}

void look_up(benchmark::State& state, const Texture& texture, float long_axis, float short_axis) {
    const std::vector<Vec2f> points = walk();
    const TextureFootprint footprint = ellipse(long_axis, short_axis);
    std::size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(texture.lookup(points[i++ % kInputs], footprint));
}

/// The same for the paths of a block at a time; the time is that of one look-up.
void look_up_many(benchmark::State& state, const Texture& texture, float long_axis, float short_axis) {
    const std::vector<Vec2f> points = walk();
    const TextureFootprint footprint = ellipse(long_axis, short_axis);
    TextureLookups lookups;
    std::size_t i = 0;
    while (state.KeepRunningBatch(kBlockLanes)) {
        lookups.clear();
        for (std::size_t lane = 0; lane < kBlockLanes; ++lane) lookups.add(texture, points[i++ % kInputs], footprint);
        lookups.finish();
        benchmark::DoNotOptimize(lookups[0]);
    }
}

template <typename Function>
void register_texture(const std::string& name, const Texture& texture, const Function& function) {
    const auto add = [&](const char* kind, float long_axis, float short_axis) {
        benchmark::RegisterBenchmark(("Texture/" + name + "/" + kind).c_str(), function, texture, long_axis,
                                     short_axis);
    };
    add("magnified", 0.5f, 0.5f);
    add("circle", 3.0f, 3.0f);
    add("ellipse_2", 6.0f, 3.0f);
    add("ellipse_8", 24.0f, 3.0f);
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
    const TextureFile file;
    const TextureOptions options{.encoding = Encoding::Srgb};
    TextureCache cache(std::uint64_t{1} << 30);
    const Texture resident(MipChain(read_image_levels(file.path()), Encoding::Srgb), options);
    register_texture("resident", resident, look_up);
    register_texture("resident_many", resident, look_up_many);
    register_texture("cached", Texture(cache.add(file.path(), Encoding::Srgb), options), look_up);
    benchmark::RunSpecifiedBenchmarks();
}
