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
#include <optional>
#include <string>

namespace etendue {

struct RenderOptions : SamplingOptions {
    std::uint32_t spp = 64;
    double time_limit_seconds = 0.0;  ///< no pass starts after this; 0 for no limit
    double relative_error = 0.0;      ///< no pass starts once the estimate is below this; 0 for no limit
    /// Once the error can be estimated, samples go where they lower it most, see plan_adaptive_pass. It needs a limit
    /// of the error; `spp` is then the most that a pixel gets.
    bool adaptive = false;
    std::uint32_t min_spp = 0;  ///< that every pixel gets before
};

/// How far a render is.
struct RenderProgress {
    /// Share of the samples that are taken, or of the time limit that has passed, whichever is larger, [0, 1]; 1 once
    /// the image is complete. With a limit of the error, the render may end sooner than it says.
    double fraction = 0.0;
    double seconds = 0.0;  ///< seconds of rendering
    std::uint64_t samples = 0;
    std::uint64_t rays = 0;
};

/// Called from rendering threads, one call at a time, ten times a second at most and once at the end.
using ProgressCallback = std::function<void(const RenderProgress&)>;

enum class HaltReason {
    SamplesDone,
    TimeLimit,
    ErrorReached,
    Interrupted,
};
[[nodiscard]] const char* halt_reason_name(HaltReason reason);

/// Root of the mean squared relative error to be expected of the image, from the passes that it is made of; see
/// estimate_errors. There is none as long as there are too few samples, or if every other pass is not kept.
[[nodiscard]] std::optional<double> relative_error(const RenderState& state);

struct RenderResult : RenderState {
    HaltReason halt_reason = HaltReason::SamplesDone;
};

/// Holds what is done now and then in the middle of a render, such as writing a checkpoint.
struct RenderPause {
    StopPredicate is_due;                         ///< false for a while after `act`
    std::function<void(const RenderState&)> act;  ///< nothing is rendered meanwhile
};

/// Renders `world`, beginning with `state`. A pass that was stopped is finished first, so that no pixel of what is
/// returned has fewer samples than others unless it was interrupted or is adaptive; if `state` has more samples than
/// are asked for, so has the result. The image is bit-identical for every thread count and tile order, and however
/// often the render was stopped and gone on with. `stop` and `pause` are looked at before every tile (or group of
/// tiles, see ProgressiveRender): when one of them says so, those under way are finished, and what there is is returned
/// or shown to `pause`. The limit of time counts what `state` has taken; that of the error needs a state that keeps
/// every other pass.
[[nodiscard]] RenderResult render(const World& world, const Integrator& integrator, const RenderOptions& options,
                                  const ThreadPool& threads, const std::atomic<bool>& stop,
                                  const ProgressCallback& progress, const RenderPause& pause, RenderState state);

/// Renders `world` from the first sample, without pauses. `stop` and `progress` are used as in the overload that begins
/// with a `RenderState`.
[[nodiscard]] RenderResult render(const World& world, const Integrator& integrator, const RenderOptions& options,
                                  const ThreadPool& threads, const std::atomic<bool>& stop,
                                  const ProgressCallback& progress);

/// The film's means of red, green, blue and alpha.
[[nodiscard]] ImageF rgba_image(const Film& film);

}  // namespace etendue
