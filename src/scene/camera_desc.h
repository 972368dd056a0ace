// Cameras. They look along their local -Z with +Y up, as in glTF.
#pragma once

#include "core/error.h"
#include "core/vec.h"

#include <limits>
#include <string>
#include <vector>

namespace etendue {

enum class CameraType { Perspective, Orthographic };

/// Describes the opening of a camera's lens.
struct ApertureDesc {
    static constexpr int kLeastBlades = 3;
    static constexpr int kMostBlades = 64;

    int blades = 0;         ///< 0 for a round one, or [kLeastBlades, kMostBlades]
    float rotation = 0.0f;  ///< of the blades, radians
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
    float ymag = 1.0f;  ///< orthographic: half the height of the view, metres, > 0
    /// Width over height that the file asks for; 0 to follow the image's. When both are known and differ, the image's
    /// wins and the vertical field of view is kept.
    float aspect_ratio = 0.0f;
    /// Moves the view to the right and up, without turning the camera: shares of the view's longer side.
    Vec2f shift{0.0f, 0.0f};
    ClipDesc clip;                ///< what is shown
    ClipDesc file_clip;           ///< what the scene file would have shown; nobody but render.json looks at it
    float lens_radius = 0.0f;     ///< metres; 0 for a pinhole
    ApertureDesc aperture;        ///< used when lens_radius > 0
    float focus_distance = 1.0f;  ///< metres along the optical axis, > 0; used when lens_radius > 0
    float focal_length = 0.0f;    ///< millimetres, for the headers of images; 0 if it is not known
    Mat4f to_world;               ///< in the middle of the shutter
    std::vector<Mat4f> motion;    ///< at equally spaced times from its opening to its closing; empty if it stands still
    SourceLocation location;
};

}  // namespace etendue
