#include "image/image_reader.h"

#include "core/error.h"
#include "image/encoded_image.h"
#include "image/image_functions.h"
#include "image/image_pieces.h"
#include "image/read.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace etendue {

namespace {

/// A decoded image by rows.
class WholePieces final : public ImagePieces {
  public:
    WholePieces(ImageInfo info, ImageF pixels)
        : info_(std::move(info)), pixels_(std::move(pixels)), level_{{{pixels_.width, pixels_.height}}} {}

    [[nodiscard]] const ImageInfo& info() const override { return info_; }
    [[nodiscard]] std::span<const ImageLevel> levels() const override { return level_; }
    [[nodiscard]] ImageLevel tile() const override { return {}; }
    void read_rows(int /*level*/, int y_begin, int y_end, std::span<float> values) override {
        const auto row = static_cast<std::size_t>(pixels_.width) * static_cast<std::size_t>(pixels_.channels);
        const auto rows = std::span(pixels_.pixels).subspan(static_cast<std::size_t>(y_begin) * row);
        std::ranges::copy(rows.first(static_cast<std::size_t>(y_end - y_begin) * row), values.begin());
    }
    void read_tile(int /*level*/, int /*x*/, int /*y*/, std::span<float> /*values*/) override {
        throw IoError("it is not stored in tiles");
    }

  private:
    ImageInfo info_;
    ImageF pixels_;
    std::array<ImageLevel, 1> level_;
};

}  // namespace

struct ImageReader::Impl {
    std::unique_ptr<ImagePieces> pieces;
};

ImageReader::ImageReader(const ImageSource& source) : impl_(std::make_unique<Impl>()) {
    const EncodedImage image = look_at(source);
    if (image.radiance)
        impl_->pieces = std::make_unique<WholePieces>(read_image_info(source), read_image_float(source));
    else
        impl_->pieces = image_functions().open_pieces(image);
}

ImageReader::~ImageReader() = default;
ImageReader::ImageReader(ImageReader&&) noexcept = default;
ImageReader& ImageReader::operator=(ImageReader&&) noexcept = default;

const ImageInfo& ImageReader::info() const {
    return impl_->pieces->info();
}

std::span<const ImageLevel> ImageReader::levels() const {
    return impl_->pieces->levels();
}

ImageLevel ImageReader::tile() const {
    return impl_->pieces->tile();
}

void ImageReader::read_rows(int level, int y_begin, int y_end, std::span<float> values) {
    impl_->pieces->read_rows(level, y_begin, y_end, values);
}

void ImageReader::read_tile(int level, int x, int y, std::span<float> values) {
    impl_->pieces->read_tile(level, x, y, values);
}

}  // namespace etendue
