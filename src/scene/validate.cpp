#include "scene/validate_parts.h"

namespace etendue {

ProblemList validate(const SceneDesc& scene) {
    ProblemList problems;
    validate_images_and_textures(scene, problems);
    validate_materials(scene, problems);
    validate_meshes(scene, problems);
    validate_instances(scene, problems);
    validate_cameras(scene, problems);
    validate_lights(scene, problems);
    validate_settings(scene, problems);
    return problems;
}

}  // namespace etendue
