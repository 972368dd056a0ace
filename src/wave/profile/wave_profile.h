// What the waves of one thread do and how long it takes, for `etendue profile`. Renders have none.
#pragma once

#include "core/ray.h"
#include "core/tick_clock.h"
#include "wave/profile/ray_recorder.h"
#include "wave/profile/stage.h"
#include "wave/ray_kind.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace etendue {

/// Why paths end.
enum class PathEnding : std::uint8_t {
    Escaped,   ///< into the environment, or out of the scene
    Absorbed,  ///< a sample of the BSDF with no weight
    Roulette,
    TooLong,  ///< the limit of its length; light subpaths leave edges for the way to the camera
    Unlit,    ///< a surface that only shows its colour
    Count
};
inline constexpr std::size_t kPathEndings = static_cast<std::size_t>(PathEnding::Count);
inline constexpr std::array<std::string_view, kPathEndings> kPathEndingNames{
    "left the scene", "absorbed by a surface", "Russian roulette", "longest path allowed", "unlit surface"};

/// How useful samples are.
struct SampleUse {
    std::uint64_t light_samples = 0;  ///< of next-event estimation
    // Of eye paths:
    std::uint64_t bsdf_samples = 0;
    std::uint64_t bsdf_absorbed = 0;   ///< without weight
    std::uint64_t phase_samples = 0;   ///< in media
    std::uint64_t bsdf_met_light = 0;  ///< samples of either whose rays met a lamp or an environment that shines
};

/// How paths of one kind end, and how long they get.
class PathTally {
  public:
    /// Lengths that are told apart; longer paths are counted with the longest.
    static constexpr int kMostRays = 256;

    /// Counts a path of `rays` rays that came to its end.
    void count(PathEnding ending, int rays);
    void add(const PathTally& other);

    [[nodiscard]] std::uint64_t paths(PathEnding ending) const { return endings_[static_cast<std::size_t>(ending)]; }
    /// Returns how many paths took each number of rays; the list ends with the longest path.
    [[nodiscard]] std::vector<std::uint64_t> lengths() const;

  private:
    std::array<std::uint64_t, kPathEndings> endings_{};
    std::array<std::uint64_t, kMostRays + 1> lengths_{};
};

/// An eye path that was longer than most.
struct LongPath {
    int x = 0;  ///< the pixel of its sample
    int y = 0;
    std::uint32_t sample = 0;  ///< index in the pixel
    int rays = 0;
};

class WaveProfile {
  public:
    /// Long paths that are remembered.
    static constexpr std::size_t kLongPaths = 16;

    /// `recorded_rays` is about how many rays of each kind are kept.
    explicit WaveProfile(std::size_t recorded_rays);

    /// Leaves the time since the last stamp out of all stages.
    void skip() { last_ = ticks_now(); }
    /// Adds the time since the last stamp to `stage`.
    void stamp(Stage stage) { ticks_[static_cast<std::size_t>(stage)] += lap(); }
    /// Begins a block of paths. True if its stages are told apart: of every second one only, as stamps would take more
    /// than a hundredth of the time where paths are short.
    [[nodiscard]] bool start_block() { return tells_apart_ = !tells_apart_; }
    /// Adds the time since the last stamp to `stage`, in a block whose stages are told apart.
    void stamp_in_block(Stage stage) { ticks_in_blocks_[static_cast<std::size_t>(stage)] += lap(); }
    /// Adds the time since the last stamp to the blocks whose stages are not told apart; stages share it as in the
    /// other blocks.
    void stamp_block() { ticks_of_blocks_ += lap(); }
    /// Adds the time since the last stamp to `stage` and to the rays of `kind` that were traced.
    void stamp(Stage stage, RayKind kind) {
        const std::uint64_t elapsed = lap();
        ticks_[static_cast<std::size_t>(stage)] += elapsed;
        ticks_of_kind_[static_cast<std::size_t>(kind)] += elapsed;
    }
    /// Keeps some of `rays` for the replay.
    template <typename Batch>
    void record(RayKind kind, const Batch& rays) {
        recorders_[static_cast<std::size_t>(kind)].offer(rays);
        skip();
    }
    /// `count` rays of a kind met something.
    void count_hits(RayKind kind, std::uint64_t count) { hits_[kind] += count; }
    /// Counts an eye path that came to its end.
    void end_eye_path(PathEnding ending, const LongPath& path);
    /// Counts a light subpath of `rays` rays that came to its end.
    void end_light_path(PathEnding ending, int rays) { light_paths_.count(ending, rays); }
    [[nodiscard]] SampleUse& use() { return use_; }

    /// Adds the profile of another thread.
    void add(const WaveProfile& other);

    [[nodiscard]] double seconds(Stage stage) const;
    [[nodiscard]] double seconds(RayKind kind) const {
        return in_seconds(ticks_of_kind_[static_cast<std::size_t>(kind)]);
    }
    /// Returns how many stamps were taken.
    [[nodiscard]] std::uint64_t stamps() const { return stamps_; }
    [[nodiscard]] std::uint64_t hits(RayKind kind) const { return hits_[kind]; }
    [[nodiscard]] const PathTally& eye_paths() const { return eye_paths_; }
    [[nodiscard]] const PathTally& light_paths() const { return light_paths_; }
    /// Returns the longest eye paths, the longest of all first.
    [[nodiscard]] std::span<const LongPath> longest() const { return longest_; }
    [[nodiscard]] const SampleUse& use() const { return use_; }
    [[nodiscard]] const RayRecorder& recorder(RayKind kind) const { return recorders_[static_cast<std::size_t>(kind)]; }

    /// Measures how many seconds of the processor one stamp takes.
    [[nodiscard]] static double seconds_per_stamp();

  private:
    [[nodiscard]] std::uint64_t lap() {
        const std::uint64_t now = ticks_now();
        ++stamps_;
        return now - std::exchange(last_, now);
    }
    [[nodiscard]] double in_seconds(std::uint64_t ticks) const { return in_seconds(static_cast<double>(ticks)); }
    [[nodiscard]] double in_seconds(double ticks) const { return scale_.seconds_per_tick() * ticks; }

    TickScale scale_;
    std::uint64_t last_ = ticks_now();
    std::uint64_t stamps_ = 0;
    std::array<std::uint64_t, kStages> ticks_{};
    std::array<std::uint64_t, kStages> ticks_in_blocks_{};
    std::uint64_t ticks_of_blocks_ = 0;
    bool tells_apart_ = false;
    std::array<std::uint64_t, kRayKinds> ticks_of_kind_{};
    RaysByKind hits_;
    PathTally eye_paths_;
    PathTally light_paths_;
    std::vector<LongPath> longest_;
    SampleUse use_;
    std::vector<RayRecorder> recorders_;  ///< of each kind
};

/// Adds the time since the last stamp to `stage`, where there is a profile.
inline void stamp(WaveProfile* profile, Stage stage) {
    if (profile != nullptr) [[unlikely]]
        profile->stamp(stage);
}

}  // namespace etendue
