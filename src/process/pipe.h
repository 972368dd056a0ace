// A pipe of the system.
#pragma once

#include "process/file_descriptor.h"

namespace etendue {

/// Its ends; programs that are started inherit neither.
struct Pipe {
    FileDescriptor reader;
    FileDescriptor writer;
};

/// Both ends are closed, with the reason in errno, if the system makes no more.
[[nodiscard]] Pipe make_pipe();

}  // namespace etendue
