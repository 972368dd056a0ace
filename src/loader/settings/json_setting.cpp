// A member of render.json as the value of a row of the table of settings.
#include "core/overloaded.h"
#include "core/shown_text.h"
#include "loader/json_text.h"
#include "loader/settings/json_object.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace etendue {

template <typename Element>
bool JsonObject::read_list(std::string_view key, std::size_t least, std::size_t most, std::string_view elements,
                           std::vector<Element>& out, const auto& read_element) {
    const nlohmann::json* value = member(key);
    if (value == nullptr) return false;
    if (least == most && !check_array(*value, at(key), most, elements)) return false;
    if (!value->is_array() || value->size() < least || value->size() > most) {
        const std::string found =
            value->is_array() ? fmt::format("an array of {}", value->size()) : std::string(json_kind(*value));
        const std::string count = most < std::numeric_limits<std::size_t>::max()
                                      ? fmt::format("an array of {} to {} {}", least, most, elements)
                                      : fmt::format("a list of {}", elements);
        problems_.error(at(key), fmt::format("must be {}, but is {}", count, found));
        return false;
    }
    for (std::size_t i = 0; i < value->size(); ++i)
        if (!read_element((*value)[i], element_at(key, i), out.emplace_back())) return false;
    return true;
}

std::optional<SettingValue> JsonObject::read_setting(const Setting& setting, std::string_view key) {
    using Value = std::optional<SettingValue>;
    const auto value_if = [](bool is_read, auto value) { return is_read ? Value(std::move(value)) : Value(); };
    return std::visit(
        Overloaded{
            [&](const WholeNumber& type) {
                std::int64_t value = 0;
                const bool is_read = integer(key, type.least, type.most, value);
                return value_if(is_read, value);
            },
            [&](const RealNumber& type) {
                double value = 0.0;
                float narrow = 0.0f;
                const bool is_read = type.is_single ? number(key, type.range, narrow) : number(key, type.range, value);
                return value_if(is_read, type.is_single ? static_cast<double>(narrow) : value);
            },
            [&](const YesNo&) {
                bool value = false;
                const bool is_read = boolean(key, value);
                return value_if(is_read, value);
            },
            [&](const Name&) {
                std::string value;
                const bool is_read = text(key, value);
                return value_if(is_read, std::move(value));
            },
            [&](const Choice& type) {
                std::string value;
                bool is_read = text(key, value);
                if (is_read && std::ranges::count(type.names, value) == 0) {
                    report_unknown_name(at(key), value, type.names);
                    is_read = false;
                }
                return value_if(is_read, std::move(value));
            },
            [&](const Form& type) {
                std::string value;
                bool is_read = text(key, value);
                if (is_read && !type.accepts(value)) {
                    problems_.error(at(key), fmt::format("'{}' is not {}", shown(value), type.form));
                    is_read = false;
                }
                return value_if(is_read, std::move(value));
            },
            [&](const WholeNumbers& type) {
                std::vector<std::int64_t> value;
                const auto read_element = [&](const auto& json, const SourceLocation& where, auto& out) {
                    return read_integer(&json, where, type.each.least, type.each.most, out);
                };
                const bool is_read = read_list(key, type.least_count, type.most_count, "integers", value, read_element);
                return value_if(is_read, std::move(value));
            },
            [&](const RealNumbers& type) {
                std::vector<double> value;
                const auto read_element = [&](const auto& json, const SourceLocation& where, auto& out) {
                    return read_number(&json, where, type.each.range, out);
                };
                const bool is_read = read_list(key, type.least_count, type.most_count, "numbers", value, read_element);
                return value_if(is_read, std::move(value));
            },
            [&](const Texts& type) {
                std::vector<std::string> value;
                const nlohmann::json* const found = member(key);
                if (type.takes_one && found != nullptr && found->is_string()) {
                    const bool is_read = text(key, value.emplace_back());
                    return value_if(is_read, std::move(value));
                }
                const auto read_element = [&](const auto& json, const SourceLocation& where, std::string& out) {
                    if (json.is_string()) json.get_to(out);
                    if (json.is_string() && type.each.accepts(out)) return true;
                    problems_.error(where, fmt::format("must be a text of the form {}", type.each.form));
                    return false;
                };
                const bool is_read =
                    read_list(key, 0, std::numeric_limits<std::size_t>::max(), "texts", value, read_element);
                return value_if(is_read, std::move(value));
            }},
        setting.type);
}

bool JsonObject::setting(const Setting& setting, std::string_view key, RenderSettings& out) {
    const std::optional<SettingValue> value = read_setting(setting, key);
    if (!value) return false;
    if (const auto problem = problem_with(setting, *value)) {
        problems_.error(at(key), *problem);
        return false;
    }
    setting.place.write(out, *value);
    return true;
}

}  // namespace etendue
