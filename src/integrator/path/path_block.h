// A block of paths, between the stages of shading.
#pragma once

#include "bsdf/bsdf.h"
#include "core/columns.h"
#include "integrator/path/block_lanes.h"
#include "integrator/path/glossy_lanes.h"
#include "integrator/path/wave_paths.h"
#include "wave/number_pairs.h"
#include "world/plain_lookups.h"
#include "world/scattering.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace etendue {

/// Lists lanes in the order in which they were offered, each at most once.
class LaneList {
  public:
    /// Numbers a lane. The type is larger than a byte: bytes may alias anything, so that compilers would read the count
    /// anew after each byte they write.
    using Lane = std::uint16_t;

    void clear() { count_ = 0; }
    void add(std::size_t lane) { add_if(true, lane); }
    /// Adds `lane` if `is_listed`, without a branch: `is_listed` is a matter of chance, which no processor predicts.
    void add_if(bool is_listed, std::size_t lane) {
        lanes_[count_] = static_cast<Lane>(lane);
        count_ += is_listed ? 1 : 0;
    }

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] std::size_t operator[](std::size_t i) const { return lanes_[i]; }
    [[nodiscard]] const Lane* begin() const { return lanes_.data(); }
    [[nodiscard]] const Lane* end() const { return lanes_.data() + count_; }

  private:
    std::size_t count_ = 0;
    std::array<Lane, kBlockLanes> lanes_{};
};

/// Holds what all stages of shading ask of a path whose ray has hit a surface.
struct ShadedPath {
    const PlainSurface* plain = nullptr;        ///< see Materials::plain_surface
    const MetallicRoughness* glossy = nullptr;  ///< lobe of the path, where many are evaluated at once
    std::uint32_t light = kNone;                ///< light that is sampled
    bool is_wide = false;                       ///< scattered by a lobe that is evaluated for many paths at once
};

/// Holds what else paths have that are shaded one by one: some 700 bytes, apart from what stays in the first-level
/// cache.
struct SingleShading {
    SurfacePoint point;  ///< surface point; for a plain surface its material only, where words are followed
    std::optional<Crossing> crossing;
    Wavelength wavelength{};  ///< wavelength with which the path goes on, and its weight
    bool chooses_wavelength = false;
    Bsdf storage;
    std::optional<Scattering> scattering;  ///< unless it is_wide; of glossy ones where words are followed
    BsdfValue towards_light;
    BsdfSample sample;
};

/// Holds what a path keeps when it goes straight through a clear surface: its last vertex stays the one before.
struct ClearPassage {
    LightReceiver from;
    float passed = 0.0f;  ///< metres, behind the surface
};

/// Holds what the stages of shading a block of paths tell each other. Path `k` of the block is path `first` + `k` of
/// the wave, and has lane `k` of `lanes`.
struct PathBlock {
    std::size_t first = 0;  ///< the block's first path, in the wave
    std::size_t count = 0;  ///< paths in the block
    NumberPairs light_choice, light_triangle, light_direction, bsdf_direction;
    NumberPairs choices;  ///< x: which lobe, y: whether the path ends
    NumberPairs medium;   ///< x: how far, y: by which channel
    std::array<ShadedPath, kBlockLanes> paths{};
    std::vector<SingleShading> singles{kBlockLanes};
    std::vector<ClearPassage> clear;                ///< only if the World has clear surfaces
    std::array<ChosenLight, kBlockLanes> lights{};  ///< light samples outside the lanes, by path
    LaneList escaped;                               ///< paths that have left the scene
    LaneList on_emitter, on_hidden;                 ///< paths on surfaces that emit, on hidden boundaries
    LaneList on_surface;                            ///< paths on surfaces that may scatter them
    LaneList sampling;                              ///< paths of `on_surface` that sample lights
    LaneList on_texture, on_gloss;                  ///< paths on textured plain surfaces, in GlossyLanes
    BlockLanes lanes;

    /// Draws the numbers of the block's paths for a bounce, many at a time.
    void draw_numbers(const PathContext& context, const WavePaths& wave);
    /// Draws the numbers for the `round`-th light sample of the block's paths.
    void draw_light_numbers(const PathContext& context, const WavePaths& wave, std::uint32_t round);
    /// Returns the numbers from which the light sample of path `k` is made.
    [[nodiscard]] LightNumbers light_numbers(std::size_t k) const {
        return {light_choice[k], light_triangle[k], light_direction[k]};
    }
    void set_wide(std::size_t k, bool is_wide) {
        paths[k].is_wide = is_wide;
        lanes.is_wide.set(k, is_wide ? 1.0f : 0.0f);
    }
    /// Returns what scattering towards `wi` by the surface of path `k`, which is wide, may be taken for in `words`.
    [[nodiscard]] VertexEvent wide_event(const World& world, const PathWords& words, std::size_t k,
                                         const Vec3f& wi) const;
    [[nodiscard]] std::size_t bytes() const;
};

}  // namespace etendue
