// The parts of a wave's work that a profile tells apart, and how long they take a thread.
#pragma once

#include "core/tick_clock.h"
#include "wave/ray_kind.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace etendue {

/// Names the stages of a wave, in their order.
enum class Stage : std::uint8_t {
    Generate,       ///< camera rays, and where light paths begin
    Numbers,        ///< random numbers of a bounce
    Intersect,      ///< nearest surfaces
    HitSetup,       ///< points on surfaces with their frames, normal maps included; what the first hits show; media
    Emission,       ///< light that rays meet, with its MIS weight: lamps and the environment
    Textures,       ///< textures looked up, and the lobes that they ask for
    LightSampling,  ///< points on lights
    Material,       ///< lobes evaluated and sampled
    Mis,            ///< weights of samples and connections, and the rays that will decide whether they count
    Roulette,       ///< paths ended, moved and left behind
    Occluded,       ///< whether something is in the way
    Splat,          ///< light that arrived added to samples and put on the film
    Film,           ///< samples added to pixels
    Count
};

inline constexpr std::size_t kStages = static_cast<std::size_t>(Stage::Count);

/// Holds the names of the stages in reports, in the order of `Stage`.
inline constexpr std::array<std::string_view, kStages> kStageNames{
    "generate", "random numbers", "intersect",      "hit set-up",
    "emission", "textures",       "light sampling", "material evaluation",
    "MIS",      "roulette",       "occluded",       "splat",
    "film"};

/// Shares the time of a thread among stages: each stamp adds the time since the last one to a stage.
class StageClock {
  public:
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

    /// Adds the times of another thread.
    void add(const StageClock& other);

    /// Returns the time that `stage` took.
    [[nodiscard]] double seconds(Stage stage) const;
    /// Returns the time that tracing rays of `kind` took.
    [[nodiscard]] double seconds(RayKind kind) const {
        return in_seconds(static_cast<double>(ticks_of_kind_[static_cast<std::size_t>(kind)]));
    }
    /// Returns how many stamps were taken.
    [[nodiscard]] std::uint64_t stamps() const { return stamps_; }
    /// Measures how many seconds of the processor one stamp takes.
    [[nodiscard]] static double seconds_per_stamp();

  private:
    [[nodiscard]] std::uint64_t lap() {
        const std::uint64_t now = ticks_now();
        ++stamps_;
        return now - std::exchange(last_, now);
    }
    [[nodiscard]] double in_seconds(double ticks) const { return scale_.seconds_per_tick() * ticks; }

    TickScale scale_;
    std::uint64_t last_ = ticks_now();
    std::uint64_t stamps_ = 0;
    std::array<std::uint64_t, kStages> ticks_{};
    std::array<std::uint64_t, kStages> ticks_in_blocks_{};
    std::uint64_t ticks_of_blocks_ = 0;
    bool tells_apart_ = false;
    std::array<std::uint64_t, kRayKinds> ticks_of_kind_{};
};

}  // namespace etendue
