#include "wave/lamp_images.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace etendue {

namespace {

/// Returns which region along one axis `pixel` lies in.
int region_of(int pixel) {
    static_assert(std::has_single_bit(static_cast<unsigned>(kLampRegion)));
    return pixel >> std::countr_zero(static_cast<unsigned>(kLampRegion));  // rounds down
}

/// Returns the columns and rows of regions that cover `rect`.
PixelRect regions_around(const PixelRect& rect) {
    return {region_of(rect.x0), region_of(rect.y0), region_of(rect.x1 - 1) + 1, region_of(rect.y1 - 1) + 1};
}

}  // namespace

LampImages::LampImages(const World& world, const TileJob& whole, const PixelRect& window)
    : world_(world), whole_(whole), lamps_(lamps_to_look_for(world)) {
    if (lamps_.empty()) return;
    regions_ = regions_around(window);
    all_ = std::make_unique<Region[]>(regions_.area());
}

const LampPixels& LampImages::region(int x, int y) const {
    const auto row = static_cast<std::size_t>(y - regions_.y0);
    Region& region = all_[row * static_cast<std::size_t>(regions_.width()) + static_cast<std::size_t>(x - regions_.x0)];
    std::call_once(region.once, [&] {
        region.found = find_lamp_pixels(world_, whole_, lamps_, {x * kLampRegion, y * kLampRegion});
        found_bytes_ += region.found.bytes();
    });
    return region.found;
}

bool LampImages::contain(const Vec2f& film) const {
    const int x = region_of(static_cast<int>(std::floor(film.x)));
    const int y = region_of(static_cast<int>(std::floor(film.y)));
    return regions_.contains(x, y) && region(x, y).contain(film);
}

void LampImages::for_each_in(const PixelRect& rect,
                             const std::function<void(const LampPixels&, const LampPixel&)>& visit) const {
    const PixelRect asked = intersection(regions_around(rect), regions_);
    for (int y = asked.y0; y < asked.y1; ++y)
        for (int x = asked.x0; x < asked.x1; ++x) {
            const LampPixels& found = region(x, y);
            for (const LampPixel& pixel : found.all())
                if (rect.contains(pixel.pixel.x, pixel.pixel.y)) visit(found, pixel);
        }
}

std::unique_ptr<const LampImages> find_lamp_images(const World& world, const TileJob& whole, const PixelRect& window) {
    auto images = std::make_unique<const LampImages>(world, whole, window);
    return images->may_exist() ? std::move(images) : nullptr;
}

std::size_t LampImages::bytes() const {
    return sizeof *this + vector_bytes(lamps_) + (all_ ? regions_.area() * sizeof(Region) : 0) + found_bytes_;
}

}  // namespace etendue
