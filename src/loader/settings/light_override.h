// What render.json says of one lamp: a change of the scene file's, or a lamp of its own.
#pragma once

#include "core/error.h"
#include "core/rgb.h"
#include "core/vec.h"
#include "loader/settings/place.h"

#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace etendue {

/// Kinds of lamps that render.json adds.
enum class LampKind : std::uint8_t { Rectangle, Disk, Sphere, Sun, Point, Spot };

struct LightOverride {
    std::optional<LampKind> kind;  ///< none for a change of a lamp of the file
    Place place;
    std::optional<Rgb> color;
    std::optional<float> intensity;   ///< candela or lux
    std::optional<float> power;       ///< W
    std::optional<float> irradiance;  ///< W/m²
    std::optional<float> radiance;    ///< W/(m² sr)
    float scale = 1.0f;               ///< factor of any of these
    std::string ies;                  ///< file name of a profile; not yet resolved
    std::optional<float> radius;      ///< metres
    std::optional<float> width;       ///< metres, given with `height`, but for rectangles
    std::optional<float> height;      ///< metres
    std::optional<float> angle;       ///< radians under which the disk of a sun is seen
    float spread = kPi;               ///< radians, full angle of the cone that a panel shines into
    float inner_cone_angle = 0.0f;    ///< as in LightDesc
    float outer_cone_angle = 0.785398163f;
    std::optional<bool> visible_to_camera;
    std::optional<bool> stops_light;  ///< whether it stops other lamps' light
    bool enabled = true;
    bool is_from_extras = false;  ///< whether the scene file says it, so that errors are warnings
    SourceLocation location;

    /// True of lamps that are surfaces whatever else is said.
    [[nodiscard]] bool has_own_surface() const {
        return kind == LampKind::Rectangle || kind == LampKind::Disk || kind == LampKind::Sphere;
    }
};

/// Reads one member of `lights`. Errors for what lamps of its kind do not have, and for what is said twice or missing.
[[nodiscard]] LightOverride read_light(const nlohmann::json& value, const SourceLocation& where, ProblemList& problems);

}  // namespace etendue
