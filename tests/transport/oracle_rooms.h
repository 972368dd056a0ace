// Rooms for what the scenes of scenes/ and the rooms of agreement do not have together.
#pragma once

#include "world/world.h"

namespace etendue::test {

/// Names what is around all things of a room.
enum class RoomAir {
    Vacuum,
    Fog,   ///< which scatters light
    Resin  ///< which absorbs light, and hides the boundaries of all bodies in it
};

/// Lamps, bodies in and beside each other, a prism, panes, a veil before a mirror, textures and relief, a sign that is
/// unlit, and things that move.
[[nodiscard]] World crowded_room(RoomAir air);

/// Fog, lamps and a wall before a moving camera whose near and far planes lie in the fog, which drifts.
[[nodiscard]] World divided_room();

/// Many small lamps, a sky with a sun and a point, so that lights are chosen by what they light.
[[nodiscard]] World many_lights_room();

}  // namespace etendue::test
