// How profile.json tells of accelerators.
#pragma once

#include "report/accelerator_report.h"

#include <nlohmann/json.hpp>

namespace etendue {

/// docs/profile.md describes it.
[[nodiscard]] nlohmann::ordered_json accelerators_object(const AcceleratorReport& report);

}  // namespace etendue
