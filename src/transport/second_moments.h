// How noisy path tracing, bidirectional path tracing and merging would be, told by samples of the last.
//
// An integrator that makes the path x with the density p(x) has the second moment int f² / p dx. Any sampler estimates
// that integral, and the one that combines all strategies does so with little noise: with C, the weighted light that it
// finds by one of them, and share = p(x) over the density of all strategies together, the balance heuristic has
//
//   sum C² / share
//
// for its expected value. So light that path tracing meets once in a million samples is counted as what it is,
// fireflies, by samples that find it all the time.
#pragma once

#include "transport/bidirectional.h"
#include "transport/photon_map.h"
#include "transport/strategies.h"
#include "transport/subpath.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace etendue {

/// Counts the integrators that are compared by samples of the last: `path`, `bdpt` and `vcm`.
inline constexpr std::size_t kComparedCount = 3;

template <typename T>
using PerIntegrator = std::array<T, kComparedCount>;

/// Holds light that has been found, as the mean of its three channels, and what it adds to the sums of each integrator.
struct ComparedLight {
    double light = 0.0;               ///< weighted
    PerIntegrator<double> moments{};  ///< second moments
    PerIntegrator<double> missed{};   ///< light that the integrator never finds

    void add(const ComparedLight& other);
};

/// Hears of light at a place on the film, in [0, 1]².
using HearLight = std::function<void(const ComparedLight&, const Vec2f& film)>;

/// Counts what the work of a sample depends on.
struct SampleWork {
    double eye_rays = 0.0;       ///< rays of the eye subpath
    double light_samples = 0.0;  ///< lights sampled for its vertices
    double light_rays = 0.0;     ///< rays of the light subpath
    double connections = 0.0;    ///< pairs of vertices, and vertices and the lens, that were connected
    double merges = 0.0;         ///< photons that vertices took light from

    void add(const SampleWork& other);
};

/// Holds the light subpath of a sample with the densities that each integrator's strategies have.
class ComparedSample {
  public:
    /// Follows the light subpath of `eye`. Weights are those of the balance heuristic, whatever `settings` say.
    ComparedSample(const World& world, const EyeSample& eye, const IntegratorSettings& settings,
                   const BidirectionalSetup& setup);
    ComparedSample(const ComparedSample&) = delete;
    ComparedSample& operator=(const ComparedSample&) = delete;

    /// Holds a photon for all, and its densities without merges and for path tracing alone.
    struct Photons {
        std::vector<Photon> all;  ///< without words; `first_word` is the place of each here
        std::vector<SubpathDensities> unmerged;
        std::vector<SubpathDensities> of_path_tracing;

        void append(const Photons& others);
    };

    /// Appends the photons that the light subpath leaves.
    void append_photons(Photons& photons) const;

    /// Returns the light of the sample, but for what the eye sees directly and the images of lamps that have samples of
    /// their own, and passes to `hear` what its light subpath alone brings to the film. Photons are those of `photons`.
    [[nodiscard]] ComparedLight compare(const PhotonMap& map, const Photons& photons, SampleWork& work,
                                        const HearLight& hear) const;

  private:
    /// Holds where the ray of an eye subpath has led.
    struct Met {
        Subpath subpath;
        Vertex vertex;
        SubpathDensities arrived;
    };
    /// Holds the eye subpath with one kind of densities.
    struct EyeSubpath {
        std::vector<Met> met;
        std::vector<SubpathVertex> vertices;
        double rays = 0.0;
        double connectable = 0.0;  ///< vertices that can be connected, before it was cut short
    };
    /// Holds the eye subpath with the strategies of `vcm` and with those of `bdpt`.
    struct EyeSubpaths {
        EyeSubpath all, unmerged;
    };

    /// Sums the light that path tracing finds at all vertices of a path, which varies together; but for fireflies,
    /// which samples of one size tell nothing of.
    struct LightOfPath {
        double sum = 0.0;
        double squares = 0.0;

        /// Adds `found`, of which path tracing's strategies have `of_path` times the density.
        void add(const StrategyLight& found, double of_path);
    };

    [[nodiscard]] std::vector<SubpathVertex> follow_light(const SubpathSample& sample);
    [[nodiscard]] EyeSubpath follow_eye(const SubpathSample& sample) const;
    void compare_met(const EyeSubpaths& eye, ComparedLight& sum, LightOfPath& by_path) const;
    void compare_sampled(const EyeSubpaths& eye, ComparedLight& sum, LightOfPath& by_path) const;
    void compare_connected(const EyeSubpaths& eye, ComparedLight& sum) const;
    void compare_merged(const EyeSubpaths& eye, const PhotonMap& map, const Photons& photons, SampleWork& work,
                        ComparedLight& sum) const;

    EyeSample eye_;
    PathLengths lengths_;
    bool lamp_images_ = true;
    // Subpaths of the sample with the strategies of `vcm`, of `bdpt`, and of path tracing alone.
    SubpathSample with_all_, without_merges_, of_path_;
    double light_rays_ = 0.0;
    double light_vertices_ = 0.0;                 ///< vertices that can be connected, before the subpath was cut short
    std::vector<SubpathVertex> all_;              ///< with the strategies of `vcm`
    std::vector<SubpathVertex> unmerged_;         ///< with those of `bdpt`
    std::vector<SubpathVertex> of_path_tracing_;  ///< with s = 0 and s = 1
};

}  // namespace etendue
