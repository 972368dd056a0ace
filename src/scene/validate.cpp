#include "scene/validate_parts.h"

#include <cmath>

namespace etendue {

ProblemList validate(const SceneDesc& scene) {
    ProblemList problems;
    const Vec3d& origin = scene.origin;
    if (!std::isfinite(origin.x) || !std::isfinite(origin.y) || !std::isfinite(origin.z))
        problems.error({scene.file.string(), {}}, "the scene's origin is not finite");
    validate_images_and_textures(scene, problems);
    validate_materials(scene, problems);
    validate_meshes(scene, problems);
    validate_instances(scene, problems);
    validate_cameras(scene, problems);
    validate_lights(scene, problems);
    validate_settings(scene, problems);
    if (!problems.has_errors()) validate_extent(scene, problems);
    return problems;
}

}  // namespace etendue
