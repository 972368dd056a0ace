#include "profile/profile_runs.h"

#include "picture/render_setup.h"
#include "process/hardware_counters.h"
#include "process/peak_memory.h"
#include "render/progressive_render.h"
#include "render/render_profile.h"
#include "render/tiles.h"
#include "report/profile_figures.h"
#include "session/interrupt.h"
#include "session/progress_display.h"
#include "wave/profile/wave_profile.h"

#include <algorithm>
#include <array>
#include <memory>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Limits the rays of each kind that all threads record together: a quarter of a million, 9 MB.
constexpr std::size_t kRecordedRays = std::size_t{1} << 18;
constexpr int kReplays = 3;
/// Samples of a pixel whose rays are counted one by one for the map of costs.
constexpr std::uint32_t kCostSamples = 4;

double share(std::uint64_t part, std::uint64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole)
                     : std::numeric_limits<double>::quiet_NaN();
}

/// Returns the share of the lanes of packets of 16 that the recorded rays fill.
double packet_fill(const RayRecorder& recorder) {
    constexpr std::size_t kLanes = 16;
    std::size_t lanes = 0;
    for (const std::vector<Ray>& segment : recorder.segments())
        lanes += (segment.size() + kLanes - 1) / kLanes * kLanes;
    return share(recorder.ray_count(), lanes);
}

/// One integrator on one number of threads, with what it needs to render.
struct Setup {
    std::unique_ptr<const Integrator> integrator;
    std::shared_ptr<const ThreadPool> threads;
    RenderOptions options;
    ProfileRun run;
};

/// Renders until `seconds` are over or there are `spp` samples; false if it is interrupted.
bool render_for(ProgressiveRender& render, double seconds, std::uint32_t spp) {
    while (render.state().spp_done < spp && render.state().wall_seconds < seconds)
        if (!render.add_samples(pass_size(render.state().spp_done, spp), [] { return interrupt_requested().load(); }))
            return false;
    return true;
}

class RunMeasurement {
  public:
    RunMeasurement(const World& world, const SceneHitNames& names, const RenderSettings& settings,
                   const ProfileRequest& request)
        : world_(world), names_(names), request_(request), display_("profile", request.quiet) {
        std::vector<std::shared_ptr<const ThreadPool>> pools;
        for (const int threads : request.threads) pools.push_back(std::make_shared<const ThreadPool>(threads));
        for (const std::string& name : request.integrators) {
            RenderSettings of_run = settings;
            of_run.integrator.type = name;
            for (const auto& pool : pools) {
                Setup& setup = setups_.emplace_back();
                setup.integrator = create_integrator(of_run);
                setup.threads = pool;
                setup.options = make_render_options(of_run);
                setup.run.integrator = name;
                setup.run.threads = pool->thread_count();
                setup.run.light_samples = static_cast<int>(settings.integrator.light_samples);
            }
        }
        steps_ = setups_.size() * static_cast<std::size_t>(request.repetitions + 2) + request.integrators.size();
    }

    ProfileRuns measure() {
        for (Setup& setup : setups_)
            if (!choose_samples(setup)) return finish(true);
        for (int repetition = 0; repetition < request_.repetitions; ++repetition)
            for (Setup& setup : setups_)
                if (!repeat(setup)) return finish(true);
        result_.peak_memory_bytes = peak_memory_bytes();
        for (Setup& setup : setups_)
            if (!instrument(setup)) return finish(true);
        for (const std::string& name : request_.integrators)
            if (!map_costs(name)) return finish(true);
        compare_threads();
        return finish(false);
    }

  private:
    ProfileRuns finish(bool interrupted) {
        for (Setup& setup : setups_) result_.runs.push_back(std::move(setup.run));
        result_.interrupted = interrupted;
        return std::move(result_);
    }

    void show_step() {
        ++step_;
        display_.update({.fraction = static_cast<double>(step_) / static_cast<double>(steps_),
                         .seconds = seconds_,
                         .samples = samples_,
                         .rays = rays_});
    }

    [[nodiscard]] bool render(Setup& setup, ProgressiveRender& progressive, double seconds, std::uint32_t spp) {
        const bool done = render_for(progressive, seconds, spp);
        const RenderState& state = progressive.state();
        seconds_ += state.wall_seconds;
        samples_ += state.counters.samples;
        rays_ += state.counters.rays.total();
        show_step();
        const std::size_t pixels = setup.options.window.area();
        result_.film_bytes = std::max(
            result_.film_bytes, pixels * sizeof(PixelSum) +
                                    (setup.integrator->makes_splats() ? pixels * sizeof(SplatSum) : std::size_t{0}));
        result_.wave_bytes = std::max(result_.wave_bytes, progressive.scratch_bytes());
        result_.tile_bytes = std::max(result_.tile_bytes, progressive.tile_bytes());
        return done;
    }

    /// How many samples fit into the time.
    bool choose_samples(Setup& setup) {
        ProgressiveRender progressive(world_, *setup.integrator, setup.options, *setup.threads);
        constexpr std::uint32_t kMost = 1u << 20;
        if (!render(setup, progressive, request_.spp ? 0.0 : request_.seconds, kMost)) return false;
        setup.run.spp = request_.spp.value_or(progressive.state().spp_done);
        return true;
    }

    bool repeat(Setup& setup) {
        ProgressiveRender progressive(world_, *setup.integrator, setup.options, *setup.threads);
        const ProcessorCounters counters;
        if (!render(setup, progressive, std::numeric_limits<double>::infinity(), setup.run.spp)) return false;
        ProfileRun& run = setup.run;
        const RenderState& state = progressive.state();
        run.hardware.unavailable = counters.unavailable();
        run.hardware.values.clear();
        for (const ProcessorCounters::Count& count : counters.read())
            run.hardware.values.push_back({count.name, count.value});
        run.seconds.push_back(state.wall_seconds);
        run.cpu_seconds.push_back(state.cpu_seconds);
        run.samples = state.counters.samples;
        run.rays = state.counters.rays.total();
        return true;
    }

    bool instrument(Setup& setup) {
        ProfileRun& run = setup.run;
        const auto threads = static_cast<std::size_t>(run.threads);
        RenderProfile profile(run.threads, kRecordedRays / threads);
        RenderOptions options = setup.options;
        options.profile = &profile;
        ProgressiveRender progressive(world_, *setup.integrator, options, *setup.threads);
        if (!render(setup, progressive, std::numeric_limits<double>::infinity(), run.spp)) return false;
        run.instrumented_seconds = progressive.state().wall_seconds;
        run.instrumented_cpu_seconds = progressive.state().cpu_seconds;
        const WaveProfile waves = profile.total();
        result_.rays.add(waves);
        describe_stages(run, profile, waves);
        describe_paths(run, waves);
        describe_tiles(run, profile);
        describe_rays(setup, waves, progressive.state().counters.rays);
        run.scene_hits = count_scene_hits(world_, names_, waves, progressive.state().counters.rays);
        return true;
    }

    static void describe_stages(ProfileRun& run, const RenderProfile& profile, const WaveProfile& waves) {
        const double all = run.instrumented_seconds * run.threads;
        double known = 0.0;
        for (std::size_t i = 0; i < kStages; ++i) {
            const auto stage = static_cast<Stage>(i);
            double seconds = waves.clock().seconds(stage);
            if (stage == Stage::Splat) seconds += profile.splat_seconds();
            known += seconds;
            run.stages.push_back({std::string(kStageNames[i]), seconds});
        }
        run.stages.push_back({"other", std::max(0.0, all - known)});
        run.timing_share = StageClock::seconds_per_stamp() * static_cast<double>(waves.clock().stamps()) / all;
    }

    static PathsReport describe(const PathTally& tally) {
        PathsReport report{.lengths = tally.lengths()};
        if (report.lengths.empty()) return report;
        for (std::size_t i = 0; i < kPathEndings; ++i)
            report.endings.push_back(
                {std::string(kPathEndingNames[i]), static_cast<double>(tally.paths(static_cast<PathEnding>(i)))});
        return report;
    }

    static void describe_paths(ProfileRun& run, const WaveProfile& waves) {
        run.eye_paths = describe(waves.eye_paths());
        run.light_paths = describe(waves.light_paths());
        for (const LongPath& path : waves.longest())
            run.longest.push_back({.x = path.x, .y = path.y, .sample = path.sample, .vertices = path.rays + 1});
        const SampleUse& use = waves.use();
        run.bsdf_absorbed = share(waves.eye_paths().paths(PathEnding::Absorbed), use.bsdf_samples);
        run.bsdf_met_light = share(use.bsdf_met_light, use.bsdf_samples + use.phase_samples);
    }

    static void describe_tiles(ProfileRun& run, const RenderProfile& profile) {
        std::vector<double> busy(static_cast<std::size_t>(run.threads), 0.0);
        for (const TileTime& tile : profile.tiles()) {
            run.tiles.push_back(
                {tile.rect, tile.slot, tile.first_sample, tile.start, tile.end, tile.cpu_seconds, tile.samples});
            busy[static_cast<std::size_t>(tile.slot)] += tile.end - tile.start;
        }
        const double mean = std::accumulate(busy.begin(), busy.end(), 0.0) / static_cast<double>(busy.size());
        run.load_imbalance = mean > 0.0 ? std::ranges::max(busy) / mean - 1.0 : 0.0;
    }

    void describe_rays(Setup& setup, const WaveProfile& waves, const RaysByKind& rays) {
        ProfileRun& run = setup.run;
        double single = 0.0;
        double best = 0.0;
        for (std::size_t i = 0; i < kRayKinds; ++i) {
            const auto kind = static_cast<RayKind>(i);
            if (rays[kind] == 0) continue;
            RayKindReport report{.kind = std::string(kRayKindNames[i]),
                                 .rays = rays[kind],
                                 .seconds = waves.clock().seconds(kind),
                                 .recorded = waves.recorder(kind).ray_count(),
                                 .hit_share = share(waves.hits(kind), rays[kind]),
                                 .packet_fill = packet_fill(waves.recorder(kind))};
            replay(*setup.threads, waves.recorder(kind), kind, report);
            const auto count = static_cast<double>(rays[kind]);
            single += count / report.single;
            best += count / std::max({report.single, report.packet8, report.packet16});
            run.kinds.push_back(std::move(report));
        }
        // All repetitions render the same samples, and so does this one: these are the rays of each of them.
        const double seconds = median(run.cpu_seconds);
        run.efficiency_single = single / seconds;
        run.efficiency_best = best / seconds;
        const std::uint64_t shadow = rays[RayKind::Shadow];
        run.shadow_unoccluded = share(shadow - waves.hits(RayKind::Shadow), shadow);
        run.light_sampling_used = share(shadow, waves.use().light_samples);
    }

    /// Traces the recorded rays again on all threads at once, as they were rendered; each segment counts with the
    /// median of its times.
    void replay(const ThreadPool& threads, const RayRecorder& recorder, RayKind kind, RayKindReport& report) const {
        const Coherence coherence = is_coherent(kind) ? Coherence::Coherent : Coherence::Incoherent;
        const std::span<const std::vector<Ray>> segments = recorder.segments();
        constexpr std::array kForms{QueryForm::Single, QueryForm::Packet8, QueryForm::Packet16};
        // Other programs seldom take the processor during the microseconds of a segment, and hardly ever in two rounds
        // of the same segment.
        std::array<std::vector<std::vector<double>>, kForms.size()> seconds;
        seconds.fill(std::vector<std::vector<double>>(segments.size()));
        const auto parts = static_cast<std::size_t>(threads.thread_count());
        for (int round = 0; round < kReplays; ++round)
            for (std::size_t form = 0; form < kForms.size(); ++form)
                threads.parallel_for(parts, [&](std::size_t part, int) {
                    for (std::size_t s = part; s < segments.size(); s += parts)
                        seconds[form][s].push_back(
                            world_.geometry().replay(segments[s], asks_for_occlusion(kind), coherence, kForms[form]));
                });
        const auto rate_of = [&](std::size_t form) {
            double sum = 0.0;
            for (const std::vector<double>& of_segment : seconds[form]) sum += median(of_segment);
            return static_cast<double>(report.recorded) / sum;
        };
        report.single = rate_of(0);
        report.packet8 = rate_of(1);
        report.packet16 = rate_of(2);
    }

    /// Makes the map of costs of `integrator`, from its run on most threads; the rays are counted by a render of their
    /// own, which layers make slower. Returns false if it was interrupted.
    bool map_costs(const std::string& integrator) {
        const auto setup = std::ranges::max_element(
            setups_, {}, [&](const Setup& s) { return s.run.integrator == integrator ? s.run.threads : 0; });
        RenderOptions options = setup->options;
        auto aovs = std::make_shared<AovSet>();
        aovs->layout.has_ray_counts = true;
        options.aovs = aovs;
        ProgressiveRender progressive(world_, *setup->integrator, options, *setup->threads);
        if (!render(*setup, progressive, std::numeric_limits<double>::infinity(),
                    std::min(kCostSamples, setup->run.spp)))
            return false;
        CostMap map{.integrator = integrator, .rays = progressive.state().film.resolve_ray_counts()};
        map.seconds.resize(map.rays.size());
        const PixelRect& window = options.window;
        for (const TileCost& tile : most_expensive_tiles(setup->run)) {
            const auto for_pixels = [&](const auto& visit) {
                for (int y = tile.rect.y0; y < tile.rect.y1; ++y)
                    for (int x = tile.rect.x0; x < tile.rect.x1; ++x)
                        visit(static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(window.width()) +
                              static_cast<std::size_t>(x - window.x0));
            };
            double rays = 0.0;
            for_pixels([&](std::size_t p) { rays += static_cast<double>(map.rays[p]); });
            const double seconds = tile.cpu_seconds_per_sample * static_cast<double>(tile.rect.area());
            if (rays > 0.0)
                for_pixels([&](std::size_t p) {
                    map.seconds[p] = static_cast<float>(seconds * (static_cast<double>(map.rays[p]) / rays));
                });
        }
        result_.costs.push_back(std::move(map));
        return true;
    }

    /// Compares runs with those on one thread, by the medians of the times that are reported.
    void compare_threads() {
        for (Setup& setup : setups_) {
            const auto alone = std::ranges::find_if(setups_, [&](const Setup& other) {
                return other.run.threads == 1 && other.run.integrator == setup.run.integrator;
            });
            if (alone == setups_.end()) continue;
            setup.run.parallel_efficiency =
                samples_per_second(setup.run) / (samples_per_second(alone->run) * setup.run.threads);
        }
    }

    const World& world_;
    const SceneHitNames& names_;
    const ProfileRequest& request_;
    ProgressDisplay display_;
    std::vector<Setup> setups_;
    ProfileRuns result_;
    std::size_t step_ = 0;
    std::size_t steps_ = 1;
    double seconds_ = 0.0;
    std::uint64_t samples_ = 0;
    std::uint64_t rays_ = 0;
};

}  // namespace

ProfileRuns measure_runs(const World& world, const SceneHitNames& names, const RenderSettings& settings,
                         const ProfileRequest& request) {
    return RunMeasurement(world, names, settings, request).measure();
}

}  // namespace etendue
