// render.json: what it says, before it meets the scene. Its keys are described in docs/render-json.md.
#pragma once

#include "loader/settings/camera_changes.h"
#include "loader/settings/light_override.h"
#include "loader/settings/material_factors.h"
#include "loader/settings/shape_change.h"
#include "scene/scene_desc.h"

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace etendue {

struct EmissionOverride {
    Rgb color{1.0f};
    float strength = 1.0f;
};

struct MaterialOverride {
    MaterialModelDesc model;
    std::optional<int> priority;
    std::optional<EmissionOverride> emission;
    std::vector<FactorChange> factors;  ///< factors of the glTF material; none beside a model
    std::optional<bool> solid;          ///< the mesh bounds a body of the glTF material; none beside a model
    std::optional<bool> visible_to_camera;
    std::optional<bool> catches_shadows;
    std::optional<bool> is_holdout;
    bool is_from_extras = false;  ///< whether the scene file says it, so that errors are warnings
    SourceLocation location;
};

/// Where a camera stands and looks, in the world.
struct CameraAim {
    Vec3d position{0.0};
    Vec3d look_at{0.0};
    Vec3f up{0.0f, 1.0f, 0.0f};
    bool focuses = true;  ///< on `look_at`: the document gives no other distance
};

/// Sets the transform of `camera`, and its focus if that is at `look_at`, which must differ from `position`, for a
/// scene with this origin.
void aim(const CameraAim& aim, const Vec3d& origin, CameraDesc& camera);

struct RenderJson {
    std::string scene;                 ///< file name; empty for the only one
    RenderSettings settings;           ///< `camera` is the name chosen
    std::optional<CameraDesc> camera;  ///< described here; chosen too
    CameraAim camera_aim;              ///< aim of the chosen camera
    CameraChange said_of_camera;       ///< what `camera` has been given, but for its aim
    LensSettings lens;                 ///< lens of whichever camera is chosen
    std::map<std::string, CameraChange> cameras;
    std::optional<EnvironmentDesc> environment;  ///< its image not yet resolved
    std::map<std::string, MaterialOverride> materials;
    std::map<std::string, LightOverride> lights;
    std::map<std::string, ShapeChange> shapes;
    SourceLocation location;
    std::filesystem::path file;  ///< that it was read from; empty if no file was
    std::string document;        ///< the text of all of it
};

/// Reads the member `environment`.
[[nodiscard]] EnvironmentDesc read_environment(const nlohmann::json& value, const SourceLocation& where,
                                               ProblemList& problems);

/// Reads one member of `materials`.
[[nodiscard]] MaterialOverride read_material(const nlohmann::json& value, const SourceLocation& where,
                                             ProblemList& problems);

/// Parses `file`, merged with the text of another document, `given` (RFC 7386); either may be empty. All errors go to
/// `problems`, each with its JSON pointer; members with errors keep their defaults.
[[nodiscard]] RenderJson read_render_json(const std::filesystem::path& file, std::string_view given,
                                          ProblemList& problems);

/// Applies what the document says of the scene to one that has been loaded: overrides by name, camera, environment
/// (whose header is read, and which may come from one of `assets`, directories outside of the scene's). Names that the
/// scene does not have are errors that suggest the nearest one.
void apply_render_json(const RenderJson& json, std::span<const std::filesystem::path> assets, SceneDesc& scene,
                       ProblemList& problems);

}  // namespace etendue
