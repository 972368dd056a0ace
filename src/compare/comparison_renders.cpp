#include "compare/comparison_renders.h"

#include "core/log.h"
#include "core/process_time.h"
#include "film/median_of_means.h"
#include "render/progressive_render.h"
#include "render/tiles.h"
#include "report/human_units.h"
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
        const std::uint32_t before = spp();
        const double begin = time();
        if (before >= most) return false;
        std::uint32_t count = pass_size(before, most);
        if (budget_.seconds && before > 0) {
            count = fit_samples(count, *budget_.seconds - begin, sample_seconds_);
            if (count == 0) return false;
        }
        const bool done = render_.add_samples(count, [] { return interrupt_requested().load(); });
        // By the last pass alone: the first samples take what is made once, such as tables, besides.
        if (spp() > before) sample_seconds_ = (time() - begin) / (spp() - before);
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
    double sample_seconds_ = 0.0;  ///< time of a sample of every pixel in the last pass
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

/// Renders a sample of every variant, so that no render whose time is counted is the first to read what all use;
/// returns false if it is interrupted.
bool warm_up(std::span<const Variant> variants, const RendersRequest& request, const ThreadPool& threads) {
    for (const Variant& variant : variants) {
        TimedRender render(variant, request.first_seed, threads, {.spp = 1}, variant.name + " warm-up", request.quiet,
                           request.watcher);
        if (!render_in_steps(render, [] {})) return false;
    }
    return true;
}

/// Renders for `seconds`; returns what samples cost, or nothing if it is interrupted.
std::optional<SampleCost> measured_cost(TimedRender& render, double seconds) {
    struct Mark {
        std::uint32_t spp;
        double time;
    };
    render.advance(1);
    Mark late{render.spp(), render.time()};
    SampleCost cost{.first = late.time, .next = late.time};
    // The later half tells the cost, since merge radii shrink, and the cost with them.
    while (render.advance(kMostSamples))
        if (render.time() < 0.5 * seconds) late = {render.spp(), render.time()};
    if (render.spp() > late.spp) cost.next = (render.time() - late.time) / (render.spp() - late.spp);
    return interrupt_requested() ? std::nullopt : std::optional(cost);
}

/// Finds by short renders how many samples of each variant take the time of the budget; returns nothing if it is
/// interrupted.
std::optional<std::vector<RenderBudget>> calibrate(std::span<const Variant> variants, const RendersRequest& request,
                                                   const ThreadPool& threads) {
    constexpr std::uint32_t kRenders = 3;
    constexpr double kShare = 0.2;
    RenderBudget part = request.budget;
    *part.seconds *= kShare;
    std::vector<std::vector<SampleCost>> costs(variants.size());
    for (std::uint32_t i = 0; i < kRenders; ++i)
        for (std::size_t v = 0; v < variants.size(); ++v) {
            TimedRender render(variants[v], request.first_seed + i, threads, part,
                               fmt::format("{} calibration {}/{}", variants[v].name, i + 1, kRenders), request.quiet,
                               request.watcher);
            const std::optional<SampleCost> cost = measured_cost(render, *part.seconds);
            if (!cost) return std::nullopt;
            costs[v].push_back(*cost);
        }
    std::vector<RenderBudget> budgets;
    for (const std::vector<SampleCost>& of_variant : costs)
        budgets.push_back({.spp = calibrated_samples(*request.budget.seconds, of_variant)});
    return budgets;
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

/// Renders a variant with one seed, and keeps the images on the way; returns nothing if it is interrupted.
std::optional<SeedRender> render_once(const Variant& variant, std::uint32_t seed, const RenderBudget& budget,
                                      const std::string& title, const RendersRequest& request, ImageStore& store,
                                      const ThreadPool& threads) {
    SeedRender result{.seed = seed};
    TimedRender render(variant, seed, threads, budget, title, request.quiet, request.watcher);
    return keep_images(render, store, result) ? std::optional(std::move(result)) : std::nullopt;
}

/// Returns the samples with which `render` would have taken the time that is asked for: its own if it did not miss it.
std::uint32_t fitting_samples(const RenderBudget& asked, const SeedRender& render) {
    const Snapshot& last = render.checkpoints.back();
    return asked.seconds ? corrected_samples(last.spp, asked.by_wall ? last.seconds : last.cpu_seconds, *asked.seconds)
                         : last.spp;
}

/// Says how long all renders take at least, if they take a time that was asked for.
void announce(std::size_t variants, const RendersRequest& request, const ThreadPool& threads) {
    if (const double seconds = least_seconds(variants, request, threads.thread_count());
        seconds > 0.0 && !request.quiet)
        log_info("{} {} by {} {} take {} at least", variants, variants == 1 ? "variant" : "variants", request.seeds,
                 request.seeds == 1 ? "seed" : "seeds", human_seconds(seconds));
}

}  // namespace

std::uint32_t fit_samples(std::uint32_t wanted, double seconds, double sample_seconds) {
    if (seconds <= 0.0) return 0;
    const double fitting = std::round(seconds / sample_seconds);
    return fitting < wanted ? static_cast<std::uint32_t>(fitting) : wanted;
}

std::uint32_t calibrated_samples(double seconds, std::span<const SampleCost> costs) {
    constexpr double kLeastSeconds = 1e-9;
    std::vector<double> samples;
    for (const SampleCost& cost : costs)
        samples.push_back(1.0 + std::max(0.0, seconds - cost.first) / std::max(cost.next, kLeastSeconds));
    std::ranges::sort(samples);
    return static_cast<std::uint32_t>(std::lround(std::min(samples.at(samples.size() / 2), double(kMostSamples))));
}

std::uint32_t corrected_samples(std::uint32_t samples, double taken, double asked) {
    constexpr double kMostOff = 0.2;
    if (!(taken > 0.0) || std::abs(taken / asked - 1.0) <= kMostOff) return samples;
    const double corrected = std::min(samples * asked / taken, double(kMostSamples));
    return static_cast<std::uint32_t>(std::lround(std::max(1.0, corrected)));
}

double least_seconds(std::size_t variants, const RendersRequest& request, int threads) {
    if (!request.budget.seconds) return 0.0;
    const double of_render = *request.budget.seconds / (request.budget.by_wall ? 1.0 : threads);
    return static_cast<double>(variants) * request.seeds * of_render;
}

std::uint32_t render_seed(std::uint32_t first, std::size_t render, std::size_t variant, std::size_t variants) {
    return first + static_cast<std::uint32_t>(render * variants + variant);
}

std::vector<VariantRenders> render_variants(std::span<const Variant> variants, const RendersRequest& request,
                                            ImageStore& store, const ThreadPool& threads) {
    std::vector<VariantRenders> renders(variants.size());
    // All renders of a variant take equally many samples; a single render may spend the time exactly.
    std::vector<RenderBudget> budgets(variants.size(), request.budget);
    announce(variants.size(), request, threads);
    if (request.budget.seconds && request.seeds == 1 && !warm_up(variants, request, threads)) return renders;
    if (request.budget.seconds && request.seeds > 1) {
        std::optional<std::vector<RenderBudget>> calibrated = calibrate(variants, request, threads);
        if (!calibrated) return renders;
        budgets = std::move(*calibrated);
    }
    for (int seed = 0; seed < request.seeds; ++seed)
        for (std::size_t v = 0; v < variants.size(); ++v) {
            const std::uint32_t number =
                render_seed(request.first_seed, static_cast<std::size_t>(seed), v, variants.size());
            const std::string title = fmt::format("{} {}/{}", variants[v].name, seed + 1, request.seeds);
            std::optional<SeedRender> result =
                render_once(variants[v], number, budgets[v], title, request, store, threads);
            // The first render may find that the calibration, whose renders are short, missed the time.
            if (result && seed == 0 && request.seeds > 1)
                if (const std::uint32_t samples = fitting_samples(request.budget, *result);
                    samples != result->checkpoints.back().spp)
                    result =
                        render_once(variants[v], number, {.spp = samples}, title + " again", request, store, threads);
            if (!result) {
                for (VariantRenders& of_variant : renders) of_variant.seeds.resize(static_cast<std::size_t>(seed));
                return renders;
            }
            budgets[v] = {.spp = result->checkpoints.back().spp};
            renders[v].seeds.push_back(std::move(*result));
        }
    return renders;
}

std::optional<ReferenceRenders> render_reference(const Variant& variant, const RenderBudget& budget,
                                                 std::uint32_t first_seed, const ThreadPool& threads, bool quiet) {
    ReferenceRenders result;
    RenderBudget of_one = budget;
    if (of_one.seconds) *of_one.seconds /= kReferenceRenders;
    for (std::uint32_t i = 0; i < kReferenceRenders; ++i) {
        TimedRender render(variant, first_seed + i, threads, of_one,
                           fmt::format("reference by {} {}/{}", variant.name, i + 1, kReferenceRenders), quiet);
        while (render.advance(kMostSamples)) {
        }
        if (interrupt_requested()) return std::nullopt;
        result.images.push_back(render.image());
        result.spp = render.spp();
        result.seconds += render.seconds();
        result.cpu_seconds += render.cpu_seconds();
        of_one = {.spp = render.spp()};
    }
    return result;
}

}  // namespace etendue
