// Light that subpaths from the eye meet: the strategies without a vertex from the light.
#pragma once

#include "integrator/bdpt/bdpt_job.h"
#include "wave/aov/sample_light.h"
#include "wave/lamps_in_view.h"

#include <span>
#include <vector>

namespace etendue {

/// Weighs the light that the eye subpaths of a wave meet, and adds it to their samples.
class MetLight final : public LightFinder {
  public:
    /// Names what light is found for, with what, and where it goes.
    struct Parts {
        const BdptJob& job;
        SubpathWave& eye;
        LampsInView& lamps;
        SampleLight& found;
        std::vector<float>& alpha;  ///< by slot, 1 less what comes through from behind the whole scene
        TileBuffer& tile;
        RenderCounters& counters;
    };

    explicit MetLight(const Parts& parts) : parts_(parts) {}

    void on_emitter(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction,
                    const SubpathDensities& arrived) override;
    void on_unlit(const SubpathState& state, const SurfacePoint& point) override;
    void on_escape(const SubpathState& state, const Vec3f& direction) override;
    void on_replaced_surface(SubpathState& state, const Ray& ray, const Interior& interior, const Hit& hit) override;
    void on_first_hits(std::span<const Ray> rays, std::span<const Hit> hits) override;
    [[nodiscard]] bool finds_emission(const Hit& first_hit) const override {
        return parts_.lamps.finds_emission(first_hit);
    }

  private:
    /// Counts for a profile that a direction which the subpath sampled has led to light.
    void count(const SubpathState& state) const;
    /// Adds `light` to the sample of `state`, by its weight.
    void add(const SubpathState& state, const Rgb& light, const StrategySums& sums, const AovSet::Source& source);

    Parts parts_;
    std::vector<ExpressionShare> shares_;  ///< shares of expressions in the light of the path at hand
};

}  // namespace etendue
