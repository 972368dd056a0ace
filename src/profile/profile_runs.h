// Renders that are measured: how fast they are by themselves, and then where their time goes.
#pragma once

#include "core/parallel.h"
#include "profile/accelerator_runs.h"
#include "profile/scene_hits.h"
#include "render/render.h"
#include "report/profile_report.h"
#include "scene/render_settings.h"
#include "world/world.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

struct ProfileRequest {
    std::vector<std::string> integrators{};
    std::vector<int> threads{};          ///< numbers of threads, one for each run of an integrator
    double seconds = 1.0;                ///< seconds of each repetition, about
    std::optional<std::uint32_t> spp{};  ///< samples per pixel of each repetition, in place of `seconds`
    int repetitions = 1;
    bool quiet = false;
};

/// Holds what each pixel has cost one integrator.
struct CostMap {
    std::string integrator{};
    std::vector<float> rays{};     ///< rays of a sample, pixel by pixel of the window
    std::vector<float> seconds{};  ///< CPU seconds of a sample: those of the pixel's tile, shared out by rays
};

struct ProfileRuns {
    std::vector<ProfileRun> runs{};       ///< by integrator, then by threads
    std::vector<CostMap> costs{};         ///< a map of each integrator
    std::size_t film_bytes = 0;           ///< bytes of the largest film
    std::size_t wave_bytes = 0;           ///< bytes that threads keep between tiles, in the run that keeps most
    std::size_t tile_bytes = 0;           ///< bytes of tiles under way and splats that wait, in the run with most
    std::uint64_t peak_memory_bytes = 0;  ///< before anything was recorded
    RecordedRays rays{};                  ///< some of those that were traced again, of all integrators together
    bool interrupted = false;             ///< there may be fewer repetitions then, or none
};

/// Measures every integrator on every number of threads. Repetitions of all runs take turns, so that what else the
/// machine does falls on all alike; each takes the same samples. After them each run renders once more with its stages
/// timed and some of its rays recorded, which bare Embree then traces again on as many threads.
[[nodiscard]] ProfileRuns measure_runs(const World& world, const SceneHitNames& names, const RenderSettings& settings,
                                       const ProfileRequest& request);

}  // namespace etendue
