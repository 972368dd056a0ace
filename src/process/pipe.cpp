#include "process/pipe.h"

#include <array>

#include <fcntl.h>
#include <unistd.h>

namespace etendue {

Pipe make_pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return {FileDescriptor(), FileDescriptor()};
    return {FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

}  // namespace etendue
