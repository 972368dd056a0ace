#include "loader/settings/json_object.h"

#include "core/shown_text.h"
#include "loader/json_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace etendue {

namespace {

using Json = nlohmann::json;

const Json& empty_object() {
    static const Json empty = Json::object();
    return empty;
}

}  // namespace

JsonObject::JsonObject(const Json& value, SourceLocation where, ProblemList& problems)
    : object_(value.is_object() ? &value : &empty_object()), where_(std::move(where)), problems_(problems) {
    if (!value.is_object()) problems_.error(where_, fmt::format("must be an object, but is {}", json_kind(value)));
}

SourceLocation JsonObject::at(std::string_view key) const {
    return {where_.file, child_pointer(where_.pointer, key)};
}

SourceLocation JsonObject::element_at(std::string_view key, std::size_t index) const {
    return {where_.file, child_pointer(at(key).pointer, index)};
}

const Json* JsonObject::member(std::string_view key) {
    known_.emplace_back(key);
    const auto found = object_->find(key);
    return found == object_->end() ? nullptr : &*found;
}

bool JsonObject::text(std::string_view key, std::string& out) {
    const Json* value = member(key);
    if (value == nullptr) return false;
    if (!value->is_string()) {
        problems_.error(at(key), fmt::format("must be a string, but is {}", json_kind(*value)));
        return false;
    }
    out = value->get<std::string>();
    if (!out.empty()) return true;
    problems_.error(at(key), "must not be empty");
    return false;
}

bool JsonObject::boolean(std::string_view key, bool& out) {
    const Json* value = member(key);
    if (value == nullptr) return false;
    if (!value->is_boolean()) {
        problems_.error(at(key), fmt::format("must be true or false, but is {}", json_kind(*value)));
        return false;
    }
    out = value->get<bool>();
    return true;
}

bool JsonObject::read_integer(const Json* value, const SourceLocation& where, std::int64_t min, std::int64_t max,
                              std::int64_t& out) {
    if (value == nullptr) return false;
    const double number = value->is_number() ? value->get<double>() : 0.0;
    const bool in_range = value->is_number() && number == std::trunc(number) && number >= static_cast<double>(min) &&
                          number <= static_cast<double>(max);
    if (!in_range) {
        problems_.error(where, fmt::format("must be an integer in [{}, {}], but is {}", min, max,
                                           value->is_number() ? fmt::format("{}", number) : json_kind(*value)));
        return false;
    }
    out = static_cast<std::int64_t>(number);
    return true;
}

bool JsonObject::read_number(const Json* value, const SourceLocation& where, const NumberRange& range, double& out) {
    if (value == nullptr) return false;
    if (!value->is_number() || !range.contains(value->get<double>())) {
        problems_.error(where,
                        fmt::format("must be {}, but is {}", range.str(),
                                    value->is_number() ? fmt::format("{}", value->get<double>()) : json_kind(*value)));
        return false;
    }
    out = value->get<double>();
    return true;
}

bool JsonObject::number(std::string_view key, const NumberRange& range, double& out) {
    return read_number(member(key), at(key), range, out);
}

bool JsonObject::number(std::string_view key, const NumberRange& range, float& out) {
    double value = 0.0;
    if (!number(key, range, value)) return false;
    // Rounding must not carry a value to an end that the range leaves out.
    if (!range.contains_single(value)) {
        problems_.error(at(key), fmt::format("must be {} in single precision, but is {}", range.str(), value));
        return false;
    }
    out = static_cast<float>(value);
    return true;
}

bool JsonObject::check_array(const Json& value, const SourceLocation& where, std::size_t length,
                             std::string_view elements) {
    if (value.is_array() && value.size() == length) return true;
    const std::string found =
        value.is_array() ? fmt::format("an array of {}", value.size()) : std::string(json_kind(value));
    problems_.error(where, fmt::format("must be an array of {} {}, but is {}", length, elements, found));
    return false;
}

template <typename Number>
bool JsonObject::read_each(std::string_view key, const NumberRange& range, std::span<Number> out) {
    const Json* value = member(key);
    if (value == nullptr || !check_array(*value, at(key), out.size(), "numbers")) return false;
    std::vector<Number> result(out.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        double element = 0.0;
        if (!read_number(&(*value)[i], element_at(key, i), range, element)) return false;
        result[i] = static_cast<Number>(element);
    }
    std::ranges::copy(result, out.begin());
    return true;
}

bool JsonObject::read_numbers(std::string_view key, const NumberRange& range, std::span<float> out) {
    return read_each(key, range, out);
}

bool JsonObject::read_numbers(std::string_view key, const NumberRange& range, std::span<double> out) {
    return read_each(key, range, out);
}

bool JsonObject::color(std::string_view key, const NumberRange& range, Rgb& out) {
    std::array<float, 3> channels{};
    if (!read_numbers(key, range, channels)) return false;
    out = {channels[0], channels[1], channels[2]};
    return true;
}

bool JsonObject::vector(std::string_view key, Vec2f& out) {
    std::array<float, 2> components{};
    if (!read_numbers(key, kAnyNumber, components)) return false;
    out = {components[0], components[1]};
    return true;
}

bool JsonObject::vector(std::string_view key, Vec3f& out) {
    std::array<float, 3> components{};
    if (!read_numbers(key, kAnyNumber, components)) return false;
    out = {components[0], components[1], components[2]};
    return true;
}

bool JsonObject::vector(std::string_view key, Vec3d& out) {
    std::array<double, 3> components{};
    if (!read_numbers(key, kAnyNumber, components)) return false;
    out = {components[0], components[1], components[2]};
    return true;
}

bool JsonObject::quaternion(std::string_view key, std::array<double, 4>& out) {
    return read_numbers(key, kAnyNumber, out);
}

void JsonObject::report_unknown_name(const SourceLocation& where, std::string_view name,
                                     std::span<const std::string_view> known) {
    problems_.error(where, fmt::format("unknown name '{}'; {}", shown(name), name_hint(name, known)));
}

void JsonObject::finish(PlaceOfKey place) {
    std::vector<std::string_view> known;
    for (const std::string& key : known_)
        if (std::ranges::find(known, key) == known.end()) known.push_back(key);
    for (const auto& [key, value] : object_->items()) {
        if (std::ranges::find(known, std::string_view(key)) != known.end()) continue;
        if (problems_.is_full()) {
            problems_.error({}, {});  // is only counted
            continue;
        }
        const std::string elsewhere = place != nullptr ? place(key) : "";
        problems_.error(at(key), fmt::format("unknown key '{}'; {}", shown(key),
                                             elsewhere.empty() ? name_hint(key, known) : elsewhere));
    }
}

}  // namespace etendue
