// What plain metallic-roughness surfaces make of the paths of a block: those stand here side by side, since what is
// computed for them is dear.
#pragma once

#include "bsdf/metallic_roughness.h"
#include "bsdf/plain_metallic_roughness.h"
#include "core/columns.h"
#include "integrator/path/block_lanes.h"
#include "wave/number_pairs.h"
#include "world/oriented_surface.h"

#include <cstddef>

namespace etendue {

/// Holds the paths of a block that are on plain metallic-roughness surfaces, side by side: about 13 KiB.
struct GlossyLanes {
    /// Makes room for a block's paths, and behind them for as much as is written at once.
    static constexpr std::size_t kSize = kBlockLanes + Wide::kWidth;
    using Column = BasicColumn<kSize>;
    using Vec2Columns = BasicVec2Columns<kSize>;
    using Vec3Columns = BasicVec3Columns<kSize>;
    using RgbColumns = BasicRgbColumns<kSize>;

    RgbColumns base, f0;
    Column metallic, alpha, f90;

    // As in SurfacePoint and in BlockLanes.
    Vec3Columns tangent, bitangent, normal, geometric_normal;
    Vec3Columns wo;

    Column u_lobe;
    Vec2Columns u_bsdf;
    Vec3Columns light_wi;

    RgbColumns f_cos;
    Column pdf;

    Vec3Columns next_direction;
    RgbColumns next_weight;
    Column next_pdf;

    /// Sets the lobe of `lane`, which must be plain.
    void set_lobe(std::size_t lane, const MetallicRoughness& lobe) {
        base.set(lane, lobe.base);
        f0.set(lane, lobe.f0);
        metallic.set(lane, lobe.metallic);
        alpha.set(lane, lobe.alpha_x);
        f90.set(lane, lobe.f90);
    }

    /// Moves what is known of those paths [0, paths) of a block that are on gloss here, side by side. `choices` are
    /// their numbers for the choice of a lobe, in x, `directions` those for the direction. With `lights_only`, only the
    /// directions to their lights are moved, as all else has been moved here before.
    void take(const BlockLanes& lanes, std::size_t paths, const NumberPairs& choices, const NumberPairs& directions,
              bool lights_only);
    /// Evaluates the lobes of lanes [0, count), rounded up.
    void evaluate(std::size_t count);
    /// Evaluates and samples the lobes of lanes [0, count), rounded up.
    void evaluate_and_sample(std::size_t count);
    /// Moves values, and samples if `with_samples`, back to those of the first `paths` of `lanes` that are on gloss.
    void give(BlockLanes& lanes, std::size_t paths, bool with_samples) const;

  private:
    /// Returns the surfaces of lanes from `l` on, turned to `wo`.
    [[nodiscard]] OrientedSurface<Wide> surface(std::size_t l) const {
        return {{tangent.load(l), bitangent.load(l), normal.load(l)}, geometric_normal.load(l), wo.load(l), true};
    }
    [[nodiscard]] PlainMetallicRoughness<Wide> lobe(std::size_t l) const {
        return {base.load(l), metallic.load(l), alpha.load(l), f0.load(l), f90.load(l)};
    }
};

}  // namespace etendue
