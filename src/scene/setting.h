// One setting of a render: where it stands, what it may be, what it decides, and its help. Plain data; who reads
// render.json, who declares options and who writes pages walk `settings_table`.
#pragma once

#include "scene/render_settings.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace etendue {

/// Holds the value of any setting; nothing where a default is meant that is found out later.
using SettingValue = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::int64_t>,
                                  std::vector<double>, std::vector<std::string>>;

/// Holds the numbers that something accepts.
struct NumberRange {
    double min = -std::numeric_limits<float>::max();
    double max = std::numeric_limits<float>::max();
    bool open_min = false;  ///< `min` itself is not accepted
    bool open_max = false;

    [[nodiscard]] bool has_min() const { return min > -std::numeric_limits<float>::max(); }
    [[nodiscard]] bool has_max() const { return max < std::numeric_limits<float>::max(); }
    [[nodiscard]] bool contains(double value) const;
    /// Returns whether it has `value` in single precision, in which its ends are rounded as well.
    [[nodiscard]] bool contains_single(double value) const;
    /// Returns "a number in (0, 3]" or "a number >= 0".
    [[nodiscard]] std::string str() const;
};

inline constexpr NumberRange kNotNegative{.min = 0.0};

struct WholeNumber {
    std::int64_t least;
    std::int64_t most;
};

struct RealNumber {
    NumberRange range{};
    bool is_single = false;  ///< it is kept as a float
};

/// Has one option for yes, or for no, or one for each.
struct YesNo {
    std::string_view no_option{};
    std::string_view no_help{};
};

/// Takes any text but an empty one.
struct Name {
    bool is_integrator = false;  ///< it names an integrator of the registry, which this room does not know
};

struct Choice {
    std::span<const std::string_view> names;
};

/// Takes texts that follow a grammar.
struct Form {
    std::string_view form;     ///< in words, for messages
    std::string_view pattern;  ///< as a regular expression, for the schema
    bool (*accepts)(std::string_view text);
};

/// Takes a list of numbers of fixed or bounded length, which an option takes with `separator` between them.
template <typename Number>
struct Numbers {
    Number each;
    std::size_t least_count;
    std::size_t most_count;
    char separator;
    std::string_view option_form;                             ///< "WIDTHxHEIGHT"
    std::string_view condition{};                             ///< "first <= last", that `fits` asks for
    bool (*fits)(std::span<const double> numbers) = nullptr;  ///< null if any numbers do
    bool one_is_both = false;                                 ///< an option may give one number for two equal ones
};
using WholeNumbers = Numbers<WholeNumber>;
using RealNumbers = Numbers<RealNumber>;

/// Takes a list of texts that follow a grammar; an option gives one and adds it to the list.
struct Texts {
    Form each;
    /// Says that render.json may give one text in place of a list of it, and that options replace its list.
    bool takes_one = false;
};

using SettingType = std::variant<WholeNumber, RealNumber, YesNo, Name, Choice, Form, WholeNumbers, RealNumbers, Texts>;

/// Says what a setting decides.
enum class Decides {
    Samples,   ///< pixels: what a sample is
    Sums,      ///< pixels: which sums are kept of the samples
    Window,    ///< which pixels there are
    End,       ///< when the render ends, and which pixels get more samples than others until then
    Display,   ///< how files show the sums
    Report,    ///< the report of the render
    Schedule,  ///< how the work is done, and nothing that a file holds
};

/// True if a render with another value cannot go on from this one's sums, nor be merged with them.
[[nodiscard]] constexpr bool decides_pixels(Decides decides) {
    return decides == Decides::Samples || decides == Decides::Sums;
}

/// True if a render with another value writes other files.
[[nodiscard]] constexpr bool decides_files(Decides decides) {
    return decides != Decides::Schedule;
}

/// Says under which heading the help shows a setting.
enum class SettingGroup { Transport, Samples, View, Scene, Animation, Files, Colour };

/// Says how the value is read and written, where `RenderSettings` holds it.
struct SettingPlace {
    SettingValue (*read)(const RenderSettings& settings);
    void (*write)(RenderSettings& settings, const SettingValue& value);  ///< nothing writes the default
};

/// One row of the table.
struct Setting {
    std::string_view pointer;   ///< JSON pointer in render.json: "/integrator/max_depth"
    std::string_view option{};  ///< "--max-depth"; empty if there is none, or only one for no
    SettingType type;
    Decides decides;
    std::string_view needs{};         ///< pointer of the setting without which it has no effect
    std::string_view unit{};          ///< "pixels"
    std::string_view default_text{};  ///< words for a setting without a value
    std::string_view help;            ///< a sentence without its full stop; names stand in backticks
    std::string_view page{};          ///< below docs/, for more: "adaptive.md#sampling"
    SettingPlace place;
    SettingGroup group{};  ///< set by the table
};

/// Holds all settings of a render, group by group, in the order of the help. To add one, see CONTRIBUTING.md (A
/// setting).
[[nodiscard]] std::span<const Setting> settings_table();

/// Returns the setting with this JSON pointer, or null.
[[nodiscard]] const Setting* find_setting(std::string_view pointer);

/// Returns the setting that has this option, for yes or for no, or null.
[[nodiscard]] const Setting* setting_of_option(std::string_view option);

/// Returns "integrator.max_depth".
[[nodiscard]] std::string setting_name(const Setting& setting);

/// Returns the value that a render has where nobody says anything.
[[nodiscard]] SettingValue default_value(const Setting& setting);

/// Returns `value` as JSON, exactly: two values have one text only if they are equal in all bits.
[[nodiscard]] std::string to_text(const Setting& setting, const SettingValue& value);

/// Returns what a value must be, in words: "an integer in [1, 64]".
[[nodiscard]] std::string requirement(const SettingType& type);

/// Returns what is wrong with `value`, "is 65, but must be an integer in [1, 64]"; nothing if it can be taken.
[[nodiscard]] std::optional<std::string> problem_with(const Setting& setting, const SettingValue& value);

/// Returns what an option must be given, in words: "WIDTHxHEIGHT, each an integer in [1, 65536]".
[[nodiscard]] std::string option_requirement(const SettingType& type);

/// Returns the value that an option's text stands for; nothing if it is not what `option_requirement` says.
[[nodiscard]] std::optional<SettingValue> parse_option(const Setting& setting, const std::string& text);

/// Returns the words of a command line that ask for `value`, without quotes; none if no option does.
[[nodiscard]] std::vector<std::string> option_words(const Setting& setting, const SettingValue& value);

}  // namespace etendue
