// Which random numbers a path takes for what. The wide integrators and the scalar algorithms of this room take the same
// ones.
#pragma once

#include "sampling/sampler.h"

#include <cstdint>

namespace etendue {

/// Numbers the pairs that camera rays take; integrators begin after them. The alpha key takes bits, which are unrelated
/// to the pair of the same dimension: the time has that.
enum CameraDimension : std::uint32_t {
    kFilmDimension,
    kLensDimension,
    kCameraAlphaDimension,
    kFirstFreeDimension,
    kTimeDimension = kCameraAlphaDimension
};

/// Numbers the pairs of one bounce of an eye path, within those of the bounce.
enum BounceDimension : std::uint32_t {
    kLightChoice,
    kLightTriangle,
    kLightDirection,
    kBsdfDirection,
    kChoices,  ///< x: which lobe, y: whether the path ends
    kAlpha,
    kBounceDimensions
};

/// Numbers the pairs of one bounce that only scenes with bodies need, apart from the others: adding one changes none of
/// these.
enum BodyDimension : std::uint32_t {
    kMedium,  ///< x: how far, y: by which channel
    kWavelength,
    kBodyDimensions
};

/// Numbers the pairs of one branch of Whitted's trees, whose seed sets it apart from the others.
enum BranchDimension : std::uint32_t {
    kBranchLightChoice = kFirstFreeDimension,
    kBranchLightTriangle,
    kBranchLightDirection,
    kBranchEnvironmentDirection,
    kBranchWavelength,
    kBranchAlpha,
    kBranchEnd
};

/// Names the end from which a subpath of bidirectional path tracing begins.
enum class SubpathEnd { AtEye, AtLight };

/// Numbers the pairs of one bounce of a subpath of bidirectional path tracing, for scattering and for connections.
enum class SubpathDimension : std::uint32_t {
    Scattering,
    Choices,  ///< x: which lobe, y: whether the path ends
    Medium,
    Alpha,
    LightChoice,  ///< the light of a connection; for one to the camera, the point of the lens
    LightTriangle,
    LightDirection,
    Count
};

/// Numbers the pairs with which a light subpath begins, from kFirstLightDimension on.
enum EmissionDimension : std::uint32_t { kEmitterChoice, kTriangle, kPosition, kDirection, kEmissionDimensions };

/// Begins the dimensions of light subpaths, far from those of eye paths.
inline constexpr std::uint32_t kFirstLightDimension = 1u << 29;
/// Has the wavelength that both subpaths of a sample take in dispersive bodies.
inline constexpr std::uint32_t kSubpathWavelengthDimension = 1u << 30;

/// Returns the dimension of bounce `bounce` of a subpath, from 1 on; 0 is where a light subpath begins.
[[nodiscard]] constexpr std::uint32_t subpath_dimension(SubpathEnd end, int bounce, SubpathDimension which) {
    const std::uint32_t first =
        end == SubpathEnd::AtEye ? kFirstFreeDimension : kFirstLightDimension + kEmissionDimensions;
    return first + static_cast<std::uint32_t>(bounce) * static_cast<std::uint32_t>(SubpathDimension::Count) +
           static_cast<std::uint32_t>(which);
}

/// Returns the dimension of the eye path's ray number `rays` and of what that leads to.
[[nodiscard]] constexpr std::uint32_t bounce_dimension(int rays, BounceDimension which) {
    return kFirstFreeDimension + static_cast<std::uint32_t>(rays) * kBounceDimensions + which;
}

/// Returns the dimension, of those that only bodies need, of ray number `rays`.
[[nodiscard]] constexpr std::uint32_t body_dimension(int rays, BodyDimension which) {
    constexpr std::uint32_t kFirst = 1u << 30;
    return kFirst + static_cast<std::uint32_t>(rays) * kBodyDimensions + which;
}

/// Returns the key of the `round`-th of `samples` light samples at a vertex of the sample with `key`. Those that are
/// split have a sequence of their own, with one point after the other for all samples of the pixel.
[[nodiscard]] constexpr SampleKey light_sample_key(SampleKey key, std::uint32_t samples, std::uint32_t round) {
    return samples > 1 ? SampleKey{hash_u32(key.pixel_seed), key.index * samples + round} : key;
}

/// Returns the alpha key of the shadow ray of the `round`-th light sample, from that of the ray that goes on: it
/// differs from this one and from those of all other rounds.
[[nodiscard]] constexpr std::uint32_t shadow_alpha_key(std::uint32_t alpha_key, std::uint32_t round) {
    return round == 0 ? ~alpha_key : hash_combine(~alpha_key, round);
}

/// Returns the seed of the `child`-th branch that grows from the one with `seed` in a tree of Whitted's.
[[nodiscard]] constexpr std::uint32_t branch_seed(std::uint32_t seed, std::uint32_t child) {
    return hash_combine(hash_combine(seed, kBranchEnd), child);
}

/// Draws the random numbers of one sample.
struct SampleNumbers {
    SampleSequence sequence = SampleSequence::Sobol;
    SampleKey key;

    [[nodiscard]] Vec2f pair(std::uint32_t dimension) const { return sample_2d(sequence, key, dimension); }
    [[nodiscard]] std::uint32_t bits(std::uint32_t dimension) const { return sample_bits(key, dimension); }
};

}  // namespace etendue
