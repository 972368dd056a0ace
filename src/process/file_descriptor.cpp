#include "process/file_descriptor.h"

#include <unistd.h>

namespace etendue {

void FileDescriptor::close() {
    if (is_open()) ::close(std::exchange(number_, -1));
}

}  // namespace etendue
