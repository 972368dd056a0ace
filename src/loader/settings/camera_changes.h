// What render.json says of cameras: of all at its top level, of one by its name below `cameras`.
#pragma once

#include "loader/settings/json_object.h"
#include "scene/scene_desc.h"

#include <map>
#include <optional>
#include <string>

namespace etendue {

/// Holds what is said of a lens; nothing for what the camera has itself.
struct LensSettings {
    std::optional<float> lens_radius{};     ///< metres; 0 for a pinhole
    std::optional<float> focus_distance{};  ///< metres, > 0
    std::optional<float> f_stop{};          ///< focal length over the diameter of the lens, > 0; in place of the radius
    std::optional<float> focal_length{};    ///< millimetres, > 0; none for that of the camera's field of view
    std::optional<float> sensor_width{};    ///< millimetres of the image's longer side, > 0
    std::string focus_node{};               ///< name of the node in focus, in place of the distance; empty for none
    SourceLocation location{};              ///< place of the object that says it

    [[nodiscard]] bool empty() const {
        return !lens_radius && !focus_distance && !f_stop && !focal_length && !sensor_width && focus_node.empty();
    }
};

/// Holds what is said of what a camera shows; nothing for what it has itself.
struct ViewSettings {
    std::optional<CameraType> type{};
    std::optional<float> yfov{};
    std::optional<float> ymag{};
    std::optional<float> fov{};
    std::optional<FisheyeType> mapping{};
    std::optional<Vec2f> shift{};
    bool clips_as_file = false;
    std::optional<float> clip_start{};
    std::optional<float> clip_end{};
    std::optional<int> blades{};
    std::optional<float> blade_rotation{};
    std::optional<float> aperture_ratio{};
};

/// Holds what is said of one camera.
struct CameraChange {
    LensSettings lens{};
    ViewSettings view{};
    SourceLocation location{};
    bool is_from_extras = false;  ///< whether the scene file says it, so that errors are warnings
};

/// Reads the members of `object` that are about a lens; errors for what is said twice.
[[nodiscard]] LensSettings read_lens(JsonObject& object);

/// Reads the members of `object` that are about what a camera shows, but for `clip`.
[[nodiscard]] ViewSettings read_view(JsonObject& object);

/// Gives `camera` what `view` says.
void apply_view(const ViewSettings& view, CameraDesc& camera);

/// Reads what is said of one camera by its name.
[[nodiscard]] CameraChange read_camera_change(const nlohmann::json& value, const SourceLocation& where,
                                              ProblemList& problems);

/// Changes the scene's cameras: all of them as `all` says, and those that have names in `changes`. What is said of one
/// goes before what is said of all. Errors for names that the scene does not have, and for a focus behind the camera
/// that is chosen or named; notes for what a camera's type ignores, also of `own`, which the camera of render.json has
/// been given already.
void apply_camera_changes(const LensSettings& all, const std::map<std::string, CameraChange>& changes,
                          const CameraChange& own, SceneDesc& scene, ProblemList& problems);

}  // namespace etendue
