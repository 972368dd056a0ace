#include "session/settings_overrides.h"

#include "session/usage_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

int floor_half(int number) {
    return number >= 0 ? number / 2 : -((1 - number) / 2);
}

void apply_quality(Quality quality, RenderSettings& settings) {
    if (quality == Quality::Final) return;
    settings.spp = std::max(1, settings.spp / (quality == Quality::Draft ? 16 : 4));
    settings.options["/spp"] = "--quality";
    // More buckets than samples would leave some empty; a median of fewer than three means is just the mean.
    if (settings.robust_buckets > settings.spp) settings.robust_buckets = settings.spp < 3 ? 0 : (settings.spp - 1) | 1;
    if (quality == Quality::Preview) return;
    FilmSettings& film = settings.film;
    const FilmSettings before = film;
    film.width = std::max(1, film.width / 2);
    film.height = std::max(1, film.height / 2);
    settings.options["/size"] = "--quality";
    if (film.overscan >= 1.0f) film.overscan = std::ceil(0.5f * film.overscan);
    if (film.crop) {
        auto& c = *film.crop;
        // An odd size loses its last column or row; a window that was only there keeps the one before.
        const auto first = [](int pixel, int size, int half) {
            return pixel < size ? std::min(floor_half(pixel), half - 1) : half + floor_half(pixel - size);
        };
        const auto end = [](int pixel, int size, int half) {
            return pixel <= size ? std::min(half, floor_half(pixel + 1)) : half + floor_half(pixel - size + 1);
        };
        c = {first(c[0], before.width, film.width), first(c[1], before.height, film.height),
             end(c[2], before.width, film.width), end(c[3], before.height, film.height)};
    }
}

/// Returns the defaults with the value that is given for the setting at `pointer`.
RenderSettings defaults_with(const SettingsOverrides& overrides, std::string_view pointer) {
    RenderSettings settings;
    const auto given = overrides.given.find(pointer);
    if (given != overrides.given.end()) find_setting(pointer)->place.write(settings, given->second.value);
    return settings;
}

}  // namespace

void SettingsOverrides::give(std::string_view option, const std::string& text) {
    const Setting* const setting = setting_of_option(option);
    if (setting == nullptr) throw UsageError(fmt::format("there is no option {}", option));
    GivenSetting& kept = given[std::string(setting->pointer)];
    kept.option = option;
    if (std::holds_alternative<YesNo>(setting->type)) {
        kept.value = option == setting->option;
        return;
    }
    std::optional<SettingValue> value = parse_option(*setting, text);
    if (!value) throw UsageError(fmt::format("{}: '{}' is not {}", option, text, option_requirement(setting->type)));
    auto* const texts = std::get_if<std::vector<std::string>>(&kept.value);
    if (texts == nullptr)
        kept.value = std::move(*value);
    else
        texts->push_back(text);
}

std::optional<std::uint32_t> SettingsOverrides::spp() const {
    if (!has("/spp")) return std::nullopt;
    return static_cast<std::uint32_t>(defaults_with(*this, "/spp").spp);
}

std::optional<FrameRange> SettingsOverrides::frames() const {
    return defaults_with(*this, "/frames").frames;
}

void SettingsOverrides::apply(RenderSettings& settings) const {
    if (quality) apply_quality(*quality, settings);
    for (const auto& [pointer, setting] : given) {
        const Setting& row = *find_setting(pointer);
        const auto* const texts = std::get_if<Texts>(&row.type);
        if (texts != nullptr && !texts->takes_one) continue;
        row.place.write(settings, setting.value);
        settings.options[pointer] = setting.option;
    }
    for (AovDesc& aov : defaults_with(*this, "/aovs").aovs) {
        aov.location = {"--aov", {}};
        settings.aovs.push_back(std::move(aov));
    }
    if (deep) settings.aovs.push_back({.name = "deep", .source = "deep", .is_float = {}, .location = {"--deep", {}}});
    if (settings.color.aces_container && depth == PixelDepth::Float)
        throw SceneError(settings.at("/color/aces_container"),
                         "an ACES container (SMPTE ST 2065-4) holds 16-bit floats; leave --float out");
}

std::optional<std::filesystem::path> SettingsOverrides::environment_file() const {
    if (!environment || *environment == kNoEnvironment || *environment == kNeutralEnvironment) return std::nullopt;
    return *environment;
}

void SettingsOverrides::apply_environment(SceneDesc& scene) const {
    if (!environment) return;
    if (has("/studio")) throw SceneError({"--environment", {}}, "--studio puts another light in its place: give one");
    if (scene.settings.studio || *environment == kNoEnvironment) scene.settings.studio = false;
    if (const auto file = environment_file()) {
        // Only the rotation of the scene's own environment applies to the new image.
        const auto rotation = scene.environment.rotation;
        scene.environment = {};
        scene.environment.enabled = true;
        scene.environment.rotation = rotation;
        scene.environment.image = std::filesystem::absolute(*file);
        scene.environment.color = Rgb(1.0f);
        scene.inputs.push_back(scene.environment.image);
    } else {
        scene.environment = {};
        scene.environment.enabled = *environment == kNeutralEnvironment;
    }
    scene.environment.location = {*environment, ""};
}

LoadOptions SettingsOverrides::load_options() const {
    return {.frame = frame,
            .adjust = [overrides = *this](RenderSettings& settings) { overrides.apply(settings); },
            .settings = {},
            .assets = assets};
}

}  // namespace etendue
