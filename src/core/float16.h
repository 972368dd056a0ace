// 16-bit floats, Imath's.
#pragma once

#include <Imath/half.h>

namespace etendue {

using Float16 = half;

}  // namespace etendue
