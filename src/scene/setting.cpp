#include "scene/setting.h"

#include "core/overloaded.h"
#include "scene/old_setting_names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace etendue {

namespace {

std::string number_text(std::int64_t number, const WholeNumber& /*type*/) {
    return fmt::format("{}", number);
}

/// Returns the shortest text that is read back as the same bits.
std::string number_text(double number, const RealNumber& type) {
    return type.is_single ? fmt::format("{}", static_cast<float>(number)) : fmt::format("{}", number);
}

std::string json_string(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            quoted += {'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20)
            quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            quoted += c;
    }
    return quoted + '"';
}

std::string number_requirement(const WholeNumber& type) {
    return fmt::format("an integer in [{}, {}]", type.least, type.most);
}

std::string number_requirement(const RealNumber& type) {
    return type.range.str();
}

bool accepts(const WholeNumber& type, std::int64_t number) {
    return number >= type.least && number <= type.most;
}

bool accepts(const RealNumber& type, double number) {
    return std::isfinite(number) && (type.is_single ? type.range.contains_single(number) : type.range.contains(number));
}

template <typename Number, typename Value>
bool accepts(const Numbers<Number>& type, const std::vector<Value>& numbers) {
    if (numbers.size() < type.least_count || numbers.size() > type.most_count) return false;
    if (!std::ranges::all_of(numbers, [&](Value number) { return accepts(type.each, number); })) return false;
    const std::vector<double> all(numbers.begin(), numbers.end());
    return type.fits == nullptr || type.fits(all);
}

template <typename Number>
std::string condition_text(const Numbers<Number>& type) {
    return type.condition.empty() ? "" : fmt::format(" with {}", type.condition);
}

/// Reads all of `text`, but for a plus sign before it.
template <typename Value>
std::optional<Value> parse_number(std::string_view text) {
    if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
    Value number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

std::optional<SettingValue> checked(const Setting& setting, SettingValue value) {
    if (problem_with(setting, value)) return std::nullopt;
    return value;
}

template <typename Value, typename Number>
std::optional<SettingValue> parse_numbers(const Setting& setting, const Numbers<Number>& type, std::string_view text) {
    std::vector<Value> numbers;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(type.separator, begin), text.size());
        const std::optional<Value> number = parse_number<Value>(text.substr(begin, end - begin));
        if (!number) return std::nullopt;
        numbers.push_back(*number);
        begin = end + 1;
    }
    if (type.one_is_both && numbers.size() == 1) numbers.push_back(numbers.front());
    return checked(setting, std::move(numbers));
}

template <typename Value, typename Number>
std::string joined_numbers(const std::vector<Value>& numbers, const Number& each, std::string_view separator) {
    std::string text;
    for (const Value number : numbers) text += (text.empty() ? "" : std::string(separator)) + number_text(number, each);
    return text;
}

template <typename Value, typename Number>
std::string json_numbers(const std::vector<Value>& numbers, const Number& each) {
    return "[" + joined_numbers(numbers, each, ", ") + "]";
}

template <typename Value, typename Number>
std::string option_numbers(const std::vector<Value>& numbers, const Numbers<Number>& type) {
    return joined_numbers(numbers, type.each, std::string_view(&type.separator, 1));
}

}  // namespace

bool NumberRange::contains(double value) const {
    return (open_min ? value > min : value >= min) && (open_max ? value < max : value <= max);
}

bool NumberRange::contains_single(double value) const {
    const auto rounded = [](double number) { return static_cast<double>(static_cast<float>(number)); };
    const NumberRange single{rounded(min), rounded(max), open_min, open_max};
    return single.contains(rounded(value));
}

std::string NumberRange::str() const {
    if (has_max())
        return fmt::format("a number in {}{:g}, {:g}{}", open_min ? '(' : '[', min, max, open_max ? ')' : ']');
    if (has_min()) return fmt::format("a number {} {:g}", open_min ? ">" : ">=", min);
    return "a number that fits single precision";
}

const Setting* find_setting(std::string_view pointer) {
    for (const OldSettingName& old : kOldSettingNames)
        if (pointer == old.pointer) pointer = old.now;
    const auto found = std::ranges::find(settings_table(), pointer, &Setting::pointer);
    return found == settings_table().end() ? nullptr : &*found;
}

const Setting* setting_of_option(std::string_view option) {
    if (option.empty()) return nullptr;
    const auto found = std::ranges::find_if(settings_table(), [&](const Setting& setting) {
        const auto* const yes_no = std::get_if<YesNo>(&setting.type);
        return setting.option == option || (yes_no != nullptr && yes_no->no_option == option);
    });
    return found == settings_table().end() ? nullptr : &*found;
}

std::string setting_name(const Setting& setting) {
    std::string name(setting.pointer.substr(1));
    std::ranges::replace(name, '/', '.');
    return name;
}

SettingValue default_value(const Setting& setting) {
    return setting.place.read(RenderSettings{});
}

std::string to_text(const Setting& setting, const SettingValue& value) {
    return std::visit(Overloaded{[](std::monostate) { return std::string("null"); },
                                 [](bool yes) { return std::string(yes ? "true" : "false"); },
                                 [](std::int64_t number) { return fmt::format("{}", number); },
                                 [&](double number) { return number_text(number, std::get<RealNumber>(setting.type)); },
                                 [](const std::string& text) { return json_string(text); },
                                 [&](const std::vector<std::int64_t>& numbers) {
                                     return json_numbers(numbers, std::get<WholeNumbers>(setting.type).each);
                                 },
                                 [&](const std::vector<double>& numbers) {
                                     return json_numbers(numbers, std::get<RealNumbers>(setting.type).each);
                                 },
                                 [](const std::vector<std::string>& texts) {
                                     std::string list;
                                     for (const std::string& text : texts)
                                         list += (list.empty() ? "" : ", ") + json_string(text);
                                     return "[" + list + "]";
                                 }},
                      value);
}

std::string requirement(const SettingType& type) {
    return std::visit(
        Overloaded{[](const WholeNumber& number) { return number_requirement(number); },
                   [](const RealNumber& number) { return number_requirement(number); },
                   [](const YesNo&) { return std::string("true or false"); },
                   [](const Name&) { return std::string("a name"); },
                   [](const Choice& choice) { return fmt::format("one of {}", fmt::join(choice.names, ", ")); },
                   [](const Form& form) { return std::string(form.form); },
                   []<typename Number>(const Numbers<Number>& numbers) {
                       const std::string count = numbers.least_count == numbers.most_count
                                                     ? fmt::format("{}", numbers.most_count)
                                                     : fmt::format("{} to {}", numbers.least_count, numbers.most_count);
                       return fmt::format("{} numbers{}, each {}", count, condition_text(numbers),
                                          number_requirement(numbers.each));
                   },
                   [](const Texts& texts) { return fmt::format("texts, each {}", texts.each.form); }},
        type);
}

std::optional<std::string> problem_with(const Setting& setting, const SettingValue& value) {
    if (std::holds_alternative<std::monostate>(value)) return std::nullopt;
    const bool is_good = std::visit(
        Overloaded{
            [](const WholeNumber& type, std::int64_t number) { return accepts(type, number); },
            [](const RealNumber& type, double number) { return accepts(type, number); },
            [](const YesNo&, bool) { return true; }, [](const Name&, const std::string& name) { return !name.empty(); },
            [](const Choice& type, const std::string& name) { return std::ranges::count(type.names, name) > 0; },
            [](const Form& type, const std::string& text) { return type.accepts(text); },
            [](const WholeNumbers& type, const std::vector<std::int64_t>& numbers) { return accepts(type, numbers); },
            [](const RealNumbers& type, const std::vector<double>& numbers) { return accepts(type, numbers); },
            [](const Texts& type, const std::vector<std::string>& texts) {
                return std::ranges::all_of(texts, type.each.accepts);
            },
            [](const auto&, const auto&) { return false; }},
        setting.type, value);
    if (is_good) return std::nullopt;
    return fmt::format("is {}, but must be {}", to_text(setting, value), requirement(setting.type));
}

std::string option_requirement(const SettingType& type) {
    return std::visit(Overloaded{[]<typename Number>(const Numbers<Number>& numbers) {
                                     return fmt::format("{}{}, each {}", numbers.option_form, condition_text(numbers),
                                                        number_requirement(numbers.each));
                                 },
                                 [](const Texts& texts) { return std::string(texts.each.form); },
                                 [&](const auto&) { return requirement(type); }},
                      type);
}

std::optional<SettingValue> parse_option(const Setting& setting, const std::string& text) {
    const auto number = [&]<typename Value>(std::optional<Value> parsed) -> std::optional<SettingValue> {
        return parsed ? checked(setting, *parsed) : std::nullopt;
    };
    return std::visit(
        Overloaded{[&](const WholeNumber&) { return number(parse_number<std::int64_t>(text)); },
                   [&](const RealNumber&) { return number(parse_number<double>(text)); },
                   [](const YesNo&) { return std::optional<SettingValue>(); },
                   [&](const WholeNumbers& type) { return parse_numbers<std::int64_t>(setting, type, text); },
                   [&](const RealNumbers& type) { return parse_numbers<double>(setting, type, text); },
                   [&](const Texts&) { return checked(setting, std::vector<std::string>{text}); },
                   [&](const auto&) { return checked(setting, text); }},
        setting.type);
}

std::vector<std::string> option_words(const Setting& setting, const SettingValue& value) {
    if (const auto* const type = std::get_if<YesNo>(&setting.type)) {
        const auto* const yes = std::get_if<bool>(&value);
        const std::string_view option = yes != nullptr && *yes ? setting.option : type->no_option;
        return yes == nullptr || option.empty() ? std::vector<std::string>{} : std::vector{std::string(option)};
    }
    if (setting.option.empty()) return {};
    const std::string option(setting.option);
    return std::visit(
        Overloaded{[](std::monostate) { return std::vector<std::string>{}; },
                   [&](const std::string& text) {
                       return std::vector{option, text};
                   },
                   [&](const std::vector<std::int64_t>& numbers) {
                       return std::vector{option, option_numbers(numbers, std::get<WholeNumbers>(setting.type))};
                   },
                   [&](const std::vector<double>& numbers) {
                       return std::vector{option, option_numbers(numbers, std::get<RealNumbers>(setting.type))};
                   },
                   [&](const std::vector<std::string>& texts) {
                       std::vector<std::string> words;
                       for (const std::string& text : texts) words.insert(words.end(), {option, text});
                       return words;
                   },
                   [&](const auto&) {
                       return std::vector{option, to_text(setting, value)};
                   }},
        value);
}

}  // namespace etendue
