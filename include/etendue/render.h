// From a scene to a picture.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string_view>

#include <etendue/picture.h>
#include <etendue/scene.h>

namespace etendue {

/// How far a render is.
struct Progress {
    double fraction = 0.0;  ///< share of all samples that are taken, [0, 1]
    double seconds = 0.0;   ///< seconds of rendering
    std::uint64_t samples = 0;
    std::uint64_t rays = 0;
};

struct RenderControl {
    int threads = 0;  ///< [0, 4096]; 0 for one per processor
    /// Called from any thread, one call at a time, ten times a second at most and once at the end. Must not throw.
    std::function<void(const Progress&)> progress{};
    /// When it asks for it, rendering ends within a few tiles, with what there is until then.
    std::stop_token stop{};
};

/// Renders `scene`. Move a scene that is not needed any more: that spares a copy of its meshes. The picture is the same
/// bit for bit for every number of threads. $OCIO may name an OpenColorIO config in place of the built-in one. Several
/// calls may run at once. Throws Error.
[[nodiscard]] [[gnu::visibility("default")]] Picture render(Scene scene, const RenderControl& control = {});

/// "Etendue 1.2.3".
[[nodiscard]] [[gnu::visibility("default")]] std::string_view version();

}  // namespace etendue
