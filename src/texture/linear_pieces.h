// An image's pieces in linear light, for the cache of tiles. For this room only.
#pragma once

#include "image/image_pieces.h"
#include "image/image_reader.h"
#include "texture/texture_options.h"

#include <span>

namespace etendue {

/// Integers under a curve or times alpha become 16-bit floats, everything else keeps its depth; what is not finite
/// becomes its `finite_value`. The file's own mip levels are shown if they reach 1 × 1.
class LinearPieces final : public ImagePieces {
  public:
    /// Multiplies colours by alpha if `times_alpha`, which asks for an image that has one. Bytes in memory must outlive
    /// it. Throws IoError as ImageReader does.
    LinearPieces(const ImageSource& source, Encoding encoding, bool times_alpha = false);

    [[nodiscard]] const ImageInfo& info() const override { return info_; }
    [[nodiscard]] std::span<const ImageLevel> levels() const override { return levels_; }
    [[nodiscard]] ImageLevel tile() const override { return reader_.tile(); }
    void read_rows(int level, int y_begin, int y_end, std::span<float> values) override;
    void read_tile(int level, int x, int y, std::span<float> values) override;

  private:
    void linearize(std::span<float> values) const;
    /// Takes the curve off colours.
    void decode(std::span<float> values) const;

    ImageReader reader_;
    Encoding encoding_;
    bool times_alpha_;
    ImageInfo info_;
    std::span<const ImageLevel> levels_;
};

}  // namespace etendue
