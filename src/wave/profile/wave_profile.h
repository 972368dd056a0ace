// What the waves of one thread do and how long it takes, for `etendue profile`. Renders have none.
#pragma once

#include "core/ray.h"
#include "wave/profile/ray_recorder.h"
#include "wave/profile/stage_clock.h"
#include "wave/ray_kind.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
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
    std::uint64_t light_samples = 0;  ///< samples of next-event estimation
    // Of eye paths:
    std::uint64_t bsdf_samples = 0;
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

/// Counts what the waves of one thread do, and has the clock that times them.
class WaveProfile {
  public:
    /// Long paths that are remembered.
    static constexpr std::size_t kLongPaths = 16;

    /// `recorded_rays` is about how many rays of each kind are kept.
    explicit WaveProfile(std::size_t recorded_rays);

    /// Returns the clock that shares the thread's time among stages.
    [[nodiscard]] StageClock& clock() { return clock_; }
    [[nodiscard]] const StageClock& clock() const { return clock_; }
    /// Keeps some of `rays` for the replay.
    template <typename Batch>
    void record(RayKind kind, const Batch& rays) {
        recorders_[static_cast<std::size_t>(kind)].offer(rays);
        clock_.skip();
    }
    /// `count` rays of a kind met something.
    void count_hits(RayKind kind, std::uint64_t count) { hits_[kind] += count; }
    /// Counts an eye path that came to its end.
    void count_eye_path_end(PathEnding ending, const LongPath& path);
    /// Counts a light subpath of `rays` rays that came to its end.
    void end_light_path(PathEnding ending, int rays) { light_paths_.count(ending, rays); }
    [[nodiscard]] SampleUse& use() { return use_; }

    /// Adds the profile of another thread.
    void add(const WaveProfile& other);

    [[nodiscard]] std::uint64_t hits(RayKind kind) const { return hits_[kind]; }
    [[nodiscard]] const PathTally& eye_paths() const { return eye_paths_; }
    [[nodiscard]] const PathTally& light_paths() const { return light_paths_; }
    /// Returns the longest eye paths, the longest of all first.
    [[nodiscard]] std::span<const LongPath> longest() const { return longest_; }
    [[nodiscard]] const SampleUse& use() const { return use_; }
    [[nodiscard]] const RayRecorder& recorder(RayKind kind) const { return recorders_[static_cast<std::size_t>(kind)]; }

  private:
    StageClock clock_;
    RaysByKind hits_;
    PathTally eye_paths_;
    PathTally light_paths_;
    std::vector<LongPath> longest_;
    SampleUse use_;
    std::vector<RayRecorder> recorders_;  ///< recorder of each kind of ray
};

/// Adds the time since the last stamp to `stage`, where there is a profile.
inline void stamp(WaveProfile* profile, Stage stage) {
    if (profile != nullptr) [[unlikely]]
        profile->clock().stamp(stage);
}

}  // namespace etendue
