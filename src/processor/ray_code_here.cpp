// The one source of this room that is compiled for each instruction set; cmake/EtendueRayCode.cmake renames what it
// defines.
#include "processor/ray_code_here.h"

namespace etendue {

namespace {

#if defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512CD__) && defined(__AVX512DQ__) && \
    defined(__AVX512VL__)
constexpr InstructionSet kCompiledFor = InstructionSet::Avx512;
#elif defined(__AVX2__) && defined(__FMA__)
constexpr InstructionSet kCompiledFor = InstructionSet::Avx2;
#else
constexpr InstructionSet kCompiledFor = InstructionSet::Sse4;
#endif

}  // namespace

constinit const RayCode ray_code_here{kCompiledFor, &compile_world, &with_camera, &make_integrator, &run_pilot};

}  // namespace etendue
