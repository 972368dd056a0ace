// What the images of a comparison are measured against, and whether they agree among themselves.
#pragma once

#include "compare/comparison_renders.h"
#include "compare/comparison_variants.h"
#include "report/comparison_report.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Holds the image or images that the images of a comparison are compared with.
class Reference {
  public:
    /// Holds one image that has nothing to do with those that are measured, and whose noise is not known.
    Reference(ImageF image, ReferenceReport report);
    /// Holds one image that has nothing to do with those that are measured, and the variance of each of its values, by
    /// which the report's noise is set.
    Reference(ImageEstimate estimate, ReferenceReport report);
    /// Holds a pooled reference: for every round of renders an image that the round had no part in, with the variance
    /// of each of its values, and the variance of each value of their mean.
    Reference(std::vector<ImageEstimate> of_rounds, ImageF variance, ReferenceReport report);

    /// Returns the reference for the render with number `round` of every variant.
    [[nodiscard]] const ImageF& of_round(std::size_t round) const { return estimate_of(round).mean; }
    /// Returns the variance of each value of `of_round`; empty if it is not known.
    [[nodiscard]] std::span<const float> variance_of_round(std::size_t round) const {
        return estimate_of(round).variance.pixels;
    }
    /// Returns the reference of all rounds together.
    [[nodiscard]] ImageF whole() const;
    /// Returns the variance of each value of `whole`; null if it is not known.
    [[nodiscard]] const ImageF* variance() const { return variance_ ? &*variance_ : nullptr; }
    [[nodiscard]] const ReferenceReport& report() const { return report_; }

  private:
    [[nodiscard]] const ImageEstimate& estimate_of(std::size_t round) const {
        return images_.size() == 1 ? images_.front() : images_[round];
    }

    std::vector<ImageEstimate> images_;
    std::optional<ImageF> variance_;
    ReferenceReport report_;
};

/// The finished images of a variant.
struct FinishedImages {
    std::vector<ImageF> of_seeds{};
    ImageEstimate estimate{};         ///< estimate of two seeds or more
    std::optional<int> block_size{};  ///< smallest that can be tested; nothing if few pixels make up the whole image
    double relative_variance = kUnknown;  ///< relative variance of one render
};

[[nodiscard]] std::vector<FinishedImages> finished_images(std::span<const VariantRenders> renders,
                                                          const ImageStore& store);

/// Tests every two variants that show the same light and whose images can be tested, in the smallest blocks that both
/// allow. Those count as comparable that also find all of it.
[[nodiscard]] std::vector<PairReport> compare_pairs(std::span<const Variant> variants,
                                                    std::span<const FinishedImages> images);

/// Returns the estimate of `images` with its variance widened for splats that fall into several pixels of a block.
[[nodiscard]] ImageEstimate widened_estimate(const FinishedImages& images, int block_size);

/// Pools a reference: the mean of all renders of the variants that show the same light and find all of it, of all
/// rounds but one each time, weighted by one over their mean relative variance, or those without any alike and the
/// others not at all. Variants whose images cannot be tested have no part in it. If there are several kinds of light,
/// the one that most variants show. None if fewer than two variants, or fewer than three rounds, are there to be
/// pooled, or if those variants disagree. `notes` gets what is to be said of the reference.
[[nodiscard]] std::optional<Reference> pool_reference(std::span<const Variant> variants,
                                                      std::span<const FinishedImages> images,
                                                      std::span<const PairReport> pairs,
                                                      std::vector<std::string>& notes);

/// Returns notes on a reference that `reference` renders, and `variants` are measured against: light that it does not
/// find, or that they do not show; and whether it would make the same errors as they.
[[nodiscard]] std::vector<std::string> reference_notes(const Variant& reference, std::span<const Variant> variants);

}  // namespace etendue
