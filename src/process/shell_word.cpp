#include "process/shell_word.h"

#include <algorithm>

#include <fmt/format.h>

namespace etendue {

namespace {

bool is_control(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

/// $'...', in which a backslash and three octal digits stand for any byte.
std::string with_escapes(const std::string& text) {
    std::string result = "$'";
    for (const char c : text) {
        if (is_control(c))
            result += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
        else if (c == '\'' || c == '\\')
            result += {'\\', c};
        else
            result += c;
    }
    return result + "'";
}

}  // namespace

std::string quoted(const std::string& text) {
    if (std::ranges::any_of(text, is_control)) return with_escapes(text);
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

}  // namespace etendue
