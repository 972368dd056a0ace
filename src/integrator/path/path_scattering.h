// Where surfaces and media send paths.
#pragma once

#include "integrator/path/path_light.h"

#include <cstddef>

namespace etendue {

/// Samples how the surfaces and media that a block's paths are in scatter them, and takes the paths on.
class PathScattering {
  public:
    /// All arguments have to stay where they are.
    PathScattering(WavePaths& paths, PathBlock& block, PathLight& light)
        : paths_(paths), block_(block), light_(light) {}

    /// Evaluates the BSDFs of all paths that are wide towards their light samples, and samples where the paths go on:
    /// both share what depends on the way back to the eye alone.
    void evaluate_and_sample_by_lanes();
    /// Evaluates the BSDFs of all paths that are wide towards another light sample each.
    void evaluate_by_lanes();
    /// Samples the BSDF of path `k`, which is not wide.
    void sample_bsdf(const PathContext& context, std::size_t k);

    /// Takes path `k` through the medium that its ray is in; true if it scatters there.
    bool scatter_in_medium(const PathContext& context, std::size_t k);
    /// Takes path `k` through a boundary that another body hides.
    void pass_hidden(const PathContext& context, std::size_t k);
    /// Takes path `k` where the sample of its BSDF says; false if it ends.
    bool scatter_at_surface(const PathContext& context, std::size_t k);
    /// Takes all paths that are wide where the samples of their BSDFs say, at once.
    void scatter_by_lanes(const PathContext& context);

  private:
    /// Has path `k` go on as if it still came from the vertex before.
    void keep_last_vertex(std::size_t k);
    /// Takes path `k` straight through a clear surface, which is no vertex.
    void pass_straight(const PathContext& context, std::size_t k);
    /// Tells the profile, if there is one, how path `k` scattered.
    void count_sample(const PathContext& context, std::size_t k, const BsdfSample& sample) const;
    /// Bends the cone of path `k`, which has arrived as `arriving`, as `sample` does, before the path's ray is changed.
    void bend_cone(const World& world, std::size_t k, const RayCone& arriving, const Vec3f& geometric_normal,
                   const BsdfSample& sample);
    /// Bends the cones of all paths that are wide.
    void bend_cones(const World& world);
    /// Returns what the lanes have sampled for path `k`, but for its direction.
    [[nodiscard]] BsdfSample sample_of_lane(std::size_t k) const;

    WavePaths& paths_;
    PathBlock& block_;
    PathLight& light_;
    GlossyLanes glossy_;
};

}  // namespace etendue
