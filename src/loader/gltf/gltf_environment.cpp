#include "loader/gltf/gltf_environment.h"

#include "loader/gltf/gltf_transform.h"
#include "loader/gltf/gltf_value.h"

#include <fmt/format.h>

namespace etendue {

namespace {

constexpr const char* kImageBasedLights = "EXT_lights_image_based";

/// Largest face that is taken: six of them take 1.2 GB while the environment is built.
constexpr int kMaxFaceSide = 4096;

/// False, with an error, unless all faces are squares of one size that is not absurd.
bool check_faces(const CubeMapDesc& cube, int size, const SceneDesc& scene, const SourceLocation& where,
                 ProblemList& problems) {
    const auto image = [&](std::size_t face) -> const ImageDesc& {
        return scene.images[static_cast<std::size_t>(cube.faces[face].index)];
    };
    const int side = image(0).width;
    for (std::size_t face = 0; face < cube.faces.size(); ++face) {
        if (image(face).width == side && image(face).height == side) continue;
        problems.error(where, fmt::format("face {} has {} x {} pixels, but the faces of a cube map are squares of one "
                                          "size, {} x {}",
                                          face, image(face).width, image(face).height, side, side));
        return false;
    }
    if (side > kMaxFaceSide) {
        problems.error(where,
                       fmt::format("the faces have {0} x {0} pixels; at most {1} x {1} are taken", side, kMaxFaceSide));
        return false;
    }
    if (side != size)
        problems.warning(where, fmt::format("specularImageSize is {}, but the images have {} pixels: their size is "
                                            "taken",
                                            size, side));
    return true;
}

}  // namespace

void read_environment(const GltfDocument& document, TextureReader& textures, SceneDesc& scene, ProblemList& problems) {
    const tinygltf::Model& model = document.model;
    if (model.scenes.empty()) return;
    const tinygltf::Value* reference = find_extension(model.scenes[scene.shown_scene].extensions, kImageBasedLights);
    if (reference == nullptr) return;
    const int index = integer_or(*reference, "light", 0);
    const tinygltf::Value& light = model.extensions.at(kImageBasedLights).Get("lights").Get(index);
    const SourceLocation where = document.at(fmt::format("/extensions/{}/lights/{}", kImageBasedLights, index));

    CubeMapDesc cube;
    const tinygltf::Value& sharpest = light.Get("specularImages").Get(0);
    for (std::size_t face = 0; face < cube.faces.size(); ++face) {
        cube.faces[face] =
            textures.required_image(static_cast<std::size_t>(sharpest.Get(static_cast<int>(face)).GetNumberAsInt()));
        if (!cube.faces[face]) return;  // reported with the image
    }
    if (!check_faces(cube, integer_or(light, "specularImageSize", 0), scene, where, problems)) return;
    const std::optional<Mat4d> rotation =
        rotation_matrix({element_or(light, "rotation", 0, 0.0), element_or(light, "rotation", 1, 0.0),
                         element_or(light, "rotation", 2, 0.0), element_or(light, "rotation", 3, 1.0)});
    if (!rotation) problems.warning(where, "the rotation is a zero quaternion and is ignored");
    cube.to_world = to_float(rotation.value_or(Mat4d()));
    cube.intensity = static_cast<float>(number_or(light, "intensity", 1.0));

    scene.environment = {};
    scene.environment.enabled = true;
    scene.environment.cube = cube;
    scene.environment.location = where;
}

}  // namespace etendue
