// A pipe of the system.
#pragma once

#include "process/file_descriptor.h"

namespace etendue {

/// Holds the ends of a pipe; programs that are started inherit neither.
struct Pipe {
    FileDescriptor reader;
    FileDescriptor writer;
};

/// Makes a pipe; if the system makes no more, both ends are closed, with the reason in errno.
[[nodiscard]] Pipe make_pipe();

}  // namespace etendue
