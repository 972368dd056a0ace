// Whether the files of a render can be written where they are to be, found before anything is rendered.
#pragma once

#include "integrator/integrator.h"
#include "picture/aov_setup.h"
#include "render/render.h"
#include "scene/scene_desc.h"
#include "session/scene_render.h"

#include <filesystem>

namespace etendue {

/// Refers to what is known of a render before its scene is compiled.
struct PlannedOutput {
    const SceneRenderRequest& request;
    const std::filesystem::path& output;  ///< image or part
    const SceneDesc& scene;
    const AovPlan& aovs;
    const RenderOptions& options;
    const Integrator& integrator;
};

/// Throws SceneError or UsageError if a file of the render would replace an input, or an image or a layer of another
/// render, and IoError if one cannot be written. Makes directories that are missing.
void check_outputs(const PlannedOutput& planned);

/// Throws SceneError if `output`, such as NAME.LAYER.exr, has the name of a layer of another image, NAME.exr.
void require_no_layer_of_another(const std::filesystem::path& output);

/// Throws SceneError with the place `where` if the file of a layer, `layer`, is an image of its own already. Throws
/// IoError if the file cannot be written.
void require_no_image_at(const std::filesystem::path& layer, const SourceLocation& where);

/// Throws SceneError if `output` is a part whose depths would lack light that its integrator finds for other pixels.
void require_depths_of_part(const std::filesystem::path& output, const RenderOptions& options, const AovPlan& aovs,
                            const Integrator& integrator);

}  // namespace etendue
