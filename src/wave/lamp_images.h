// Images of small lamps in mirrors and behind smooth glass (E S+ L).
//
// No strategy but s = 0 makes such paths, and a pixel's own samples rarely meet a lamp that is small on the film: its
// image would be a few fireflies. So the film is searched once for all samples: where the way that a ray takes by
// deltas passes a lamp closely, as measured by how fast it sweeps past, the pixel is divided into ever smaller cells,
// down to the size of the lamp's image. Within the cells that are left, samples of their own find the lamps that deltas
// show, and a pixel's samples leave them alone: both parts of the film are sampled without bias, however well the cells
// fit.
#pragma once

#include "core/parallel.h"
#include "core/vec.h"
#include "core/vector_bytes.h"
#include "scene/integrator_settings.h"
#include "transport/delta_tree.h"
#include "wave/aov/path_words.h"
#include "wave/render_counters.h"
#include "wave/tile_job.h"
#include "world/world.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace etendue {

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

/// Holds the parts of a render's film in which deltas may show small lamps.
class LampImages {
  public:
    /// Adds a pixel with its cells, which lie in it and do not overlap; pixels come row by row.
    void add(const Vec2i& pixel, std::span<const FilmCell> cells);
    void add(const LampImages& others);

    [[nodiscard]] bool empty() const { return pixels_.empty(); }
    /// Returns the pixels, row by row.
    [[nodiscard]] std::span<const LampPixel> pixels() const { return pixels_; }
    /// Returns those in the rows [top, bottom).
    [[nodiscard]] std::span<const LampPixel> rows(int top, int bottom) const;
    /// Returns true if a cell contains `film`.
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

/// Returns the images that the film of `whole`, a job of the full image, shows of lamps, whatever the lengths of paths
/// are. They depend on the seed, and neither on the window nor on the threads.
[[nodiscard]] LampImages find_lamp_images(const World& world, const TileJob& whole, const ThreadPool& threads);

/// Holds the light of a lamp that a point of the film shows by way of deltas.
struct LampSeen {
    Rgb light;                       ///< W/(m² sr)
    ExpressionMask expressions = 0;  ///< of which it is a part
    Vec3f first_position{0.0f};      ///< metres, what the camera ray has met
};

/// Returns the tree of the ray through `film`, pixels of the full image of `job`, whose lens point and time `key`
/// draws; `tracer` may be null.
[[nodiscard]] DeltaBranch branch_through(const World& world, const TileJob& job, const Vec2f& film, SampleKey key,
                                         SampleTracer* tracer);

/// Appends to `seen` the lamps that `branch`, of a camera ray, shows by paths of `lengths` with at least one delta.
void look_for_lamps(const World& world, const DeltaBranch& branch, const PathLengths& lengths, PathWords& words,
                    std::vector<LampSeen>& seen);

/// Samples the images of lamps for one tile after the other.
class LampImageSampler {
  public:
    /// Hears that the sample of index `sample` of `pixel`, of the tile, is to have `light` of what `seen` tells.
    using Add = std::function<void(const Vec2i& pixel, std::uint32_t sample, const LampSeen& seen, const Rgb& light)>;
    /// True if the job takes the sample of this index of a pixel of the full image.
    using HasSample = std::function<bool(const Vec2i& pixel, std::uint32_t sample)>;

    /// Starts a job, which must outlive the call of `sample`, for paths of `lengths`.
    void start(const World& world, const TileJob& job, const PathLengths& lengths);
    [[nodiscard]] bool is_active() const { return images_ != nullptr; }
    /// Returns true if the lamps that deltas show at `film`, pixels of the full image, are found here.
    [[nodiscard]] bool finds(const Vec2f& film) const { return is_active() && images_->contain(film); }
    /// Draws the samples of all images whose light falls into the tile, for the samples [first, end) of its pixels.
    void sample(std::uint32_t first, std::uint32_t end, const HasSample& has_sample, const Add& add,
                RenderCounters& counters);

  private:
    const World* world_ = nullptr;
    const TileJob* job_ = nullptr;
    PathLengths lengths_;
    const LampImages* images_ = nullptr;  ///< null if there are none
    PathWords words_;
    std::vector<LampSeen> seen_;
};

}  // namespace etendue
