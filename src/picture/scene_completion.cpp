#include "picture/scene_completion.h"

namespace etendue {

void complete_scene(SceneDesc& scene, ProblemList& problems) {
    add_missing_camera_and_light(scene, problems);
    const ProblemList remaining = validate(scene);
    if (remaining.has_errors()) throw SceneError(remaining);
    apply_variant(scene);
}

}  // namespace etendue
