#include "cli/settings_pages.h"

#include "core/overloaded.h"
#include "picture/render_setup.h"
#include "scene/setting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace etendue::test {

namespace {

using OrderedJson = nlohmann::ordered_json;

/// Returns an integer where the number is one, which JSON then has without a point.
OrderedJson shortest(double number) {
    return number == std::floor(number) ? OrderedJson(static_cast<std::int64_t>(number)) : OrderedJson(number);
}

OrderedJson each_schema(const WholeNumber& type) {
    return {{"type", "integer"}, {"minimum", type.least}, {"maximum", type.most}};
}

OrderedJson each_schema(const RealNumber& type) {
    OrderedJson schema{{"type", "number"}};
    const NumberRange& range = type.range;
    if (range.has_min()) schema[range.open_min ? "exclusiveMinimum" : "minimum"] = shortest(range.min);
    if (range.has_max()) schema[range.open_max ? "exclusiveMaximum" : "maximum"] = shortest(range.max);
    return schema;
}

OrderedJson type_schema(const SettingType& type) {
    return std::visit(
        Overloaded{[](const WholeNumber& number) { return each_schema(number); },
                   [](const RealNumber& number) { return each_schema(number); },
                   [](const YesNo&) {
                       return OrderedJson{{"type", "boolean"}};
                   },
                   [](const Name& name) {
                       return name.is_integrator ? OrderedJson{{"enum", integrator_setting_names()}}
                                                 : OrderedJson{{"type", "string"}, {"minLength", 1}};
                   },
                   [](const Choice& choice) {
                       return OrderedJson{{"enum", std::vector<std::string>(choice.names.begin(), choice.names.end())}};
                   },
                   [](const Form& form) {
                       return OrderedJson{{"type", "string"}, {"pattern", form.pattern}};
                   },
                   []<typename Number>(const Numbers<Number>& numbers) {
                       return OrderedJson{{"type", "array"},
                                          {"items", each_schema(numbers.each)},
                                          {"minItems", numbers.least_count},
                                          {"maxItems", numbers.most_count}};
                   },
                   [](const Texts& texts) {
                       const OrderedJson one{{"type", "string"}, {"pattern", texts.each.pattern}};
                       const OrderedJson list{{"type", "array"}, {"items", one}};
                       return texts.takes_one ? OrderedJson{{"anyOf", {one, list}}} : list;
                   }},
        type);
}

std::string default_in_words(const Setting& setting) {
    const SettingValue value = default_value(setting);
    const bool is_in_words =
        std::holds_alternative<std::monostate>(value) || std::holds_alternative<Texts>(setting.type);
    return is_in_words && !setting.default_text.empty() ? std::string(setting.default_text) : to_text(setting, value);
}

std::string schema_description(const Setting& setting) {
    std::string text(setting.help);
    std::erase(text, '`');
    text += ".";
    if (!setting.unit.empty()) text += fmt::format(" In {}.", setting.unit);
    return text + fmt::format(" Default: {}.", default_in_words(setting));
}

std::string value_in_words(const SettingType& type) {
    return std::visit(
        Overloaded{[](const Name& name) {
                       return name.is_integrator ? fmt::format("`{}`", fmt::join(integrator_setting_names(), "`, `"))
                                                 : std::string("string");
                   },
                   [](const Choice& choice) { return fmt::format("`{}`", fmt::join(choice.names, "`, `")); },
                   [](const Form& form) { return fmt::format("string: {}", form.form); },
                   [](const Texts& texts) {
                       return fmt::format("{}: {}", texts.takes_one ? "string or strings" : "strings", texts.each.form);
                   },
                   [&](const auto&) { return requirement(type); }},
        type);
}

std::string options_in_words(const Setting& setting) {
    std::string text = setting.option.empty() ? "" : fmt::format("`{}`", setting.option);
    if (const auto* const type = std::get_if<YesNo>(&setting.type); type != nullptr && !type->no_option.empty())
        text += fmt::format("{}`{}`", text.empty() ? "" : ", ", type->no_option);
    return text.empty() ? "–" : text;
}

/// Writes `json` in one line.
std::string one_line(const OrderedJson& json) {
    if (!json.is_structured() || json.empty()) return json.dump();
    std::string text;
    for (const auto& [key, value] : json.items()) {
        const std::string name = json.is_object() ? OrderedJson(key).dump() + ": " : "";
        text += fmt::format("{}{}{}", text.empty() ? "" : ", ", name, one_line(value));
    }
    return json.is_object() ? "{ " + text + " }" : "[" + text + "]";
}

std::string lines_of(const OrderedJson& json, std::size_t indent, std::size_t before) {
    constexpr std::size_t kWidth = 100;
    std::string line = one_line(json);
    if (!json.is_structured() || json.empty() || (indent > 0 && before + line.size() <= kWidth)) return line;
    std::string text;
    const std::string blanks(indent + 2, ' ');
    for (const auto& [key, value] : json.items()) {
        const std::string name = json.is_object() ? OrderedJson(key).dump() + ": " : "";
        const std::string lines = lines_of(value, indent + 2, indent + 2 + name.size());
        text += fmt::format("{}\n{}{}{}", text.empty() ? "" : ",", blanks, name, lines);
    }
    const std::string end = "\n" + std::string(indent, ' ');
    return json.is_object() ? "{" + text + end + "}" : "[" + text + end + "]";
}

}  // namespace

nlohmann::ordered_json with_settings(nlohmann::ordered_json schema) {
    for (const Setting& setting : settings_table()) {
        std::string place;
        for (std::string rest(setting.pointer); !rest.empty();) {
            const std::size_t end = rest.find('/', 1);
            place += "/properties" + rest.substr(0, end);
            rest = end == std::string::npos ? "" : rest.substr(end);
        }
        OrderedJson& property = schema[OrderedJson::json_pointer(place)];
        OrderedJson made = type_schema(setting.type);
        if (property.contains("oneOf")) {  // or an object that describes one
            property["oneOf"][0] = std::move(made);
            continue;
        }
        property = {{"description", schema_description(setting)}};
        property.update(made);
    }
    return schema;
}

std::string schema_text(const nlohmann::ordered_json& schema) {
    return lines_of(schema, 0, 0) + "\n";
}

std::string with_settings_table(const std::string& page) {
    const std::string begin = "<!-- settings: made of the table -->\n";
    const std::string end = "<!-- end of settings -->";
    const std::size_t from = page.find(begin);
    const std::size_t to = page.find(end);
    if (from == std::string::npos || to == std::string::npos) return page;
    std::string table = "\n| key | option | value | default | meaning |\n|---|---|---|---|---|\n";
    for (const Setting& setting : settings_table()) {
        const std::string_view file = setting.page.substr(0, setting.page.find('#'));
        const std::string_view target = file == "render-json.md" ? setting.page.substr(file.size()) : setting.page;
        table += fmt::format("| `{}` | {} | {}{} | {} | {}{} |\n", setting_name(setting), options_in_words(setting),
                             value_in_words(setting.type),
                             setting.unit.empty() ? "" : fmt::format("; {}", setting.unit), default_in_words(setting),
                             setting.help, file.empty() ? "" : fmt::format(" ([{}]({}))", file, target));
    }
    return page.substr(0, from + begin.size()) + table + "\n" + page.substr(to);
}

}  // namespace etendue::test
