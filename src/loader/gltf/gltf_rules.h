// What glTF demands of a document beyond the types of its members.
#pragma once

#include "core/error.h"

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// Checks glTF's rules in a `document` whose shape has been checked: adds an error to `problems` for what stands in the
/// way of rendering, and for every other breach one warning, which says what is made of the breach.
void check_rules(const nlohmann::json& document, const SourceLocation& file, ProblemList& problems);

}  // namespace etendue
