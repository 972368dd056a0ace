// The measured distribution of a lamp, as a table that is looked up by direction.
#pragma once

#include "core/vec.h"

#include <cstddef>
#include <vector>

namespace etendue {

/// Ascending angles, at least two, and the interval between two of them that an angle lies in: by arithmetic if they
/// are spread evenly, as most measured ones are, else by bisection.
class AngleTable {
  public:
    /// An interval, and a place in it from 0 to 1.
    struct Place {
        std::size_t index;
        float fraction;
    };

    explicit AngleTable(std::vector<float> angles);

    /// Where `angle` lies; one beyond the ends counts as the end.
    [[nodiscard]] Place find(float angle) const;

    [[nodiscard]] float front() const { return angles_.front(); }
    [[nodiscard]] float back() const { return angles_.back(); }
    [[nodiscard]] std::size_t size() const { return angles_.size(); }
    [[nodiscard]] float operator[](std::size_t i) const { return angles_[i]; }

  private:
    std::vector<float> angles_;
    float intervals_per_radian_ = 0.0f;  ///< 0 if they are uneven
};

/// Intensity over the sphere, bilinear in the vertical angle (from the lamp's axis, local -Z) and the horizontal one
/// (from local +X towards +Y); zero beyond the vertical angles of the table. See IesProfileDesc for what stands in
/// them.
class IesProfile {
  public:
    /// `vertical` and `horizontal` in radians, ascending, `horizontal` from 0 to 2 pi; `candela` has the vertical
    /// angles of each horizontal one after the other.
    IesProfile(std::vector<float> vertical, std::vector<float> horizontal, std::vector<float> candela);

    /// Towards `direction`, a unit vector away from the lamp in its local frame.
    [[nodiscard]] float candela(const Vec3f& direction) const;

    /// Mean over all horizontal angles at the vertical angle `theta`, radians.
    [[nodiscard]] double mean_candela(double theta) const;
    /// The greatest vertical angle of the table, radians.
    [[nodiscard]] float last_vertical() const { return vertical_.back(); }

  private:
    AngleTable vertical_;
    AngleTable horizontal_;
    std::vector<float> candela_;
    std::vector<double> mean_;  ///< over the horizontal angles, for each vertical one
};

}  // namespace etendue
