#include "oiio/library_setup.h"

#include <OpenImageIO/imageio.h>

namespace etendue::oiio {

void configure_image_library() {
    [[maybe_unused]] static const bool done = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
}

}  // namespace etendue::oiio
