// The search for images of lamps in mirrors and glass, in one region of the film.
#pragma once

#include "core/vec.h"
#include "core/vector_bytes.h"
#include "wave/tile_job.h"
#include "world/world.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// Counts the pixels of the sides of a region, whose corners lie at multiples of it.
inline constexpr int kLampRegion = 32;

/// Holds a square part of the film, in pixels of the full image.
struct FilmCell {
    Vec2f corner{0.0f};  ///< least x and y
    float size = 1.0f;

    [[nodiscard]] Vec2f middle() const { return corner + Vec2f(0.5f * size); }
    [[nodiscard]] float area() const { return size * size; }
    [[nodiscard]] bool contains(const Vec2f& film) const {
        return film.x >= corner.x && film.x < corner.x + size && film.y >= corner.y && film.y < corner.y + size;
    }
};

/// Names a pixel in part of which deltas may show a small lamp.
struct LampPixel {
    Vec2i pixel{0};
    std::uint32_t first_cell = 0;
    std::uint32_t cell_count = 0;
    float area = 0.0f;  ///< area of the cells, square pixels

    /// Returns how many samples the cells get for each of a pixel's own.
    [[nodiscard]] std::uint32_t samples() const { return area < 0.5f ? 2u : 1u; }
};

/// Holds the pixels of a region of the film that show images of lamps, and in which cells.
class LampPixels {
  public:
    /// Adds a pixel with its cells, which lie in it and do not overlap; pixels come row by row.
    void add(const Vec2i& pixel, std::span<const FilmCell> cells);
    void add(const LampPixels& others);

    /// Returns the pixels, row by row.
    [[nodiscard]] std::span<const LampPixel> all() const { return pixels_; }
    /// Returns true if a cell contains `film`, pixels of the full image.
    [[nodiscard]] bool contain(const Vec2f& film) const;
    /// Returns a point that is uniform over the cells of `pixel`, for `u` in [0, 1)².
    [[nodiscard]] Vec2f point(const LampPixel& pixel, Vec2f u) const;
    [[nodiscard]] std::size_t bytes() const { return vector_bytes(pixels_, cells_); }

  private:
    [[nodiscard]] std::span<const FilmCell> cells_of(const LampPixel& pixel) const {
        return std::span(cells_).subspan(pixel.first_cell, pixel.cell_count);
    }

    std::vector<LampPixel> pixels_;
    std::vector<FilmCell> cells_;
};

/// Bounds a lamp.
struct LampSphere {
    Vec3f middle{0.0f};   ///< metres
    float radius = 0.0f;  ///< metres
    double power = 0.0;   ///< watts
};

/// Returns the lamps whose images are looked for; none if nothing mirrors or refracts smoothly.
[[nodiscard]] std::vector<LampSphere> lamps_to_look_for(const World& world);

/// Returns the pixels that show images of `lamps` in the region whose first pixel is `corner`. It depends on the seed
/// and the size of the full image of `whole` besides.
[[nodiscard]] LampPixels find_lamp_pixels(const World& world, const TileJob& whole, std::span<const LampSphere> lamps,
                                          const Vec2i& corner);

}  // namespace etendue
