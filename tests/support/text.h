// Texts as tests look at them.
#pragma once

#include <string>

namespace etendue::test {

[[nodiscard]] inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace etendue::test
