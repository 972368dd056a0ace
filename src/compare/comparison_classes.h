// Parts of an image to look at by what light is there: caustics, light of one bounce, and so on.
#pragma once

#include "compare/comparison_measures.h"
#include "compare/comparison_variants.h"
#include "picture/aov_setup.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Returns what is to be rendered for `classes`, names of layers of light such as "caustics", of a variant that is made
/// of `scene` by `request`. Throws SceneError if there is no such layer of light, or the variant's integrator cannot
/// tell it apart.
[[nodiscard]] AovPlan plan_of_classes(const std::filesystem::path& scene, const VariantRequest& request,
                                      std::span<const std::string> classes);

/// Returns for each layer of `plan` the block of the image in which its light is brightest, no block twice; found by a
/// few samples of `variant`. `notes` gets the classes that have no light.
[[nodiscard]] std::vector<NamedRegion> regions_of_classes(const Variant& variant, const AovPlan& plan,
                                                          const MeasureContext& context,
                                                          std::vector<std::string>& notes);

}  // namespace etendue
