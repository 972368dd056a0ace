// The slopes of a normal map in pieces, for the cache of tiles. For this room only.
#pragma once

#include "image/image_pieces.h"
#include "texture/linear_pieces.h"
#include "texture/slope_rows.h"

#include <span>
#include <vector>

namespace etendue {

/// A normal map's SlopeMoments at half the size, as an image of five floats a texel: its first mip level, of which the
/// cache makes the others by averaging. An odd last row or column of the map is left out. It is stored by rows.
class SlopePieces final : public ImagePieces {
  public:
    /// Normals are `interpolated` as in SlopeRows. Bytes in memory must outlive it. Throws IoError as ImageReader does.
    SlopePieces(const ImageSource& source, bool interpolated);

    [[nodiscard]] const ImageInfo& info() const override { return info_; }
    [[nodiscard]] std::span<const ImageLevel> levels() const override { return {&level_, 1}; }
    [[nodiscard]] ImageLevel tile() const override { return {}; }
    void read_rows(int level, int y_begin, int y_end, std::span<float> values) override;
    /// Never called: there are no tiles.
    void read_tile(int level, int x, int y, std::span<float> values) override;

  private:
    /// Has `texels_` hold row `y` of the map.
    void fetch_row(int y);
    void read_slopes(int y, std::span<Vec2f> slopes);

    LinearPieces map_;
    ImageInfo info_;
    ImageLevel level_;
    SlopeRows slopes_;
    int first_row_ = 0;          ///< the first of the map's rows that `texels_` hold
    int end_row_ = 0;            ///< the first that they do not hold
    std::vector<float> texels_;  ///< row by row: one, or as many as a tile of the map is high
    std::vector<float> tile_;
};

}  // namespace etendue
