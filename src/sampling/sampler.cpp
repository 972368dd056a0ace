#include "sampling/sampler.h"

namespace etendue {

void sample_2d(SampleSequence sequence, std::span<const std::uint32_t> pixel_seeds,
               std::span<const std::uint32_t> indices, std::uint32_t dimension, std::span<float> x,
               std::span<float> y) {
    // One loop per sequence: the choice inside would keep the loop from being vectorised.
    const std::size_t count = x.size();
    const std::uint32_t* const seeds = pixel_seeds.data();
    const std::uint32_t* const index = indices.data();
    float* const out_x = x.data();
    float* const out_y = y.data();
    const auto fill = [&](SampleSequence constant_sequence) {
        for (std::size_t i = 0; i < count; ++i) {
            const Vec2f u = sample_2d(constant_sequence, {seeds[i], index[i]}, dimension);
            out_x[i] = u.x;
            out_y[i] = u.y;
        }
    };
    if (sequence == SampleSequence::Sobol)
        fill(SampleSequence::Sobol);
    else
        fill(SampleSequence::Random);
}

}  // namespace etendue
