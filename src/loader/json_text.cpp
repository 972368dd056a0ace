#include "loader/json_text.h"

#include "core/shown_text.h"

#include <algorithm>
#include <cstddef>
#include <unordered_set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;

/// "[json.exception.parse_error.101] parse error at line 1, column 2: ...": the bracket is of no use to a reader.
std::string reason(const Json::exception& error) {
    const std::string_view what = error.what();
    const std::size_t bracket = what.find("] ");
    return "not valid JSON: " + std::string(bracket == std::string_view::npos ? what : what.substr(bracket + 2));
}

/// Says what many write who are used to JavaScript; empty if that is not what stands before byte `end` of the text.
std::string habit(std::string_view text, std::size_t end) {
    end = std::min(end, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    const std::string_view before = text.substr(0, end);
    for (const std::string_view mark : {"//", "/*"})
        if (before.ends_with(mark) || (end > 0 && text.substr(end - 1).starts_with(mark)))
            return fmt::format("not valid JSON: in line {} is a comment ('{}'), which JSON does not have: take it out",
                               line, mark);
    if (!before.ends_with('}') && !before.ends_with(']')) return {};
    const std::size_t last = before.find_last_not_of(" \t\r\n", before.size() - 2);
    if (last == std::string_view::npos || before[last] != ',') return {};
    return fmt::format("not valid JSON: in line {}, a comma stands before '{}': take it out",
                       1 + std::count(before.begin(), before.begin() + static_cast<std::ptrdiff_t>(last), '\n'),
                       before.back());
}

/// Reads through a text without keeping it, and stops at the first thing that is not accepted. nlohmann's parser keeps
/// its own stack, so that depth costs heap, not the call stack; but whoever walks the document afterwards may recurse.
/// (Its callback while parsing would do as well, but takes quadratic time in the length of arrays.)
class StrictReader : public nlohmann::json_sax<Json> {
  public:
    explicit StrictReader(std::string_view text) : text_(text) {}

    std::string failure;  ///< empty if all is well

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }

    bool start_array(std::size_t) override { return descend(); }
    bool end_array() override { return ascend(); }
    bool end_object() override { return ascend(); }
    bool start_object(std::size_t) override { return descend(); }

    bool key(string_t& name) override {
        if (keys_.back().insert(name).second) return true;
        failure = fmt::format("the key '{}' stands twice in the same object", shown(name));
        return false;
    }

    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
        failure = habit(text_, position);
        if (failure.empty()) failure = reason(error);
        return false;
    }

  private:
    bool descend() {
        keys_.emplace_back();
        if (keys_.size() <= static_cast<std::size_t>(kMaxJsonDepth)) return true;
        failure = fmt::format("arrays and objects nest deeper than {} levels", kMaxJsonDepth);
        return false;
    }

    bool ascend() {
        keys_.pop_back();
        return true;
    }

    std::string_view text_;
    std::vector<std::unordered_set<std::string>> keys_;  ///< keys of every open object; empty for arrays
};

}  // namespace

Json parse_json(std::string_view text, const SourceLocation& where) {
    StrictReader reader(text);
    Json::sax_parse(text.begin(), text.end(), &reader);
    if (!reader.failure.empty()) throw SceneError(where, reader.failure);
    try {
        return Json::parse(text.begin(), text.end());
    } catch (const Json::exception& error) {
        throw SceneError(where, reason(error));
    }
}

std::string child_pointer(std::string_view pointer, std::string_view key) {
    std::string result(pointer);
    result += '/';
    for (const char c : key) {
        if (c == '~') {
            result += "~0";
        } else if (c == '/') {
            result += "~1";
        } else {
            result += c;
        }
    }
    return result;
}

std::string child_pointer(std::string_view pointer, std::size_t index) {
    return fmt::format("{}/{}", pointer, index);
}

std::string_view json_kind(const Json& value) {
    switch (value.type()) {
        case Json::value_t::null:
            return "null";
        case Json::value_t::object:
            return "an object";
        case Json::value_t::array:
            return "an array";
        case Json::value_t::string:
            return "a string";
        case Json::value_t::boolean:
            return "a boolean";
        default:
            return "a number";
    }
}

}  // namespace etendue
