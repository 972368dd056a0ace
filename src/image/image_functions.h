// What the module of image formats does for this room. For the rooms image and oiio.
#pragma once

#include "image/encoded_image.h"
#include "image/image.h"
#include "image/image_pieces.h"
#include "image/layers.h"
#include "image/read.h"
#include "image/read_channels.h"
#include "image/write.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace etendue {

/// Holds the functions that the image module exports: each does what the function of this room with its name does, or
/// what is said here. All throw IoError, and std::bad_alloc where memory is short, which is no fault of the image.
struct ImageFunctions {
    ImageInfo (*read_image_info)(const EncodedImage& image);
    ImageF (*read_image_float)(const EncodedImage& image);
    Image8 (*read_image_8bit)(const EncodedImage& image);
    std::vector<NativeImage> (*read_image_levels)(const EncodedImage& image);
    /// Opens an image to be read in pieces; bytes in memory must outlive the result.
    std::unique_ptr<ImagePieces> (*open_pieces)(const EncodedImage& image);
    LayeredImage (*read_layers)(const EncodedImage& image);
    ImageF (*read_layer)(const EncodedImage& image, const ImageLayer& layer);
    ChannelImage (*read_channels)(const EncodedImage& image);

    /// The bytes of a file of `format` ("openexr", "png"), of which the reader of a message knows the `path`.
    std::vector<unsigned char> (*encode)(const std::filesystem::path& path, const std::string& format,
                                         std::span<const ImagePart> parts, const ImageWriteOptions& options);
    std::vector<unsigned char> (*encode_deep)(const std::filesystem::path& path, const DeepImageView& image,
                                              const ImageWriteOptions& options);
    std::vector<unsigned char> (*encode_jpeg)(const ImageF& image, int quality);
};

/// The name under which the module exports them.
inline constexpr const char* kImageFunctionsSymbol = "etendue_image_functions";

/// Returns the functions of the image module, which the first call loads. Throws as `image_module_symbol` does.
[[nodiscard]] const ImageFunctions& image_functions();

[[nodiscard]] constexpr bool is_integer(PixelDepth depth) {
    return depth == PixelDepth::UInt8 || depth == PixelDepth::UInt16;
}

}  // namespace etendue
