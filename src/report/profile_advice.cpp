#include "report/profile_advice.h"

#include "report/human_units.h"
#include "report/profile_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace etendue {

namespace {

/// Shares of the time from which on something is worth a sentence.
constexpr double kMuchTime = 0.1;
constexpr double kMuchWaiting = 0.15;
/// Is the least share of the rays whose saving is worth a sentence.
constexpr double kManyRays = 0.02;

struct Sentence {
    double share = 0.0;  ///< share of the time, or of the rays
    std::string text{};
};

std::vector<std::string> sorted_texts(std::vector<Sentence> sentences) {
    std::ranges::stable_sort(sentences, std::ranges::greater{}, &Sentence::share);
    std::vector<std::string> texts;
    texts.reserve(sentences.size());
    for (const Sentence& sentence : sentences) texts.push_back(sentence.text);
    return texts;
}

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

/// True if others took so much of the threads' time that what was taken by the clock says nothing about the render.
bool was_disturbed(const ProfileRun& run) {
    constexpr double kMostTaken = 0.2;
    return thread_time(run).taken > kMostTaken;
}

class Adviser {
  public:
    explicit Adviser(const ProfileRun& run) : run_(run), all_(sum_of(run.stages)) {
        rays();
        light_samples();
        stages();
        long_paths();
        threads();
    }

    [[nodiscard]] const std::vector<Sentence>& costs() const { return costs_; }
    [[nodiscard]] const std::vector<Sentence>& changes() const { return changes_; }

  private:
    static void add(std::vector<Sentence>& sentences, double share, double least, std::string text) {
        if (share >= least) sentences.push_back({share, std::move(text)});
    }

    void rays() {
        for (const RayKindReport& kind : run_.kinds) {
            const double share = rate(kind.seconds, all_);
            if (!(share >= kMuchTime)) continue;
            std::string text = fmt::format("{} rays are {} of the time", kind.kind, human_percent(share));
            if (kind.kind == "shadow" && kind.hit_share > 0.0)
                text += fmt::format("; {} of them are blocked{}", human_percent(kind.hit_share), most_blocked());
            // Full packets take hardly longer than those that are half full.
            if (kind.packet_fill < 0.75) {
                text += fmt::format("; their packets are {} full", human_percent(kind.packet_fill));
                if (run_.spp < 16)
                    add(changes_, share, kMuchTime,
                        fmt::format("--spp 16 or more makes the packets of {} rays fuller", kind.kind));
            }
            add(costs_, share, kMuchTime, text);
        }
    }

    /// Names the lamp to which most of the blocked shadow rays went, if there are several.
    [[nodiscard]] std::string most_blocked() const {
        const auto& lamps = run_.scene_hits.lamps;
        if (lamps.size() < 2) return "";
        double blocked = 0.0;
        for (const LampReport& lamp : lamps) blocked += lamp.blocked;
        const auto most = std::ranges::max_element(lamps, {}, &LampReport::blocked);
        return blocked > 0.0 ? fmt::format(", about {} of those on the way to '{}'",
                                           rough_percent(most->blocked / blocked), most->name)
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
        // Unlike times, counts are the same in every profile of this work.
        const double share =
            std::min(1.0, saved / samples) * rate(static_cast<double>(shadow->rays), static_cast<double>(run_.rays));
        add(changes_, share, kManyRays,
            fmt::format(
                "--light-samples 1 in place of {} leaves out about {} of the rays, and direct light has more noise",
                run_.light_samples, rough_percent(share)));
    }

    void stages() {
        const double textures = stage_share(run_, "textures");
        add(costs_, textures, kMuchTime,
            fmt::format("textures are {} of the time{}", human_percent(textures), most_of(run_.scene_hits.textures)));
        const double material = stage_share(run_, "material evaluation");
        add(costs_, material, 0.2,
            fmt::format("evaluating materials is {} of the time{}", human_percent(material),
                        most_of(run_.scene_hits.materials)));
        add(costs_, rate(run_.bsdf_absorbed * material, 1.0), 0.02,
            fmt::format(
                "{} of the BSDF samples have no weight: material evaluation, {} of the time, makes them in vain",
                human_percent(run_.bsdf_absorbed), human_percent(material)));
    }

    [[nodiscard]] static std::string most_of(const std::vector<HitsReport>& met) {
        if (met.size() < 2) return "";
        double all = 0.0;
        for (const HitsReport& one : met) all += one.seconds;
        return fmt::format("; '{}' takes about {} of that", met.front().name,
                           rough_percent(rate(met.front().seconds, all)));
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
            if (!(share >= kManyRays && share < 0.5)) continue;
            add(changes_, share, kManyRays,
                fmt::format(
                    "{} of the rays of eye paths lie beyond their ray number {}: --max-depth {} leaves out these, "
                    "the other rays that they cause, and the light of longer paths",
                    human_percent(share), depth, depth));
            return;
        }
    }

    void threads() {
        const double waiting = thread_time(run_).waiting;
        add(changes_, waiting, kMuchWaiting,
            fmt::format(
                "threads have no tile for {} of their time, most of it at the ends of passes; larger images and "
                "more --spp leave less of it",
                human_percent(waiting)));
        if (was_disturbed(run_)) return;
        if (run_.threads > 1 && run_.parallel_efficiency < 0.8)
            add(costs_, 1.0 - run_.parallel_efficiency, 0.0,
                fmt::format("{} threads do the work of {:.1f}", run_.threads, run_.threads * run_.parallel_efficiency));
        add(costs_, run_.load_imbalance, kMuchWaiting,
            fmt::format("the busiest thread renders {} longer than the mean of all: tiles are unequal, or few",
                        human_percent(run_.load_imbalance)));
    }

    const ProfileRun& run_;
    double all_;
    std::vector<Sentence> costs_;
    std::vector<Sentence> changes_;
};

}  // namespace

std::vector<std::string> costs(const ProfileRun& run) {
    return sorted_texts(Adviser(run).costs());
}

std::vector<std::string> advice(const ProfileRun& run) {
    return sorted_texts(Adviser(run).changes());
}

std::string busy_machine(const std::vector<ProfileRun>& runs) {
    std::vector<std::string> names;
    std::vector<double> taken;
    for (const ProfileRun& run : runs) {
        if (!was_disturbed(run)) continue;
        names.push_back(fmt::format("{}, threads: {}", run.integrator, run.threads));
        taken.push_back(thread_time(run).taken);
    }
    if (taken.empty()) return "";
    const auto [least, most] = std::ranges::minmax(taken);
    const std::string from = taken.size() > 1 ? human_percent(least) + " to " : "";
    return fmt::format(
        "{}: other programs, or the system, took {}{} of the threads' time: CPU times, bare Embree's rates and "
        "efficiency still hold, except that others use the caches too; seconds of stages, rays per second of the "
        "renderer and all else by the clock do not",
        fmt::join(names, "; "), from, human_percent(most));
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
