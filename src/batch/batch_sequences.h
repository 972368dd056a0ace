// Says which frames of a batch wait for the first frame of their sequence, whose exposure they take.
#pragma once

#include "batch/batch_plan.h"
#include "session/settings_overrides.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace etendue {

/// Holds back frames of sequences for which the user gives no exposure. Each waits until the first frame of its
/// sequence that is still to be rendered is done, has failed or is left to another process.
class FirstFrames {
  public:
    /// Holds back nothing.
    FirstFrames() = default;
    /// Reads the render.json of each scene with frames.
    FirstFrames(const BatchPlan& plan, const SettingsOverrides& overrides);

    /// Returns whether the image at `index` in the plan has nothing to wait for.
    [[nodiscard]] bool lets_begin(std::size_t index) const;
    /// Notes that the image has ended, or that another process has it.
    void end(std::size_t index);

  private:
    std::vector<std::optional<std::size_t>> waits_for_{};  ///< the index of the frame that each image waits for
    std::vector<bool> has_ended_{};
};

}  // namespace etendue
