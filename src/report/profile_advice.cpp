#include "report/profile_advice.h"

#include "report/human_units.h"
#include "report/profile_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Shares of the time from which on something is worth a sentence.
constexpr double kMuchTime = 0.1;
constexpr double kMuchWaiting = 0.15;

struct Advice {
    double share = 0.0;  ///< share of the time
    std::string text{};
};

const RayKindReport* kind_of(const ProfileRun& run, std::string_view name) {
    const auto found = std::ranges::find(run.kinds, name, &RayKindReport::kind);
    return found == run.kinds.end() ? nullptr : &*found;
}

double stage_share(const ProfileRun& run, std::string_view name) {
    const auto found = std::ranges::find(run.stages, name, &NamedValue::name);
    return found == run.stages.end() ? 0.0 : rate(found->value, sum_of(run.stages));
}

/// Shares of the threads' time in the repetition with instruments.
struct ThreadTime {
    double waiting = 0.0;  ///< without a tile while others have one; none of a single thread
    double taken = 0.0;    ///< by other programs or the system; NaN if it is not known
};

ThreadTime thread_time(const ProfileRun& run) {
    double tiles = 0.0, cpu = 0.0;
    for (const TileReport& tile : run.tiles) {
        tiles += tile.end - tile.start;
        cpu += tile.cpu_seconds;
    }
    const double all = run.instrumented_seconds * run.threads;
    // Waiting takes as much longer as tiles do, of which others have taken some; between tiles there is work, too.
    const double without_tile = run.threads > 1 ? std::max(0.0, all - tiles) * rate(cpu, tiles) : 0.0;
    const double idle = std::max(0.0, without_tile - std::max(0.0, run.instrumented_cpu_seconds - cpu));
    return {rate(without_tile, all), 1.0 - rate(run.instrumented_cpu_seconds + idle, all)};
}

class Adviser {
  public:
    explicit Adviser(const ProfileRun& run) : run_(run), all_(sum_of(run.stages)) {}

    [[nodiscard]] std::vector<std::string> sentences() {
        rays();
        light_samples();
        stages();
        long_paths();
        threads();
        std::ranges::stable_sort(found_, std::ranges::greater{}, &Advice::share);
        std::vector<std::string> texts;
        texts.reserve(found_.size());
        for (const Advice& advice : found_) texts.push_back(advice.text);
        return texts;
    }

  private:
    void add(double share, double least, std::string text) {
        if (share >= least) found_.push_back({share, std::move(text)});
    }

    void rays() {
        for (const RayKindReport& kind : run_.kinds) {
            const double share = rate(kind.seconds, all_);
            if (!(share >= kMuchTime)) continue;
            std::string text = fmt::format("{} rays are {} of the time", kind.kind, human_percent(share));
            if (kind.kind == "shadow" && kind.hit_share > 0.0)
                text += fmt::format("; {} of them are blocked{}", human_percent(kind.hit_share), most_blocked());
            // Full packets take hardly longer than those that are half full.
            if (kind.packet_fill < 0.75)
                text += fmt::format("; their packets are {} full{}", human_percent(kind.packet_fill),
                                    run_.spp < 16 ? ", and with --spp 16 or more they are fuller" : "");
            add(share, kMuchTime, text);
        }
    }

    /// Names the lamp to which most of the blocked shadow rays went, if there are several.
    [[nodiscard]] std::string most_blocked() const {
        const auto& lamps = run_.scene_hits.lamps;
        if (lamps.size() < 2) return "";
        double blocked = 0.0;
        for (const LampReport& lamp : lamps) blocked += lamp.blocked;
        const auto most = std::ranges::max_element(lamps, {}, &LampReport::blocked);
        return blocked > 0.0
                   ? fmt::format(", {} of those on the way to '{}'", human_percent(most->blocked / blocked), most->name)
                   : "";
    }

    void light_samples() {
        const RayKindReport* const shadow = kind_of(run_, "shadow");
        const RayKindReport* const camera = kind_of(run_, "camera");
        if (shadow == nullptr || camera == nullptr || run_.light_samples < 2 || !(run_.light_sampling_used > 0.0))
            return;
        // What the eye sees directly has so many light samples at each point, all else one.
        const double samples = static_cast<double>(shadow->rays) / run_.light_sampling_used;
        const double saved = (run_.light_samples - 1) * static_cast<double>(camera->rays) * camera->hit_share;
        const double share =
            std::min(1.0, saved / samples) * (rate(shadow->seconds, all_) + stage_share(run_, "light sampling"));
        add(share, 0.02,
            fmt::format("--light-samples 1 in place of {} saves about {}, and direct light has more noise",
                        run_.light_samples, human_percent(share)));
    }

    void stages() {
        const double textures = stage_share(run_, "textures");
        add(textures, kMuchTime,
            fmt::format("textures are {} of the time{}", human_percent(textures), most_of(run_.scene_hits.textures)));
        const double material = stage_share(run_, "material evaluation");
        add(material, 0.2,
            fmt::format("evaluating materials is {} of the time{}", human_percent(material),
                        most_of(run_.scene_hits.materials)));
        add(rate(run_.bsdf_absorbed * material, 1.0), 0.02,
            fmt::format(
                "{} of the BSDF samples have no weight: material evaluation, {} of the time, makes them in vain",
                human_percent(run_.bsdf_absorbed), human_percent(material)));
    }

    [[nodiscard]] static std::string most_of(const std::vector<NamedValue>& hits) {
        if (hits.size() < 2) return "";
        return fmt::format("; '{}' has {} of the hits", hits.front().name,
                           human_percent(rate(hits.front().value, sum_of(hits))));
    }

    void long_paths() {
        constexpr std::array<std::size_t, 3> kDepths{4, 8, 16};
        const RayKindReport* const bounce = kind_of(run_, "bounce");
        if (bounce == nullptr) return;
        double rays = 0.0;
        const auto beyond = [&](std::size_t depth) {
            double count = 0.0;
            for (std::size_t length = depth + 1; length < run_.eye_paths.lengths.size(); ++length)
                count += static_cast<double>((length - depth) * run_.eye_paths.lengths[length]);
            return count;
        };
        rays = beyond(0);
        for (const std::size_t depth : kDepths) {
            const double share = rate(beyond(depth), rays);
            if (!(share >= 0.02 && share < 0.5)) continue;
            add(share, 0.02,
                fmt::format("{} of the rays of eye paths lie beyond their ray number {}: --max-depth {} saves about "
                            "that, and the light of longer paths is missing",
                            human_percent(share), depth, depth));
            return;
        }
    }

    void threads() {
        const double waiting = thread_time(run_).waiting;
        add(waiting, kMuchWaiting,
            fmt::format(
                "threads have no tile for {} of their time, most of it at the ends of passes; larger images and "
                "more --spp leave less of it",
                human_percent(waiting)));
        if (run_.threads > 1 && run_.parallel_efficiency < 0.8)
            add(1.0 - run_.parallel_efficiency, 0.0,
                fmt::format("{} threads do the work of {:.1f}", run_.threads, run_.threads * run_.parallel_efficiency));
        add(run_.load_imbalance, kMuchWaiting,
            fmt::format("the busiest thread renders {} longer than the mean of all: tiles are unequal, or few",
                        human_percent(run_.load_imbalance)));
    }

    const ProfileRun& run_;
    double all_;
    std::vector<Advice> found_;
};

}  // namespace

std::vector<std::string> advice(const ProfileRun& run) {
    return Adviser(run).sentences();
}

std::string busy_machine(const ProfileRun& run) {
    constexpr double kMostTaken = 0.2;
    const double taken = thread_time(run).taken;
    if (!(taken > kMostTaken)) return "";
    return fmt::format(
        "{}, threads: {}: other programs, or the system, took {} of the threads' time: CPU times and efficiency hold, "
        "but seconds of stages, rays per second and all else by the clock do not",
        run.integrator, run.threads, human_percent(taken));
}

std::string disagreement_of_repetitions(const ProfileRun& run) {
    constexpr double kMostSpread = 0.1;
    if (run.cpu_seconds.size() < 2) return "";
    const auto [least, most] = std::ranges::minmax(run.cpu_seconds);
    const double spread = rate(most - least, median(run.cpu_seconds));
    if (!(spread > kMostSpread)) return "";
    return fmt::format(
        "{}, threads: {}: repetitions of the same samples took {} to {} of CPU time, {} apart: the machine "
        "had other work, and differences below that mean nothing",
        run.integrator, run.threads, human_seconds(least), human_seconds(most), human_percent(spread));
}

}  // namespace etendue
