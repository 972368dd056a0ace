#include "loader/json_text.h"

#include <unordered_set>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

namespace {

using Json = nlohmann::json;

/// Watches the parser's events. nlohmann's parser keeps its own stack, so that depth costs heap, not the call stack;
/// but whoever walks the document afterwards may recurse.
class Watch {
  public:
    explicit Watch(const SourceLocation& where) : where_(where) {}

    bool operator()(int depth, Json::parse_event_t event, Json& value) {
        if (depth > kMaxJsonDepth) {
            throw SceneError(where_, fmt::format("arrays and objects nest deeper than {} levels", kMaxJsonDepth));
        }
        if (event == Json::parse_event_t::object_start) keys_.emplace_back();
        if (event == Json::parse_event_t::object_end) keys_.pop_back();
        if (event == Json::parse_event_t::key) {
            const std::string& key = value.get_ref<const std::string&>();
            if (!keys_.back().insert(key).second) {
                throw SceneError(where_, fmt::format("the key '{}' stands twice in the same object", shown(key)));
            }
        }
        return true;
    }

  private:
    const SourceLocation& where_;
    std::vector<std::unordered_set<std::string>> keys_;
};

}  // namespace

Json parse_json(std::string_view text, const SourceLocation& where) {
    Watch watch(where);
    const Json::parser_callback_t callback = [&watch](int depth, Json::parse_event_t event, Json& value) {
        return watch(depth, event, value);
    };
    try {
        return Json::parse(text.begin(), text.end(), callback);
    } catch (const Json::exception& error) {
        // "[json.exception.parse_error.101] parse error at line 1, column 2: ...": the bracket is of no use to a
        // reader.
        const std::string_view what = error.what();
        const std::size_t bracket = what.find("] ");
        throw SceneError(where,
                         "not valid JSON: " + std::string(bracket == what.npos ? what : what.substr(bracket + 2)));
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

std::string shown(std::string_view name) {
    constexpr std::size_t kLongest = 80;
    std::string result(name.substr(0, kLongest));
    for (char& c : result) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    if (name.size() > kLongest) result += "...";
    return result;
}

}  // namespace etendue
