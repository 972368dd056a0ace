#include "compare/comparison_variants.h"

#include "core/log.h"
#include "loader/loader.h"
#include "picture/integrator_choice.h"
#include "picture/render_setup.h"
#include "process/shell_word.h"
#include "processor/ray_code.h"
#include "session/image_job.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

/// Writes as text what of a scene decides which light there is: neither how it is computed nor what memory that takes.
std::string light_text(SceneDesc scene) {
    scene.settings.integrator = {};
    scene.settings.spp = 1;
    scene.settings.seed = 0;
    scene.settings.sampler = {};
    scene.settings.time_limit = 0.0;
    scene.settings.relative_error = 0.0;
    scene.settings.clamp_indirect = 0.0f;
    scene.settings.robust_buckets = 0;
    scene.settings.brightest = 0;
    scene.settings.accelerator = {};
    scene.settings.film.filter = {};
    scene.settings.film.filter_radius = {};
    // The text of a scene has the names of its files only.
    std::string text = dump_without_settings(scene) + requested_settings(scene.settings) + "\n";
    for (const std::filesystem::path& input : scene.inputs) text += input.string() + "\n";
    return text;
}

void require_comparable(const Variant& first, const Variant& other) {
    const FilmSettings& a = first.settings.film;
    const FilmSettings& b = other.settings.film;
    const ColorSettings& color_a = first.settings.color;
    const ColorSettings& color_b = other.settings.color;
    const char* different = a.width != b.width || a.height != b.height || a.crop != b.crop ? "size or crop window"
                            : color_a.working_space != color_b.working_space               ? "working space"
                            : color_a.display != color_b.display || color_a.view != color_b.view ||
                                    color_a.look != color_b.look || color_a.exposure != color_b.exposure
                                ? "view"
                                : nullptr;
    if (different != nullptr)
        throw SceneError({other.options, {}}, fmt::format("'{}' and '{}' cannot be compared: they differ in their {}; "
                                                          "give that to both",
                                                          first.name, other.name, different));
}

/// Completes a variant by what depends on its settings and its world alone.
void complete(Variant& variant) {
    variant.sampling = make_render_options(variant.settings);
    variant.sampling.brightest = 0;
    if (variant.settings.robust_buckets > 0) {
        AovSet aovs;
        aovs.add_buckets(static_cast<std::size_t>(variant.settings.robust_buckets));
        variant.sampling.aovs = std::make_shared<AovSet>(aovs);
    }
    variant.integrator = create_integrator(variant.settings);
    variant.cannot_find = variant.integrator->unreachable_light(*variant.world);
}

/// Lengths of the paths that an image shows, in edges.
std::array<int, 2> path_window(const Variant& variant) {
    const IntegratorSettings& settings = variant.settings.integrator;
    return {settings.lengths.min_depth,
            std::min(settings.lengths.max_depth, find_integrator(settings.type)->longest_path)};
}

}  // namespace

std::vector<Variant> make_variants(const std::filesystem::path& scene, std::span<const VariantRequest> requests,
                                   const ColorConfig& colors, const ThreadPool& threads, bool quiet) {
    std::vector<Variant> variants;
    for (const VariantRequest& request : requests) {
        SettingsOverrides overrides = request.request.overrides;
        if (frames_of(scene, overrides)) overrides.frame = 0;
        PreparedScene prepared = prepare_scene(scene, overrides);
        const std::string working_space = resolve_colors(prepared.scene.settings, colors);
        Variant variant;
        variant.name = request.name;
        variant.options = request.options;
        variant.given = request.request.given;
        variant.inputs = prepared.scene.files_to_keep();
        variant.settings = prepared.scene.settings;
        variant.light = light_text(prepared.scene);
        const auto same_world = std::ranges::find_if(variants, [&](const Variant& other) {
            return other.light == variant.light && other.settings.texture_memory == variant.settings.texture_memory;
        });
        variant.world = same_world != variants.end()
                            ? same_world->world
                            : std::make_shared<const World>(ray_code().compile_world(
                                  std::move(prepared.scene), colors, working_space, threads, prepared.problems, {}));
        if (request.is_for_mirrors && !variant.world->traits().has_specular_surfaces) continue;
        if (variants.empty() && !quiet)
            for (const Problem& problem : prepared.problems.all()) log_warning("{}", problem.str());
        if (variant.settings.integrator.type == kAutoIntegrator) {
            const IntegratorChoice choice =
                choose_integrator(*variant.world, variant.settings, integrators_to_choose(variant.settings), threads);
            variant.settings.integrator.type = choice.integrator;
            if (!quiet) log_info("{}: auto chose {}", variant.name, choice.reason);
        }
        complete(variant);
        if (!quiet)
            for (const auto& notes : {variant.integrator->ineffective_options(*variant.world),
                                      ineffective_settings(variant.settings, variant.world->traits().has_bodies)})
                for (const std::string& note : notes) log_warning("note: {}: {}", variant.name, note);
        if (!variants.empty()) require_comparable(variants.front(), variant);
        if (!quiet)
            for (const std::string& missing : variant.cannot_find) log_warning("note: {}: {}", variant.name, missing);
        variants.push_back(std::move(variant));
    }
    return variants;
}

Variant with_integrator(const Variant& like, const std::string& integrator) {
    Variant variant;
    variant.name = integrator;
    variant.settings = like.settings;
    variant.world = like.world;
    variant.light = like.light;
    variant.settings.integrator.type = integrator;
    variant.settings.integrator.strategy.reset();
    variant.settings.integrator.weighted = true;
    variant.settings.clamp_indirect = 0.0f;
    variant.settings.robust_buckets = 0;
    complete(variant);
    return variant;
}

std::string different_light(const Variant& a, const Variant& b) {
    for (const Variant* variant : {&a, &b}) {
        if (!find_integrator(variant->settings.integrator.type)->shows_light)
            return fmt::format("'{}' shows something else than light", variant->name);
        if (const auto& strategy = variant->settings.integrator.strategy)
            return fmt::format("'{}' shows the strategy {} alone", variant->name, strategy_text(*strategy));
    }
    if (a.settings.clamp_indirect != b.settings.clamp_indirect)
        return fmt::format("'{}' and '{}' limit indirect light differently", a.name, b.name);
    if (a.settings.robust_buckets != b.settings.robust_buckets)
        return fmt::format("'{}' and '{}' are not both means of their samples, and medians are too dark", a.name,
                           b.name);
    const std::array<int, 2> of_a = path_window(a);
    const std::array<int, 2> of_b = path_window(b);
    if (of_a != of_b)
        return fmt::format("'{}' shows paths of {} to {} edges, '{}' those of {} to {}", a.name, of_a[0], of_a[1],
                           b.name, of_b[0], of_b[1]);
    const FilmSettings& film_a = a.settings.film;
    const FilmSettings& film_b = b.settings.film;
    if (film_a.filter != film_b.filter || film_a.filter_radius != film_b.filter_radius)
        return fmt::format("'{}' and '{}' have different pixel filters", a.name, b.name);
    if (a.light != b.light)
        return fmt::format(
            "the scenes of '{}' and '{}' differ, in their camera, moment, lights, environment or materials", a.name,
            b.name);
    return "";
}

std::string render_command(const std::filesystem::path& scene, const Variant& variant, std::uint32_t spp,
                           std::uint32_t seed) {
    const std::vector<GivenOption> given = without(without(variant.given, "--spp"), "--seed");
    std::string command = command_line("etendue render " + quoted(scene.string()), given);
    if (variant.settings.frame) command += fmt::format(" --frames {}", *variant.settings.frame);
    command += fmt::format(" --spp {} --seed {}", spp, seed);
    // The scene's own limit, which is not looked at here, would cut the image short.
    if (variant.settings.time_limit > 0.0) command += " --time 1e9";
    if (variant.settings.relative_error > 0.0) command += " --error 1e-6 --no-adaptive";
    return command + " --float -o image.exr";
}

std::string command_note(const Variant& variant) {
    const IntegratorSettings& settings = variant.settings.integrator;
    if (settings.cached_connections == 0 || !find_integrator(settings.type)->has_strategies()) return "";
    return "With cached connections the command renders an image of the same light with other noise: each pass fills "
           "its caches anew, and here passes end wherever an image is kept.";
}

}  // namespace etendue
