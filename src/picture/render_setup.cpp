#include "picture/render_setup.h"

#include "core/error.h"
#include "integrator/integrator.h"
#include "processor/ray_code.h"
#include "scene/setting.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace etendue {

namespace {

FilterShape to_filter_shape(PixelFilterType type) {
    switch (type) {
        case PixelFilterType::BlackmanHarris:
            return FilterShape::BlackmanHarris;
        case PixelFilterType::Box:
            return FilterShape::Box;
        case PixelFilterType::Gaussian:
            return FilterShape::Gaussian;
        case PixelFilterType::Mitchell:
            return FilterShape::Mitchell;
    }
    return FilterShape::BlackmanHarris;
}

}  // namespace

std::string integrators_that(const std::function<bool(const IntegratorEntry&)>& is_meant) {
    std::vector<std::string> names;
    for (const IntegratorEntry& entry : integrator_registry())
        if (is_meant(entry)) names.push_back(fmt::format("'{}'", entry.name));
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
    return text;
}

RenderOptions make_render_options(const RenderSettings& settings) {
    const FilmSettings& film = settings.film;
    RenderOptions options;
    options.full_width = film.width;
    options.full_height = film.height;
    options.window = film.window();
    options.spp = static_cast<std::uint32_t>(settings.spp);
    options.seed = settings.seed;
    options.sequence = settings.sampler == SamplerType::Random ? SampleSequence::Random : SampleSequence::Sobol;
    options.filter = PixelFilter(to_filter_shape(film.filter), film.filter_radius);
    options.time_limit_seconds = settings.time_limit;
    options.relative_error = settings.relative_error;
    if (settings.clamp_indirect > 0.0f) options.clamp_indirect = settings.clamp_indirect;
    options.brightest = static_cast<std::size_t>(settings.brightest);
    // Samples of a pass that merges all have one index, so that no pixel has more of them.
    const IntegratorEntry* const integrator = find_integrator(settings.integrator.type);
    const bool merges = integrator != nullptr && integrator->merges;
    options.adaptive = settings.adaptive && settings.relative_error > 0.0 && !merges;
    options.min_spp = static_cast<std::uint32_t>(settings.min_spp);
    return options;
}

RenderOptions make_part_options(const RenderSettings& settings, const std::optional<SampleRange>& samples) {
    RenderOptions options = make_render_options(settings);
    options.splat_window = settings.film.frame();
    options.time_limit_seconds = 0.0;
    options.relative_error = 0.0;
    options.adaptive = false;
    if (samples) options.spp = samples->end - samples->begin;
    return options;
}

bool keeps_every_other_pass(const RenderOptions& options, bool has_halves) {
    return options.relative_error > 0.0 || has_halves;
}

RenderState make_render_state(const RenderOptions& options, bool has_halves) {
    RenderState state{.film = make_film(options)};
    if (keeps_every_other_pass(options, has_halves)) state.every_other_pass = make_second_film(options);
    return state;
}

std::vector<std::string> integrator_names() {
    std::vector<std::string> names;
    for (const IntegratorEntry& entry : integrator_registry()) names.emplace_back(entry.name);
    return names;
}

std::vector<std::string> integrator_setting_names() {
    std::vector<std::string> names = integrator_names();
    names.insert(names.begin(), std::string(kAutoIntegrator));
    return names;
}

bool has_strategies(const std::string& integrator) {
    const IntegratorEntry* const entry = find_integrator(integrator);
    return entry != nullptr && entry->has_strategies();
}

bool shows_strategy(const std::string& integrator, const Strategy& strategy) {
    return has_strategies(integrator) && (strategy != kMerges || find_integrator(integrator)->merges);
}

void require_strategies(const RenderSettings& settings, const SourceLocation& asked_for) {
    const std::string& type = settings.integrator.type;
    if (has_strategies(type)) return;
    const std::string others = integrators_that([](const IntegratorEntry& entry) { return entry.has_strategies(); });
    throw SceneError(asked_for, fmt::format("'{}' has no strategies; these have some: {}", type, others));
}

namespace {

constexpr int kShortestIndirect = 3;  // edges

/// Returns true if the integrator tells indirect light from direct light.
bool finds_indirect_light(const IntegratorEntry& entry) {
    return entry.has_expressions && entry.longest_path >= kShortestIndirect;
}

/// Throws SceneError for what could have no effect with the integrator `entry`.
void require_fireflies(const RenderSettings& settings, const IntegratorEntry& entry) {
    if (settings.clamp_indirect > 0.0f && !finds_indirect_light(entry))
        throw SceneError(settings.at("/clamp_indirect"),
                         fmt::format("'{}' finds no indirect light that could be limited; these find some: {}",
                                     entry.name, integrators_that(finds_indirect_light)));
    if (settings.robust_buckets > 0 && !entry.shows_light)
        throw SceneError(settings.at("/robust"), fmt::format("'{}' shows no light, and has no fireflies", entry.name));
    if (settings.robust_buckets > settings.spp)
        throw SceneError(
            settings.at("/robust"),
            fmt::format("mon:{0} is the median of {0} means, and each pixel has {1} samples: buckets would "
                        "stay empty; take more samples or fewer buckets",
                        settings.robust_buckets, settings.spp));
}

}  // namespace

std::unique_ptr<const Integrator> create_integrator(const RenderSettings& settings) {
    const IntegratorSettings& s = settings.integrator;
    if (s.type == kAutoIntegrator)
        throw SceneError(settings.at("/integrator/type"),
                         fmt::format("'auto' has an integrator chosen for a render; name one here: {}",
                                     fmt::join(integrator_names(), ", ")));
    std::vector<std::string_view> names;
    for (const IntegratorEntry& entry : integrator_registry()) {
        names.push_back(entry.name);
        if (entry.name == s.type) require_fireflies(settings, entry);
        if (entry.name == s.type && s.lengths.min_depth > entry.longest_path)
            throw SceneError(settings.at("/integrator/min_depth"),
                             fmt::format("min_depth is {}, but the paths of '{}' have at most {} edges",
                                         s.lengths.min_depth, s.type, entry.longest_path));
    }
    auto integrator = ray_code().make_integrator(s.type, s);
    if (!integrator)
        throw SceneError(settings.at("/integrator/type"),
                         fmt::format("no integrator is named '{}'; {}", s.type, name_hint(s.type, names)));
    if (s.strategy) {
        require_strategies(settings, settings.at(std::string(kStrategySetting)));
        if (!shows_strategy(s.type, *s.strategy))
            throw SceneError(settings.at(std::string(kStrategySetting)),
                             fmt::format("'{}' merges nothing; these do: {}", s.type,
                                         integrators_that([](const IntegratorEntry& entry) { return entry.merges; })));
    }
    return integrator;
}

namespace {

bool is_looked_at(const Setting& setting, const std::string& integrator) {
    const auto owns = [&](const IntegratorEntry& entry) { return entry.owns(setting.pointer); };
    const IntegratorEntry* const entry = find_integrator(integrator);
    return (entry != nullptr && owns(*entry)) || std::ranges::none_of(integrator_registry(), owns);
}

}  // namespace

std::vector<std::string> ineffective_settings(const RenderSettings& settings, bool has_bodies) {
    std::vector<std::string> sentences;
    const std::string& type = settings.integrator.type;
    RenderSettings effective = settings;
    effective.time_code = settings.shown_time();
    for (const Setting& setting : settings_table()) {
        // A render.json may well hold it for when the other setting or another integrator is asked for.
        const auto option = settings.options.find(std::string(setting.pointer));
        if (option == settings.options.end()) continue;
        if (const Setting* const needed = find_setting(setting.needs);
            needed != nullptr && needed->place.read(effective) == default_value(*needed))
            sentences.push_back(fmt::format("{} has no effect without {}", option->second, needed->option));
        if (!is_looked_at(setting, type))
            sentences.push_back(fmt::format(
                "{} has no effect with '{}': it is for {}", option->second, type,
                integrators_that([&](const IntegratorEntry& entry) { return entry.owns(setting.pointer); })));
    }
    if (settings.film.crop && settings.film.overscan > 0.0f)
        if (const auto option = settings.options.find("/film/overscan"); option != settings.options.end())
            sentences.push_back(fmt::format("{} has no effect beside the window of {}, which may lie beyond the image",
                                            option->second, settings.at("/crop").str()));
    const IntegratorEntry* const entry = find_integrator(type);
    if (entry != nullptr && entry->merges && settings.relative_error > 0.0 && settings.adaptive)
        for (const char* const pointer : {"/adaptive", "/min_spp"})
            if (const auto option = settings.options.find(pointer); option != settings.options.end())
                sentences.push_back(
                    fmt::format("{} has no effect with '{}': samples merge with photons of their own index, so that "
                                "all pixels have as many",
                                option->second, type));
    if (settings.clamp_indirect > 0.0f && settings.integrator.lengths.max_depth < kShortestIndirect && !has_bodies)
        sentences.push_back(fmt::format(
            "{} has no effect: paths have at most {} (--max-depth), and indirect light takes {}",
            settings.at("/clamp_indirect").str(),
            settings.integrator.lengths.max_depth == 1 ? "1 edge"
                                                       : fmt::format("{} edges", settings.integrator.lengths.max_depth),
            kShortestIndirect));
    return sentences;
}

std::vector<std::string> notes_on(const World& world, const Integrator& integrator, const RenderSettings& settings) {
    std::vector<std::string> notes;
    for (std::vector<std::string> some : {integrator.unreachable_light(world), integrator.ineffective_options(world),
                                          ineffective_settings(settings, world.traits().has_bodies)})
        notes.insert(notes.end(), some.begin(), some.end());
    return notes;
}

namespace {

/// The config knows names only; where they stood is known here.
auto located(const RenderSettings& settings, const char* pointer, const auto& look_up) {
    try {
        return look_up();
    } catch (const SceneError& error) {
        throw SceneError(settings.at(pointer), error.problems().all().front().message);
    }
}

/// The space of the EXR, with the working space in place of none.
std::string resolve_output_space(const RenderSettings& settings, const ColorConfig& colors) {
    const ColorSettings& s = settings.color;
    if (!s.output_space.empty()) {
        std::string space = located(settings, "/color/output_space", [&] {
            (void)colors.matrix(s.working_space, s.output_space);
            return colors.resolve_space(s.output_space);
        });
        if (!s.aces_container || space == colors.aces_space()) return space;
        throw SceneError(settings.at("/color/output_space"),
                         fmt::format("an ACES container (SMPTE ST 2065-4) is in ACES2065-1, not in '{}'", space));
    }
    if (!s.aces_container) return s.working_space;
    if (colors.aces_space().empty())
        throw SceneError(settings.at("/color/aces_container"),
                         fmt::format("the OpenColorIO config {} has no ACES2065-1", colors.origin()));
    return colors.aces_space();
}

}  // namespace

std::string resolve_colors(RenderSettings& settings, const ColorConfig& colors) {
    ColorSettings& s = settings.color;
    s.working_space = located(settings, "/color/working_space", [&] {
        return s.working_space.empty() ? colors.default_working_space() : colors.resolve_space(s.working_space);
    });
    if (s.display.empty()) s.display = colors.default_display();
    const std::string default_view =
        located(settings, "/color/display", [&] { return colors.default_view(s.display); });
    if (s.view.empty()) s.view = default_view;
    located(settings, "/color/look", [&] { colors.require_look(s.look); });
    (void)located(settings, "/color/view", [&] {
        return colors.display_transform(s.working_space, s.display, s.view, s.exposure.value_or(0.0f), s.look);
    });
    s.output_space = resolve_output_space(settings, colors);
    return s.working_space;
}

}  // namespace etendue
