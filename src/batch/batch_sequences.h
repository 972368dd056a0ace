// Says which frames of a batch wait for the first frame of their sequence, whose exposure they take.
#pragma once

#include "batch/batch_plan.h"
#include "session/settings_overrides.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace etendue {

/// Holds back frames of sequences for which the user gives no exposure. All but the first of a sequence wait until
/// that is made or left to another process. If it fails, the next one takes its place.
class FirstFrames {
  public:
    /// Holds back nothing.
    FirstFrames() = default;
    /// Reads the render.json of each scene with frames.
    FirstFrames(const BatchPlan& plan, const SettingsOverrides& overrides);

    /// Returns whether the image at `index` in the plan has nothing to wait for.
    [[nodiscard]] bool lets_begin(std::size_t index) const;
    /// Notes that the image at `index` is made or that another process has it, or else that it failed.
    void end(std::size_t index, bool is_made);

  private:
    std::vector<std::optional<std::size_t>> sequences_{};       ///< number of the sequence of each image
    std::vector<std::vector<std::size_t>> frames_that_wait_{};  ///< images of each sequence, the last one first
};

}  // namespace etendue
