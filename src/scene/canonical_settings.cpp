#include "scene/canonical_settings.h"

#include <fmt/format.h>

namespace etendue {

namespace {

std::string text_in(const Setting& setting, const RenderSettings& settings) {
    return to_text(setting, setting.place.read(settings));
}

std::string default_text_of(const Setting& setting) {
    return to_text(setting, default_value(setting));
}

bool is_default(const Setting& setting, const RenderSettings& settings) {
    return text_in(setting, settings) == default_text_of(setting);
}

}  // namespace

SettingTexts setting_texts(const RenderSettings& settings) {
    SettingTexts texts;
    for (const Setting& setting : settings_table()) texts[std::string(setting.pointer)] = text_in(setting, settings);
    return texts;
}

SettingTexts canonical_settings(const RenderSettings& settings, bool (*takes_part)(Decides decides)) {
    RenderSettings effective = settings;
    // A frame is the same image in a longer sequence, so only the moment counts.
    effective.time_code = settings.shown_time();
    for (const Setting& setting : settings_table())
        if (!setting.needs.empty() && is_default(*find_setting(setting.needs), effective))
            setting.place.write(effective, default_value(setting));
    SettingTexts texts;
    for (const Setting& setting : settings_table())
        if (takes_part(setting.decides)) texts[std::string(setting.pointer)] = text_in(setting, effective);
    return texts;
}

std::vector<std::string> changed_settings(const SettingTexts& before, const SettingTexts& after) {
    std::vector<std::string> lines;
    for (const Setting& setting : settings_table()) {
        const auto text_of = [&](const SettingTexts& texts) {
            const auto found = texts.find(std::string(setting.pointer));
            return found == texts.end() ? default_text_of(setting) : found->second;
        };
        const std::string old_text = text_of(before);
        const std::string new_text = text_of(after);
        if (old_text != new_text)
            lines.push_back(fmt::format("{}: {} -> {}", setting_name(setting), old_text, new_text));
    }
    return lines;
}

SettingTexts without_defaults(SettingTexts texts) {
    std::erase_if(texts, [](const auto& entry) {
        const Setting* const setting = find_setting(entry.first);
        return setting != nullptr && entry.second == default_text_of(*setting);
    });
    return texts;
}

std::string to_json_object(const SettingTexts& texts) {
    std::string object;
    for (const auto& [pointer, text] : texts)
        object += fmt::format("{}\"{}\": {}", object.empty() ? "" : ", ", pointer, text);
    return "{" + object + "}";
}

}  // namespace etendue
