// A whole scene as plain data: structs, vectors, integer handles. No pixels, no BVH, no behaviour.
#pragma once

#include "core/bounds.h"
#include "core/error.h"
#include "core/vec.h"
#include "scene/camera_desc.h"
#include "scene/light_desc.h"
#include "scene/material_desc.h"
#include "scene/mesh_desc.h"
#include "scene/render_settings.h"
#include "scene/texture_desc.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Holds the settings that the scene file's extras give one of its things under the name "etendue".
struct ExtrasDesc {
    enum class Of { Material, Light, Camera, Node, Scene };

    Of of = Of::Node;
    std::string name;  ///< name of the thing; none of a scene
    std::string json;  ///< text of a JSON object
    SourceLocation location;
};

struct SceneDesc {
    std::string name;                 ///< name of the scene directory or file, without extension
    std::filesystem::path directory;  ///< nothing outside of it is read, but for files the command line names
    std::filesystem::path file;       ///< the scene file

    /// Where in the world this description has its origin, metres: all transforms and skinned vertices in it are
    /// relative to it, so that single precision is enough for a scene that lies far from the world's origin.
    Vec3d origin{0.0};

    std::vector<ImageDesc> images;
    std::vector<TextureDesc> textures;
    std::vector<MaterialDesc> materials;  ///< a primitive without one gets an index into here too
    std::vector<MeshDesc> meshes;
    std::vector<std::string> animations;  ///< names of those that the file has
    std::vector<std::string> scenes;      ///< names of those that the file has
    std::size_t shown_scene = 0;          ///< index into `scenes`
    std::vector<std::string> variants;    ///< names of the sets of materials that the file offers
    std::vector<NodeDesc> nodes;          ///< parents before their children
    std::vector<InstanceDesc> instances;
    std::vector<CameraDesc> cameras;
    std::vector<IesProfileDesc> ies_profiles;
    std::vector<LightDesc> lights;
    EnvironmentDesc environment;
    std::vector<ExtrasDesc> extras;
    RenderSettings settings;

    std::vector<std::string> extensions_used;           ///< by the file and understood here
    std::vector<std::string> extensions_ignored;        ///< by the file, not understood here and not required
    std::vector<std::filesystem::path> inputs;          ///< every file that was or will be read
    std::vector<std::filesystem::path> images_of_file;  ///< images that the file names, shown or not

    /// Returns the files that no output may replace: inputs, and images that nothing shows.
    [[nodiscard]] std::vector<std::filesystem::path> files_to_keep() const {
        std::vector<std::filesystem::path> files = inputs;
        files.insert(files.end(), images_of_file.begin(), images_of_file.end());
        return files;
    }
};

/// Everything that is wrong with `scene`: handles out of range, arrays of different lengths, non-finite numbers, values
/// outside the ranges that the structs state, names that do not exist. An empty list of errors means that `World`
/// can be compiled from it.
[[nodiscard]] ProblemList validate(const SceneDesc& scene);

/// Takes a texture of `material` away that cannot be shown: factors stand alone, normals stay as they are. What would
/// shine or mirror in full without its texture goes dark.
void leave_out_texture(TextureRef& ref, MaterialDesc& material);

/// Leaves out the textures whose image is unreadable, of all materials.
void leave_out_unreadable_images(SceneDesc& scene);

/// Returns the camera of this name, or else the first whose node has it; null if there is none.
[[nodiscard]] const CameraDesc* find_camera(const SceneDesc& scene, std::string_view name);

/// Returns the names by which `find_camera` finds cameras.
[[nodiscard]] std::vector<std::string_view> camera_names(const SceneDesc& scene);

/// Returns for each lamp its node's name, or an empty one where that is the name of a lamp itself: names of lamps go
/// before those of nodes.
[[nodiscard]] std::vector<std::string_view> node_names_of_lights(const SceneDesc& scene);

/// Counts the images that materials do without because they are unreadable.
[[nodiscard]] std::size_t count_missing_textures(const SceneDesc& scene);

/// Gives every primitive the material that it has in the variant that the settings name, if they name one. The scene
/// must have passed `validate`.
void apply_variant(SceneDesc& scene);

/// Human-readable text with everything but the bulk arrays, for `inspect` and for tests to compare.
[[nodiscard]] std::string dump(const SceneDesc& scene);

/// Returns the part of that text that is not about `SceneDesc::settings`.
[[nodiscard]] std::string dump_without_settings(const SceneDesc& scene);

/// Bounds of all instances, from the scene's origin.
[[nodiscard]] Bounds compute_bounds(const SceneDesc& scene);

/// Where the description of a scene with these bounds in the world should have its origin: in the world's, unless the
/// bounds are more than 64 times their size away from it. Then it is near their centre, at a multiple of a power of two
/// that is no less than twice their size: a scene that is moved by round numbers stays the same to the bit.
[[nodiscard]] Vec3d choose_origin(const Bounds& bounds);

/// Adds a camera that frames the bounding box if there is none, and the studio where the settings ask for it or nothing
/// emits light. Each addition is reported to `problems` as a note.
void add_missing_camera_and_light(SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
