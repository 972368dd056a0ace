// In place of oidn.cpp where CMake does not find the library.
#include "core/error.h"
#include "denoise/oidn.h"

namespace etendue {

bool has_oidn() {
    return false;
}

std::optional<ImageF> denoise_oidn(const ImageF&, const OidnFeatures&, const OidnSettings&) {
    throw IoError("this program was built without Intel Open Image Denoise");
}

}  // namespace etendue
