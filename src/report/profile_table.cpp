#include "report/human_units.h"
#include "report/profile_advice.h"
#include "report/profile_figures.h"
#include "report/profile_report.h"
#include "report/text_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace etendue {

namespace {

using Rows = std::vector<std::vector<std::string>>;

constexpr std::size_t kIndent = 2;
constexpr int kBar = 40;  // characters that a stage takes that takes all the time
constexpr std::size_t kTilesInTable = 3;
constexpr std::size_t kLongestPaths = 3;
constexpr std::size_t kNamesInTable = 3;

/// Draws `share`, clamped to [0, 1], as a bar of '#'; all bars have one width, as columns are flush right.
std::string bar(double share) {
    const long length = std::isfinite(share) ? std::lround(kBar * std::clamp(share, 0.0, 1.0)) : 0;
    return fmt::format("{:<{}}", std::string(static_cast<std::size_t>(length), '#'), kBar);
}

std::string number(double value) {
    return std::isfinite(value) ? fmt::format("{:.2f}", value) : "-";
}

std::string rate_or_none(double rays_per_second) {
    return rays_per_second > 0.0 ? human_count(rays_per_second) : "-";
}

std::string overview(const std::vector<ProfileRun>& runs) {
    Rows rows{
        {"", "threads", "spp", "time", "rays/s", "samples/s", "eff. single", "eff. best", "parallel", "imbalance"}};
    for (const ProfileRun& run : runs)
        rows.push_back({run.integrator, fmt::format("{}", run.threads), fmt::format("{}", run.spp),
                        human_seconds(median(run.seconds)), human_count(rays_per_second(run)),
                        human_count(samples_per_second(run)), number(run.efficiency_single),
                        number(run.efficiency_best), human_percent(run.parallel_efficiency),
                        human_percent(run.load_imbalance)});
    return aligned(rows);
}

std::string rays(const ProfileRun& run) {
    Rows rows{{"rays", "traced", "hit", "renderer/s", "single/s", "packets of 8/s", "of 16/s"}};
    for (const RayKindReport& kind : run.kinds)
        rows.push_back({kind.kind, human_count(static_cast<double>(kind.rays)), human_percent(kind.hit_share),
                        rate_or_none(rays_per_second(kind)), rate_or_none(kind.single), rate_or_none(kind.packet8),
                        rate_or_none(kind.packet16)});
    return aligned(rows, kIndent);
}

std::string stages(const ProfileRun& run) {
    const double sum = sum_of(run.stages);
    Rows rows{{"stage", "thread time", "share", ""}};
    for (const NamedValue& stage : run.stages) {
        const double share = rate(stage.value, sum);
        rows.push_back({stage.name, human_seconds(stage.value), human_percent(share), bar(share)});
    }
    return aligned(rows, kIndent);
}

std::string shares(const ProfileRun& run) {
    Rows rows{{"time in which rays are traced", human_percent(tracing_share(run))},
              {"shadow rays unoccluded", human_percent(run.shadow_unoccluded)},
              {"light samples that made a shadow ray", human_percent(run.light_sampling_used)},
              {"BSDF samples that met light", human_percent(run.bsdf_met_light)},
              {"BSDF samples absorbed", human_percent(run.bsdf_absorbed)}};
    return aligned(rows, kIndent);
}

/// `kind` is "eye path".
std::string paths_of(const PathsReport& paths, const char* kind) {
    const double ended = sum_of(paths.endings);
    if (ended == 0.0) return "";
    Rows rows{{fmt::format("{}s end", kind), "paths", "share"}};
    for (const NamedValue& ending : paths.endings)
        rows.push_back({ending.name, human_count(ending.value), human_percent(rate(ending.value, ended))});
    std::string text = aligned(rows, kIndent);
    double count = 0.0, rays = 0.0;
    for (std::size_t length = 0; length < paths.lengths.size(); ++length) {
        count += static_cast<double>(paths.lengths[length]);
        rays += static_cast<double>(length * paths.lengths[length]);
    }
    if (count == 0.0) return text;
    return text +
           fmt::format("  rays of {}s: {:.2f} on average, {} at most\n", kind, rays / count, paths.lengths.size() - 1);
}

/// Says where the longest eye paths are, or how many there are if all of these have `max_depth` rays.
std::string longest_paths(const ProfileRun& run, int max_depth) {
    if (run.longest.empty()) return "";
    const std::vector<std::uint64_t>& lengths = run.eye_paths.lengths;
    const auto limit = static_cast<std::size_t>(max_depth);
    const auto is_at_limit = [&](const LongPathReport& path) { return path.vertices == max_depth + 1; };
    if (limit < lengths.size() && std::ranges::all_of(run.longest, is_at_limit))
        return fmt::format("  eye paths that reached the limit of {} rays: {}\n", max_depth, lengths[limit]);
    std::string places;
    for (std::size_t i = 0; i < std::min(kLongestPaths, run.longest.size()); ++i) {
        const LongPathReport& path = run.longest[i];
        places += fmt::format("{}{} vertices at ({}, {}), sample {}", i == 0 ? "" : "; ", path.vertices, path.x, path.y,
                              path.sample);
    }
    return wrapped("  longest eye paths: " + places, kIndent + 2);
}

std::string paths(const ProfileRun& run, int max_depth) {
    return paths_of(run.eye_paths, "eye path") + paths_of(run.light_paths, "light subpath") +
           longest_paths(run, max_depth);
}

std::string expensive_tiles(const ProfileRun& run) {
    std::string places;
    for (const TileCost& tile : most_expensive_tiles(run, kTilesInTable))
        places += fmt::format("{}({}, {}) {} ({})", places.empty() ? "" : "; ", tile.rect.x0, tile.rect.y0,
                              human_seconds(tile.cpu_seconds), human_percent(tile.share));
    return places.empty() ? "" : wrapped("  most expensive tiles, CPU time: " + places, kIndent + 2);
}

std::string hardware(const ProfileRun& run) {
    if (run.hardware.values.empty())
        return run.hardware.unavailable.empty()
                   ? ""
                   : wrapped("  hardware counters: " + run.hardware.unavailable, kIndent + 2);
    std::string counts;
    for (const NamedValue& counter : run.hardware.values)
        counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", counter.name, human_count(counter.value));
    return wrapped("  hardware counters: " + counts, kIndent + 2);
}

/// Says which share of the time of all threads, `all` seconds, goes to what.
std::string hits(const SceneHitsReport& report, double all) {
    std::string text;
    const auto add = [&text, all](const char* title, const std::vector<HitsReport>& met) {
        std::string names;
        for (std::size_t i = 0; i < std::min(kNamesInTable, met.size()); ++i)
            names += fmt::format("{}{} {}", names.empty() ? "" : "; ", met[i].name,
                                 rough_percent(rate(met[i].seconds, all)));
        if (!names.empty()) text += wrapped(fmt::format("  time by {}, about: {}", title, names), kIndent + 2);
    };
    add("material", report.materials);
    add("object", report.objects);
    add("texture", report.textures);
    if (report.lamps.size() < 2) return text;  // a single lamp has all shadow rays
    double shadow_rays = 0.0;
    for (const LampReport& lamp : report.lamps) shadow_rays += lamp.shadow_rays;
    std::string lamps;
    for (std::size_t i = 0; i < std::min(kNamesInTable, report.lamps.size()); ++i)
        lamps += fmt::format("{}{} {}, {} of these blocked", lamps.empty() ? "" : "; ", report.lamps[i].name,
                             rough_percent(rate(report.lamps[i].shadow_rays, shadow_rays)),
                             rough_percent(rate(report.lamps[i].blocked, report.lamps[i].shadow_rays)));
    return text + wrapped("  shadow rays by lamp, about: " + lamps, kIndent + 2);
}

std::string listed(const char* title, const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences) text += wrapped("  * " + sentence, kIndent + 2);
    return text.empty() ? text : fmt::format("  {}:\n{}", title, text);
}

std::string run_text(const ProfileRun& run, int max_depth) {
    std::string text = fmt::format("\n{}, {} thread{}\n", run.integrator, run.threads, run.threads == 1 ? "" : "s");
    if (!run.kinds.empty()) text += rays(run) + '\n';
    if (!run.stages.empty()) text += stages(run) + '\n';
    return text + shares(run) + '\n' + paths(run, max_depth) + expensive_tiles(run) +
           hits(run.scene_hits, sum_of(run.stages)) + hardware(run) + listed("what takes the time", costs(run)) +
           listed("what to change", advice(run));
}

std::string phases(const ProfileReport& report) {
    Rows rows{{"start", "time"}};
    for (const NamedValue& phase : report.load) rows.push_back({phase.name, human_seconds(phase.value)});
    rows.push_back({"first sample of every pixel, from the start", human_seconds(report.first_pixel_seconds)});
    return aligned(rows);
}

std::string bvh_text(const BvhReport& bvh) {
    const auto triangles = static_cast<double>(bvh.triangles);
    return wrapped(
        fmt::format("BVH: {} triangles stored, {} as seen, {} instances; built in {} ({} triangles/s); {}, "
                    "{:.0f} bytes a triangle; {}",
                    human_count(triangles), human_count(static_cast<double>(bvh.instanced_triangles)), bvh.instances,
                    human_seconds(bvh.build_seconds), human_count(rate(triangles, bvh.build_seconds)),
                    human_bytes(static_cast<double>(bvh.bytes)),
                    triangles > 0.0 ? static_cast<double>(bvh.bytes) / triangles : 0.0, bvh.quality),
        kIndent);
}

std::string memory(const ProfileReport& report) {
    Rows rows{{"memory", "size"}};
    for (const NamedValue& owner : report.memory) rows.push_back({owner.name, human_bytes(owner.value)});
    rows.push_back({"peak of the process", human_bytes(static_cast<double>(report.peak_memory_bytes))});
    return aligned(rows);
}

}  // namespace

std::string to_table(const ProfileReport& report) {
    const std::string busy = busy_machine(report.runs);
    std::string text = busy.empty() ? "" : wrapped("Note: " + busy, kIndent) + '\n';
    text += wrapped(fmt::format("{}, {} x {} pixels, paths of up to {} edges", report.scene, report.width,
                                report.height, report.max_depth));
    const std::string nodes =
        report.memory_nodes > 1 ? fmt::format(" at {} memory nodes", report.memory_nodes) : std::string();
    text += wrapped(fmt::format("{}, {} processors{}, {}; {}", report.processor, report.processors, nodes, report.isa,
                                report.ray_tracer));
    text += '\n' + overview(report.runs);
    text += wrapped(
        "efficiency: time that bare Embree takes for the same rays over that of the render, single: one by one; best: "
        "in packets where those are faster; parallel: speed over that of one thread times the threads",
        kIndent);
    text += wrapped(
        "rays: renderer/s are rays per second of one thread while it traces them; single and packets, bare Embree's",
        kIndent);
    for (const ProfileRun& run : report.runs) text += run_text(run, report.max_depth);
    text += '\n' + phases(report) + '\n' + bvh_text(report.bvh) + '\n' + memory(report);
    if (report.accelerators) text += '\n' + to_table(*report.accelerators);
    std::string notes;
    for (const std::string& note : report.notes)
        if (note != busy) notes += wrapped("Note: " + note, kIndent);
    if (!notes.empty()) text += '\n' + notes;
    if (report.against) text += '\n' + to_table(*report.against);
    return text;
}

namespace {

std::string amount(double value, const std::string& unit) {
    if (unit == "s") return human_seconds(value);
    if (unit == "bytes") return human_bytes(value);
    return human_count(value) + (unit == "rays/s" ? "/s" : "");
}

std::vector<std::string> figure_row(const std::string& name, const ComparedFigure& figure) {
    return {name, amount(figure.before, figure.unit), amount(figure.now, figure.unit),
            number(rate(figure.now, figure.before))};
}

}  // namespace

std::string to_table(const ProfileComparison& comparison) {
    std::string text = wrapped(fmt::format("Against the baseline of {}, made by {}", comparison.baseline_created,
                                           comparison.baseline_program));
    if (!comparison.refusal.empty())
        return text + wrapped("They cannot be compared: " + comparison.refusal + ".", kIndent);
    Rows verdicts{{"", "threads", "a sample, before", "now", "ratio",
                   fmt::format("{:g}% interval", 100.0 * comparison.options.confidence), "verdict"}};
    Rows figures{{"without a verdict", "before", "now", "ratio"}};
    for (const ComparedRun& run : comparison.runs) {
        const bool has_interval = std::isfinite(run.low) && std::isfinite(run.high);
        verdicts.push_back({run.integrator, fmt::format("{}", run.threads), human_seconds(run.before),
                            human_seconds(run.now), number(run.ratio),
                            has_interval ? fmt::format("{:.3f} to {:.3f}", run.low, run.high) : "-",
                            verdict_name(run.verdict)});
        for (const ComparedFigure& figure : run.rays_per_second)
            figures.push_back(
                figure_row(fmt::format("{}, {}: {} rays", run.integrator, run.threads, figure.name), figure));
    }
    for (const ComparedFigure& figure : comparison.figures) figures.push_back(figure_row(figure.name, figure));
    text += aligned(verdicts, kIndent) + '\n' + aligned(figures, kIndent);
    for (const std::string& note : comparison.notes) text += wrapped("Note: " + note, kIndent);
    return text + wrapped(fmt::format("Time is that of all threads. Slower: the whole interval lies above {:g}.",
                                      1.0 + comparison.options.tolerance));
}

}  // namespace etendue
