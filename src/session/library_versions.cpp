#include "session/library_versions.h"

#include "color/color_config.h"
#include "core/parallel.h"
#include "core/vec.h"
#include "image/read.h"
#include "world/world.h"

#include <CLI/Version.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace etendue {

std::map<std::string, std::string> library_versions() {
    return {{"embree", ray_tracer_version()},
            {"oneTBB", parallel_library_version()},
            {"OpenImageIO", image_library_version()},
            {"OpenColorIO", color_library_version()},
            {"Imath", IMATH_VERSION_STRING},
            {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                          NLOHMANN_JSON_VERSION_PATCH)},
            {"CLI11", CLI11_VERSION},
            {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
            {"compiler", __VERSION__}};
}

}  // namespace etendue
