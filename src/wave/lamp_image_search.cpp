#include "wave/lamp_image_search.h"

#include "sampling/hash.h"
#include "transport/roulette.h"
#include "wave/lamps_by_deltas.h"
#include "world/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace etendue {

namespace {

/// Bounds the lamps that images are looked for; of more, those of the most power.
constexpr std::size_t kMostLamps = 64;
/// Bounds the edges of the paths that are looked along: light of longer ones is dim.
constexpr int kMostEdges = 5;
/// Bounds the throughput of ways that are looked along from below; of dimmer ones, some are.
constexpr float kLeastThroughput = 1.0f / 64.0f;
/// Bounds the throughput of likely ways from below.
constexpr float kLikely = 0.5f;
/// Bounds the width of images by likely ways, pixels: a pixel's own samples meet wider ones well enough.
constexpr float kMostWidth = 0.5f;
/// Bounds the width of images by other ways, pixels: wider ones are as noisy as all else that is seen by these.
constexpr float kMostUnlikelyWidth = 16.0f;
/// Counts the pixels of the sides of a block, with which the search begins.
constexpr int kBlockSide = 4;
/// Gives the size, pixels, down to which cells at the edges of mirrors are divided in any case.
constexpr float kEdgeCell = 0.25f;
/// Bounds the size of cells from below, pixels.
constexpr float kLeastCell = 1.0f / 64.0f;
/// Gives the distance of the rays whose difference is the derivative, in sizes of the cell, or of a pixel if that is
/// smaller.
constexpr float kDifference = 0.02f;
/// Bounds the distance of these rays from below, in widths of the image: sixteen steps of floats.
constexpr float kLeastDifference = 0x1p-19f;
/// Multiplies how far the derivative says that the way moves within a cell, as the way to the lamp is curved.
constexpr float kMargin = 1.5f;
/// Multiplies the margin for cells of several pixels.
constexpr float kBlockMargin = 2.5f;
/// Counts the points of a pixel's cells that are looked at; it shows something if one of them is lit.
constexpr std::uint32_t kLooks = 64;

/// Holds a ray at the end of a way by deltas.
struct DeltaEnd {
    std::uint32_t way = 0;  ///< name of the branch
    Vec3f origin;
    Vec3f direction;
    float throughput = 1.0f;
};

/// Lists the ends of all ways by deltas, but for the camera ray.
struct EndCollector {
    struct NoState {};

    std::vector<DeltaEnd>& ends;

    void visit(const DeltaBranch& branch, NoState, const Vertex&) const {
        if (branch.path.edges > 1)
            ends.push_back({branch.numbers.key.pixel_seed, branch.path.ray.origin, branch.path.ray.direction,
                            max_component(branch.path.throughput) * (kLeastThroughput / kSmallestContribution)});
    }
    [[nodiscard]] static NoState after(NoState state, const Vertex&, const BsdfSample&) { return state; }
};

Vec2i pixel_of(const Vec2f& film) {
    return {static_cast<int>(std::floor(film.x)), static_cast<int>(std::floor(film.y))};
}

/// Looks for images of lamps in the blocks of a region.
class ImageFinder {
  public:
    ImageFinder(const World& world, const TileJob& whole, std::span<const LampSphere> lamps)
        : world_(world), whole_(whole), lamps_(lamps) {}

    /// Returns the pixels that show images in the region at `corner`.
    [[nodiscard]] LampPixels look_at(const Vec2i& corner) {
        const Vec2f first(static_cast<float>(corner.x), static_cast<float>(corner.y));
        constexpr std::size_t kBlocks = kLampRegion / kBlockSide;
        find_ways(first, kBlocks, kBlocks, kBlockSide);
        const std::vector<std::uint32_t> ways = ways_;
        const auto corner_of = [&](std::size_t block) {
            const std::size_t row = block / kBlocks;
            return first +
                   Vec2f(static_cast<float>(block % kBlocks), static_cast<float>(row)) * static_cast<float>(kBlockSide);
        };
        for (std::size_t block = 0; block < kBlocks * kBlocks; ++block)
            if (is_even(ways, kBlocks, block % kBlocks, block / kBlocks))
                divide({corner_of(block), kBlockSide}, false);
            else
                look_at_uneven(corner_of(block));
        return collect();
    }

  private:
    /// Says what is known of a part of the film.
    enum class Shows { Nothing, Parts, Lamp };

    /// Names the ways through the corners of `columns` × `rows` squares, row by row, and after these through their
    /// middles; 0 where there are none.
    void find_ways(const Vec2f& corner, std::size_t columns, std::size_t rows, float size) {
        points_.clear();
        const auto add = [&](std::size_t x, std::size_t y, float beside) {
            points_.push_back(corner + Vec2f(static_cast<float>(x) + beside, static_cast<float>(y) + beside) * size);
        };
        for (std::size_t y = 0; y <= rows; ++y)
            for (std::size_t x = 0; x <= columns; ++x) add(x, y, 0.0f);
        for (std::size_t y = 0; y < rows; ++y)
            for (std::size_t x = 0; x < columns; ++x) add(x, y, 0.5f);
        const std::size_t count = points_.size();
        film_.resize(count);
        for (std::size_t i = 0; i < count; ++i) film_[i] = on_film(whole_, points_[i]);
        rays_.resize(count);
        hits_.assign(count, {});
        world_.camera().generate_rays(film_, std::vector(count, Vec2f(0.5f)), std::vector(count, kMidShutter), rays_);
        world_.geometry().intersect(rays_, hits_, Coherence::Coherent, QueryForm::Best, RayEnds::AtCamera);
        ways_.assign(count, 0);
        for (std::size_t i = 0; i < count; ++i)
            if (hits_[i].valid() && world_.materials().at(hits_[i])->is_specular) {
                find_ends(points_[i], ends_);
                for (const DeltaEnd& end : ends_) ways_[i] = hash_combine(ways_[i], end.way);
            }
    }
    /// Returns whether the ways are the same through the corners and the middle of a square.
    [[nodiscard]] bool is_even(const std::vector<std::uint32_t>& ways, std::size_t columns, std::size_t x,
                               std::size_t y) const {
        const std::size_t rows = (ways.size() - columns - 1) / (2 * columns + 1);
        const std::size_t corner = y * (columns + 1) + x;
        const std::uint32_t middle = ways[(rows + 1) * (columns + 1) + y * columns + x];
        return ways[corner] == middle && ways[corner + 1] == middle && ways[corner + columns + 1] == middle &&
               ways[corner + columns + 2] == middle;
    }
    /// Looks at a block, some of whose pixels lie at the edges of mirrors, and at these more closely.
    void look_at_uneven(const Vec2f& corner) {
        find_ways(corner, kBlockSide, kBlockSide, 1.0f);
        const std::vector<std::uint32_t> ways = ways_;
        for (std::size_t y = 0; y < kBlockSide; ++y)
            for (std::size_t x = 0; x < kBlockSide; ++x)
                divide({corner + Vec2f(static_cast<float>(x), static_cast<float>(y)), 1.0f},
                       !is_even(ways, kBlockSide, x, y));
    }
    /// Puts the parts of `cell` that may show a lamp into the list, each about as wide as that. At the edge of a mirror
    /// the middle says little of a cell.
    void divide(const FilmCell& cell, bool is_at_edge) {
        Shows shows = is_at_edge && cell.size > kEdgeCell ? Shows::Parts : look_through(cell);
        if (shows == Shows::Nothing) return;
        if (shows == Shows::Lamp && cell.size <= 1.0f) return cells_.push_back(cell);
        const float half = 0.5f * cell.size;
        for (const Vec2f& part : {Vec2f(0.0f, 0.0f), Vec2f(half, 0.0f), Vec2f(0.0f, half), Vec2f(half, half)})
            divide({cell.corner + part, half}, is_at_edge);
    }
    [[nodiscard]] Shows look_through(const FilmCell& cell) {
        const Vec2f middle = cell.middle();
        const float difference =
            std::max(kDifference * std::min(cell.size, 1.0f), kLeastDifference * static_cast<float>(whole_.full_width));
        const Vec2f beside = middle + Vec2f(difference);
        const float margin = cell.size > 1.0f ? kMargin * kBlockMargin : kMargin;
        find_ends(middle, ends_);
        if (ends_.empty()) return Shows::Nothing;
        find_ends({beside.x, middle.y}, ends_right_);
        find_ends({middle.x, beside.y}, ends_below_);
        Shows shows = Shows::Nothing;
        for (const DeltaEnd& end : ends_) {
            const DeltaEnd* const right = find(ends_right_, end.way);
            const DeltaEnd* const below = find(ends_below_, end.way);
            if (right == nullptr || below == nullptr) continue;
            for (const LampSphere& lamp : lamps_) {
                if (!(dot(lamp.middle - end.origin, end.direction) > 0.0f)) continue;
                const Vec3f miss = missed_by(end, end, lamp);
                const float dx = length(missed_by(*right, end, lamp) - miss) / (beside.x - middle.x);
                const float dy = length(missed_by(*below, end, lamp) - miss) / (beside.y - middle.y);
                const float sweep = std::hypot(dx, dy);  // metres per pixel
                const float within = margin * sweep * cell.size * std::numbers::sqrt2_v<float> / 2.0f;
                const float most_width = end.throughput > kLikely ? kMostWidth : kMostUnlikelyWidth;
                if (!(length(miss) <= lamp.radius + within) || lamp.radius > most_width * sweep) continue;
                if (cell.size > kLeastCell && within > kMargin * 0.5f * lamp.radius) return Shows::Parts;
                shows = Shows::Lamp;
            }
        }
        return shows;
    }
    /// Returns the pixels of the cells that show light.
    [[nodiscard]] LampPixels collect() {
        LampPixels all;
        const auto place = [](const FilmCell& cell) {
            const Vec2i pixel = pixel_of(cell.corner);
            return std::pair(pixel.y, pixel.x);
        };
        std::ranges::stable_sort(cells_, {}, place);
        for (std::size_t first = 0, end = 0; first < cells_.size(); first = end) {
            while (end < cells_.size() && place(cells_[end]) == place(cells_[first])) ++end;
            const Vec2i pixel = pixel_of(cells_[first].corner);
            LampPixels found;
            found.add(pixel, std::span(cells_).subspan(first, end - first));
            if (shows_light(found)) all.add(found);
        }
        return all;
    }
    /// Returns how far `end` passes the middle of `lamp`, metres across the way that `reference` takes.
    [[nodiscard]] static Vec3f missed_by(const DeltaEnd& end, const DeltaEnd& reference, const LampSphere& lamp) {
        const Vec3f to_middle = lamp.middle - end.origin;
        const float along = dot(to_middle, reference.direction) / dot(end.direction, reference.direction);
        return to_middle - end.direction * along;
    }
    void find_ends(const Vec2f& film, std::vector<DeltaEnd>& ends) {
        ends.clear();
        EndCollector collector{ends};
        const Ray ray = world_.camera().generate_ray(on_film(whole_, film), Vec2f(0.5f, 0.5f), kMidShutter);
        DeltaBranch branch = branch_along(world_, whole_, ray, {whole_.seed, 0}, nullptr);
        branch.path.throughput = Rgb(kSmallestContribution / kLeastThroughput);
        follow_deltas(world_, branch, EndCollector::NoState{}, kMostEdges, collector);
    }
    [[nodiscard]] static const DeltaEnd* find(const std::vector<DeltaEnd>& ends, std::uint32_t way) {
        const auto found = std::ranges::find(ends, way, &DeltaEnd::way);
        return found != ends.end() ? &*found : nullptr;
    }
    [[nodiscard]] bool shows_light(const LampPixels& found) const {
        std::vector<LampSeen> seen;
        PathWords none;
        for (std::uint32_t i = 0; i < kLooks && seen.empty(); ++i) {
            const SampleKey key{whole_.seed, i};
            const Vec2f film = found.point(found.all().front(), sample_2d(whole_.sequence, key, kFilmDimension));
            look_for_lamps(world_, branch_through(world_, whole_, film, key, nullptr), {.max_depth = kMostEdges}, none,
                           seen);
        }
        return !seen.empty();
    }

    const World& world_;
    const TileJob& whole_;
    std::span<const LampSphere> lamps_;
    std::vector<DeltaEnd> ends_, ends_right_, ends_below_;
    std::vector<FilmCell> cells_;  ///< cells that may show lamps
    // Of `find_ways`.
    std::vector<Vec2f> points_, film_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<std::uint32_t> ways_;
};

}  // namespace

void LampPixels::add(const Vec2i& pixel, std::span<const FilmCell> cells) {
    float area = 0.0f;
    for (const FilmCell& cell : cells) area += cell.area();
    pixels_.push_back(
        {pixel, static_cast<std::uint32_t>(cells_.size()), static_cast<std::uint32_t>(cells.size()), area});
    cells_.insert(cells_.end(), cells.begin(), cells.end());
}

void LampPixels::add(const LampPixels& others) {
    for (const LampPixel& pixel : others.pixels_) add(pixel.pixel, others.cells_of(pixel));
}

bool LampPixels::contain(const Vec2f& film) const {
    const auto place = [](const Vec2i& pixel) { return std::pair(pixel.y, pixel.x); };
    const Vec2i wanted = pixel_of(film);
    const auto found = std::ranges::lower_bound(pixels_, place(wanted), {},
                                                [&](const LampPixel& pixel) { return place(pixel.pixel); });
    return found != pixels_.end() && found->pixel == wanted &&
           std::ranges::any_of(cells_of(*found), [&](const FilmCell& cell) { return cell.contains(film); });
}

Vec2f LampPixels::point(const LampPixel& pixel, Vec2f u) const {
    const std::span<const FilmCell> cells = cells_of(pixel);
    float left = u.x * pixel.area;
    std::size_t i = 0;
    for (; i + 1 < cells.size() && left >= cells[i].area(); ++i) left -= cells[i].area();
    const float x = std::min(left / cells[i].area(), std::nextafter(1.0f, 0.0f));
    return cells[i].corner + Vec2f(x, u.y) * cells[i].size;
}

std::vector<LampSphere> lamps_to_look_for(const World& world) {
    std::vector<LampSphere> spheres;
    if (!world.traits().has_specular_surfaces || !world.traits().has_emitting_surfaces) return spheres;
    for (std::uint32_t light = 0; light < world.lights().count(); ++light) {
        if (!world.lights().can_be_hit(light)) continue;
        const std::optional<LightBounds> bounds = world.lights().bounds(light);
        if (!bounds || !(bounds->power > 0.0)) continue;
        const float radius = 0.5f * length(bounds->box.size());
        if (radius > 0.0f) spheres.push_back({bounds->box.center(), radius, bounds->power});
    }
    std::ranges::stable_sort(spheres, std::ranges::greater{}, &LampSphere::power);
    if (spheres.size() > kMostLamps) spheres.resize(kMostLamps);
    return spheres;
}

LampPixels find_lamp_pixels(const World& world, const TileJob& whole, std::span<const LampSphere> lamps,
                            const Vec2i& corner) {
    return ImageFinder(world, whole, lamps).look_at(corner);
}

}  // namespace etendue
