#include "film/film.h"

namespace etendue {

Film::Film(int full_width, int full_height, const PixelRect& window)
    : full_width_(full_width), full_height_(full_height), window_(window), pixels_(window.area()) {}

void Film::add(const TileBuffer& tile) {
    const PixelRect& rect = tile.rect();
    std::size_t source = 0;
    for (int y = rect.y0; y < rect.y1; ++y) {
        std::size_t target = static_cast<std::size_t>(y - window_.y0) * static_cast<std::size_t>(window_.width()) +
                             static_cast<std::size_t>(rect.x0 - window_.x0);
        for (int x = rect.x0; x < rect.x1; ++x, ++source, ++target) {
            const PixelSum& from = tile.pixel(source);
            PixelSum& to = pixels_[target];
            to.r += from.r;
            to.g += from.g;
            to.b += from.b;
            to.alpha += from.alpha;
            to.samples += from.samples;
        }
    }
}

std::vector<float> Film::resolve() const {
    std::vector<float> image;
    image.reserve(pixels_.size() * 4);
    for (const PixelSum& p : pixels_) {
        const double scale = p.samples > 0 ? 1.0 / static_cast<double>(p.samples) : 0.0;
        for (const double sum : {p.r, p.g, p.b, p.alpha}) image.push_back(static_cast<float>(sum * scale));
    }
    return image;
}

std::uint64_t Film::sample_count() const {
    std::uint64_t count = 0;
    for (const PixelSum& p : pixels_) count += p.samples;
    return count;
}

}  // namespace etendue
