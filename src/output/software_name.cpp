#include "output/software_name.h"

namespace etendue {

std::string_view software_name() {
    return "Etendue " ETENDUE_VERSION;
}

}  // namespace etendue
