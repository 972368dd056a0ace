// A wave of eye and light subpaths, and all connections between them.
#pragma once

#include "integrator/bdpt/bdpt_options.h"
#include "integrator/bdpt/reference_weights.h"
#include "integrator/subpath/connectible_vertices.h"
#include "integrator/subpath/connections.h"
#include "integrator/subpath/subpath_wave.h"

#include <cstddef>
#include <vector>

namespace etendue {

class BdptWave final : public IntegratorScratch, private LightFinder {
  public:
    /// Samples in a wave. A vertex takes 208 bytes, and 248 more for a lobe that was evaluated there: the ten or so of
    /// a sample stay in a cache of 2 MiB until they are connected.
    static constexpr std::size_t kCapacity = 512;

    /// Traces samples [first, first + count) of the job, count <= kCapacity.
    void trace(const World& world, const TileJob& job, const BdptOptions& options, std::size_t first, std::size_t count,
               TileBuffer& tile, RenderCounters& counters);

  private:
    struct Context : SubpathJob {
        const BdptOptions& options;

        /// True if the vertex may be connected to those of other samples: each sample has a time and a wavelength of
        /// its own.
        [[nodiscard]] bool is_shared(const PathVertex& vertex) const {
            return options.cached_connections > 0 && !world.has_motion() && !vertex.is_dispersed;
        }
    };

    // s = 0: subpaths from the eye that meet a light.
    void on_emitter(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction,
                    const SubpathDensities& arrived) override;
    void on_unlit(const SubpathState& state, const SurfacePoint& point, const Vec3f& direction) override;
    void on_escape(const SubpathState& state, const Vec3f& direction) override;
    void on_first_hits(std::span<const Ray> rays, std::span<const Hit> hits) override;
    void add(const SubpathState& state, const Rgb& light, double fewer_from_eye, const PathLightEnd& end,
             const AovSet::Source& source);

    /// s = 1: to a point on a light that is sampled for the vertex.
    void connect_to_light(const Context& context, const PathVertex& vertex, const LightNumbers& numbers);
    /// t = 1: to a point on the lens that is sampled for the vertex.
    void connect_to_camera(const Context& context, const PathVertex& vertex, Vec2f lens);
    /// s > 1, t > 1: to all of the sample's own light subpath that the cache does not have.
    void connect_to_own(const Context& context, const PathVertex& eye);
    /// To `count` vertices drawn from the cache, in place of all that it has of an average light subpath.
    void connect_to_cache(const Context& context, const PathVertex& eye, int count);
    /// `scale` is how many connections this one stands for.
    void connect(const Context& context, const PathVertex& eye, const PathVertex& light, float scale);

    /// Of a strategy, from the ratios of those with fewer vertices on one side.
    [[nodiscard]] static float weight(const BdptOptions& options, double fewer_from_light, double fewer_from_eye);

    /// Shows the weight of a path to the observer, and in debug builds compares it with the reference. The path leads
    /// from `end` over the subpath that ends in `light` and back over that which ends in `eye`; either may be null.
    void check(const SubpathJob& job, const BdptOptions& options, std::size_t s, float weight, const PathLightEnd& end,
               const PathVertex* light, const PathVertex* eye, const CameraConnection& camera) const;
    [[nodiscard]] PathLightEnd light_end(std::uint32_t slot) const;
    /// How the camera sees the first vertex of a sample's eye subpath.
    [[nodiscard]] CameraConnection camera_of(const SubpathJob& job, const PathVertex& eye) const;

    std::vector<CameraSample> samples_;
    std::vector<Ray> camera_rays_;
    SampleLight found_;
    std::vector<float> alpha_;
    std::vector<ExpressionShare> shares_;  ///< of the path at hand
    SubpathWave eye_{SubpathEnd::AtEye};
    SubpathWave light_{SubpathEnd::AtLight};
    VerticesToLight to_light_;
    VerticesToCamera to_camera_;
    /// Light vertices that eye vertices of any sample may be connected to, if options ask for that.
    std::vector<const PathVertex*> cache_;
    Connections connections_;
    const Context* context_ = nullptr;  ///< of the call of `trace` under way, for what eye subpaths find
    TileBuffer* tile_ = nullptr;        ///< the same
};

}  // namespace etendue
