// Parts of an image to look at by what light is there: caustics, light of one bounce, and so on.
#pragma once

#include "compare/comparison_measures.h"
#include "compare/comparison_variants.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Returns for each of `classes`, names of layers of light such as "caustics", the block of the image in which its
/// light is brightest, no block twice; found by a few samples of `variant`, which is made of `scene` by `request`.
/// `notes` gets the classes that have no light. Throws SceneError if there is no such layer of light, or the variant's
/// integrator cannot tell it apart.
[[nodiscard]] std::vector<NamedRegion> regions_of_classes(const std::filesystem::path& scene,
                                                          const VariantRequest& request, const Variant& variant,
                                                          std::span<const std::string> classes,
                                                          const MeasureContext& context,
                                                          std::vector<std::string>& notes);

}  // namespace etendue
