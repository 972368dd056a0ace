// Do two renderings estimate the same image? A z-test of the means of blocks of pixels, whose variance is measured from
// several independent renders: samples within a pixel of a low-discrepancy sampler are not independent, whole renders
// with different seeds are. Samples of different pixels are independent too (every pixel has numbers of its own, and
// pixel filters are importance-sampled, so that no sample counts for two pixels): so the variance of a block's mean is
// the sum of its pixels' over their squared number, and it is known much better than any pixel's.
#pragma once

#include "image/image.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// An image with the variance of each of its values (of the value, not of one of the samples it is a mean of).
struct ImageEstimate {
    ImageF mean;
    ImageF variance;
};

/// From at least two independent renders of one shape, which differ in nothing but their seed. Throws
/// std::invalid_argument if they are too few or differ in shape.
[[nodiscard]] ImageEstimate estimate_image(std::span<const ImageF> renders);

struct AgreementOptions {
    int block_size = 16;         ///< pixels, side of the square blocks; the last ones of a row or column may be smaller
    double significance = 0.01;  ///< probability that any block fails although both images are right
    double mean_tolerance = 0.01;  ///< most relative difference between the means of the whole images
    double block_tolerance = 0.0;  ///< relative; smaller differences of a block count as none: what rounding explains
};

/// A block, or the whole image, and how it differs.
struct BlockDifference {
    int x = 0;  ///< of the first pixel
    int y = 0;
    int width = 0;
    int height = 0;
    int channel = 0;
    double mean_a = 0.0;
    double mean_b = 0.0;
    double z = 0.0;  ///< (mean_a - mean_b) / standard error; beyond the tolerance, else 0
};

struct BlockAgreement {
    bool blocks_agree = false;
    bool means_agree = false;
    double p_value = 1.0;   ///< of the worst block, corrected for the number of blocks and channels (Sidak 1967)
    std::size_t tests = 0;  ///< blocks and the whole image, times channels
    BlockDifference worst;
    /// Largest relative difference of the images' means over the channels.
    double mean_difference = 0.0;

    [[nodiscard]] bool agree() const { return blocks_agree && means_agree; }
    /// For a failure message.
    [[nodiscard]] std::string str() const;
};

/// Two-sided z-tests of all blocks and channels of `a` against those of `b`, and of the whole image as one more block,
/// which sees small differences everywhere; and a comparison of the images' means by their size. Throws
/// std::invalid_argument if the shapes differ. Values that are not finite do not agree.
[[nodiscard]] BlockAgreement test_agreement(const ImageEstimate& a, const ImageEstimate& b,
                                            const AgreementOptions& options = {});

}  // namespace etendue
