// The ways into the code that is compiled as this source is.
#pragma once

#include "processor/ray_code.h"

namespace etendue {

extern const RayCode ray_code_here;

}  // namespace etendue
