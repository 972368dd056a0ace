// Lamps that camera rays meet at once, estimated with what the samples of neighbouring pixels have met: alone, a sample
// far from its pixel meets a lamp rarely and brings all of its light, far too much in some pixels beside every lamp.
// Sample i of pixel p is given the light E that the i-th samples of p and its eight neighbours q have met at x_q,
//
//   sum over q of f_p(x_q) E(x_q) / sum over q' of d_q'(x_q)
//
// where f is the filter and d the density with which samples are placed (Veach 1997, equation 9.8; docs/derivations.md,
// equation 22). Neighbours may lie beside the image. It is a function of the seed, the pixel and the sample: i-th
// samples of pixels that the tile does not render are traced again, as far as what they meet first. So crops, parts and
// adaptive passes see what the whole image would.
//
// Filters with negative parts keep to a pixel's own samples, as does a box that reaches no neighbour's: weights of both
// signs divide a pixel's light, and what has no part in them would be noisier for it. So does a pixel where rays
// through the middles of all nine meet emission of about the same brightness.
#pragma once

#include "core/pixel_rect.h"
#include "scene/integrator_settings.h"
#include "wave/camera_wave.h"
#include "wave/lamp_images.h"
#include "wave/lamps_by_deltas.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace etendue {

class LampsInView {
  public:
    /// Share, in [0, 1], of the light of `point`, which the ray of `sample` has met, that is to be found so.
    using Share = std::function<float(const CameraSample& sample, const Ray& ray, const SurfacePoint& point)>;

    /// Starts a job, which must outlive the call of `finish`, for paths of `lengths`. Without a `share` it is all
    /// light.
    void start(const World& world, const TileJob& job, const PathLengths& lengths, bool filters_textures,
               Share share = {});

    /// True if the emission of what a camera ray has hit first is found here, and nobody else may add it.
    [[nodiscard]] bool finds_emission(const Hit& hit) const { return is_active_ && is_lamp(*world_, hit); }

    /// Returns true if the emission that a path of `sample` has met by deltas alone is found here (lamp_images.h).
    [[nodiscard]] bool finds_image(const CameraSample& sample) const {
        return images_ != nullptr && images_->contain(film_position(sample));
    }

    /// Notes what lamps `samples` of the job have met: `rays` are theirs, `hits` what these met first.
    void note(std::span<const CameraSample> samples, std::span<const Ray> rays, std::span<const Hit> hits,
              RenderCounters& counters);
    /// Notes what else `samples` of the job have found, for layers that tell of their variance.
    void note_radiance(std::span<const CameraSample> samples, const SampleLight& light);

    /// Adds the light of lamps to the pixels of the job and their layers, once all samples are noted.
    void finish(TileBuffer& tile, RenderCounters& counters);

    [[nodiscard]] std::size_t bytes() const;

  private:
    /// The lamp that a sample has met.
    struct Met {
        Vec2i pixel;               ///< whose sample it is, of the full image
        std::uint32_t sample = 0;  ///< index in that pixel
        Vec2f offset;              ///< on the film, pixels from the middle of that pixel
        Rgb light;
        ExpressionMask expressions = 0;
        float depth = 0.0f;  ///< metres along the viewing direction; of deep images only
    };

    /// Returns where `sample` of the job falls on the film, pixels of the full image.
    [[nodiscard]] Vec2f film_position(const CameraSample& sample) const;
    /// Draws the samples of all images of lamps whose light falls into the tile.
    void sample_images(TileBuffer& tile, RenderCounters& counters);
    [[nodiscard]] static bool is_lamp(const World& world, const Hit& hit);
    /// True if the job takes the sample of this index of `pixel`.
    [[nodiscard]] bool has_sample(const Vec2i& pixel, std::uint32_t sample) const;
    [[nodiscard]] SurfacePoint surface_point(const Ray& ray, const Hit& hit) const;
    /// Nobody counts what is dropped if `counters` is null.
    void note(const CameraSample& sample, const Vec2i& pixel, const Ray& ray, const Hit& hit, RenderCounters* counters);
    /// Traces those samples of neighbours that the job does not take.
    void trace_neighbours(RenderCounters& counters);
    /// Finds the emission in the middle of each pixel that light may be added to, and of its neighbours.
    void look_at_middles(RenderCounters& counters);
    /// True if a pixel keeps to its own samples.
    [[nodiscard]] bool has_even_middles(const Vec2i& pixel) const;
    void spread(const Met& met, TileBuffer& tile, RenderCounters& counters);
    /// Adds what `met` brings to the pixel at `position`.
    void add(const Met& met, const Vec2i& position, const Rgb& light, TileBuffer& tile);
    /// Has `counters` remember `light`, if it is bright.
    void offer(const Met& met, const Vec2i& position, const Rgb& light, RenderCounters& counters) const;
    /// Returns the radiance that a sample has found; `pixel` is its pixel in the tile, and the job takes it.
    [[nodiscard]] Rgb& found_by(std::uint32_t pixel, std::uint32_t sample);

    const World* world_ = nullptr;
    const TileJob* job_ = nullptr;
    bool filters_textures_ = false;
    Share share_;
    bool is_active_ = false;
    PathLengths lengths_;
    const LampImages* images_ = nullptr;        ///< images of lamps; null if there are none
    std::vector<LampSeen> seen_;                ///< lamps that the current sample of an image has found
    PixelRect around_;                          ///< the job's rectangle with the neighbours of its pixels
    std::vector<std::uint32_t> first_samples_;  ///< by pixel of the tile; kNone of those without samples
    std::vector<Met> met_;
    std::vector<Rgb> found_;      ///< by pixel and sample; only if there are layers of variance
    std::vector<float> middles_;  ///< the largest component of the emission there, by pixel of `around_`
    std::vector<std::uint8_t> asks_for_middle_;
    std::vector<std::uint8_t> is_even_;  ///< by pixel of the tile: 1 for those that keep to their own samples
    // Of rays that are traced for neighbours and middles.
    std::vector<Vec2i> positions_;
    std::vector<CameraSample> samples_;
    std::vector<Vec2f> film_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    PathWords words_;
    std::vector<ExpressionShare> shares_;
};

}  // namespace etendue
