#include "cli/settings_options.h"

#include "core/overloaded.h"
#include "picture/render_setup.h"
#include "session/usage_error.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace etendue {

namespace {

const std::map<std::string, Quality> kQualities{
    {"draft", Quality::Draft}, {"preview", Quality::Preview}, {"final", Quality::Final}};

/// Returns the heading under which the help shows settings of `group`.
const char* heading_of(SettingGroup group) {
    switch (group) {
        case SettingGroup::Transport:
            return "Light transport";
        case SettingGroup::Samples:
            return "Samples and when to end";
        case SettingGroup::View:
            return "Size and camera";
        case SettingGroup::Scene:
            return "What the scene shows";
        case SettingGroup::Animation:
            return "Animation";
        case SettingGroup::Files:
            return "Layers and files";
        case SettingGroup::Colour:
            return "Colour";
    }
    return "";
}

std::string without_backticks(std::string_view text) {
    std::string plain(text);
    std::erase(plain, '`');
    return plain;
}

/// Returns the default as an option would ask for it; empty if none needs to be told.
std::string default_of(const Setting& setting) {
    const SettingValue value = default_value(setting);
    if (std::holds_alternative<std::monostate>(value)) return std::string(setting.default_text);
    if (std::holds_alternative<Texts>(setting.type)) return std::string(setting.default_text);
    if (const auto* const yes = std::get_if<bool>(&value)) return *yes ? "yes" : "";
    return option_words(setting, value).back();
}

/// Returns the help of the option, with unit, default and page.
std::string description_of(const Setting& setting) {
    std::string notes;
    const auto add = [&](const std::string& note) { notes += (notes.empty() ? "" : "; ") + note; };
    if (const std::string text = default_of(setting); text == "yes")
        add("default");
    else if (!text.empty())
        add(fmt::format("default: {}", text));
    if (!setting.unit.empty()) add(fmt::format("in {}", setting.unit));
    if (!setting.page.empty()) add(fmt::format("docs/{}", setting.page.substr(0, setting.page.find('#'))));
    return without_backticks(setting.help) + (notes.empty() ? "" : fmt::format(" ({})", notes));
}

/// Says what stands behind the option: "INT in [1 - 64]".
std::string type_name_of(const SettingType& type) {
    return std::visit(
        Overloaded{[](const WholeNumber& number) { return fmt::format("INT in [{} - {}]", number.least, number.most); },
                   [](const RealNumber& number) {
                       const NumberRange& range = number.range;
                       if (range.has_max()) return fmt::format("FLOAT in [{:g} - {:g}]", range.min, range.max);
                       return range.has_min() ? fmt::format("FLOAT {} {:g}", range.open_min ? ">" : ">=", range.min)
                                              : std::string("FLOAT");
                   },
                   [](const Choice& choice) { return fmt::format("TEXT:{{{}}}", fmt::join(choice.names, ",")); },
                   [](const Name& name) {
                       return name.is_integrator
                                  ? fmt::format("TEXT:{{{}}}", fmt::join(integrator_setting_names(), ","))
                                  : std::string("TEXT");
                   },
                   []<typename Number>(const Numbers<Number>& numbers) {
                       const std::string_view form = numbers.option_form;
                       return form.find(' ') == std::string_view::npos ? std::string(form) : std::string("TEXT");
                   },
                   [](const auto&) { return std::string("TEXT"); }},
        type);
}

void give_or_fail(SettingsOverrides& overrides, std::string_view option, const std::string& text) {
    try {
        overrides.give(option, text);
    } catch (const UsageError& error) {
        throw CLI::ValidationError(error.what());
    }
}

/// Adds the option for yes, that for no, or both, of which one may be given.
void add_flags(CLI::App& command, const Setting& setting, const YesNo& type, SettingsOverrides& overrides) {
    const auto add = [&](std::string_view option, const std::string& help) {
        return command
            .add_flag_callback(
                std::string(option), [&overrides, option] { overrides.give(option); }, help)
            ->group(heading_of(setting.group));
    };
    CLI::Option* yes = setting.option.empty() ? nullptr : add(setting.option, description_of(setting));
    CLI::Option* no = type.no_option.empty() ? nullptr : add(type.no_option, without_backticks(type.no_help));
    if (yes != nullptr && no != nullptr) no->excludes(yes);
}

void add_setting_option(CLI::App& command, const Setting& setting, SettingsOverrides& overrides) {
    if (const auto* const flags = std::get_if<YesNo>(&setting.type))
        return add_flags(command, setting, *flags, overrides);
    if (setting.option.empty()) return;
    CLI::Option* option = nullptr;
    if (std::holds_alternative<Texts>(setting.type))
        option = command
                     .add_option_function<std::vector<std::string>>(
                         std::string(setting.option),
                         [&](const std::vector<std::string>& texts) {
                             overrides.given.erase(std::string(setting.pointer));
                             for (const std::string& text : texts) give_or_fail(overrides, setting.option, text);
                         },
                         description_of(setting))
                     ->allow_extra_args(false);
    else
        option = command.add_option_function<std::string>(
            std::string(setting.option),
            [&](const std::string& text) { give_or_fail(overrides, setting.option, text); }, description_of(setting));
    option->type_name(type_name_of(setting.type));
    option->group(heading_of(setting.group));
    const auto* const name = std::get_if<Name>(&setting.type);
    if (name != nullptr && name->is_integrator)
        option->check(CLI::IsMember(integrator_setting_names()).description(""));
}

/// Adds --assets DIR, which adds to `assets` before what $ETENDUE_ASSETS lists.
void add_assets_option(CLI::App& command, std::vector<std::filesystem::path>& assets) {
    if (const char* listed = std::getenv("ETENDUE_ASSETS")) {
        std::istringstream list(listed);
        for (std::string directory; std::getline(list, directory, ':');)
            if (!directory.empty()) assets.emplace_back(directory);
    }
    command
        .add_option_function<std::vector<std::string>>(
            "--assets",
            [&assets](const std::vector<std::string>& given) {
                assets.insert(assets.begin(), given.begin(), given.end());
            },
            "Directory outside of the scene's from which the environment image that render.json names may come; may be "
            "repeated. $ETENDUE_ASSETS lists more, with ':' between them")
        ->check(CLI::ExistingDirectory)
        ->group(heading_of(SettingGroup::Scene))
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace

CLI::Validator real_range(double least, double most) {
    const auto check = [least, most](const std::string& text) {
        double value = 0.0;
        // Written so that NaN does not pass.
        if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return std::string();
        return fmt::format("'{}' is not a number from {:g} to {:g}", text, least, most);
    };
    return CLI::Validator(check, fmt::format("FLOAT in [{:g} - {:g}]", least, most));
}

PixelRect parse_pixel_window(const std::string& option, const std::string& text) {
    const Setting& crop = *find_setting("/crop");
    const std::optional<SettingValue> value = parse_option(crop, text);
    if (!value) throw CLI::ValidationError(option, fmt::format("'{}' is not {}", text, option_requirement(crop.type)));
    const auto& sides = std::get<std::vector<std::int64_t>>(*value);
    const auto side = [&](std::size_t i) { return static_cast<int>(sides[i]); };
    return {side(0), side(1), side(2), side(3)};
}

void add_png_option(CLI::App& command, SettingsOverrides& overrides) {
    command
        .add_flag_callback(
            "--no-png", [&overrides] { overrides.png = false; }, "Write no PNG beside the image")
        ->group(heading_of(SettingGroup::Files));
}

void add_scene_argument(CLI::App& command, std::string& scene) {
    // In capitals: CLI11 2.4 refuses a word that has the name of an option, as --scene.
    command.add_option("SCENE", scene, "Scene directory, .gltf or .glb")->required();
}

void add_settings_options(CLI::App& command, SettingsOverrides& overrides) {
    command
        .add_option_function<std::string>(
            "--quality", [&overrides](const std::string& text) { overrides.quality = kQualities.at(text); },
            "draft: half the size, 1/16 of the samples; preview: 1/4 of the samples; final: as the scene says")
        ->check(CLI::IsMember(kQualities))
        ->group("Size and camera");
    for (const Setting& setting : settings_table()) add_setting_option(command, setting, overrides);
    command
        .add_option(
            "--environment", overrides.environment,
            "Environment image (EXR or HDR) in place of the scene's, of which only the rotation is kept, or 'neutral' "
            "for white from everywhere, or 'none' for no light from afar")
        ->check(CLI::Validator(
            [](std::string& text) {
                return text == kNoEnvironment || text == kNeutralEnvironment ? std::string() : CLI::ExistingFile(text);
            },
            "FILE, neutral or none"))
        ->group(heading_of(SettingGroup::Scene));
    add_assets_option(command, overrides.assets);
    command
        .add_flag_callback(
            "--deep", [&overrides] { overrides.deep = true; },
            "Write a deep image beside the image, IMAGE.deep.exr: colour and opacity at up to 16 depths of each pixel "
            "(docs/deep.md)")
        ->group(heading_of(SettingGroup::Files));
    auto* half = command.add_flag_callback(
        "--half", [&overrides] { overrides.depth = PixelDepth::Half; }, "Write 16-bit floats (default)");
    half->group(heading_of(SettingGroup::Files));
    command
        .add_flag_callback(
            "--float", [&overrides] { overrides.depth = PixelDepth::Float; }, "Write 32-bit floats")
        ->excludes(half)
        ->group(heading_of(SettingGroup::Files));
}

}  // namespace etendue
