// Intel Open Image Denoise, a trained network: openimagedenoise.github.io. Only in builds whose CMake finds the
// library.
#pragma once

#include "image/image.h"

#include <atomic>
#include <optional>

namespace etendue {

/// Returns false in builds without the library, whose `denoise_oidn` throws.
[[nodiscard]] bool has_oidn();

/// Holds what the network is told besides the light: three channels each, noisy themselves, as large as the light.
struct OidnFeatures {
    ImageF albedo;  ///< without channels if there is none
    ImageF normal;  ///< in any space; only used beside an albedo, as the library asks
};

struct OidnSettings {
    int threads = 0;  ///< 0 for one per processor
    /// Once it is true, the work ends as soon as it can.
    const std::atomic<bool>* stop = nullptr;
};

/// Returns the layer of light `light`, three channels of finite values without an upper bound, denoised by the filter
/// "RT"; none if it was stopped. Throws IoError with the library's reason.
[[nodiscard]] std::optional<ImageF> denoise_oidn(const ImageF& light, const OidnFeatures& features,
                                                 const OidnSettings& settings);

}  // namespace etendue
