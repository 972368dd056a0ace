#include "sampling/sampler.h"

#include "core/wide_bits.h"

namespace etendue {

void sample_2d(SampleSequence sequence, std::span<const std::uint32_t> pixel_seeds,
               std::span<const std::uint32_t> indices, std::uint32_t dimension, std::span<float> x,
               std::span<float> y) {
    const std::size_t count = x.size();
    std::size_t i = 0;
    if (sequence == SampleSequence::Sobol)
        for (; i + Wide::kWidth <= count; i += Wide::kWidth) {
            const WideBits seed = hash_combine(WideBits::load(&pixel_seeds[i]), dimension);
            const PointBits<WideBits> point = owen_sobol_bits(WideBits::load(&indices[i]), seed);
            to_unit_float(point.x).store_unaligned(&x[i]);
            to_unit_float(point.y).store_unaligned(&y[i]);
        }
    for (; i < count; ++i) {
        const Vec2f u = sample_2d(sequence, {pixel_seeds[i], indices[i]}, dimension);
        x[i] = u.x;
        y[i] = u.y;
    }
}

}  // namespace etendue
