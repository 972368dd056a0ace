// The options of `compare`: those of all variants, and those that make one.
#pragma once

#include "cli/command_options.h"
#include "compare/comparison_variants.h"

#include <span>
#include <string>

namespace etendue {

/// Lists the options of `render` that `compare` does not take: it decides itself how long it renders, which images and
/// into what file. A single variant does not take the seed and the number of samples either.
[[nodiscard]] std::span<const OptionOfRender> options_compare_sets();

/// Returns `common` and then `options`. Throws CLI::ParseError for options that it does not know, and for those that
/// `etendue compare` sets itself.
[[nodiscard]] RenderRequest with_options(const RenderRequest& common, const std::string& options);

}  // namespace etendue
