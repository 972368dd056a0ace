#include "core/standard_output.h"

#include "core/error.h"
#include "core/shown_text.h"
#include "core/system_error_text.h"

#include <array>
#include <cerrno>
#include <cstddef>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace etendue {

void print_text(std::string_view text) {
    print_data(shown_lines(text));
}

// Without a buffer of our own, whose last bytes would be written when nobody can say any more that it failed.
void print_data(std::string_view data) {
    while (!data.empty()) {
        const ssize_t written = ::write(STDOUT_FILENO, data.data(), data.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) throw IoError(fmt::format("cannot write to standard output: {}", system_error_text(errno)));
        data.remove_prefix(static_cast<std::size_t>(written));
    }
}

void keep_standard_descriptors() {
    // For the other direction: using them is an error still. What is said on standard error is lost in any case.
    constexpr std::array kDirections{O_WRONLY, O_RDONLY, O_WRONLY};
    for (int descriptor = 0; descriptor < static_cast<int>(kDirections.size()); ++descriptor)
        if (::fcntl(descriptor, F_GETFD) < 0 && errno == EBADF)
            (void)::open("/dev/null", kDirections.at(static_cast<std::size_t>(descriptor)));
}

}  // namespace etendue
