// One tile of a world, without the scheduling of render/.
#pragma once

#include "integrator/integrator.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace etendue::test {

/// `spp` samples of the pixels of `window`, row by row, of an image of `width` × `height`.
[[nodiscard]] inline std::vector<Rgb> render_pixels(const World& world, const Integrator& integrator,
                                                    const PixelRect& window, int width, int height, std::uint32_t spp) {
    const PixelFilter filter(FilterShape::Box);
    const auto scratch = integrator.make_scratch();
    const TileJob job{window, window, width, height, 0, spp, 1, SampleSequence::Sobol, &filter};
    TileBuffer tile;
    tile.reset(job.rect);
    RenderCounters counters;
    integrator.render_tile(world, job, *scratch, tile, counters);
    std::vector<Rgb> pixels;
    for (std::size_t i = 0; i < job.rect.area(); ++i) {
        const PixelSum& sum = tile.pixel(i);
        const double scale = 1.0 / static_cast<double>(sum.samples);
        pixels.emplace_back(static_cast<float>(sum.r * scale), static_cast<float>(sum.g * scale),
                            static_cast<float>(sum.b * scale));
    }
    return pixels;
}

struct TileResult {
    Rgb mean;            ///< over all pixels
    double error = 0.0;  ///< standard error of the mean's green channel
    double alpha = 0.0;  ///< mean
    RenderCounters counters;
};

/// `spp` samples of each of the 4 × 4 pixels of the scenes of world/test_scene.h. The error is estimated from
/// independent repetitions with other seeds.
[[nodiscard]] inline TileResult render_tile(const World& world, const Integrator& integrator, std::uint32_t spp,
                                            SampleSequence sequence = SampleSequence::Sobol) {
    constexpr std::uint32_t kRepetitions = 8;
    const PixelFilter filter(FilterShape::Box);
    const auto scratch = integrator.make_scratch();
    TileResult result;
    std::vector<double> means;
    for (std::uint32_t seed = 0; seed < kRepetitions; ++seed) {
        const TileJob job{{0, 0, 4, 4}, {0, 0, 4, 4}, 4, 4, 0, spp, seed, sequence, &filter};
        TileBuffer tile;
        tile.reset(job.rect);
        integrator.render_tile(world, job, *scratch, tile, result.counters);
        PixelSum sum;
        for (std::size_t i = 0; i < job.rect.area(); ++i) {
            const PixelSum& p = tile.pixel(i);
            sum.r += p.r, sum.g += p.g, sum.b += p.b, sum.alpha += p.alpha;
            sum.samples += p.samples;
        }
        const double scale = 1.0 / static_cast<double>(sum.samples);
        means.push_back(sum.g * scale);
        result.mean += Rgb(static_cast<float>(sum.r * scale), static_cast<float>(sum.g * scale),
                           static_cast<float>(sum.b * scale)) /
                       static_cast<float>(kRepetitions);
        result.alpha += sum.alpha * scale / kRepetitions;
    }
    double squares = 0.0;
    for (const double m : means) {
        const double difference = m - static_cast<double>(result.mean.g);
        squares += difference * difference;
    }
    result.error = std::sqrt(squares / (kRepetitions - 1.0) / kRepetitions);
    return result;
}

}  // namespace etendue::test
