// IES files: ANSI/IES LM-63 of 1986, 1991, 1995, 2002 and 2019, type C photometry.
#pragma once

#include "core/error.h"
#include "scene/ies_profile_desc.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace etendue {

/// Largest IES file that is read: 16 MiB, hundreds of times what goniophotometers write.
inline constexpr std::uintmax_t kMaxIesBytes = std::uintmax_t{1} << 24;

/// Most vertical or horizontal angles, and most values, that a file may have.
inline constexpr int kMaxIesAngles = 4096;
inline constexpr std::size_t kMaxIesValues = std::size_t{1} << 20;

/// The lamp that `text` describes, in candela: its values times the candela multiplier, the ballast factor and, where
/// the file's year has it (until 1995), the ballast-lamp photometric factor. Symmetries are undone.
///
/// Lumens, sizes, watts and the dependence on tilt say nothing about the lamp as it was measured and are skipped, and
/// so is what stands after the last value. Throws SceneError at `where`, with the number of the line, if the text is no
/// such file, is of type A or B, has values that are not numbers or out of range, or ends early.
[[nodiscard]] IesProfileDesc parse_ies(std::string_view text, std::string name, const SourceLocation& where);

}  // namespace etendue
