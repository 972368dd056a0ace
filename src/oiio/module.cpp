// What the module exports, under the names that the rooms image and texture ask for.
#include "image/image_functions.h"
#include "oiio/functions.h"
#include "texture/tile_cache.h"

namespace oiio = etendue::oiio;

extern "C" {

[[gnu::visibility("default")]] extern const etendue::ImageFunctions etendue_image_functions;
[[gnu::visibility("default")]] extern etendue::MakeTileCache* const etendue_make_tile_cache;

const etendue::ImageFunctions etendue_image_functions{
    .read_image_info = &oiio::read_image_info,
    .read_image_float = &oiio::read_image_float,
    .read_image_8bit = &oiio::read_image_8bit,
    .read_image_levels = &oiio::read_image_levels,
    .open_pieces = &oiio::open_pieces,
    .read_layers = &oiio::read_layers,
    .read_layer = &oiio::read_layer,
    .read_channels = &oiio::read_channels,
    .encode = &oiio::encode,
    .encode_deep = &oiio::encode_deep,
    .encode_jpeg = &oiio::encode_jpeg,
};
etendue::MakeTileCache* const etendue_make_tile_cache = &oiio::make_tile_cache;
}
