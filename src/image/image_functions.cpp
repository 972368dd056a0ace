#include "image/image_functions.h"

#include "image/image_module.h"

namespace etendue {

const ImageFunctions& image_functions() {
    static const auto* const functions = static_cast<const ImageFunctions*>(image_module_symbol(kImageFunctionsSymbol));
    return *functions;
}

}  // namespace etendue
