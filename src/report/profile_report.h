// What `etendue profile` has measured: where the time of a render goes, next to what bare Embree needs for its rays.
//
// A plain description, in the order of the report. Numbers that are not known are NaN, and null in JSON. Times of
// stages, tiles and repetitions are seconds.
#pragma once

#include "core/pixel_rect.h"
#include "report/accelerator_report.h"
#include "report/profile_comparison.h"

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// A number with a name, in the order of the report: a phase of loading and its seconds, an owner of memory and its
/// bytes, a reason why paths end and how many did.
struct NamedValue {
    std::string name{};
    double value = 0.0;
};

/// Rays of one kind: "camera", "bounce", "shadow", "light-subpath", "connection", "light-to-camera".
struct RayKindReport {
    std::string kind{};
    std::uint64_t rays = 0;      ///< counted where they are traced
    double seconds = 0.0;        ///< seconds of all threads in which the renderer traced these rays
    std::uint64_t recorded = 0;  ///< rays of these that bare Embree traced again
    /// Rays per second of one thread that traces the recorded rays again and does nothing else, 0 if none were.
    double single = 0.0;  ///< rtcIntersect1 or rtcOccluded1
    double packet8 = 0.0;
    double packet16 = 0.0;
    double hit_share = std::numeric_limits<double>::quiet_NaN();  ///< share of the rays that met something, [0, 1]
    /// Share of the lanes of packets of 16 that the recorded rays fill, [0, 1].
    double packet_fill = std::numeric_limits<double>::quiet_NaN();
};

/// Shadow rays to one lamp, by the name of the object whose surface they end at.
struct LampReport {
    std::string name{};
    double shadow_rays = 0.0;
    double blocked = 0.0;  ///< shadow rays of these that met something before
    double seconds = 0.0;  ///< seconds of all threads in which they were traced
};

/// Holds what rays met under one name of the scene.
struct HitsReport {
    std::string name{};
    double hits = 0.0;
    double seconds = 0.0;  ///< seconds of all threads that they took
};

/// Holds what rays met, by names of the scene, what takes the most time first; these are estimates from the rays that
/// were recorded.
struct SceneHitsReport {
    std::vector<HitsReport> materials{};  ///< seconds of set-up, textures and lobes
    std::vector<HitsReport> objects{};    ///< the same seconds, and those of the rays that met the object
    std::vector<HitsReport> textures{};   ///< hits on materials that name the image; seconds of textures
    std::vector<LampReport> lamps{};
};

/// A tile of one pass.
struct TileReport {
    PixelRect rect{};
    int thread = 0;
    std::uint32_t first_sample = 0;
    double start = 0.0;  ///< since the run began
    double end = 0.0;
    double cpu_seconds = 0.0;  ///< processor time of its thread
    std::uint64_t samples = 0;
};

/// How paths of one kind end, and how long they get.
struct PathsReport {
    std::vector<NamedValue> endings{};     ///< why they end, and how many did
    std::vector<std::uint64_t> lengths{};  ///< how many took as many rays as the index says
};

/// A sample whose path was among the longest.
struct LongPathReport {
    int x = 0;
    int y = 0;
    std::uint32_t sample = 0;
    int vertices = 0;
};

/// Holds what the processor counted while the render ran; empty where the kernel does not allow it.
struct HardwareCounters {
    std::vector<NamedValue> values{};  ///< "cycles", "instructions", "cache-misses", …
    std::string unavailable{};         ///< a sentence; empty if there are values
};

/// One integrator on one number of threads.
struct ProfileRun {
    std::string integrator{};
    int threads = 1;
    std::uint32_t spp = 0;
    std::vector<double> seconds{};      ///< seconds of each repetition without instruments, all of the same samples
    std::vector<double> cpu_seconds{};  ///< processor seconds of all threads, repetition by repetition
    double instrumented_seconds = 0.0;  ///< seconds of the repetition in which stages were timed and rays recorded
    double instrumented_cpu_seconds =
        std::numeric_limits<double>::quiet_NaN();  ///< processor seconds of all threads in that repetition
    std::uint64_t samples = 0;                     ///< samples of one repetition
    std::uint64_t rays = 0;
    std::vector<RayKindReport> kinds{};  ///< kinds of rays that the integrator traces
    int light_samples = 1;               ///< lights that are sampled at what the eye sees directly
    SceneHitsReport scene_hits{};
    std::vector<NamedValue> stages{};  ///< seconds of all threads, in the order of the wave; "other" is the last
    double timing_share = 0.0;         ///< share of the threads' time that time stamps themselves took, [0, 1]
    /// Processor time that bare Embree takes for exactly these rays over that of the render, by the median of the
    /// repetitions: as single rays, and in the form that is fastest for each kind.
    double efficiency_single = std::numeric_limits<double>::quiet_NaN();
    double efficiency_best = std::numeric_limits<double>::quiet_NaN();
    double parallel_efficiency = std::numeric_limits<double>::quiet_NaN();  ///< speed over threads × that of one thread
    double load_imbalance = 0.0;      ///< longest time that a thread rendered over the mean of all, minus 1
    std::vector<TileReport> tiles{};  ///< tiles of the instrumented repetition
    PathsReport eye_paths{};
    PathsReport light_paths{};              ///< light subpaths; empty if the integrator has none
    std::vector<LongPathReport> longest{};  ///< eye paths
    double shadow_unoccluded = std::numeric_limits<double>::quiet_NaN();  ///< share of shadow rays
    double light_sampling_used =
        std::numeric_limits<double>::quiet_NaN();  ///< share of light samples that made a shadow ray
    double bsdf_met_light = std::numeric_limits<double>::quiet_NaN();  ///< share of BSDF samples whose rays met light
    double bsdf_absorbed = std::numeric_limits<double>::quiet_NaN();   ///< share of BSDF samples of weight zero
    HardwareCounters hardware{};
    std::string heat_map{};  ///< name of the EXR beside the report: rays per pixel and CPU seconds per sample
    /// CPU seconds of a sample that the last colour of its picture stands for; the first is 0.
    double heat_map_high = std::numeric_limits<double>::quiet_NaN();
};

struct BvhReport {
    double build_seconds = 0.0;
    std::uint64_t triangles = 0;            ///< stored
    std::uint64_t instanced_triangles = 0;  ///< triangles as seen, shared meshes as often as they are placed
    std::uint64_t instances = 0;
    std::uint64_t bytes = 0;
    std::string quality{};  ///< "medium, robust"
};

/// Numbers the format of profile.json; it changes when the meaning of a key does.
inline constexpr int kProfileFormat = 2;

/// A run of an earlier profile.
struct EarlierRun {
    std::string integrator{};
    int threads = 1;
    double cpu_seconds_per_sample = 0.0;  ///< median of the repetitions
};

struct EarlierProfile {
    std::string file{};
    std::string created{};
    std::string program{};
    std::vector<EarlierRun> runs{};
};

struct ProfileReport {
    std::string program{};
    std::string created{};  ///< ISO 8601, UTC
    std::string command{};
    std::string scene{};
    std::string scene_path{};
    int width = 0;
    int height = 0;
    std::optional<PixelRect> crop{};  ///< pixels that are rendered, if they are not all
    int max_depth = 0;
    std::uint32_t seed = 0;
    std::map<std::string, std::string> settings{};  ///< other settings that decide how much work a sample is, by name
    std::string processor{};                        ///< model of the processor
    int processors = 0;
    int memory_nodes = 1;  ///< parts of the machine with memory of their own, of which the process has processors
    std::string isa{};
    std::string ray_tracer{};
    std::vector<NamedValue> load{};    ///< phases from the start of the process, seconds
    double first_pixel_seconds = 0.0;  ///< from the start of the process to the end of a first sample of every pixel
    BvhReport bvh{};
    std::vector<NamedValue> memory{};  ///< owners and bytes
    std::uint64_t peak_memory_bytes = 0;
    std::vector<std::string> notes{};
    std::vector<ProfileRun> runs{};  ///< by integrator, then by threads
    std::optional<AcceleratorReport> accelerators{};
    std::optional<ProfileComparison> against{};
    std::vector<EarlierProfile> history{};  ///< profiles of the same work, the oldest first
};

/// docs/profile.md describes it.
[[nodiscard]] std::string to_json(const ProfileReport& report);

/// Tables for a terminal, of at most 100 columns.
[[nodiscard]] std::string to_table(const ProfileReport& report);

/// Comma-separated values with a line of names: one row for each figure of each run. docs/profile.md lists the columns.
[[nodiscard]] std::string to_csv(const ProfileReport& report);

/// The start of the process, and the tiles and waits of each thread with the sums of stages, in the Trace Event Format
/// of Chrome, which Perfetto opens: one process for the start and for each run.
[[nodiscard]] std::string to_chrome_trace(const ProfileReport& report);

/// PNG files by keys, which `heat_map_key` makes.
using ProfileImages = std::map<std::string, std::vector<unsigned char>>;

/// "heat/path-2" for the heat map of `path` on two threads.
[[nodiscard]] std::string heat_map_key(const ProfileRun& run);

/// One HTML file that shows the report and needs nothing else.
[[nodiscard]] std::string make_profile_page(const ProfileReport& report, const ProfileImages& images);

}  // namespace etendue
