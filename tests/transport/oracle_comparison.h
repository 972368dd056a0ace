// Samples of the wide integrators against those of the scalar algorithms, from the same random numbers.
#pragma once

#include "integrator/integrator.h"

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>

namespace etendue::test {

/// Says which samples are compared.
struct OracleRun {
    std::string integrator = "path";  ///< one that computes many samples at once
    PathLengths lengths{};
    std::uint32_t light_samples = 1;
    Heuristic heuristic = Heuristic::Balance;
    SampleSequence sequence = SampleSequence::Sobol;
    MergeAt merge = MergeAt::SeenByDeltas;  ///< of vcm
    int width = 24;                         ///< pixels
    int height = 24;
    std::uint32_t samples = 8;  ///< of each pixel
};
std::ostream& operator<<(std::ostream& out, const OracleRun& run);

struct OracleComparison {
    std::size_t samples = 0;
    std::size_t lit = 0;        ///< samples that find light
    std::size_t differing = 0;  ///< by more than rounding
    std::size_t splats = 0;
    std::size_t splats_alone = 0;  ///< that only one of the two has
    std::size_t photons = 0;
    std::size_t photons_alone = 0;  ///< that only one of the two has
    std::string first;              ///< of these: where it is, and what both have found
};
std::ostream& operator<<(std::ostream& out, const OracleComparison& comparison);

[[nodiscard]] OracleComparison compare_with_oracle(const World& world, const OracleRun& run);

}  // namespace etendue::test
