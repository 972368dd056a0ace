// Inputs that are not read even if they are there.
#pragma once

#include "core/error.h"

namespace etendue {

/// An input that lies outside the scene's directory, or would take too much memory.
class RefusedInput : public IoError {
  public:
    using IoError::IoError;
};

}  // namespace etendue
