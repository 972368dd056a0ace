// Triangles of mesh lights that are sampled for many paths at once.
#pragma once

#include "core/columns.h"
#include "core/wide_rows.h"
#include "light/mesh_light.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace etendue {

/// Holds a LightTriangleFront for each path of a block. What the triangle alone decides stays where it is, in a row,
/// until it is computed with.
class LightFrontColumns {
  public:
    LightFrontColumns() { clear(); }

    /// Gives all lanes triangles of no meaning, until they are set.
    void clear() { rows_.fill(kNoTriangle.data()); }
    void set(std::size_t lane, const MeshLight& light, const MeshLight::TriangleChoice& choice) {
        rows_[lane] = light.row(choice.triangle);
        area_.set(lane, light.area());
        gain_.set(lane, choice.gain);
        back_.set(lane, light.back());
    }
    [[nodiscard]] LightTriangleFront<Wide> load(std::size_t first) const {
        std::array<const float*, Wide::kWidth> rows;
        std::copy_n(&rows_[first], rows.size(), rows.begin());
        const WideRow row = load_rows(rows);
        return {{row[0], row[1], row[2]},
                {row[3], row[4], row[5]},
                {row[6], row[7], row[8]},
                {row[9], row[10], row[11]},
                row[12],
                area_.load(first) / gain_.load(first),
                back_.load(first)};
    }

  private:
    alignas(kRowFloats * sizeof(float)) static constexpr std::array<float, kRowFloats> kNoTriangle{};

    std::array<const float*, kBlockLanes> rows_;
    Column area_, gain_, back_;
};

}  // namespace etendue
