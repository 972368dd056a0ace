// What is said of an image besides its pixels, kept with its checkpoints and parts.
#pragma once

#include "film/bucket_layers.h"
#include "output/aov_output.h"
#include "output/output_frame.h"
#include "output/statistics.h"
#include "picture/aov_setup.h"
#include "render/progressive_render.h"
#include "scene/aov_desc.h"
#include "scene/scene_desc.h"
#include "world/world.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

struct ImageDescription {
    OutputFrame frame;            ///< without pixels, layers, window and counts, which the film knows
    std::vector<AovOutput> aovs;  ///< the layers that the film has
    AovLayout aov_layout = AovLayout::Layers;
    bool has_halves = false;      ///< layers of half of the samples were asked for, too
    BucketLayers buckets{};       ///< layers of the median of means that the image is; none if it is the mean
    float clamp_indirect = 0.0f;  ///< the limit of indirect contributions; 0 for none
    std::optional<std::size_t> removed_light{};  ///< the light layer of what that took away
    PixelDepth depth = PixelDepth::Half;  ///< depth in which the image is written, unless a merge is told another
    RenderStatistics statistics;          ///< statistics of the render; read back, without its cost
};

/// The description of an image of `scene`, whose names of colour spaces are resolved, with the layers of `plan`.
[[nodiscard]] ImageDescription describe_settings(const SceneDesc& scene, const AovPlan& plan);

/// Puts in the integrator of `settings`, and all settings with it.
void describe_integrator(ImageDescription& description, const RenderSettings& settings);

/// Puts in how the camera sees the world.
void describe_camera(ImageDescription& description, const World& world);

/// Puts in what the film and the counters of `state` say: pixels, window, samples, rays and seconds, and why rendering
/// ended.
void describe_state(ImageDescription& description, const RenderState& state, bool complete,
                    const std::string& halt_reason);

/// A sentence if the median of means is one of few means, or none: the fewer, the nearer to the mean.
[[nodiscard]] std::optional<std::string> few_buckets(const RenderStatistics& statistics);

/// Puts in the layers of the film, and if the state has every other pass by itself, those of that.
void resolve_layers(ImageDescription& description, const RenderState& state);

}  // namespace etendue
