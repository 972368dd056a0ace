#include "app/library_versions.h"

#include "color/color_config.h"
#include "core/parallel.h"
#include "image/read.h"
#include "world/world.h"

namespace etendue {

std::map<std::string, std::string> library_versions() {
    return {{"embree", ray_tracer_info().version},
            {"oneTBB", parallel_library_version()},
            {"OpenImageIO", image_library_version()},
            {"OpenColorIO", color_library_version()}};
}

}  // namespace etendue
