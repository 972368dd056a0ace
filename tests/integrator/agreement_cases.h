// Rooms that integrators must agree on: the walls open to one kind of light, a body and an occluder.
#pragma once

#include "core/pixel_rect.h"
#include "integrator/integrator.h"
#include "scene/scene_desc.h"
#include "world/world.h"

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::test {

inline constexpr int kAgreementWidth = 64;
inline constexpr int kAgreementHeight = 48;

struct AgreementCase {
    std::string name;
    std::function<void(SceneDesc&)> make;
    PathLengths lengths{.max_depth = 6};
    PixelRect window{0, 0, kAgreementWidth, kAgreementHeight};
    std::uint32_t spp = 64;
    std::vector<std::string> integrators{"path", "light", "bdpt"};  ///< each finds all light of the room
};

[[nodiscard]] const std::vector<AgreementCase>& agreement_cases();
/// The one of this name, which there must be.
[[nodiscard]] const AgreementCase& agreement_case(std::string_view name);

/// A room by its name, and what renders it: the parameters of tests that need both.
struct RoomRun {
    std::string name;
    std::string integrator;
};
void PrintTo(const RoomRun& run, std::ostream* out);

[[nodiscard]] SceneDesc agreement_scene(const AgreementCase& agreement);
[[nodiscard]] World agreement_world(const AgreementCase& agreement);

}  // namespace etendue::test
