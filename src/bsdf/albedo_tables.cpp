// The build says where the files are.
#include "bsdf/albedo_tables.h"

asm(".pushsection .rodata\n"
    ".balign 64\n"
    ".hidden etendue_ggx_albedo\n"
    ".global etendue_ggx_albedo\n"
    "etendue_ggx_albedo: .incbin \"" ETENDUE_GGX_ALBEDO
    "\"\n"
    ".balign 64\n"
    ".hidden etendue_ggx_anisotropic_albedo\n"
    ".global etendue_ggx_anisotropic_albedo\n"
    "etendue_ggx_anisotropic_albedo: .incbin \"" ETENDUE_GGX_ANISOTROPIC_ALBEDO
    "\"\n"
    ".balign 64\n"
    ".hidden etendue_sheen_albedo\n"
    ".global etendue_sheen_albedo\n"
    "etendue_sheen_albedo: .incbin \"" ETENDUE_SHEEN_ALBEDO
    "\"\n"
    ".popsection\n");
