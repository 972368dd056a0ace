// The pyramid of all strategies of a scene, in files.
#pragma once

#include "color/color_config.h"
#include "core/parallel.h"
#include "image/write.h"
#include "integrator/integrator.h"
#include "output/output_frame.h"
#include "output/statistics.h"
#include "picture/output_paths.h"
#include "render/render.h"
#include "render/strategy_pyramid.h"
#include "scene/render_settings.h"

#include <filesystem>
#include <span>
#include <string>

namespace etendue {

struct StrategiesRequest {
    /// The longest paths whose strategies are shown if none are asked for: the sheet of images grows as their square.
    static constexpr int kLongest = 8;

    std::filesystem::path output{};  ///< the EXR, a PNG goes beside it; empty for none
    int longest = 0;                 ///< edges; 0 for the smaller of kLongest and the integrator's longest
    bool weighted = true;
};

/// Returns a description of the strategies image that `request` asks for, if paths have these `lengths`.
[[nodiscard]] StrategiesShown strategies_shown(const StrategiesRequest& request, const PathLengths& lengths);

/// Returns whether no strategies image is asked for, or the one asked for, of paths of these `lengths`, was written
/// with the render whose files are `image`, and after it.
[[nodiscard]] bool has_strategies_image(const StrategiesRequest& request, const PathLengths& lengths,
                                        const OutputPaths& image);

/// Before anything is rendered: throws UsageError if the pyramid would be written over the image, whose files are
/// `image`, or would show nothing, and std::runtime_error if it needs more memory than the machine has.
void check_strategies_request(const StrategiesRequest& request, std::span<const std::filesystem::path> image,
                              const RenderSettings& settings, const RenderOptions& options, PixelDepth depth);

/// Renders every strategy of the integrator of these settings, and its merges, if it has any, and writes an EXR with a
/// part for each, named "s0t2" and so on, and a PNG with all of them labelled (s,t), a row for each length of path.
/// `frame` says what is to be said of the image. Returns false, and writes nothing, if it is interrupted.
[[nodiscard]] bool write_strategies_image(const StrategiesRequest& request, const World& world,
                                          const IntegratorSettings& integrator, const RenderOptions& options,
                                          OutputFrame frame, const ColorConfig& colors, PixelDepth depth,
                                          const ThreadPool& threads, const std::string& title, bool quiet);

/// "(s,t)", or "merges"
[[nodiscard]] std::string strategy_label(const Strategy& strategy);

}  // namespace etendue
