#include "core/system_error_text.h"

#include <cerrno>
#include <system_error>

#include <fmt/format.h>
#include <sys/resource.h>

namespace etendue {

std::string system_error_text(int error) {
    std::string text = std::generic_category().message(error);
    rlimit limit{};
    if (error == EFBIG && ::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        text += fmt::format(": no file may have more than {} KiB here; raise that limit (ulimit -f)",
                            limit.rlim_cur / 1024);
    return text;
}

}  // namespace etendue
