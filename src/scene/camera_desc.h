// Cameras. They look along their local -Z with +Y up, as in glTF.
#pragma once

#include "core/error.h"
#include "core/vec.h"

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace etendue {

enum class CameraType { Perspective, Orthographic, Equirectangular, Fisheye };

/// Gives them the names that render.json and `dump` have.
inline constexpr std::array<std::pair<std::string_view, CameraType>, 4> kCameraTypeNames{{
    {"perspective", CameraType::Perspective},
    {"orthographic", CameraType::Orthographic},
    {"equirectangular", CameraType::Equirectangular},
    {"fisheye", CameraType::Fisheye},
}};

/// Says how far from the middle of a fisheye's image an angle is seen: as far as the angle is large, or so that equal
/// areas are equal solid angles.
enum class FisheyeType { Equidistant, Equisolid };

/// Gives them the names that render.json and `dump` have.
inline constexpr std::array<std::pair<std::string_view, FisheyeType>, 2> kFisheyeTypeNames{{
    {"equidistant", FisheyeType::Equidistant},
    {"equisolid", FisheyeType::Equisolid},
}};

/// Describes the opening of a camera's lens.
struct ApertureDesc {
    static constexpr int kLeastBlades = 3;
    static constexpr int kMostBlades = 64;

    int blades = 0;         ///< 0 for a round one, or [kLeastBlades, kMostBlades]
    float rotation = 0.0f;  ///< angle by which the blades are turned, radians
    float ratio = 1.0f;     ///< height over width, > 0; the height is that of a round one
};

/// Holds between which depths along the viewing direction a camera shows surfaces.
struct ClipDesc {
    float start = 0.0f;                                  ///< metres, >= 0
    float end = std::numeric_limits<float>::infinity();  ///< metres, > start
};

struct CameraDesc {
    std::string name;
    std::string node;  ///< name of the node that places it; empty if there is none
    CameraType type = CameraType::Perspective;
    float yfov = 0.8f;  ///< perspective: full vertical field of view, radians, (0, pi)
    float fov = kPi;    ///< fisheye: full angle of the circle, radians, (0, 2 pi]
    FisheyeType fisheye = FisheyeType::Equidistant;
    float circle = 1.0f;  ///< fisheye: diameter of the circle over the shorter side of the image, > 0
    float ymag = 1.0f;    ///< orthographic: half the height of the view, metres, > 0
    /// Width over height that the file asks for; 0 to follow the image's. When both are known and differ, the image's
    /// wins and the vertical field of view is kept.
    float aspect_ratio = 0.0f;
    /// Moves the view to the right and up, without turning the camera: shares of the view's longer side.
    Vec2f shift{0.0f, 0.0f};
    ClipDesc clip;                ///< distances between which things are shown
    ClipDesc file_clip;           ///< distances that the scene file asks for; only render.json looks at them
    float lens_radius = 0.0f;     ///< metres; 0 for a pinhole
    ApertureDesc aperture;        ///< used when lens_radius > 0
    float focus_distance = 1.0f;  ///< metres along the optical axis, > 0; used when lens_radius > 0
    float focal_length = 0.0f;    ///< millimetres, for the headers of images; 0 if it is not known
    Mat4f to_world;               ///< in the middle of the shutter
    std::vector<Mat4f> motion;    ///< at equally spaced times from its opening to its closing; empty if it stands still
    SourceLocation location;
};

}  // namespace etendue
