// Albedo tables that programs of tools/ compute while the project is built; their files are bytes of the program.
#pragma once

#include "bsdf/ggx_albedo_layout.h"
#include "bsdf/ggx_anisotropic_albedo_layout.h"
#include "bsdf/sheen_albedo_layout.h"

namespace etendue {

extern "C" {
/// Holds the tables that tools/gen/make_ggx_albedo.cpp computes.
extern const ggx_albedo_layout::Tables etendue_ggx_albedo;
/// Holds the tables that tools/gen/make_ggx_anisotropic_albedo.cpp computes.
extern const ggx_anisotropic_layout::Tables etendue_ggx_anisotropic_albedo;
/// Holds the tables that tools/gen/make_sheen_albedo.cpp computes.
extern const sheen_albedo_layout::Tables etendue_sheen_albedo;
}

}  // namespace etendue
