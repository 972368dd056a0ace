// Options that cannot be followed.
#pragma once

#include <stdexcept>

namespace etendue {

/// Options that contradict each other, or the scene that they are for: exit code 2.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace etendue
