// The functions of this room that its module exports: image/image_functions.h and texture/tile_cache.h say what they
// do.
#pragma once

#include "image/encoded_image.h"
#include "image/image.h"
#include "image/image_pieces.h"
#include "image/layers.h"
#include "image/read.h"
#include "image/read_channels.h"
#include "image/write.h"
#include "texture/tile_cache.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace etendue::oiio {

[[nodiscard]] ImageInfo read_image_info(const EncodedImage& image);
[[nodiscard]] ImageF read_image_float(const EncodedImage& image);
[[nodiscard]] Image8 read_image_8bit(const EncodedImage& image);
[[nodiscard]] std::vector<NativeImage> read_image_levels(const EncodedImage& image);
[[nodiscard]] std::unique_ptr<ImagePieces> open_pieces(const EncodedImage& image);
[[nodiscard]] LayeredImage read_layers(const EncodedImage& image);
[[nodiscard]] ImageF read_layer(const EncodedImage& image, const ImageLayer& layer);
[[nodiscard]] ChannelImage read_channels(const EncodedImage& image);

[[nodiscard]] std::vector<unsigned char> encode(const std::filesystem::path& path, const std::string& format,
                                                std::span<const ImagePart> parts, const ImageWriteOptions& options);
[[nodiscard]] std::vector<unsigned char> encode_deep(const std::filesystem::path& path, const DeepImageView& image,
                                                     const ImageWriteOptions& options);
[[nodiscard]] std::vector<unsigned char> encode_jpeg(const ImageF& image, int quality);

[[nodiscard]] std::unique_ptr<TileCache> make_tile_cache(std::uint64_t budget);

}  // namespace etendue::oiio
