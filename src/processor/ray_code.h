// What works per ray, which the program has once for each instruction set; see docs/processors.md.
#pragma once

#include "integrator/integrator.h"
#include "integrator/pilot.h"
#include "processor/instruction_set.h"
#include "world/compile.h"

#include <span>

namespace etendue {

/// The ways into the code for one instruction set. What they make is used by that code alone, through virtual
/// functions.
struct RayCode {
    InstructionSet instruction_set;
    decltype(&etendue::compile_world) compile_world;
    decltype(&etendue::with_camera) with_camera;
    decltype(&etendue::make_integrator) make_integrator;
    decltype(&etendue::run_pilot) run_pilot;
};

/// Each that the program has and the processor can run, in the order of `InstructionSet`; at least one.
[[nodiscard]] std::span<const RayCode* const> ray_codes();

/// The one that runs: chosen when it is first asked for, by `choose_instruction_set`, and throws as that does.
[[nodiscard]] const RayCode& ray_code();

}  // namespace etendue
