#include "core/standard_output.h"

#include "core/error.h"
#include "core/shown_text.h"
#include "core/system_error_text.h"

#include <cerrno>
#include <cstddef>

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

}  // namespace etendue
