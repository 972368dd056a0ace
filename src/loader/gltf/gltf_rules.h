// What glTF demands of a document beyond the types of its members.
#pragma once

#include "core/error.h"

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// Of a `document` whose shape has been checked. What stands in the way of rendering is an error; of every other breach
/// there is one warning, which says what is made of it.
void check_rules(const nlohmann::json& document, const SourceLocation& file, ProblemList& problems);

}  // namespace etendue
