// The ways of rendering one scene that are to be compared.
#pragma once

#include "color/color_config.h"
#include "core/parallel.h"
#include "integrator/integrator.h"
#include "render/render.h"
#include "session/given_options.h"
#include "session/scene_render.h"
#include "session/settings_overrides.h"
#include "world/world.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Options of `render`: what they change, and how they stand on a command line.
struct RenderRequest {
    SettingsOverrides overrides{};
    std::vector<GivenOption> given{};
};

/// A variant as it is asked for.
struct VariantRequest {
    std::string name;
    std::string options;  ///< in addition to those of all variants, as they stand on a command line
    RenderRequest request;
    bool is_for_mirrors = false;  ///< left out of scenes without mirrors and smooth glass
};

/// A variant that can be rendered.
struct Variant {
    std::string name{};
    std::string options{};
    std::vector<GivenOption> given{};             ///< options of `render`: its own and those of all variants
    std::vector<std::filesystem::path> inputs{};  ///< files of its scene that no output may replace
    RenderSettings settings{};
    RenderOptions sampling{};
    std::unique_ptr<const Integrator> integrator{};
    std::shared_ptr<const World> world{};  ///< one for all variants whose scenes are the same
    std::string light{};                   ///< text of what decides which light the scene has
    std::vector<std::string> cannot_find{};
};

/// Loads and compiles the scene for each request; of a sequence, its frame 0. Notes and warnings of the first, and the
/// light that each cannot find, go to stderr unless `quiet`. Throws SceneError for what is wrong with a scene or its
/// settings, and if the variants' images could not be compared: they must have one size, crop window, working space and
/// view.
[[nodiscard]] std::vector<Variant> make_variants(const std::filesystem::path& scene,
                                                 std::span<const VariantRequest> requests, const ColorConfig& colors,
                                                 const ThreadPool& threads, bool quiet);

/// The variant of `integrator` with the settings of `like` but for the algorithm's name, in the same world.
[[nodiscard]] Variant with_integrator(const Variant& like, const std::string& integrator);

/// Why two variants show different light by what they were asked for, in words: scenes, lengths of paths, single
/// strategies, or images that are not of light at all. Empty if they show the same light, as far as each finds it.
[[nodiscard]] std::string different_light(const Variant& a, const Variant& b);

/// The command that renders an image of `variant`.
[[nodiscard]] std::string render_command(const std::filesystem::path& scene, const Variant& variant, std::uint32_t spp,
                                         std::uint32_t seed);

/// How the image of that command differs from the one that `compare` rendered; empty if it does not, but for rounding.
[[nodiscard]] std::string command_note(const Variant& variant);

}  // namespace etendue
