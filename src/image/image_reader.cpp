#include "image/image_reader.h"

#include "image/encoded_image.h"
#include "image/image_functions.h"
#include "image/image_pieces.h"

namespace etendue {

struct ImageReader::Impl {
    std::unique_ptr<ImagePieces> pieces;
};

ImageReader::ImageReader(const ImageSource& source) : impl_(std::make_unique<Impl>()) {
    const EncodedImage image = look_at(source);
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
