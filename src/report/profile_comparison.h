// Is a program slower than it was? The processor time that a sample took in two profiles, with what chance explains.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

struct ProfileReport;

/// A profile of which only what `compare_profiles` looks at is there.
using ProfileBaseline = ProfileReport;

struct ProfileComparisonOptions {
    double tolerance = 0.02;   ///< >= 0; how much slower counts as none, relative
    double confidence = 0.95;  ///< confidence of the interval of each ratio, in (0, 1)
};

enum class ProfileVerdict {
    Slower,        ///< the whole interval lies above 1 + tolerance
    Faster,        ///< the whole interval lies below 1 / (1 + tolerance)
    NoDifference,  ///< neither
    NotKnown,      ///< a side has fewer than two repetitions
};

/// Returns the name of a verdict in JSON and in tables: "no significant difference".
[[nodiscard]] const char* verdict_name(ProfileVerdict verdict);

/// A figure before and now, which nothing is concluded from.
struct ComparedFigure {
    std::string name{};
    std::string unit{};  ///< "rays/s", "s" or "bytes"
    double before = 0.0;
    double now = 0.0;
};

/// A run that both profiles have. Times are seconds of all threads for one sample.
struct ComparedRun {
    std::string integrator{};
    int threads = 1;
    double before = 0.0;  ///< geometric mean of the repetitions
    double now = 0.0;
    std::size_t repetitions_before = 0;
    std::size_t repetitions_now = 0;
    double ratio = 0.0;  ///< now over before
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();
    ProfileVerdict verdict = ProfileVerdict::NotKnown;
    std::vector<ComparedFigure> rays_per_second{};  ///< by kind, of one thread while it traces them
};

struct ProfileComparison {
    std::string baseline_created{};
    std::string baseline_program{};
    std::string refusal{};  ///< a sentence that says why the two cannot be compared; empty if they can
    ProfileComparisonOptions options{};
    std::vector<std::string> notes{};
    std::vector<ComparedRun> runs{};
    std::vector<ComparedFigure> figures{};  ///< load, BVH, memory

    /// Names the runs that have become slower: "path on 2 threads".
    [[nodiscard]] std::vector<std::string> slower_runs() const;
    /// Returns whether any run has become slower.
    [[nodiscard]] bool has_regression() const;
};

/// Reads what `compare_profiles` needs of a profile.json, whoever wrote it; `file` is what errors call it. Throws
/// SceneError, with the pointer to what is wrong, if that is not a profile of this format, or says what no profile can.
[[nodiscard]] ProfileBaseline parse_profile(const std::string& json, const std::string& file = "baseline");

/// Says in a sentence how the two profiles are of different work: scene, size, length of paths, triangles or another of
/// the settings; empty if they are not.
/// The sentence calls `before` by `name`.
[[nodiscard]] std::string difference_of_work(const ProfileReport& before, const ProfileReport& now,
                                             std::string_view name = "the baseline");

/// Why `compare_profiles` refuses the two, in a sentence; empty if it does not. Profiles that differ in scene, size,
/// length of paths, triangles or another of the settings are refused, and those of which no run is in both, with two
/// repetitions or more in the baseline. Of the runs of `now` only integrators and threads are looked at, so that it can
/// be asked before they are measured.
[[nodiscard]] std::string refusal_to_compare(const ProfileBaseline& before, const ProfileReport& now);

/// Compares runs of the same integrator on the same number of threads. Differences that are no refusal are notes.
///
/// For each run, the logarithms of the seconds per sample of all repetitions are compared: m₁ and m₂ are their means,
/// s₁² and s₂² their variances, n₁ and n₂ their numbers. With e² = s₁²/n₁ + s₂²/n₂ the interval of the ratio is
///     exp(m₂ − m₁ ± t e),
/// t the two-sided quantile of Student's distribution with e⁴ / ((s₁²/n₁)²/(n₁−1) + (s₂²/n₂)²/(n₂−1)) degrees of
/// freedom (B. L. Welch, "The generalization of 'Student's' problem when several different population variances are
/// involved", Biometrika 34, 1947). A program that has not changed is called slower with probability
/// (1 − confidence) / 2 for each run if repetitions are many, independent, and vary normally in logarithms, and the
/// tolerance is 0. Of 3 to 10 that was measured as 0.020 to 0.036 for a confidence of 0.95; a tolerance makes it less
/// (docs/profile.md).
[[nodiscard]] ProfileComparison compare_profiles(const ProfileBaseline& before, const ProfileReport& now,
                                                 const ProfileComparisonOptions& options = {});

/// A JSON object.
[[nodiscard]] std::string to_json(const ProfileComparison& comparison);

/// A table for a terminal, of at most 100 columns.
[[nodiscard]] std::string to_table(const ProfileComparison& comparison);

}  // namespace etendue
