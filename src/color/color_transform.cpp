#include "color/color_transform_impl.h"

#include <cassert>
#include <cstddef>

namespace etendue {

ColorTransform::ColorTransform() = default;
ColorTransform::~ColorTransform() = default;
ColorTransform::ColorTransform(const ColorTransform&) = default;
ColorTransform& ColorTransform::operator=(const ColorTransform&) = default;

Rgb ColorTransform::operator()(const Rgb& c) const {
    if (!impl_) return c;
    float values[3] = {c.r, c.g, c.b};
    impl_->processor->applyRGB(values);
    return {values[0], values[1], values[2]};
}

void ColorTransform::apply(std::span<float> pixels, int channels) const {
    assert((channels == 3 || channels == 4) && pixels.size() % static_cast<std::size_t>(channels) == 0);
    if (!impl_ || pixels.empty()) return;
    // Three channels at the stride of `channels`: OpenColorIO's curves would change the last bits of an alpha they saw.
    const auto count = static_cast<long>(pixels.size()) / channels;
    const auto pixel_bytes = static_cast<std::ptrdiff_t>(sizeof(float)) * channels;
    OCIO_NAMESPACE::PackedImageDesc image(pixels.data(), count, 1, 3, OCIO_NAMESPACE::BIT_DEPTH_F32, sizeof(float),
                                          pixel_bytes, pixel_bytes * count);
    impl_->processor->apply(image);
}

}  // namespace etendue
