#include "loader/gltf/gltf_loader.h"

#include "loader/files.h"
#include "loader/gltf/gltf_accessor.h"
#include "loader/gltf/gltf_animation.h"
#include "loader/gltf/gltf_animation_pointer.h"
#include "loader/gltf/gltf_document.h"
#include "loader/gltf/gltf_environment.h"
#include "loader/gltf/gltf_extras.h"
#include "loader/gltf/gltf_material.h"
#include "loader/gltf/gltf_mesh.h"
#include "loader/gltf/gltf_nodes.h"
#include "loader/gltf/gltf_textures.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace etendue {

namespace {

/// Says what is wrong with the animations that are not among `shown`, all of it as warnings: the image does not show
/// them.
void check_other_animations(const GltfDocument& document, std::span<const GltfAnimation* const> shown,
                            ProblemList& problems) {
    ProblemList found;
    AccessorReader accessors(document, found);
    for (const GltfAnimation& animation : document.animations) {
        if (accessors.is_exhausted()) break;  // which is reported
        if (std::ranges::find(shown, &animation) != shown.end()) continue;
        const AnimationSampler sampler(document, std::array{&animation}, accessors, found);
    }
    for (Problem problem : found.all()) {
        problem.severity = std::min(problem.severity, Severity::Warning);
        problems.add(std::move(problem));
    }
}

}  // namespace

bool GltfLoader::can_load(const std::filesystem::path& file) const {
    const std::string extension = lower_extension(file);
    if (extension == ".gltf" || extension == ".glb") return true;

    std::array<char, 4> magic{};
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code)) return false;
    std::ifstream stream(file, std::ios::binary);
    stream.read(magic.data(), magic.size());
    return stream && std::string_view(magic.data(), magic.size()) == "glTF";
}

SweptSpace GltfLoader::load(const std::filesystem::path& file, const LoadOptions& options, SceneDesc& scene,
                            ProblemList& problems) const {
    const RenderSettings& settings = scene.settings;
    GltfDocument document = read_gltf_document(file, problems);
    scene.extensions_used = document.extensions_used;
    scene.extensions_ignored = document.extensions_ignored;
    scene.inputs.insert(scene.inputs.end(), document.inputs.begin(), document.inputs.end());
    scene.images_of_file = document.images_of_file;
    AccessorReader accessors(document, problems);
    for (const GltfAnimation& animation : document.animations) scene.animations.push_back(animation.name);
    std::optional<AnimationSampler> sampler;
    std::vector<const GltfAnimation*> shown;
    const bool names_animations =
        !settings.animations.empty() && settings.animations != std::vector<std::string>{std::string(kNoAnimation)};
    if (names_animations && document.animations.empty())
        problems.warning(settings.at("/animation"), "the file has no animation, and the scene stands still");
    else if (names_animations && !settings.shown_time() && !options.every_animation)
        problems.warning(settings.at("/animation"),
                         "no animation plays without a moment: name one with --time-code, or several with --frames");
    if (settings.shown_time()) {
        shown = choose_animations(document, settings, problems);
        if (!shown.empty()) sampler.emplace(document, shown, accessors, problems);
    } else if (!document.animations.empty()) {
        problems.note(document.at("/animations"),
                      "the scene is shown at rest; --time-code SECONDS shows a moment of "
                      "its animations");
    }
    if (options.every_animation) check_other_animations(document, shown, problems);
    if (sampler)
        apply_pointers(sampler->pointer_values(*settings.shown_time() + settings.shutter.middle()), document, problems);
    TextureReader textures(document, accessors, scene, problems);
    read_materials(document, textures, scene, problems);
    const std::vector<MeshDeformation> deformations = read_meshes(document, accessors, scene, problems);
    read_nodes(document, accessors, deformations, sampler ? &*sampler : nullptr, settings, scene, problems);
    read_environment(document, textures, scene, problems);
    read_extras(document, scene);
    const bool is_complete = !scene.cameras.empty() && (!scene.lights.empty() || scene.environment.enabled);
    if (!settings.frame || !sampler || is_complete || problems.has_errors()) return {};
    show_animated_nodes(sampler->pointer_values(*settings.shown_time()), document);
    return swept_by_animation(document, deformations, *sampler, settings, scene);
}

}  // namespace etendue
