#include "loader/ies/ies_tokens.h"

#include "core/shown_text.h"
#include "loader/json_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::string_view kLineEnds = "\r\n";
constexpr std::string_view kDelimiters = " \t\v\f\r\n,";

/// Length of the line end at the front of `text`.
std::size_t line_end_length(std::string_view text) {
    if (text.empty() || kLineEnds.find(text.front()) == std::string_view::npos) return 0;
    return text.starts_with("\r\n") ? 2 : 1;
}

}  // namespace

std::string_view IesTokens::line() {
    const std::size_t length = std::min(rest_.find_first_of(kLineEnds), rest_.size());
    const std::string_view result = rest_.substr(0, length);
    rest_.remove_prefix(length);
    if (const std::size_t end = line_end_length(rest_); end > 0) {
        rest_.remove_prefix(end);
        ++line_;
    }
    return result;
}

void IesTokens::skip_delimiters() {
    while (!rest_.empty() && kDelimiters.find(rest_.front()) != std::string_view::npos) {
        const std::size_t end = line_end_length(rest_);
        if (end > 0) ++line_;
        rest_.remove_prefix(std::max<std::size_t>(end, 1));
    }
}

double IesTokens::number(std::string_view what, double low, double high) {
    skip_delimiters();
    if (rest_.empty()) fail(fmt::format("the file ends where {} should stand", what));
    const std::string_view token = rest_.substr(0, std::min(rest_.find_first_of(kDelimiters), rest_.size()));
    rest_.remove_prefix(token.size());

    // from_chars knows no plus sign.
    const std::string_view digits = token.substr(token.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
        fail(fmt::format("{} must be a number, but is '{}'", what, shown(token)));
    if (value < low || value > high) fail(fmt::format("{} is {}, but must be in [{}, {}]", what, value, low, high));
    return value;
}

int IesTokens::integer(std::string_view what, int low, int high) {
    const double value = number(what, low, high);
    if (value != std::trunc(value)) fail(fmt::format("{} is {}, but must be an integer", what, value));
    return static_cast<int>(value);
}

std::vector<double> IesTokens::numbers(std::string_view what, std::size_t count, double low, double high) {
    // Each takes a character, and one that ends it unless it is the last.
    if (count > (rest_.size() + 1) / 2) fail(fmt::format("the file is too short for {} numbers ({})", count, what));
    std::vector<double> values(count);
    for (double& value : values) value = number(what, low, high);
    return values;
}

void IesTokens::fail(const std::string& message) const {
    throw SceneError(where_, fmt::format("line {}: {}", line_, message));
}

}  // namespace etendue
