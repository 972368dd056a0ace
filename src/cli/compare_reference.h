// The reference of `etendue compare`: a file, a render of its own, or what the variants' renders are pooled to.
#pragma once

#include "cli/compare_arguments.h"
#include "compare/comparison_files.h"
#include "compare/comparison_reference.h"
#include "compare/comparison_renders.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// Holds what can be known of a reference that is asked for before anything is rendered.
struct RequestedReference {
    std::optional<ImageF> image{};            ///< image of the file
    std::optional<ReferenceOrigin> origin{};  ///< origin of a file that tells its seeds
    std::optional<Variant> variant{};         ///< variant that renders it
    std::vector<std::string> notes{};
};

/// Reads the reference's file, or makes the variant that is to render it. Throws SceneError or IoError if there can be
/// no such reference.
[[nodiscard]] RequestedReference requested_reference(const CompareArguments& arguments,
                                                     const std::vector<Variant>& variants, const ColorConfig& colors);

/// Returns the seed of the first render, with a note if it is not the one that was asked for. Renders that have a part
/// in their own reference would look better than they are: seeds go on after those of the reference's file, unless
/// --seed was given.
[[nodiscard]] std::uint32_t first_seed(const CompareArguments& arguments, const std::vector<Variant>& variants,
                                       RequestedReference& requested);

/// Returns the requested reference, rendered with seeds from `seed` on if it is one to be rendered, or else the one
/// that the variants' renders are pooled to; `report` gets the notes. Returns nothing if there can be none.
[[nodiscard]] std::optional<Reference> find_reference(const CompareArguments& arguments, RequestedReference requested,
                                                      std::uint32_t seed, const std::vector<Variant>& variants,
                                                      const std::vector<VariantRenders>& renders,
                                                      const std::vector<FinishedImages>& images,
                                                      const ThreadPool& threads, ComparisonReport& report);

}  // namespace etendue
