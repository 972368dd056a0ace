#include "compare/comparison_classes.h"

#include "loader/loader.h"
#include "metrics/pixel_selection.h"
#include "render/progressive_render.h"
#include "session/image_job.h"
#include "session/interrupt.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr std::uint32_t kClassSamples = 16;

/// The layers of `plan` of a few samples of `variant`, one channel each: luminance.
std::vector<ImageF> light_of_classes(const Variant& variant, const AovPlan& plan, const MeasureContext& context) {
    RenderOptions options = variant.sampling;
    options.aovs = plan.set;
    ProgressiveRender render(*variant.world, *variant.integrator, options, context.threads);
    std::vector<ImageF> layers;
    if (!render.add_samples(kClassSamples, [] { return interrupt_requested().load(); })) return layers;
    const Rgb weights = context.colors.luminance_weights(variant.settings.color.working_space);
    for (const AovOutput& output : plan.outputs)
        layers.push_back(luminances(resolve_layer(render.state().film, output).pixels, weights));
    return layers;
}

}  // namespace

AovPlan plan_of_classes(const std::filesystem::path& scene, const VariantRequest& request,
                        std::span<const std::string> classes) {
    if (classes.empty()) return {};
    SettingsOverrides overrides = request.request.overrides;
    if (frames_of(scene, overrides)) overrides.frame = 0;
    PreparedScene prepared = prepare_scene(scene, overrides);
    prepared.scene.settings.aovs.clear();
    for (const std::string& name : classes)
        prepared.scene.settings.aovs.push_back({.name = name, .source = name, .is_float = {}});
    AovPlan plan = make_aov_plan(prepared.scene, prepared.problems);
    for (const AovOutput& output : plan.outputs)
        if (output.kind != AovKind::Layer)
            throw SceneError({"--insets", {}}, fmt::format("'{}' is no layer of light", output.name));
    return plan;
}

std::vector<NamedRegion> regions_of_classes(const Variant& variant, const AovPlan& plan, const MeasureContext& context,
                                            std::vector<std::string>& notes) {
    if (plan.outputs.empty()) return {};
    const PixelRect& window = variant.sampling.window;
    std::vector<NamedRegion> regions;
    const std::vector<ImageF> layers = light_of_classes(variant, plan, context);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        ImageF trimmed = layers[i];
        trim(trimmed);
        double brightest = 0.0;
        std::optional<PixelRect> found;
        for (const PixelRect& block : whole_blocks(window)) {
            const double mean =
                mean_of(trimmed, {.region = moved_to(block, block.x0 - window.x0, block.y0 - window.y0)});
            const bool is_free = std::ranges::find(regions, block, &NamedRegion::pixels) == regions.end();
            if (!(mean > brightest) || !is_free) continue;
            brightest = mean;
            found = block;
        }
        if (found)
            regions.push_back({plan.outputs[i].name, *found, false});
        else
            notes.push_back(
                fmt::format("the image has no light of the class '{}' to look at (--insets)", plan.outputs[i].name));
    }
    return regions;
}

}  // namespace etendue
