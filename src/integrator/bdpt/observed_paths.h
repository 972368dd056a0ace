// How complete paths come to whoever observes their weights.
#pragma once

#include "integrator/bdpt/complete_path.h"
#include "integrator/bdpt/weight_observer.h"

#include <cstddef>
#include <cstdint>

namespace etendue {

/// Puts paths of a wave together from its subpaths, for an observer, if there is one.
class ObservedPaths {
  public:
    /// Keeps references to the two waves, which must outlive it.
    ObservedPaths(SubpathWave& eye, SubpathWave& light) : eye_(eye), light_(light) {}
    ObservedPaths(const ObservedPaths&) = delete;
    ObservedPaths& operator=(const ObservedPaths&) = delete;

    /// Shows paths to `observer` from now on; to nobody if it is null.
    void start(WeightObserver* observer) { observer_ = observer; }
    /// Returns false if nobody observes.
    [[nodiscard]] bool are_seen() const { return observer_ != nullptr; }

    /// Shows the path from `end`, a point on a light that a strategy with `s` vertices there has found, to the eye
    /// vertex at a place in SubpathVertices::all.
    void show(const SubpathJob& job, std::size_t s, float weight, const PathLightEnd& end, std::uint32_t eye);
    /// Shows the path that connects `light` to the camera, which sees it as `camera` says.
    void show_to_camera(const SubpathJob& job, const ConnectibleVertex& light, float weight,
                        const CameraConnection& camera);
    /// Shows the path that connects two vertices.
    void show_between(const SubpathJob& job, const ConnectibleVertex& eye, const ConnectibleVertex& light,
                      float weight);

  private:
    /// Shows the path that leads from `end` over the subpath that ends in `light` and back over that which ends in
    /// `eye`; either may be null.
    void show(const SubpathJob& job, std::size_t s, float weight, const PathLightEnd& end, const PathVertex* light,
              const PathVertex* eye, const CameraConnection& camera) const;
    /// Returns where the light subpath of the sample in `slot` began.
    [[nodiscard]] PathLightEnd light_end(std::uint32_t slot) const;
    /// Returns how the camera sees the first vertex of the eye subpath that ends in `eye`.
    [[nodiscard]] CameraConnection camera_of(const SubpathJob& job, const PathVertex& eye) const;

    SubpathWave& eye_;
    SubpathWave& light_;
    WeightObserver* observer_ = nullptr;
};

}  // namespace etendue
