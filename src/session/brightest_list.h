// The brightest contributions of a render, for whoever looks for its fireflies.
#pragma once

#include "output/statistics.h"

namespace etendue {

/// A line each on stderr.
void list_brightest(const RenderStatistics& statistics);

}  // namespace etendue
