#include "image/module_bytes.h"

asm(".pushsection .rodata\n"
    ".hidden etendue_module_begin\n"
    ".global etendue_module_begin\n"
    "etendue_module_begin:\n"
    ".incbin \"" ETENDUE_MODULE_FILE
    "\"\n"
    ".hidden etendue_module_end\n"
    ".global etendue_module_end\n"
    "etendue_module_end:\n"
    ".popsection\n");

extern "C" {
extern const std::byte etendue_module_begin[];
extern const std::byte etendue_module_end[];
}

namespace etendue {

std::span<const std::byte> module_bytes() {
    return {etendue_module_begin, etendue_module_end};
}

}  // namespace etendue
