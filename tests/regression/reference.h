// Rendering an estimate of a scene with its variance, and storing it.
#pragma once

#include "metrics/block_agreement.h"
#include "regression/regression_scenes.h"
#include "sampling/sampler.h"

#include <cstdint>
#include <filesystem>

namespace etendue::test {

/// Renders `scene` as `sampling` says, with seeds `first_seed`, `first_seed` + 1, … Red, green and blue in ACEScg.
[[nodiscard]] ImageEstimate render_estimate(const RegressionScene& scene, const Sampling& sampling,
                                            SampleSequence sequence, std::uint32_t first_seed);

/// A reference and its variance, as they lie in the repository.
struct ReferenceFiles {
    std::filesystem::path mean;
    std::filesystem::path variance;

    [[nodiscard]] static ReferenceFiles of(const RegressionScene& scene);
};

/// Throws IoError if a file is missing or unreadable.
[[nodiscard]] ImageEstimate read_reference(const RegressionScene& scene);

/// Renders the reference of `scene` and writes it; how it was made goes into the files' metadata.
void update_reference(const RegressionScene& scene);

}  // namespace etendue::test
