// How a row of the table of settings holds its value: the value as all settings have it, from and to what
// `RenderSettings` has.
#pragma once

#include "scene/setting.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace etendue {

inline constexpr std::int64_t kMostInt = std::numeric_limits<int>::max();

template <const auto& names>
constexpr auto kNamesOf = [] {
    std::array<std::string_view, names.size()> only{};
    for (std::size_t i = 0; i < only.size(); ++i) only[i] = names[i].first;
    return only;
}();

template <const auto& names>
constexpr Choice kChoiceOf{kNamesOf<names>};

// From the type that holds a value to the value, and back.

inline SettingValue to_value(bool value) {
    return value;
}
inline SettingValue to_value(int value) {
    return std::int64_t{value};
}
inline SettingValue to_value(std::uint32_t value) {
    return std::int64_t{value};
}
inline SettingValue to_value(float value) {
    return static_cast<double>(value);
}
inline SettingValue to_value(double value) {
    return value;
}
inline SettingValue to_value(const std::string& value) {
    return value.empty() ? SettingValue() : value;
}
template <std::size_t N>
SettingValue to_value(const std::array<int, N>& value) {
    return std::vector<std::int64_t>(value.begin(), value.end());
}
inline SettingValue to_value(const std::vector<std::string>& value) {
    return value;
}
inline SettingValue to_value(const Shutter& value) {
    return std::vector{value.open, value.close};
}
inline SettingValue to_value(const CameraPlace& value) {
    std::vector<double> numbers;
    for (const Vec3d& v : {value.eye, value.target, value.up}) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    if (value.up == CameraPlace{}.up) numbers.resize(6);
    return numbers;
}
inline SettingValue to_value(const FrameRange& value) {
    std::vector<std::int64_t> numbers{value.first, value.last};
    if (value.step != 1) numbers.push_back(value.step);
    return numbers;
}
template <typename Value>
SettingValue to_value(const std::optional<Value>& value) {
    return value ? to_value(*value) : SettingValue();
}

template <typename Held>
Held from_value(const SettingValue& value) {
    if constexpr (std::is_same_v<Held, bool> || std::is_same_v<Held, std::string> ||
                  std::is_same_v<Held, std::vector<std::string>>) {
        return std::get<Held>(value);
    } else if constexpr (std::is_integral_v<Held>) {
        return static_cast<Held>(std::get<std::int64_t>(value));
    } else if constexpr (std::is_floating_point_v<Held>) {
        return static_cast<Held>(std::get<double>(value));
    } else if constexpr (std::is_same_v<Held, Shutter>) {
        // As floats, whoever asks: so a moment is the same from render.json and from the command line.
        const auto& times = std::get<std::vector<double>>(value);
        return {static_cast<double>(static_cast<float>(times.at(0))),
                static_cast<double>(static_cast<float>(times.at(1)))};
    } else if constexpr (std::is_same_v<Held, CameraPlace>) {
        const auto& numbers = std::get<std::vector<double>>(value);
        const auto vector = [&](std::size_t i) { return Vec3d(numbers.at(i), numbers.at(i + 1), numbers.at(i + 2)); };
        CameraPlace place{.eye = vector(0), .target = vector(3)};
        if (numbers.size() > 6) place.up = vector(6);
        return place;
    } else if constexpr (std::is_same_v<Held, FrameRange>) {
        const auto& numbers = std::get<std::vector<std::int64_t>>(value);
        return {static_cast<int>(numbers.at(0)), static_cast<int>(numbers.at(1)),
                numbers.size() > 2 ? static_cast<int>(numbers[2]) : 1};
    } else {
        Held held{};
        const auto& numbers = std::get<std::vector<std::int64_t>>(value);
        for (std::size_t i = 0; i < held.size(); ++i) held[i] = static_cast<int>(numbers.at(i));
        return held;
    }
}

inline const RenderSettings& default_settings() {
    static const RenderSettings settings;
    return settings;
}

template <typename Held>
struct IsOptional : std::false_type {};
template <typename Value>
struct IsOptional<std::optional<Value>> : std::true_type {};

/// Holds the value where `Place` says, as it is.
template <typename Place>
constexpr SettingPlace at(Place /*place*/) {
    return {[](const RenderSettings& settings) { return to_value(Place{}(settings)); },
            [](RenderSettings& settings, const SettingValue& value) {
                auto& held = Place{}(settings);
                using Held = std::remove_reference_t<decltype(held)>;
                if (std::holds_alternative<std::monostate>(value))
                    held = Place{}(default_settings());
                else if constexpr (IsOptional<Held>::value)
                    held = from_value<typename Held::value_type>(value);
                else
                    held = from_value<Held>(value);
            }};
}

/// Holds a value of an enumeration, by its name in `names`.
template <const auto& names, typename Place>
constexpr SettingPlace named_at(Place /*place*/) {
    return {[](const RenderSettings& settings) -> SettingValue {
                for (const auto& [name, value] : names)
                    if (value == Place{}(settings)) return std::string(name);
                return {};
            },
            [](RenderSettings& settings, const SettingValue& value) {
                Place{}(settings) = Place{}(default_settings());
                if (const auto* const text = std::get_if<std::string>(&value))
                    for (const auto& [name, named] : names)
                        if (name == *text) Place{}(settings) = named;
            }};
}

/// Holds a value that `parse` makes of its text and `text_of` turns back.
template <auto parse, auto text_of, typename Place>
constexpr SettingPlace parsed_at(Place /*place*/) {
    return {[](const RenderSettings& settings) -> SettingValue { return text_of(Place{}(settings)); },
            [](RenderSettings& settings, const SettingValue& value) {
                auto& held = Place{}(settings);
                const auto* const text = std::get_if<std::string>(&value);
                const auto parsed = text == nullptr ? std::nullopt : parse(*text);
                if (parsed)
                    held = *parsed;
                else
                    held = Place{}(default_settings());
            }};
}

template <auto parse>
bool parses(std::string_view text) {
    return parse(text).has_value();
}

}  // namespace etendue
