#include "process/process_limits.h"

#include "core/error.h"

#include <array>

#include <fmt/format.h>
#include <sys/resource.h>

namespace etendue {

namespace {

constexpr rlim_t kKiB = 1024;

/// A limit of the system's, and how the shell calls it.
struct ProcessLimit {
    __rlimit_resource resource;
    rlim_t least;  ///< bytes
    const char* what;
    const char* option;
};

/// The stack is that of threads, too. Addresses are those of all libraries besides.
constexpr std::array kProcessLimits{
    ProcessLimit{RLIMIT_STACK, 256 * kKiB, "a stack", "-s"},
    ProcessLimit{RLIMIT_DATA, kLeastMemoryLimit, "memory", "-d"},
    ProcessLimit{RLIMIT_AS, 3 * kLeastMemoryLimit, "addresses", "-v"},
};

}  // namespace

void require_process_limits() {
    for (const ProcessLimit& needed : kProcessLimits) {
        rlimit limit{};
        if (::getrlimit(needed.resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
            limit.rlim_cur >= needed.least)
            continue;
        throw IoError(fmt::format("this process may have {} of {} KiB, and needs {} KiB: raise that limit (ulimit {})",
                                  needed.what, limit.rlim_cur / kKiB, needed.least / kKiB, needed.option));
    }
}

}  // namespace etendue
