#include "denoise/unusable_pixels.h"

#include "core/vec.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace etendue {

namespace {

bool usable(const Planes& planes, int x, int y) {
    for (int plane = 0; plane < planes.count(); ++plane)
        if (!(std::abs(planes.row(plane, y)[x]) <= kLargestUsable)) return false;
    return true;
}

/// Which pixels of an image are usable.
class Mask {
  public:
    Mask(const Planes& whole, const Planes& one_half) : width_(whole.width()), height_(whole.height()) {
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) usable_.push_back(usable(whole, x, y) && usable(one_half, x, y));
    }
    [[nodiscard]] bool operator()(int x, int y) const {
        return usable_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    }
    /// The usable pixels of the smallest square around (x, y) that has any.
    [[nodiscard]] std::vector<Vec2i> nearest(int x, int y) const {
        std::vector<Vec2i> found;
        for (int radius = 1; radius <= kFillRadius && found.empty(); ++radius)
            for (int v = std::max(0, y - radius); v <= std::min(height_ - 1, y + radius); ++v)
                for (int u = std::max(0, x - radius); u <= std::min(width_ - 1, x + radius); ++u)
                    if ((*this)(u, v)) found.emplace_back(u, v);
        return found;
    }

  private:
    int width_;
    int height_;
    std::vector<bool> usable_;
};

void fill(Planes& planes, int x, int y, const std::vector<Vec2i>& sources) {
    for (int plane = 0; plane < planes.count(); ++plane) {
        float sum = 0.0f;
        for (const Vec2i& source : sources) sum += planes.row(plane, source.y)[source.x];
        planes.row(plane, y)[x] = sources.empty() ? 0.0f : sum / static_cast<float>(sources.size());
    }
}

}  // namespace

std::size_t fill_unusable(Planes& whole, Planes& one_half) {
    const Mask is_usable(whole, one_half);
    std::size_t count = 0;
    for (int y = 0; y < whole.height(); ++y) {
        for (int x = 0; x < whole.width(); ++x) {
            if (is_usable(x, y)) continue;
            ++count;
            const std::vector<Vec2i> sources = is_usable.nearest(x, y);
            fill(whole, x, y, sources);
            fill(one_half, x, y, sources);
        }
    }
    return count;
}

void bring_background_near(Planes& whole, Planes& one_half) {
    constexpr float kBehind = 1.1f;
    for (int plane = 0; plane < whole.count(); ++plane) {
        float farthest = 0.0f;
        for (int y = 0; y < whole.height(); ++y)
            std::for_each_n(whole.row(plane, y), whole.width(), [&](float v) {
                if (v < kNothingThere) farthest = std::max(farthest, v);
            });
        for (Planes* planes : {&whole, &one_half})
            for (int y = 0; y < planes->height(); ++y)
                std::for_each_n(planes->row(plane, y), planes->width(), [&](float& v) {
                    if (v >= kNothingThere) v = kBehind * farthest;
                });
    }
}

}  // namespace etendue
