// Scheduling: tiles, passes, progress and stopping. Knows nothing of light transport.
#pragma once

#include "core/parallel.h"
#include "film/film.h"
#include "image/image.h"
#include "integrator/integrator.h"
#include "render/progressive_render.h"
#include "world/world.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

namespace etendue {

struct RenderOptions : SamplingOptions {
    std::uint32_t spp = 64;
    double time_limit_seconds = 0.0;  ///< no pass starts after this; 0 for no limit
};

/// How far a render is.
struct RenderProgress {
    double fraction = 0.0;  ///< of all samples, [0, 1]
    double seconds = 0.0;   ///< since the first pass began
    std::uint64_t samples = 0;
    std::uint64_t rays = 0;
};

/// Called from rendering threads, one call at a time, ten times a second at most and once at the end.
using ProgressCallback = std::function<void(const RenderProgress&)>;

enum class HaltReason {
    SamplesDone,
    TimeLimit,
    Interrupted,
};
[[nodiscard]] const char* halt_reason_name(HaltReason reason);

struct RenderResult {
    RenderCounters counters;
    HaltReason halt_reason = HaltReason::SamplesDone;
    std::uint32_t spp_done = 0;  ///< complete passes; single tiles may have more
    double wall_seconds = 0.0;
    double cpu_seconds = 0.0;  ///< of all threads
    Film film;
};

/// Renders `world`. The image is bit-identical for every thread count and tile order. `stop` is looked at before every
/// tile: when it becomes true, the tiles under way are finished and what there is is returned.
[[nodiscard]] RenderResult render(const World& world, const Integrator& integrator, const RenderOptions& options,
                                  const ThreadPool& threads, const std::atomic<bool>& stop,
                                  const ProgressCallback& progress);

/// The film's means of red, green, blue and alpha.
[[nodiscard]] ImageF rgba_image(const Film& film);

/// Seconds of processor time that this process has used, all threads together.
[[nodiscard]] double process_cpu_seconds();

}  // namespace etendue
