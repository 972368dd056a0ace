// What the tasks of a scene need, from a short probe of it.
#pragma once

#include "farm/farm_plan.h"
#include "film/film.h"
#include "scene/scene_desc.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace etendue {

/// Holds what `etendue render --probe` has measured of one image.
struct RenderProbe {
    double start_seconds = 0.0;   ///< seconds from the start of the process to the first sample
    double render_seconds = 0.0;  ///< seconds to render all samples with `threads` threads
    std::uint64_t peak_memory_bytes = 0;
    int threads = 1;
    std::uint64_t deep_bytes = 0;  ///< part of peak_memory_bytes for depths, which the first samples have not filled
};

/// Times as much as the probe tells: nodes may be slower than the machine that was probed on, other frames may need
/// more than the first, and checkpoints and images have to be written.
inline constexpr double kTimeSafety = 3.0;
inline constexpr double kMemorySafety = 1.5;
/// No task gets less, so that schedulers and file systems have time for what is theirs.
inline constexpr int kLeastMinutes = 10;
inline constexpr int kLeastMebibytes = 512;

/// Probes the first image of a scene with the options of its renders, in a process of its own: a scene that ends it
/// ends no other. Throws SceneError with the program's words if it cannot be rendered.
[[nodiscard]] RenderProbe probe_scene(const ImageJob& first_image, const std::vector<GivenOption>& options);

/// Reads what the probe prints. Throws IoError if that is something else.
[[nodiscard]] RenderProbe parse_probe(const std::string& text);

/// How large an image is in memory and in files.
struct FilmSize {
    std::uint64_t pixels = 0;        ///< pixels that are rendered
    std::uint64_t splat_pixels = 0;  ///< pixels that splats are kept for; 0 without splats
    bool has_second_film = false;    ///< for an estimate of the error, or for denoising
    LayerLayout layers{};
    std::size_t channels = 4;  ///< channels of the image that is written

    /// Returns the bytes of the film's sums.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_with(layers); }
    /// Returns the bytes of the sums of the second film, which has no mattes and depths; 0 if there is none.
    [[nodiscard]] std::uint64_t second_bytes() const {
        return has_second_film ? bytes_with(layers.without_lists()) : 0;
    }
    /// Returns the most bytes that depths may take of the film.
    [[nodiscard]] std::uint64_t deep_bytes() const {
        return layers.is_deep ? DeepBuffer::most_bytes(splat_pixels > 0) * pixels : 0;
    }
    /// Returns the bytes of all films of a merge, whose second one has room for the same as the first.
    [[nodiscard]] std::uint64_t merge_bytes() const { return (has_second_film ? 2 : 1) * bytes(); }

  private:
    [[nodiscard]] std::uint64_t bytes_with(const LayerLayout& layout) const {
        const std::size_t splat_layers = 1 + layout.light + (layout.has_moments ? 1 : 0);
        return (sizeof(PixelSum) + layout.bytes(splat_pixels > 0)) * pixels +
               sizeof(SplatSum) * splat_layers * splat_pixels;
    }
};
/// Returns the size of the image of `scene`. Throws as make_aov_plan does.
[[nodiscard]] FilmSize film_size_of(const SceneDesc& scene);

/// Returns the bytes that all of a render takes whose beginning had `peak_memory_bytes`, `deep_bytes` of them for
/// depths: a probe neither writes an image nor keeps a second film, and its depths may become many more.
[[nodiscard]] double memory_of_render(std::uint64_t peak_memory_bytes, std::uint64_t deep_bytes, const FilmSize& size);

/// Returns the needs of a task with `threads` threads that takes `share` of the samples of an image, (0, 1].
[[nodiscard]] TaskNeeds needs_of(const RenderProbe& probe, const FilmSize& size, double share, int threads);

/// Returns the seconds before its time is up at which a task is to write its checkpoint: kLeastWarningSeconds, and the
/// time that a slow disk takes for its films.
[[nodiscard]] int warning_seconds_for(const FilmSize& size);

/// Returns the needs of the task that merges `parts` parts of an image: in memory are the sums, a part, and as much for
/// reading it; the time is that of the model in docs/farm.md, three times, as for renders.
[[nodiscard]] TaskNeeds merge_needs_of(const FilmSize& size, std::size_t parts);

}  // namespace etendue
