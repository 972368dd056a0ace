#include "app/comparison_variants.h"

#include "core/log.h"
#include "world/compile.h"

#include <cstddef>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace etendue {

namespace {

/// What of a scene the world depends on, as text: all but how its light is computed.
std::string world_text(SceneDesc scene) {
    scene.settings.integrator = {};
    scene.settings.spp = 1;
    scene.settings.seed = 0;
    scene.settings.time_limit = 0.0;
    return dump(scene);
}

void require_comparable(const Variant& first, const Variant& other) {
    const FilmSettings& a = first.settings.film;
    const FilmSettings& b = other.settings.film;
    const ColorSettings& color_a = first.settings.color;
    const ColorSettings& color_b = other.settings.color;
    const char* different =
        a.width != b.width || a.height != b.height || a.crop != b.crop ? "size or crop window"
        : color_a.working_space != color_b.working_space               ? "working space"
        : color_a.display != color_b.display || color_a.view != color_b.view || color_a.exposure != color_b.exposure
            ? "view"
            : nullptr;
    if (different != nullptr)
        throw SceneError({other.options, {}}, fmt::format("'{}' and '{}' cannot be compared: they differ in their {}; "
                                                          "give that to both",
                                                          first.name, other.name, different));
}

/// What depends on the settings alone.
void complete(Variant& variant) {
    variant.sampling = make_render_options(variant.settings);
    variant.integrator = create_integrator(variant.settings);
    variant.cannot_find = variant.integrator->unreachable_light(*variant.world);
}

}  // namespace

SettingsOverrides with_options(const SettingsOverrides& common, const std::string& options) {
    SettingsOverrides overrides = common;
    CLI::App parser;
    overrides.add_options(parser);
    parser.parse(options, false);
    return overrides;
}

std::vector<Variant> make_variants(const std::filesystem::path& scene, std::span<const VariantRequest> requests,
                                   const SettingsOverrides& common, const ColorConfig& colors,
                                   const ThreadPool& threads, bool quiet) {
    std::vector<Variant> variants;
    std::vector<std::string> worlds;  // of each variant, as text
    for (const VariantRequest& request : requests) {
        PreparedScene prepared = prepare_scene(scene, with_options(common, request.options));
        const std::string working_space = resolve_colors(prepared.scene.settings, colors);
        Variant variant{.name = request.name, .options = request.options, .settings = prepared.scene.settings};
        worlds.push_back(world_text(prepared.scene));
        for (std::size_t i = 0; i + 1 < worlds.size() && !variant.world; ++i)
            if (worlds[i] == worlds.back()) variant.world = variants[i].world;
        if (!variant.world)
            variant.world = std::make_shared<const World>(
                compile_world(std::move(prepared.scene), colors, working_space, threads, prepared.problems));
        if (variants.empty() && !quiet)
            for (const Problem& problem : prepared.problems.all()) log_warning("{}", problem.str());
        complete(variant);
        if (!quiet)
            for (const std::string& note : variant.integrator->ineffective_options(*variant.world))
                log_warning("note: {}: {}", variant.name, note);
        if (!variants.empty()) require_comparable(variants.front(), variant);
        variants.push_back(std::move(variant));
    }
    return variants;
}

Variant with_integrator(const Variant& like, const std::string& integrator) {
    Variant variant{.name = integrator, .options = {}, .settings = like.settings, .world = like.world};
    variant.settings.integrator.type = integrator;
    variant.settings.integrator.strategy.reset();
    variant.settings.integrator.weighted = true;
    complete(variant);
    return variant;
}

}  // namespace etendue
