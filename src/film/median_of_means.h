// The median of means: an estimate of a pixel that outliers do not move.
#pragma once

#include "film/bucket_layers.h"
#include "film/film.h"

#include <span>
#include <vector>

namespace etendue {

/// The median of `values`, of an even number the mean of the middle two; 0 of none. Reorders them.
[[nodiscard]] float median(std::span<float> values);

/// Returns the window row by row, four floats a pixel: red, green and blue are, each by itself, the median of the means
/// of the pixel's buckets, eye samples and splats of a bucket together; alpha is the mean (Buisine, Delepoulle and
/// Renaud, "Firefly removal in Monte Carlo rendering with adaptive Median of meaNs", 2021, who take channels by
/// themselves, too). Each bucket is divided by its own weight, so that pixels may have different numbers of samples;
/// buckets without samples do not count. A median of skewed estimates lies below their mean: the error shrinks as each
/// bucket gets more samples, because their means become normal, and the median of a normal distribution is its mean.
[[nodiscard]] std::vector<float> median_of_means(const Film& film, const BucketLayers& buckets);

}  // namespace etendue
