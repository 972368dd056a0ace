// What a batch is going to do, before it does it: which images are stale, why, and how long they will take.
#pragma once

#include "batch/batch_child.h"
#include "batch/batch_ledger.h"
#include "batch/batch_options.h"
#include "batch/batch_units.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Tells two states of a file apart; equal for a file that is missing.
struct FileStamp {
    std::uint64_t inode = 0;
    std::int64_t seconds = 0;
    std::int64_t nanoseconds = 0;

    [[nodiscard]] static FileStamp of(const std::filesystem::path& path);
    friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

struct PlannedUnit {
    BatchTask task;
    std::string reason{};                         ///< why it is stale; empty if it is up to date
    double done = 0.0;                            ///< part of its samples that a checkpoint holds, [0, 1]
    std::optional<double> estimated_seconds{};    ///< seconds for what is left; if it is stale and a probe was possible
    std::optional<std::uint64_t> memory_bytes{};  ///< bytes that its process will need; none if nobody knows
    bool resumes = true;                          ///< with its checkpoint, if there is one
    FileStamp seen{};                             ///< the statistics beside the image, when they were looked at
    ImageOutline outline{};                       ///< outline of the image, as far as it was found out
    std::string error{};  ///< why it cannot be rendered, of any number of lines; empty if nothing is known to be wrong
    bool is_running_elsewhere = false;        ///< a dry run has seen that another batch process renders it
    std::vector<std::string> warnings{};      ///< what a dry run has found to be wrong with its scene all the same
    bool loses_samples = false;               ///< its finished image has more samples than are asked for
    bool loses_pixels = false;                ///< its finished image is larger than is asked for
    bool lacks_denoising = false;             ///< the estimate leaves out taking out the noise, which nobody has timed
    std::optional<double> denoise_seconds{};  ///< seconds that taking out its noise took, if it is up to date

    [[nodiscard]] bool is_stale() const { return !reason.empty(); }
};

/// The reason of an image that is rendered again although it is up to date.
inline constexpr std::string_view kForced = "--force";

using BatchPlan = std::vector<PlannedUnit>;

/// Looks at one image: fills `reason`, `done` and `seen`. `force` is a reason, too. The scene is only loaded if the
/// files do not tell enough; if that fails, it is stale, and rendering it will say why. `history` is what the ledger
/// says.
void examine(PlannedUnit& unit, const BatchOptions& options, bool force, const LedgerHistory& history);

/// Told what is being looked at, the part of the plan that is made, and of how many images it will be.
using PlanProgress = std::function<void(const std::string& what, const BatchPlan& so_far, std::size_t of)>;

/// Examines all images and, for a dry run, finds out which of them other batch processes render. Probes the first stale
/// frame of each scene, variant and camera, or, for a dry run without probes, inspects it: the other frames are taken
/// to cost as much as that frame and to fail if it fails. Ends early if the batch is interrupted.
[[nodiscard]] BatchPlan make_plan(std::vector<BatchTask> tasks, const BatchOptions& options,
                                  const LedgerHistory& history, const PlanProgress& progress);

/// Puts the images into the order that is asked for; what is not known comes last. Scenes may read files in the
/// directories `assets`.
void arrange(BatchPlan& plan, BatchOrder order, std::span<const std::filesystem::path> assets = {});

/// Sums over the stale images of a plan.
struct PlanTotals {
    std::size_t stale = 0;
    std::size_t elsewhere = 0;     ///< images that another batch renders, in none of the other numbers
    std::size_t failing = 0;       ///< stale images that cannot be rendered
    std::size_t unknown = 0;       ///< stale images without an error or an estimate
    double seconds = 0.0;          ///< seconds of all stale images with an estimate
    bool lacks_denoising = false;  ///< `seconds` leaves out taking out the noise of some
};
[[nodiscard]] PlanTotals totals(const BatchPlan& plan);

/// Returns a table with a row for each image, what is wrong with them, what they replace, and a last line that sums up.
[[nodiscard]] std::string to_table(const BatchPlan& plan);
/// Says what is wrong with the images that will fail, once for each scene and reason; empty if nothing is.
[[nodiscard]] std::string failures(const BatchPlan& plan);
/// Lists the warnings of the images that are to be rendered, once for each scene; empty if there are none.
[[nodiscard]] std::string warnings(const BatchPlan& plan);
/// Counts the finished images that are replaced by ones with fewer samples or pixels; empty if none is.
[[nodiscard]] std::string replacements(const BatchPlan& plan);
/// One JSON object: docs/batch.md tells its keys.
[[nodiscard]] std::string to_json(const BatchPlan& plan);
/// One line: "3 of 5 images to render, about 2:10: 2 never rendered, 1 settings changed".
[[nodiscard]] std::string summary(const BatchPlan& plan);

}  // namespace etendue
