// Settings of the image library that hold for the whole process.
#pragma once

namespace etendue::oiio {

/// Keeps OpenImageIO and OpenEXR from starting thread pools beside the renderer's. Call before opening an image; only
/// the first call does anything.
void configure_image_library();

}  // namespace etendue::oiio
