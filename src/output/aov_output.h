// From the layers of a film to those of an image file.
#pragma once

#include "film/film.h"
#include "output/output_frame.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace etendue {

/// Where a layer of an image file comes from.
enum class AovKind {
    Layer,     ///< one of the film's light layers
    Values,    ///< averaged numbers
    Nearest,   ///< numbers of the nearest sample
    Samples,   ///< samples of each pixel
    Variance,  ///< variance of each pixel's mean
    Rays,      ///< rays per sample
    Mean,      ///< mean of the samples, which is the image unless that is something else
    Matte,     ///< ids and coverages, two ranks for each four channels: a Cryptomatte
    Deep,      ///< no layer, but a file of its own
};

struct AovOutput {
    std::string name;
    std::string channels;  ///< a letter each
    AovKind kind = AovKind::Layer;
    std::size_t first = 0;    ///< index of the light layer or matte, or of the first number
    float background = 0.0f;  ///< where nothing was hit; sums of averaged numbers begin there
    bool is_float = false;    ///< written as 32-bit floats; half floats are enough otherwise
    std::string manifest{};   ///< JSON: the names of ids, by them of a matte; empty if there are too many or none
};

/// The pixels of `output`, from a film that has them.
[[nodiscard]] OutputLayer resolve_layer(const Film& film, const AovOutput& output);

/// The depths of a film that has them.
[[nodiscard]] DeepPixels resolve_deep_pixels(const Film& film);

}  // namespace etendue
