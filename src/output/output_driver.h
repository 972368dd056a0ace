// Where finished images go.
#pragma once

#include "output/output_frame.h"

namespace etendue {

/// Writes frames in one format. To add another format: a class that implements this in a file of its own.
class OutputDriver {
  public:
    virtual ~OutputDriver() = default;

    /// Writes `frame`, replacing what an earlier call wrote; a reader sees the old file or the new one, never a part.
    /// Throws IoError if it cannot be written and SceneError if a colour space, display or view is not in the config.
    virtual void write(const OutputFrame& frame) = 0;
};

}  // namespace etendue
