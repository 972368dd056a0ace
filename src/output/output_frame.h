// A rendered image with everything that is said about it in files.
#pragma once

#include "core/vec.h"
#include "image/image.h"
#include "image/write.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

/// One of the layers of an image besides its colour.
struct OutputLayer {
    std::string name{};
    std::string channels{};  ///< a letter each
    bool is_float = false;   ///< to be written as 32-bit floats, whatever the image is
    bool is_color = false;   ///< in the working space; else numbers that mean the same in every space
    bool is_light = false;   ///< a part of the light of the image
    bool is_half = false;    ///< whether the layer has about half of the samples, `OutputFrame::half_share`
    bool is_matte = false;   ///< its channels are those of `matte_channel`
    std::vector<ImageAttribute> attributes{};  ///< attributes of the file or part that has the layer
    ImageF pixels{};
};

/// The depths of an image, in the space of its pixels.
struct DeepPixels {
    std::vector<std::uint32_t>
        counts{};                 ///< number of samples in each pixel, row by row; none if the image is not deep
    ImageF colors{};              ///< r, g, b and a of each depth, in one row
    std::vector<float> depths{};  ///< Z and ZBack of each
};

struct OutputFrame {
    /// 3 or 4 channels, linear in `working_space`, as large as the crop window. Alpha is associated (colour is already
    /// multiplied by it).
    ImageF pixels;
    std::vector<OutputLayer> layers;  ///< layers, of the image's size
    DeepPixels deep;                  ///< layers, of the image's size
    /// Not 0: layers that are halves are of this share of the samples, (0, 1).
    float half_share = 0.0f;
    int crop_x = 0;             ///< column of the first pixel in the full image
    int crop_y = 0;             ///< row of the first pixel in the full image, y down
    int full_width = 0;         ///< pixels; 0 if the image is not cropped
    int full_height = 0;        ///< pixels; 0 if the image is not cropped
    float pixel_aspect = 1.0f;  ///< width over height of a pixel

    std::string working_space;      ///< a scene-linear space of the OpenColorIO config
    std::string display;            ///< display of the preview; empty for the config's default
    std::string view;               ///< view of the preview; empty for the display's default
    std::string look;               ///< look of the preview; empty for the view's own
    std::optional<float> exposure;  ///< stops, preview only; none before one was asked for or chosen
    std::string exposure_reason;    ///< why that exposure was chosen; empty if it was asked for
    std::string output_space;       ///< colour space of the EXR, scene-linear; empty for the working space
    bool aces_container = false;    ///< the EXR follows SMPTE ST 2065-4

    Mat4f world_to_camera;  ///< the camera looks along -Z with +Y up
    /// Projective; x right and y up in [-1, 1] over the full image. None of a panoramic camera.
    std::optional<Mat4f> world_to_screen;

    std::string camera;           ///< its name
    float focal_length = 0.0f;    ///< millimetres; 0 if it is not known
    float f_number = 0.0f;        ///< 0 if it is not known
    float focus_distance = 0.0f;  ///< metres; 0 if all is in focus
    double fps = 0.0;             ///< frames of the sequence in a second
    std::optional<int> frame;     ///< number of this frame in its sequence
    std::string owner;            ///< whose image it is; may be empty
    std::string comments;         ///< any text; may be empty

    std::string scene;
    std::string integrator;
    std::string sampler;
    int spp = 0;  ///< samples per pixel that were taken
    std::uint32_t seed = 0;
    std::string settings;  ///< as in RenderStatistics
    std::string command;   ///< the same
    double render_seconds = 0.0;
    bool complete = true;     ///< false if rendering was stopped early
    std::string halt_reason;  ///< why it stopped, empty if nothing to say
};

}  // namespace etendue
