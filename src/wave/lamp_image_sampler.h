// Samples of images of lamps: what deltas show in the cells of the film that may show a lamp.
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "scene/integrator_settings.h"
#include "transport/delta_tree.h"
#include "wave/aov/path_words.h"
#include "wave/lamp_images.h"
#include "wave/render_counters.h"
#include "wave/tile_job.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace etendue {

/// Holds the light of a lamp that a point of the film shows by way of deltas.
struct LampSeen {
    Rgb light;                       ///< W/(m² sr)
    ExpressionMask expressions = 0;  ///< expressions that the light is a part of
    Vec3f first_position{0.0f};      ///< metres, of the surface that the camera ray has met
    float time = 0.0f;               ///< time of the camera ray, [0, 1] while the shutter is open
};

/// Returns where `film`, pixels of the full image of `job`, is on the film of the camera, in [0, 1)² within the image.
[[nodiscard]] inline Vec2f on_film(const TileJob& job, const Vec2f& film) {
    return {film.x / static_cast<float>(job.full_width), film.y / static_cast<float>(job.full_height)};
}

/// Returns the tree of the camera ray `ray`, whose numbers `key` draws; `tracer` may be null.
[[nodiscard]] DeltaBranch branch_along(const World& world, const TileJob& job, const Ray& ray, SampleKey key,
                                       SampleTracer* tracer);
/// Returns the tree of the ray through `film`, pixels of the full image of `job`, whose lens point and time `key`
/// draws; `tracer` may be null.
[[nodiscard]] DeltaBranch branch_through(const World& world, const TileJob& job, const Vec2f& film, SampleKey key,
                                         SampleTracer* tracer);

/// Appends to `seen` the lamps that `branch`, of a camera ray, shows by paths of `lengths` with at least one delta.
void look_for_lamps(const World& world, const DeltaBranch& branch, const PathLengths& lengths, PathWords& words,
                    std::vector<LampSeen>& seen);

/// Samples the images of lamps for one tile after the other.
class LampImageSampler {
  public:
    /// Hears that the sample of index `sample` of `pixel`, of the tile, is to have `light` of what `seen` tells.
    using Add = std::function<void(const Vec2i& pixel, std::uint32_t sample, const LampSeen& seen, const Rgb& light)>;
    /// True if the job takes the sample of this index of a pixel of the full image.
    using HasSample = std::function<bool(const Vec2i& pixel, std::uint32_t sample)>;

    /// Starts a job, which must outlive the call of `sample`, for paths of `lengths`.
    void start(const World& world, const TileJob& job, const PathLengths& lengths);
    [[nodiscard]] bool is_active() const { return images_ != nullptr; }
    /// Returns true if the lamps that deltas show at `film`, pixels of the full image, are found here.
    [[nodiscard]] bool finds(const Vec2f& film) const { return is_active() && images_->contain(film); }
    /// Draws the samples of all images whose light falls into the tile, for the samples [first, end) of its pixels.
    void sample(std::uint32_t first, std::uint32_t end, const HasSample& has_sample, const Add& add,
                RenderCounters& counters);

  private:
    const World* world_ = nullptr;
    const TileJob* job_ = nullptr;
    PathLengths lengths_;
    const LampImages* images_ = nullptr;  ///< null if there are none
    PathWords words_;
    std::vector<LampSeen> seen_;
};

}  // namespace etendue
