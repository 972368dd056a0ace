// What `etendue batch` has done: a unit for each image of each scene, frame and variant.
//
// A plain description, in the order of the plan. What is not known is empty, and null in JSON. Texts are taken as they
// are, from file names and messages: they may hold anything, and need not be UTF-8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

enum class UnitOutcome {
    Rendered,
    UpToDate,
    Failed,
    Interrupted,       ///< by the user, with what was rendered so far
    Running,           ///< this batch process renders it
    RunningElsewhere,  ///< another batch process has it
    NotStarted,        ///< the batch ended before its turn
    NotChosen,         ///< the batch was told to leave it as it is, and nothing better is known of it
};

/// Seconds on the clock.
struct UnitSeconds {
    double load = 0.0;   ///< reading the scene
    double build = 0.0;  ///< compiling the world
    double render = 0.0;
    double write = 0.0;    ///< the images
    double denoise = 0.0;  ///< taking the noise out of the image, and showing that

    [[nodiscard]] double total() const { return load + build + render + write + denoise; }
};

/// The error of an image that is not tried.
inline constexpr std::string_view kNotTried = "not tried: another image of the scene has shown that it is invalid";

/// One image. The statistics are those of the file beside it, of the run that made it: units that are up to date have
/// them too.
struct BatchUnit {
    std::string id{};    ///< path of its image below the output directory, without extension; unlike all others
    std::string name{};  ///< name for people: its scene, and which frame, variant and camera of it
    std::string scene{};
    std::optional<int> frame{};
    std::string variant{};  ///< variant of the scene's materials; empty if none was asked for
    std::string camera{};   ///< camera, as far as it is known
    std::string image{};    ///< the EXR, relative to the output directory
    std::string preview{};  ///< the PNG that is looked at, relative to the output directory; empty if there is none
    UnitOutcome outcome = UnitOutcome::NotStarted;
    bool is_chosen = true;                ///< false if the batch was told to leave it as it is
    std::string reason{};                 ///< why it was stale: "settings changed"; empty if it was not
    std::string error{};                  ///< one message of any number of lines, if it failed
    std::string signal{};                 ///< signal that ended its process: "SIGSEGV"; empty if none did
    int attempts = 0;                     ///< attempts that this batch made
    std::string host{};                   ///< where it was rendered, or is
    std::vector<std::string> log{};       ///< its last lines, oldest first; a few dozen at most
    std::vector<std::string> warnings{};  ///< what is wrong with the image all the same; a few dozen at most

    int width = 0;  ///< pixels rendered; 0 if not known
    int height = 0;
    int spp = 0;            ///< finished
    int spp_requested = 0;  ///< asked for; 0 if not known
    std::string integrator{};
    std::string halt_reason{};
    std::optional<double> relative_error{};            ///< estimated
    std::optional<double> relative_error_requested{};  ///< asked for; none if none was
    std::optional<UnitSeconds> seconds{};
    double seconds_before = 0.0;                ///< part of `seconds` from before the last attempt
    std::uint64_t rays_before = 0;              ///< part of `rays` from before the last attempt
    std::optional<double> estimated_seconds{};  ///< seconds that the plan expected
    std::optional<double> fraction{};           ///< part that is done while it is running, [0, 1]
    std::optional<double> seconds_left{};       ///< seconds until it is done, while it is running
    std::optional<double> rays_per_second{};
    std::optional<std::uint64_t> rays{};
    std::optional<std::uint64_t> peak_memory_bytes{};
};

/// Says what a batch does when its report is written.
enum class BatchState {
    Planning,  ///< looks at what there is to do
    Running,
    Ended
};

struct BatchReport {
    std::string title{};             ///< title of the page: the last name of the output directory
    std::string output_directory{};  ///< absolute
    std::string program{};           ///< name and version
    std::string command{};
    std::string started{};  ///< ISO 8601, UTC
    std::string ended{};    ///< ISO 8601, UTC; empty while the batch goes on
    double seconds = 0.0;   ///< from start to end, or until now
    BatchState state = BatchState::Planning;
    std::string written{};                 ///< ISO 8601, UTC: when this was known
    std::optional<double> seconds_left{};  ///< seconds until all is done, if that is known
    std::string host{};
    int threads = 0;
    int jobs = 1;  ///< images that may be rendered at the same time
    bool interrupted = false;
    std::vector<BatchUnit> units{};
};

/// Holds sums over the units. Seconds and rays count what this batch rendered, without what checkpoints held before an
/// image's last attempt.
struct BatchTotals {
    std::size_t units = 0;
    std::size_t rendered = 0;
    std::size_t up_to_date = 0;
    std::size_t failed = 0;
    std::size_t interrupted = 0;
    std::size_t running = 0;
    std::size_t running_elsewhere = 0;
    std::size_t not_started = 0;
    std::size_t not_chosen = 0;
    std::size_t not_tried = 0;      ///< units of `not_started` whose scene has failed
    std::size_t with_warnings = 0;  ///< units, whatever became of them
    UnitSeconds seconds{};
    std::uint64_t rays = 0;
    std::uint64_t peak_memory_bytes = 0;  ///< the largest of all units
};

[[nodiscard]] BatchTotals totals(const BatchReport& report);

/// Returns the report without the units that the batch was told to leave as they are.
[[nodiscard]] BatchReport of_chosen(BatchReport report);

/// Returns the name of an outcome in JSON and on the page: "up to date".
[[nodiscard]] const char* outcome_name(UnitOutcome outcome);

/// Returns the name of a state in JSON: "planning".
[[nodiscard]] const char* state_name(BatchState state);

/// Whether the unit's image shows what was asked for, finished or not: another may lie there from before.
[[nodiscard]] bool has_image(UnitOutcome outcome);

/// Returns the report as JSON, as docs/batch-report.md describes it.
[[nodiscard]] std::string to_json(const BatchReport& report);

struct Thumbnails {
    /// Small encoded images of the units, PNG or JPEG, in their order; empty where there is none.
    std::vector<std::vector<unsigned char>> files{};
    std::string note{};  ///< text about the thumbnails for a reader; may be empty
};

/// One HTML file, to stand in the output directory, that shows the report and needs nothing else; links lead to the
/// images beside it. Throws std::invalid_argument unless there is a thumbnail, be it empty, for
/// each unit.
[[nodiscard]] std::string make_batch_page(const BatchReport& report, const Thumbnails& thumbnails);

}  // namespace etendue
