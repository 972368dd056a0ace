// What is to be written of a render besides its image: arbitrary output variables (AOVs).
#pragma once

#include "core/error.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace etendue {

/// Says how mist grows with the distance between its start and its end.
enum class MistFalloff { Quadratic, Linear, InverseQuadratic };

/// Holds where the mist of the layer `mist` lies, metres from the camera.
struct MistSettings {
    float start = 5.0f;   ///< >= 0
    float depth = 25.0f;  ///< > 0, from the start to where all is mist
    MistFalloff falloff = MistFalloff::Quadratic;
};

/// How an image file holds its layers.
enum class AovLayout {
    Layers,  ///< as channels of one image: NAME.R
    Parts,   ///< as parts of one file
    Files,   ///< in files of their own beside it: IMAGE.NAME.exr
};
inline constexpr std::array<std::pair<std::string_view, AovLayout>, 3> kAovLayoutNames{{
    {"layers", AovLayout::Layers},
    {"parts", AovLayout::Parts},
    {"files", AovLayout::Files},
}};

struct AovDesc {
    std::string name;              ///< name of the layer: letters, digits, '_' and '-'
    std::string source;            ///< one that the program knows by name, "lpe:EXPRESSION" or "light:NAME"
    std::optional<bool> is_float;  ///< 32-bit or 16-bit floats; none for what suits the source
    std::optional<int> ranks{};    ///< ids that a matte keeps of a pixel
    SourceLocation location{};

    friend bool operator==(const AovDesc& a, const AovDesc& b) {
        return a.name == b.name && a.source == b.source && a.is_float == b.is_float && a.ranks == b.ranks;
    }
};

inline constexpr std::string_view kAovForm =
    "SOURCE or NAME=SOURCE, with :half or :float behind it if wanted, of mattes :RANKS; NAME of letters, digits, '_' "
    "and '-'";

/// True for what layers may be called.
[[nodiscard]] bool is_aov_name(std::string_view name);

/// "depth", "N:float", "caustics=lpe:C D S+ L", "cryptomatte:8". Nothing if `text` has another form.
[[nodiscard]] std::optional<AovDesc> parse_aov(std::string_view text);
/// Returns `aov` as text from which `parse_aov` reads the same layer.
[[nodiscard]] std::string to_text(const AovDesc& aov);

}  // namespace etendue
