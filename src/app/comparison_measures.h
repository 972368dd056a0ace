// From the images of a comparison to what is reported of them.
#pragma once

#include "app/comparison_renders.h"
#include "color/color_config.h"
#include "report/comparison_report.h"

#include <span>
#include <string>
#include <vector>

namespace etendue {

/// What the images are compared with.
class Reference {
  public:
    /// An image that has nothing to do with those that are measured.
    Reference(ImageF image, ReferenceReport report);
    /// A pooled one: for every seed an image that the renders with this seed had no part in.
    Reference(std::vector<ImageF> of_seeds, ReferenceReport report);

    [[nodiscard]] const ImageF& of_seed(std::size_t seed) const;
    [[nodiscard]] const ReferenceReport& report() const { return report_; }

  private:
    std::vector<ImageF> images_;
    ReferenceReport report_;
};

/// The finished images of a variant.
struct FinishedImages {
    std::vector<ImageF> of_seeds;
    ImageEstimate estimate;         ///< of two seeds or more
    std::optional<int> block_size;  ///< smallest that can be tested; nothing if few pixels make up the whole image
    double relative_variance = kUnknown;  ///< of one render
};

[[nodiscard]] std::vector<FinishedImages> finished_images(std::span<const VariantRenders> renders,
                                                          const ImageStore& store);

/// Tests every two variants whose images can be tested, in the smallest blocks that both allow. Those count as
/// comparable that find all light of the scene.
[[nodiscard]] std::vector<PairReport> compare_pairs(std::span<const Variant> variants,
                                                    std::span<const FinishedImages> images);

/// The same estimate with its variance widened for splats that fall into several pixels of a block.
[[nodiscard]] ImageEstimate widened_estimate(const FinishedImages& images, int block_size);

/// The mean of all renders of the variants that find all light, weighted by one over their mean relative variance, of
/// all seeds but one each time. Nothing if fewer than two variants find all light, if there are fewer than three seeds,
/// or if those variants disagree or could not be tested; `why_not` says so then.
[[nodiscard]] std::optional<Reference> pool_reference(std::span<const Variant> variants,
                                                      std::span<const FinishedImages> images,
                                                      std::span<const PairReport> pairs, std::string& why_not);

/// A part of the image to look at, in the full image's coordinates.
struct NamedRegion {
    std::string name;
    PixelRect pixels;
    bool found = false;
};

/// The blocks of the image whose errors differ most between two of the variants, at most three.
[[nodiscard]] std::vector<NamedRegion> find_regions(std::span<const FinishedImages> images, const Reference& reference,
                                                    const PixelRect& window);

/// What is measured with.
struct MeasureContext {
    const ColorConfig& colors;
    const ThreadPool& threads;
    const ImageStore& store;
};

/// Fills `report.variants`, `metrics`, `pairs`' ratios and `regions`; errors where there is a reference.
void measure(ComparisonReport& report, std::span<const Variant> variants, std::span<const VariantRenders> renders,
             std::span<const FinishedImages> images, const std::optional<Reference>& reference,
             std::span<const NamedRegion> regions, const MeasureContext& context);

}  // namespace etendue
