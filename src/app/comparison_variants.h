// The ways of rendering one scene that are to be compared.
#pragma once

#include "app/scene_render.h"
#include "app/settings_overrides.h"
#include "color/color_config.h"
#include "core/parallel.h"
#include "integrator/integrator.h"
#include "render/render.h"
#include "world/world.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// A variant as it is asked for.
struct VariantRequest {
    std::string name;
    std::string options;  ///< in addition to those of all variants, as they stand on a command line
};

/// A variant that can be rendered.
struct Variant {
    std::string name{};
    std::string options{};
    RenderSettings settings{};
    RenderOptions sampling{};
    std::unique_ptr<const Integrator> integrator{};
    std::shared_ptr<const World> world{};  ///< one for all variants whose scenes are the same
    std::vector<std::string> cannot_find{};
};

/// `common` and then `options`. Throws CLI::ParseError for options that it does not know.
[[nodiscard]] SettingsOverrides with_options(const SettingsOverrides& common, const std::string& options);

/// Loads and compiles the scene for each request. Notes and warnings of the first go to stderr unless `quiet`. Throws
/// SceneError for what is wrong with a scene or its settings, and if the variants' images could not be compared: they
/// must have one size, crop window, working space and view.
[[nodiscard]] std::vector<Variant> make_variants(const std::filesystem::path& scene,
                                                 std::span<const VariantRequest> requests,
                                                 const SettingsOverrides& common, const ColorConfig& colors,
                                                 const ThreadPool& threads, bool quiet);

/// The variant of `integrator` with its settings but for the algorithm's name; in the same world as `like`.
[[nodiscard]] Variant with_integrator(const Variant& like, const std::string& integrator);

}  // namespace etendue
