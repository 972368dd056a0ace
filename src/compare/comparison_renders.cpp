#include "compare/comparison_renders.h"

#include "core/process_time.h"
#include "film/median_of_means.h"
#include "render/progressive_render.h"
#include "render/tiles.h"
#include "report/profile_figures.h"
#include "session/interrupt.h"
#include "session/progress_display.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::uint32_t kMostSamples = 1u << 24;

/// Factor between the samples of one kept image and the next.
constexpr double kStep = 1.4142135623730951;

std::uint32_t next_checkpoint(std::uint32_t spp) {
    return std::max(spp + 1, static_cast<std::uint32_t>(std::lround(std::min(spp * kStep, 2.0 * kMostSamples))));
}

ImageF rgb_of(const Film& film, const AovSet* aovs) {
    const bool is_median = aovs != nullptr && aovs->buckets.count > 0;
    const std::vector<float> rgba = is_median ? median_of_means(film, aovs->buckets) : film.resolve();
    ImageF image(film.window().width(), film.window().height(), 3);
    for (std::size_t i = 0; i < rgba.size() / 4; ++i) std::copy_n(&rgba[4 * i], 3, &image.pixels[3 * i]);
    return image;
}

/// Renders that tell before all others how long a sample takes, of each variant, and what share of the time they take.
constexpr int kCalibrations = 3;
constexpr double kCalibrationShare = 0.1;

/// A render whose time is counted while it renders only.
class TimedRender {
  public:
    TimedRender(const Variant& variant, std::uint32_t seed, const ThreadPool& threads, const RenderBudget& budget,
                const std::string& title, bool quiet, RenderWatcher* watcher = nullptr)
        : variant_(variant),
          watcher_(watcher),
          budget_(budget),
          area_(variant.sampling.window.area()),
          aovs_(variant.sampling.aovs),
          render_(*variant.world, *variant.integrator, with_seed(variant.sampling, seed), threads),
          display_(title, quiet) {
        if (watcher_ == nullptr) return;
        watcher_->begin(title, {});
        watcher_->enter("render");
    }

    /// One more pass, up to `last` samples. False if the time is spent, the samples are taken, or it is interrupted.
    bool advance(std::uint32_t last) {
        const std::uint32_t most = std::min(last, budget_.spp.value_or(kMostSamples));
        if (spp() >= most || (budget_.seconds && time() >= *budget_.seconds && spp() > 0)) return false;
        std::uint32_t count = pass_size(spp(), most);
        if (budget_.seconds) count = fit_pass(count, spp(), time(), *budget_.seconds);
        const bool done = render_.add_samples(count, [] { return interrupt_requested().load(); });
        const double fraction = budget_.seconds ? time() / *budget_.seconds : double(spp()) / double(*budget_.spp);
        // Written so that no fraction at all, as of no time, is 1.
        const RenderProgress progress{.fraction = fraction < 1.0 ? fraction : 1.0,
                                      .seconds = seconds(),
                                      .samples = area_ * spp(),
                                      .rays = state().counters.rays.total()};
        display_.update(progress);
        if (watcher_ != nullptr) show(progress);
        return done;
    }

    [[nodiscard]] std::uint32_t spp() const { return state().spp_done; }
    [[nodiscard]] double seconds() const { return state().wall_seconds; }
    [[nodiscard]] double cpu_seconds() const { return state().cpu_seconds; }
    /// Returns the time that the budget counts.
    [[nodiscard]] double time() const { return budget_.by_wall ? seconds() : cpu_seconds(); }
    [[nodiscard]] ImageF image() const { return rgb_of(state().film, aovs_.get()); }
    [[nodiscard]] RenderCounters counters() const { return state().counters; }

  private:
    [[nodiscard]] const RenderState& state() const { return render_.state(); }
    [[nodiscard]] static RenderOptions with_seed(RenderOptions options, std::uint32_t seed) {
        options.seed = seed;
        return options;
    }

    /// Shows the image, between passes, whose time alone is counted.
    void show(const RenderProgress& progress) {
        constexpr double kSecondsBetween = 0.5;
        watcher_->update(progress);
        if (!watcher_->wants_image() || seconds_since(shown_) < kSecondsBetween) return;
        const ColorSettings& color = variant_.settings.color;
        ImageDescription now;
        now.frame.pixels = image();
        now.frame.working_space = color.working_space;
        now.frame.display = color.display;
        now.frame.view = color.view;
        now.frame.look = color.look;
        now.frame.exposure = color.exposure;
        now.frame.integrator = variant_.settings.integrator.type;
        now.frame.spp = static_cast<int>(spp());
        now.frame.render_seconds = seconds();
        now.statistics.spp_requested = static_cast<int>(budget_.spp.value_or(0));
        watcher_->show(now);
        shown_ = std::chrono::steady_clock::now();
    }

    const Variant& variant_;
    RenderWatcher* watcher_;  ///< null for nobody
    std::chrono::steady_clock::time_point shown_{};
    RenderBudget budget_;
    std::uint64_t area_;
    std::shared_ptr<const AovSet> aovs_;
    ProgressiveRender render_;
    ProgressDisplay display_;
};

/// Renders and calls `keep` wherever an image is kept on the way; returns false if it is interrupted.
bool render_in_steps(TimedRender& render, const std::function<void()>& keep) {
    std::uint32_t next = 1;
    while (render.advance(next)) {
        if (render.spp() < next) continue;
        keep();
        next = next_checkpoint(next);
    }
    return !interrupt_requested();
}

/// Returns how many samples each variant takes in the time of the budget; nothing if it is interrupted. Passes end
/// where they do in the renders that follow.
std::optional<std::vector<std::uint32_t>> calibrated_samples(std::span<const Variant> variants,
                                                             const RendersRequest& request, const ThreadPool& threads) {
    const double wanted = *request.budget.seconds;
    RenderBudget budget = request.budget;
    budget.seconds = kCalibrationShare * wanted;
    std::vector<std::vector<double>> samples_per_second(variants.size());
    for (int round = 0; round < kCalibrations; ++round)
        for (std::size_t v = 0; v < variants.size(); ++v) {
            TimedRender render(variants[v], request.first_seed, threads, budget,
                               fmt::format("{} calibration {}/{}", variants[v].name, round + 1, kCalibrations),
                               request.quiet, request.watcher);
            if (!render_in_steps(render, [] {})) return std::nullopt;
            samples_per_second[v].push_back(render.spp() / render.time());
        }
    std::vector<std::uint32_t> samples;
    samples.reserve(variants.size());
    for (std::vector<double>& of_variant : samples_per_second)
        samples.push_back(static_cast<std::uint32_t>(
            std::clamp(std::round(wanted * median(of_variant)), 1.0, static_cast<double>(kMostSamples))));
    return samples;
}

/// Renders and keeps the images on the way; returns false if it is interrupted.
bool keep_images(TimedRender& render, ImageStore& store, SeedRender& result) {
    const auto keep = [&] {
        result.checkpoints.push_back({render.spp(), render.seconds(), render.cpu_seconds(), store.add(render.image())});
    };
    if (!render_in_steps(render, keep)) return false;
    if (result.checkpoints.back().spp < render.spp()) keep();
    result.counters = render.counters();
    return true;
}

}  // namespace

std::uint32_t render_seed(std::uint32_t first, std::size_t render, std::size_t variant, std::size_t variants) {
    return first + static_cast<std::uint32_t>(render * variants + variant);
}

std::vector<VariantRenders> render_variants(std::span<const Variant> variants, const RendersRequest& request,
                                            ImageStore& store, const ThreadPool& threads) {
    std::vector<VariantRenders> renders(variants.size());
    std::vector<std::uint32_t> samples(variants.size(), request.budget.spp.value_or(0));
    if (request.budget.seconds) {
        auto calibrated = calibrated_samples(variants, request, threads);
        if (!calibrated) return renders;
        samples = std::move(*calibrated);
    }
    for (int seed = 0; seed < request.seeds; ++seed)
        for (std::size_t v = 0; v < variants.size(); ++v) {
            SeedRender result{.seed =
                                  render_seed(request.first_seed, static_cast<std::size_t>(seed), v, variants.size())};
            TimedRender render(variants[v], result.seed, threads, {.spp = samples[v]},
                               fmt::format("{} {}/{}", variants[v].name, seed + 1, request.seeds), request.quiet,
                               request.watcher);
            if (!keep_images(render, store, result)) {
                for (VariantRenders& of_variant : renders) of_variant.seeds.resize(static_cast<std::size_t>(seed));
                return renders;
            }
            renders[v].seeds.push_back(std::move(result));
        }
    return renders;
}

std::optional<ImageF> render_reference(const Variant& variant, double seconds, std::uint32_t seed,
                                       const ThreadPool& threads, bool quiet) {
    TimedRender render(variant, seed, threads, {.seconds = seconds, .by_wall = true}, "reference by " + variant.name,
                       quiet);
    while (render.advance(kMostSamples)) {
    }
    if (interrupt_requested()) return std::nullopt;
    return render.image();
}

}  // namespace etendue
