// The filters of FLIP, as products of filters along rows and columns. For flip.cpp and its tests.
//
// They are those of the spatial filters and of the "feature pipeline" of Andersson et al. 2020.
#pragma once

#include <vector>

namespace etendue {

/// Weights of an odd number of neighbours along a row or column, the pixel itself in the middle.
using FilterWeights = std::vector<float>;

/// Holds the filters of what the eye resolves: Fourier transforms of contrast sensitivity functions, as sums of
/// Gaussians a sqrt(pi / b) exp(-pi^2 d^2 / b) of the distance d in degrees. Each is normalised to a sum of 1 over the
/// square of pixels within `radius`, which is three standard deviations of the widest.
struct ContrastFilters {
    int radius = 0;             ///< pixels
    FilterWeights luminance;    ///< sums to 1
    FilterWeights red_green;    ///< sums to 1
    FilterWeights blue_narrow;  ///< yellow against blue is a sum of two: the filter is narrow × narrow + wide × wide,
    FilterWeights blue_wide;    ///< and the squares of the two sums add up to 1
};

/// `pixels_per_degree` > 0.
[[nodiscard]] ContrastFilters contrast_filters(double pixels_per_degree);

/// Holds the filters that find edges and points: derivatives of a Gaussian across, a Gaussian along. The standard
/// deviation is half of the width w = 0.082 degrees of an edge that the eye sees as one.
struct FeatureFilters {
    int radius = 0;          ///< pixels, three standard deviations
    FilterWeights gaussian;  ///< sums to 1
    FilterWeights edge;      ///< first derivative; its positive weights sum to 1, its negative ones to -1
    FilterWeights point;     ///< second derivative; its positive weights sum to 1, its negative ones to -1
};

/// `pixels_per_degree` > 0.
[[nodiscard]] FeatureFilters feature_filters(double pixels_per_degree);

}  // namespace etendue
