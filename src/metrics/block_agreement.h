// Do two renderings estimate the same image? A z-test of the means of blocks of pixels, whose variance is measured from
// several independent renders: samples within a pixel of a low-discrepancy sampler are not independent, whole renders
// with different seeds are. Samples of different pixels are independent too (every pixel has numbers of its own, and
// pixel filters are importance-sampled, so that no sample counts for two pixels): so the variance of a block's mean is
// the sum of its pixels' over their squared number, and it is known much better than any pixel's. Splats are not so:
// each counts for all pixels that its filter reaches, unless that is a box. `widen_for_correlation` makes up for it.
#pragma once

#include "image/image.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// An image with the variance of each of its values (of the value, not of one of the samples it is a mean of).
struct ImageEstimate {
    ImageF mean;
    ImageF variance;
};

struct AgreementOptions {
    int block_size = 16;         ///< pixels, side of the square blocks; the last ones of a row or column may be smaller
    double significance = 0.01;  ///< probability that any block fails although both images are right
    double mean_tolerance = 0.01;  ///< most relative difference between the means of the whole images
    double block_tolerance = 0.0;  ///< relative; smaller differences of a block count as none: what rounding explains
    /// Tells whether a block that is black and without variance in one image is certainly black. Otherwise, chance may
    /// have hidden its light: tests that only such blocks fail are left out, also that of the whole image.
    bool black_is_certain = true;
};

/// From at least two independent renders of one shape, which differ in nothing but their seed. Throws
/// std::invalid_argument if they are too few or differ in shape.
[[nodiscard]] ImageEstimate estimate_image(std::span<const ImageF> renders);

/// Mean over pixels and channels of variance / (m² + kMetricEpsilon), m being the mean of the pixel's block: of its own
/// mean a pixel with a firefly would have no more than another. Of the mean of the renders, as the variances are.
[[nodiscard]] double relative_variance(const ImageEstimate& estimate, int block_size = AgreementOptions{}.block_size);

/// Multiplies the variances of `estimate`, which `renders` made, by the mean over blocks and channels of how much more
/// the means of blocks vary from render to render than independent pixels' would; never by less than 1. Returns the
/// factor. Throws std::invalid_argument as `estimate_image`.
double widen_for_correlation(ImageEstimate& estimate, std::span<const ImageF> renders, int block_size);

/// Raises the variances of every block, where they are less, to the mean of those of the up to nine blocks around and
/// including it. Where light is found by chance, the blocks that have met little of it by chance are too dark and look
/// sure of it; what their neighbours have met tells how unsure they are.
void pool_variance(ImageEstimate& estimate, int block_size);

/// The side of the smallest blocks, `least` pixels times a power of two, whose means can be tested: where a few pixels
/// make the mean of a block or its variance, as where light is found by chance, others like them are missing from the
/// blocks next to it, and neither variance is known. Of every block's values, over its pixels in all renders, 100 or
/// more count for the mean, or a quarter of all (Kish 1965: (sum x)² / sum x²), and 4 or more, or a hundredth of all,
/// for the variance (the same of squared deviations from the pixel's mean), but in the last size, which is that of the
/// whole image. Returns nothing if even there few values make up the mean, if all is black, or if there are fewer than
/// 100 values.
[[nodiscard]] std::optional<int> testable_block_size(std::span<const ImageF> renders, int least);

/// A block, or the whole image, and how it differs.
struct BlockDifference {
    int x = 0;  ///< column of the block's first pixel
    int y = 0;
    int width = 0;
    int height = 0;
    int channel = 0;
    double mean_a = 0.0;
    double mean_b = 0.0;
    double error = 0.0;  ///< standard error of mean_a - mean_b
    double z = 0.0;      ///< (mean_a - mean_b) / error; beyond the tolerance, else 0
};

struct BlockAgreement {
    bool blocks_agree = false;
    bool means_agree = false;
    double p_value = 1.0;           ///< p-value of the worst block, corrected for the number of tests (Sidak 1967)
    std::size_t tests = 0;          ///< blocks and the whole image, times channels
    bool whole_image_only = false;  ///< the whole image is the only block, so that no part of it was tested by itself
    std::size_t black_in_a = 0;     ///< tests left out because `a` is black and `b`, by its variance, is not
    std::size_t black_in_b = 0;     ///< tests left out because `b` is black and `a`, by its variance, is not
    BlockDifference worst;
    /// Largest relative difference of the images' means over the channels.
    double mean_difference = 0.0;
    /// Hold the relative standard errors of the test, which say how small a difference it sees: `mean_error` the
    /// largest over the channels of the images' means, `block_error` the median over blocks and channels.
    double mean_error = 0.0;
    double block_error = 0.0;

    [[nodiscard]] bool agree() const { return blocks_agree && means_agree; }
    /// Describes the result for a failure message.
    [[nodiscard]] std::string str() const;
};

/// Two-sided z-tests of all blocks and channels of `a` against those of `b`, and of the whole image as one more block,
/// which sees small differences everywhere; and a comparison of the images' means by their size. Throws
/// std::invalid_argument if the shapes differ. Values that are not finite do not agree.
[[nodiscard]] BlockAgreement test_agreement(const ImageEstimate& a, const ImageEstimate& b,
                                            const AgreementOptions& options = {});

/// One channel: of each pixel the largest |z| over the channels of its block. Throws as `test_agreement`.
[[nodiscard]] ImageF agreement_map(const ImageEstimate& a, const ImageEstimate& b,
                                   const AgreementOptions& options = {});

/// The probability with which `smallest_difference` is seen.
inline constexpr double kPower = 0.9;

/// Returns the smallest difference of two means that a test of `tests` > 0, failing by chance with probability
/// `significance` in (0, 1), sees with probability kPower: of a normal estimate with the standard error `error`.
[[nodiscard]] double smallest_difference(double error, double significance, std::size_t tests);

/// The |z| that one of `tests` > 0 standard normal numbers exceeds with probability `significance` in (0, 1).
[[nodiscard]] double critical_z(double significance, std::size_t tests);

}  // namespace etendue
