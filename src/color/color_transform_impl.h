// What a ColorTransform holds. Private to the room: it shows OpenColorIO.
#pragma once

#include "color/color_config.h"

#include <OpenColorIO/OpenColorIO.h>

namespace etendue {

struct ColorTransform::Impl {
    OCIO_NAMESPACE::ConstCPUProcessorRcPtr processor;
};

}  // namespace etendue
