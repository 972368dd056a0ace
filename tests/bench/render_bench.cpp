// How close a render comes to Embree's own limit.
//
// Usage: bench_render SCENE_DIRECTORY [--spp N] [--size WxH] [--repeat N]
//
// Renders the scene with the path integrator on 1 and 2 threads, records every ray of one render, and traces exactly
// those rays again with bare Embree, as single rays and in packets of 16:
//
//   efficiency = time bare Embree takes for exactly the rays that the renderer traced, as single rays
//                / time that the renderer took
//
// All figures come from one process and are the best of `--repeat` interleaved runs.

#include "app/scene_render.h"
#include "integrator/integrator.h"
#include "render/render.h"
#include "world/compile.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace {

using namespace etendue;
using Clock = std::chrono::steady_clock;

struct Batch {
    std::vector<Ray> rays;
    Coherence coherence;
    bool shadow;
};

/// Keeps every batch; for one thread only.
class Recorder final : public RayObserver {
  public:
    void on_intersect(std::span<const Ray> rays, Coherence coherence) override { add(rays, coherence, false); }
    void on_occluded(std::span<const Ray> rays) override { add(rays, Coherence::Incoherent, true); }
    [[nodiscard]] const std::vector<Batch>& batches() const { return batches_; }

  private:
    void add(std::span<const Ray> rays, Coherence coherence, bool shadow) {
        batches_.push_back({{rays.begin(), rays.end()}, coherence, shadow});
    }
    std::vector<Batch> batches_;
};

template <typename Body>
double seconds(const Body& body) {
    const Clock::time_point start = Clock::now();
    body();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

enum class Kind { Camera, Bounce, Shadow };

/// Seconds to trace the recorded batches of one kind again.
double replay(const World& world, const std::vector<Batch>& batches, QueryForm form, Kind kind) {
    std::vector<Hit> hits;
    std::vector<std::uint8_t> occluded;
    double total = 0.0;
    for (const Batch& batch : batches) {
        const Kind of_batch = batch.shadow                             ? Kind::Shadow
                              : batch.coherence == Coherence::Coherent ? Kind::Camera
                                                                       : Kind::Bounce;
        if (of_batch != kind) continue;
        hits.resize(std::max(hits.size(), batch.rays.size()));
        occluded.resize(std::max(occluded.size(), batch.rays.size()));
        total += seconds([&] {
            if (batch.shadow)
                world.occluded(batch.rays, std::span(occluded).first(batch.rays.size()), form);
            else
                world.intersect(batch.rays, std::span(hits).first(batch.rays.size()), batch.coherence, form);
        });
    }
    return total;
}

struct Arguments {
    std::string scene;
    int spp = 4;
    int width = 512;
    int height = 512;
    int repeat = 5;
};

bool parse(int argc, char** argv, Arguments& arguments) {
    for (int i = 1; i < argc; ++i) {
        const std::string option = argv[i];
        const bool has_value = i + 1 < argc;
        if (option == "--spp" && has_value)
            arguments.spp = std::atoi(argv[++i]);
        else if (option == "--repeat" && has_value)
            arguments.repeat = std::atoi(argv[++i]);
        else if (option == "--size" && has_value &&
                 std::sscanf(argv[++i], "%dx%d", &arguments.width, &arguments.height) == 2)
            continue;
        else if (arguments.scene.empty() && option[0] != '-')
            arguments.scene = option;
        else
            return false;
    }
    return !arguments.scene.empty() && arguments.spp > 0 && arguments.repeat > 0;
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    if (!parse(argc, argv, arguments)) {
        std::fputs("usage: bench_render SCENE_DIRECTORY [--spp N] [--size WxH] [--repeat N]\n", stderr);
        return 2;
    }
    SettingsOverrides overrides;
    overrides.size = {{arguments.width, arguments.height}};
    PreparedScene prepared = prepare_scene(arguments.scene, overrides);
    const IntegratorSettings lengths = prepared.scene.settings.integrator;
    const auto integrator =
        make_integrator("path", {.lengths = {lengths.max_depth, lengths.min_depth, lengths.roulette_depth}});

    RenderOptions options;
    options.full_width = arguments.width;
    options.full_height = arguments.height;
    options.window = {0, 0, arguments.width, arguments.height};
    options.spp = static_cast<std::uint32_t>(arguments.spp);

    const ThreadPool one(1);
    const ColorConfig colors = ColorConfig::built_in();
    ProblemList problems;
    World world = compile_world(std::move(prepared.scene), colors, colors.default_working_space(), one, problems);
    const std::atomic<bool> stop{false};
    const FlushDenormals flush_denormals;

    Recorder recorder;
    world.set_observer(&recorder);
    const RenderResult recorded = render(world, *integrator, options, one, stop, {});
    world.set_observer(nullptr);
    const RenderCounters& counters = recorded.counters;

    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double render_seconds = kInfinity;
    double single[3] = {kInfinity, kInfinity, kInfinity};
    double packet[3] = {kInfinity, kInfinity, kInfinity};
    for (int run = 0; run < arguments.repeat; ++run) {
        render_seconds = std::min(render_seconds, render(world, *integrator, options, one, stop, {}).wall_seconds);
        for (const Kind kind : {Kind::Camera, Kind::Bounce, Kind::Shadow}) {
            const auto k = static_cast<std::size_t>(kind);
            single[k] = std::min(single[k], replay(world, recorder.batches(), QueryForm::Single, kind));
            packet[k] = std::min(packet[k], replay(world, recorder.batches(), QueryForm::Packet16, kind));
        }
    }

    const double rays = static_cast<double>(counters.rays());
    const double samples = static_cast<double>(counters.samples);
    const double counts[3] = {static_cast<double>(counters.camera_rays), static_cast<double>(counters.bounce_rays),
                              static_cast<double>(counters.shadow_rays)};
    constexpr const char* kNames[3] = {"camera", "bounce", "shadow"};
    fmt::print("{}: {}x{}, {} spp, {:.2f} rays per sample, embree {} {}\n", arguments.scene, arguments.width,
               arguments.height, arguments.spp, rays / samples, ray_tracer_version(), world.statistics().isa);
    fmt::print("{:<28}{:>10}{:>12}{:>12}\n", "bare Embree, 1 thread", "Mrays", "single M/s", "packet M/s");
    for (std::size_t k = 0; k < 3; ++k)
        fmt::print("  {:<26}{:>10.2f}{:>12.1f}{:>12.1f}\n", kNames[k], counts[k] * 1e-6, counts[k] / single[k] * 1e-6,
                   counts[k] / packet[k] * 1e-6);
    const double all_single = single[0] + single[1] + single[2];
    const double all_packet = packet[0] + packet[1] + packet[2];
    fmt::print("  {:<26}{:>10.2f}{:>12.1f}{:>12.1f}\n", "all", rays * 1e-6, rays / all_single * 1e-6,
               rays / all_packet * 1e-6);
    fmt::print("path, 1 thread: {:.2f} Mrays/s, {:.3f} Msamples/s, efficiency {:.2f}, {:.0f} ns shading per ray\n",
               rays / render_seconds * 1e-6, samples / render_seconds * 1e-6, all_single / render_seconds,
               (render_seconds - all_packet) / rays * 1e9);

    const ThreadPool two(2);
    std::vector<double> ratios;
    double two_seconds = kInfinity;
    for (int run = 0; run < arguments.repeat; ++run) {
        const double a = render(world, *integrator, options, one, stop, {}).wall_seconds;
        const double b = render(world, *integrator, options, two, stop, {}).wall_seconds;
        two_seconds = std::min(two_seconds, b);
        ratios.push_back(a / b);
    }
    std::sort(ratios.begin(), ratios.end());
    fmt::print("path, 2 threads: {:.2f} Mrays/s, {:.3f} Msamples/s, speed-up {:.2f} to {:.2f}, median {:.2f}\n",
               rays / two_seconds * 1e-6, samples / two_seconds * 1e-6, ratios.front(), ratios.back(),
               ratios[ratios.size() / 2]);
    return 0;
}
