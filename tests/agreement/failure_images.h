// Images of a room in which integrators disagree, for eyes.
#pragma once

#include "agreement/room_comparison.h"
#include "integrator/agreement_cases.h"
#include "metrics/block_agreement.h"

#include <filesystem>
#include <span>

namespace etendue::test {

/// Writes below `directory`, in a folder with the room's name: the image of every integrator of `agreement` that
/// disagrees with another (`estimates` are theirs, in that order), the differences of those pairs, and what each
/// strategy of `bdpt` adds if that is among them. Throws IoError.
void write_failure_images(const std::filesystem::path& directory, const RoomComparison& comparison,
                          const AgreementCase& agreement, const World& world, std::span<const ImageEstimate> estimates);

}  // namespace etendue::test
