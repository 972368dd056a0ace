// How samples of a tile begin, as camera rays, and end, in pixels and layers.
#pragma once

#include "core/ray.h"
#include "transport/dimensions.h"
#include "wave/aov/sample_light.h"
#include "wave/profile/wave_profile.h"
#include "wave/render_counters.h"
#include "wave/tile_job.h"
#include "world/world.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// One camera sample.
struct CameraSample {
    SampleKey key;
    std::uint32_t pixel = 0;  ///< index in the tile, row by row
    float weight = 1.0f;      ///< weight by the pixel filter
    Vec2f lens{0.0f, 0.0f};   ///< chooses the point on the lens, in [0, 1)²
    bool is_blind = false;    ///< it comes from where the film sees nothing: it is black, and shows nothing
};

/// How the samples of a job are numbered.
enum class SampleOrder : std::uint8_t {
    /// All of one pixel after those of another: neighbours in a wave see the same surface, and so read the same
    /// triangles, texels and nodes of the BVH, and are shaded by the same code.
    PixelByPixel,
    /// One of every pixel, then the next of every pixel: where the samples of a wave share what they are made of, those
    /// of a pixel, which are in different waves, stay independent.
    SampleBySample
};

/// Returns how many camera samples all pixels of the job have together.
[[nodiscard]] inline std::size_t camera_sample_count(const TileJob& job) {
    return (job.pixels.empty() ? job.rect.area() : job.pixels.size()) * job.sample_count;
}

/// Returns where pixel `pixel` of the job's tile is in the full image.
[[nodiscard]] inline Vec2i pixel_position(const TileJob& job, std::uint32_t pixel) {
    const auto width = static_cast<std::uint32_t>(job.rect.width());
    return {job.rect.x0 + static_cast<int>(pixel % width), job.rect.y0 + static_cast<int>(pixel / width)};
}

/// Returns where `sample` is, for the report of a dropped one. A light path belongs to the pixel of its sample,
/// wherever its splats fall.
[[nodiscard]] inline DroppedSample located(const TileJob& job, const CameraSample& sample) {
    const Vec2i position = pixel_position(job, sample.pixel);
    return {position.x, position.y, sample.key.index};
}

/// Tells the profile of `job`, if there is one, of the end of the eye path of `sample` after `rays` rays.
inline void count_eye_path_end(const TileJob& job, const CameraSample& sample, PathEnding ending, int rays) {
    if (job.profile == nullptr) return;
    const Vec2i pixel = pixel_position(job, sample.pixel);
    job.profile->count_eye_path_end(ending, {pixel.x, pixel.y, sample.key.index, rays});
}

/// Makes the camera rays of samples [first, first + rays.size()) of the job.
void generate_camera_rays(const World& world, const TileJob& job, std::size_t first, std::span<CameraSample> samples,
                          std::span<Ray> rays, SampleOrder order = SampleOrder::PixelByPixel);

/// Makes the camera rays of `samples`, whose keys are known, as are their pixels' `positions` in the full image.
void generate_camera_rays(const World& world, const TileJob& job, std::span<const Vec2i> positions,
                          std::span<CameraSample> samples, std::span<Ray> rays);

/// Adds `radiance` to the sample's pixel; drops, counts and locates what is not finite or negative: false if it was.
bool accumulate(const TileJob& job, const CameraSample& sample, const Rgb& radiance, float alpha, TileBuffer& tile,
                RenderCounters& counters);

/// Adds all that the samples have found, with their alphas, to their pixels and layers.
void accumulate(const TileJob& job, std::span<const CameraSample> samples, const SampleLight& light,
                std::span<const float> alpha, TileBuffer& tile, RenderCounters& counters);

}  // namespace etendue
