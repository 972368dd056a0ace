// The measured distribution of a lamp (IESNA LM-63, type C photometry) as a table.
#pragma once

#include "core/error.h"

#include <cstddef>
#include <string>
#include <vector>

namespace etendue {

/// Luminous intensity by direction, around the whole circle: the loader has undone the file's symmetries and applied
/// its factors. Vertical angles count from where the lamp points (its local -Z; nadir for a lamp that hangs),
/// horizontal ones from its local +X towards +Y.
struct IesProfileDesc {
    std::string name;               ///< file name, or what the scene file calls it
    std::vector<float> vertical;    ///< radians, at least two, strictly ascending in [0, pi]; no light beyond them
    std::vector<float> horizontal;  ///< radians, strictly ascending; the first is 0, the last 2 pi
    std::vector<float> candela;     ///< >= 0, the vertical angles of each horizontal one after the other
    SourceLocation location;
};

/// The greatest intensity of `profile`, candela.
[[nodiscard]] float peak_candela(const IesProfileDesc& profile);

}  // namespace etendue
