// Images of a room in which integrators disagree, for eyes.
#pragma once

#include "image/image.h"
#include "integrator/agreement_cases.h"

#include <filesystem>
#include <span>
#include <string>

namespace etendue::test {

/// The image of a room by one integrator.
struct RoomImage {
    std::string integrator;
    const ImageF* mean = nullptr;
};

/// Two that should be the same and are not.
struct Disagreement {
    RoomImage a;
    RoomImage b;
};

/// Writes below `directory`, in a folder with the room's name, which is returned: the images of each pair, their
/// differences, and what each strategy of `bdpt` adds if that is among them. Throws IoError.
std::filesystem::path write_failure_images(const std::filesystem::path& directory, const AgreementCase& agreement,
                                           const World& world, std::span<const Disagreement> pairs);

/// Where tests leave what is to be looked at: $ETENDUE_TEST_OUTPUT, which CTest sets to a folder of the build, or one
/// for temporary files.
[[nodiscard]] std::filesystem::path test_output_directory();

}  // namespace etendue::test
