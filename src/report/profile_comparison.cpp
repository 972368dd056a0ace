#include "report/profile_comparison.h"

#include "report/profile_advice.h"
#include "report/profile_figures.h"
#include "report/profile_report.h"
#include "report/ratio_interval.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Returns the logarithm of the seconds that repetitions took for a sample.
LogEstimate log_times(const ProfileRun& run) {
    const auto count = static_cast<double>(run.cpu_seconds.size());
    const auto logarithm = [&](double seconds) { return std::log(seconds / static_cast<double>(run.samples)); };
    LogEstimate times{.degrees = count - 1.0};
    double sum = 0.0;
    for (const double seconds : run.cpu_seconds) sum += logarithm(seconds);
    times.value = sum / count;
    double squares = 0.0;
    for (const double seconds : run.cpu_seconds) squares += std::pow(logarithm(seconds) - times.value, 2.0);
    if (times.degrees > 0.0) times.variance = squares / times.degrees / count;
    return times;
}

ProfileVerdict verdict_of(const ComparedRun& run, double tolerance) {
    if (!std::isfinite(run.low) || !std::isfinite(run.high)) return ProfileVerdict::NotKnown;
    if (run.low > 1.0 + tolerance) return ProfileVerdict::Slower;
    if (run.high < 1.0 / (1.0 + tolerance)) return ProfileVerdict::Faster;
    return ProfileVerdict::NoDifference;
}

ComparedRun compare_run(const ProfileRun& before, const ProfileRun& now, const ProfileComparisonOptions& options) {
    const LogEstimate a = log_times(before), b = log_times(now);
    const RatioInterval interval = ratio_interval(b, a, options.confidence);
    ComparedRun run{.integrator = now.integrator,
                    .threads = now.threads,
                    .before = std::exp(a.value),
                    .now = std::exp(b.value),
                    .repetitions_before = before.cpu_seconds.size(),
                    .repetitions_now = now.cpu_seconds.size(),
                    .ratio = interval.ratio,
                    .low = interval.low,
                    .high = interval.high};
    run.verdict = verdict_of(run, options.tolerance);
    for (const RayKindReport& kind : now.kinds)
        for (const RayKindReport& earlier : before.kinds)
            if (earlier.kind == kind.kind)
                run.rays_per_second.push_back({kind.kind, "rays/s", rays_per_second(earlier), rays_per_second(kind)});
    return run;
}

/// The first setting that the two do not share; empty if there is none.
std::string difference_of_settings(const std::map<std::string, std::string>& before,
                                   const std::map<std::string, std::string>& now, std::string_view earlier) {
    std::set<std::string> names;
    for (const auto* settings : {&before, &now})
        for (const auto& [name, value] : *settings) names.insert(name);
    const auto text = [](const std::map<std::string, std::string>& settings, const std::string& name) {
        const auto found = settings.find(name);
        return found == settings.end() ? std::string("none") : fmt::format("'{}'", found->second);
    };
    for (const std::string& name : names)
        if (const std::string was = text(before, name), is = text(now, name); was != is)
            return fmt::format("the setting '{}' differs: {} in {}, {} now", name, was, earlier, is);
    return {};
}

void note_difference(std::vector<std::string>& notes, const char* what, const std::string& before,
                     const std::string& now) {
    if (before != now) notes.push_back(fmt::format("{}: '{}' before, '{}' now", what, before, now));
}

std::vector<std::string> circumstances(const ProfileReport& before, const ProfileReport& now) {
    std::vector<std::string> notes;
    note_difference(notes, "another seed", std::to_string(before.seed), std::to_string(now.seed));
    note_difference(notes, "another processor", before.processor, now.processor);
    note_difference(notes, "another instruction set", before.isa, now.isa);
    note_difference(notes, "another ray tracer", before.ray_tracer, now.ray_tracer);
    note_difference(notes, "another BVH", before.bvh.quality, now.bvh.quality);
    return notes;
}

/// Names a run, or a comparison of two runs: "path on 2 threads".
std::string run_name(const auto& run) {
    return fmt::format("{} on {} thread{}", run.integrator, run.threads, run.threads == 1 ? "" : "s");
}

const ProfileRun* find(const std::vector<ProfileRun>& runs, const ProfileRun& like) {
    const auto found = std::find_if(runs.begin(), runs.end(), [&](const ProfileRun& run) {
        return run.integrator == like.integrator && run.threads == like.threads;
    });
    return found == runs.end() ? nullptr : &*found;
}

void add_missing(std::vector<std::string>& notes, const std::vector<ProfileRun>& runs,
                 const std::vector<ProfileRun>& others, const char* where) {
    for (const ProfileRun& run : runs)
        if (find(others, run) == nullptr) notes.push_back(fmt::format("{} is {}", run_name(run), where));
}

/// Why the runs of the two cannot be compared; empty if any can.
std::string difference_of_runs(const ProfileReport& before, const ProfileReport& now) {
    bool is_in_both = false;
    for (const ProfileRun& run : now.runs) {
        const ProfileRun* const earlier = find(before.runs, run);
        if (earlier != nullptr && earlier->cpu_seconds.size() > 1) return {};
        is_in_both = is_in_both || earlier != nullptr;
    }
    return is_in_both ? "the baseline has one repetition of each run, of which nothing can be concluded"
                      : "the baseline has no run of the same integrator on the same number of threads";
}

std::vector<ComparedFigure> figures(const ProfileReport& before, const ProfileReport& now) {
    const auto bytes = [](std::uint64_t count) { return static_cast<double>(count); };
    return {{"load", "s", sum_of(before.load), sum_of(now.load)},
            {"first pixel", "s", before.first_pixel_seconds, now.first_pixel_seconds},
            {"BVH build", "s", before.bvh.build_seconds, now.bvh.build_seconds},
            {"BVH", "bytes", bytes(before.bvh.bytes), bytes(now.bvh.bytes)},
            {"peak memory", "bytes", bytes(before.peak_memory_bytes), bytes(now.peak_memory_bytes)}};
}

}  // namespace

std::string difference_of_work(const ProfileReport& before, const ProfileReport& now, std::string_view name) {
    if (before.scene != now.scene)
        return fmt::format("{} is of the scene '{}', not of '{}'", name, before.scene, now.scene);
    if (before.width != now.width || before.height != now.height)
        return fmt::format("{} has {} x {} pixels, not {} x {}", name, before.width, before.height, now.width,
                           now.height);
    if (before.max_depth != now.max_depth)
        return fmt::format("paths of {} have up to {} edges, not {}", name, before.max_depth, now.max_depth);
    if (before.bvh.instanced_triangles != now.bvh.instanced_triangles)
        return fmt::format("the scene has changed: that of {} has {} triangles, not {}", name,
                           before.bvh.instanced_triangles, now.bvh.instanced_triangles);
    return difference_of_settings(before.settings, now.settings, name);
}

const char* verdict_name(ProfileVerdict verdict) {
    switch (verdict) {
        case ProfileVerdict::Slower:
            return "slower";
        case ProfileVerdict::Faster:
            return "faster";
        case ProfileVerdict::NoDifference:
            return "no significant difference";
        case ProfileVerdict::NotKnown:
            break;
    }
    return "not known";
}

std::vector<std::string> ProfileComparison::slower_runs() const {
    std::vector<std::string> names;
    for (const ComparedRun& run : runs)
        if (run.verdict == ProfileVerdict::Slower) names.push_back(run_name(run));
    return names;
}

bool ProfileComparison::has_regression() const {
    return !slower_runs().empty();
}

std::string refusal_to_compare(const ProfileBaseline& before, const ProfileReport& now) {
    const std::string difference = difference_of_work(before, now);
    return difference.empty() ? difference_of_runs(before, now) : difference;
}

ProfileComparison compare_profiles(const ProfileBaseline& before, const ProfileReport& now,
                                   const ProfileComparisonOptions& options) {
    ProfileComparison comparison{.baseline_created = before.created,
                                 .baseline_program = before.program,
                                 .refusal = refusal_to_compare(before, now),
                                 .options = options};
    if (!comparison.refusal.empty()) return comparison;
    comparison.notes = circumstances(before, now);
    for (const ProfileRun& run : now.runs) {
        const ProfileRun* const earlier = find(before.runs, run);
        if (earlier == nullptr) continue;
        comparison.runs.push_back(compare_run(*earlier, run, options));
        if (earlier->spp != run.spp)
            comparison.notes.push_back(
                fmt::format("{} took {} samples per pixel before, {} now: times are compared "
                            "per sample",
                            run_name(run), earlier->spp, run.spp));
        for (const ProfileRun* const one : {earlier, &run})
            if (const std::string doubt = disagreement_of_repetitions(*one); !doubt.empty())
                comparison.notes.push_back(one == earlier ? "before: " + doubt : doubt);
        if (comparison.runs.back().verdict == ProfileVerdict::NotKnown)
            comparison.notes.push_back(fmt::format(
                "of {} nothing is concluded: that takes two repetitions or more on both sides", run_name(run)));
    }
    add_missing(comparison.notes, before.runs, now.runs, "in the baseline only");
    add_missing(comparison.notes, now.runs, before.runs, "not in the baseline");
    comparison.figures = figures(before, now);
    return comparison;
}

}  // namespace etendue
