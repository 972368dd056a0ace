// Renders of rooms of agreement with layers.
#pragma once

#include "integrator/agreement_cases.h"
#include "metrics/block_agreement.h"
#include "render/render.h"
#include "wave/aov/aov_set.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace etendue::test {

/// Light layers of these expressions.
[[nodiscard]] AovSet expression_layers(const AgreementCase& agreement, const std::vector<std::string>& expressions);

/// One render of the room.
[[nodiscard]] RenderResult render_layers(const World& world, const Integrator& integrator,
                                         const AgreementCase& agreement, std::shared_ptr<const AovSet> aovs,
                                         std::uint32_t seed);
[[nodiscard]] RenderResult render_layers(const World& world, const std::string& integrator,
                                         const AgreementCase& agreement, std::shared_ptr<const AovSet> aovs,
                                         std::uint32_t seed);

}  // namespace etendue::test
