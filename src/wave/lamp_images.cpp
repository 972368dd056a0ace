#include "wave/lamp_images.h"

#include "sampling/hash.h"
#include "transport/roulette.h"
#include "transport/scattered_cone.h"
#include "wave/ray_batch.h"

#include <algorithm>
#include <array>
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
/// Bounds the width of images, pixels: a pixel's own samples meet wider ones well enough by a likely way, and by
/// others.
constexpr float kMostWidth = 0.5f;
constexpr float kMostUnlikelyWidth = 16.0f;
/// Counts the pixels of the sides of a block, with which the search begins.
constexpr int kBlockSide = 4;
/// Is the size of cells, pixels, down to which pixels at the edges of mirrors are divided in any case.
constexpr float kEdgeCell = 0.25f;
/// Bounds the size of cells from below, pixels.
constexpr float kLeastCell = 1.0f / 64.0f;
/// Pixels between the rays whose difference is the derivative, in sizes of the cell, up to that of a pixel.
constexpr float kDifference = 0.02f;
/// Multiplies how far the derivative says that the way moves within a cell, as the way to the lamp is curved.
constexpr float kMargin = 1.5f;
/// Multiplies the margin for cells of several pixels.
constexpr float kBlockMargin = 2.5f;
/// Bounds the trees that the edges of mirrors are looked at with, for each pixel of the image.
constexpr std::size_t kTreesPerPixel = 1;
/// Counts the points of a pixel's cells that are looked at; it shows something if one of them is lit.
constexpr std::uint32_t kLooks = 64;

Vec2f on_film(const TileJob& job, const Vec2f& film) {
    return {film.x / static_cast<float>(job.full_width), film.y / static_cast<float>(job.full_height)};
}

DeltaBranch branch_along(const World& world, const TileJob& job, const Ray& ray, SampleKey key, SampleTracer* tracer) {
    const EyeSample sample{.ray = ray,
                           .cone = camera_cone(world, job.full_width, job.full_height, ray),
                           .numbers = {job.sequence, key},
                           .tracer = tracer};
    return {begin_at_eye(world, sample), sample.numbers};
}

struct LampSphere {
    Vec3f middle;
    float radius = 0.0f;
    double power = 0.0;
};

std::vector<LampSphere> lamp_spheres(const World& world) {
    std::vector<LampSphere> spheres;
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

/// Looks for images of lamps in blocks of pixels, a row of them after the other.
class ImageFinder {
  public:
    ImageFinder(const World& world, const TileJob& whole, const std::vector<LampSphere>& lamps)
        : world_(world), whole_(whole), lamps_(lamps) {}

    /// Adds to `images` the pixels that show some in the row of blocks from `top` on.
    void look_at_blocks(int top, LampImages& images) {
        cells_.clear();
        trees_ = 0;
        const auto width = static_cast<std::size_t>(whole_.full_width);
        const std::size_t columns = (width + kBlockSide - 1) / kBlockSide;
        find_ways(Vec2f(0.0f, static_cast<float>(top)), columns, 1, kBlockSide);
        const std::vector<std::uint32_t> ways = ways_;
        std::vector<std::size_t> uneven;
        for (std::size_t block = 0; block < columns; ++block) {
            const FilmCell cell{{static_cast<float>(block * kBlockSide), static_cast<float>(top)}, kBlockSide};
            if (is_even(ways, columns, block, 0))
                divide(cell, false);
            else
                uneven.push_back(block);
        }
        // Where all is edges, some are looked at, wherever they are.
        std::ranges::sort(uneven, {}, [](std::size_t block) { return hash_u32(static_cast<std::uint32_t>(block)); });
        for (const std::size_t block : uneven)
            look_at_uneven({static_cast<float>(block * kBlockSide), static_cast<float>(top)},
                           trees_ < kTreesPerPixel * width * kBlockSide);
        collect(images);
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
        world_.camera().generate_rays(film_, std::vector(count, Vec2f(0.5f)), std::vector(count, 0.5f), rays_);
        world_.geometry().intersect(rays_, hits_, Coherence::Coherent, QueryForm::Best, RayEnds::AtCamera);
        ways_.assign(count, 0);
        for (std::size_t i = 0; i < count; ++i)
            if (hits_[i].valid() && is_specular(*world_.materials().at(hits_[i]))) {
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
    /// Looks at a block, some of whose pixels lie at the edges of mirrors, at these more closely if it `looks_closely`.
    void look_at_uneven(const Vec2f& corner, bool looks_closely) {
        if (!looks_closely) return divide({corner, kBlockSide}, false);
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
        const float difference = kDifference * std::min(cell.size, 1.0f);
        const float margin = cell.size > 1.0f ? kMargin * kBlockMargin : kMargin;
        find_ends(middle, ends_);
        if (ends_.empty()) return Shows::Nothing;
        find_ends(middle + Vec2f(difference, 0.0f), ends_right_);
        find_ends(middle + Vec2f(0.0f, difference), ends_below_);
        Shows shows = Shows::Nothing;
        for (const DeltaEnd& end : ends_) {
            const DeltaEnd* const right = find(ends_right_, end.way);
            const DeltaEnd* const below = find(ends_below_, end.way);
            if (right == nullptr || below == nullptr) continue;
            for (const LampSphere& lamp : lamps_) {
                if (!(dot(lamp.middle - end.origin, end.direction) > 0.0f)) continue;
                const Vec3f miss = missed_by(end, end, lamp);
                const float dx = length(missed_by(*right, end, lamp) - miss);
                const float dy = length(missed_by(*below, end, lamp) - miss);
                const float sweep = std::hypot(dx, dy) / difference;  // metres per pixel
                const float within = margin * sweep * cell.size * std::numbers::sqrt2_v<float> / 2.0f;
                const float most_width = end.throughput > kLikely ? kMostWidth : kMostUnlikelyWidth;
                if (!(length(miss) <= lamp.radius + within) || lamp.radius > most_width * sweep) continue;
                if (cell.size > kLeastCell && within > kMargin * 0.5f * lamp.radius) return Shows::Parts;
                shows = Shows::Lamp;
            }
        }
        return shows;
    }
    /// Adds the pixels of the cells that show light to `images`.
    void collect(LampImages& images) {
        const auto place = [](const FilmCell& cell) {
            const Vec2i pixel = pixel_of(cell.corner);
            return std::pair(pixel.y, pixel.x);
        };
        std::ranges::stable_sort(cells_, {}, place);
        for (std::size_t first = 0, end = 0; first < cells_.size(); first = end) {
            while (end < cells_.size() && place(cells_[end]) == place(cells_[first])) ++end;
            const Vec2i pixel = pixel_of(cells_[first].corner);
            if (pixel.x >= whole_.full_width || pixel.y >= whole_.full_height) continue;
            LampImages found;
            found.add(pixel, std::span(cells_).subspan(first, end - first));
            if (shows_light(found)) images.add(found);
        }
    }
    /// Returns how far `end` passes the middle of `lamp`, metres across the way that `reference` takes.
    [[nodiscard]] static Vec3f missed_by(const DeltaEnd& end, const DeltaEnd& reference, const LampSphere& lamp) {
        const Vec3f to_middle = lamp.middle - end.origin;
        const float along = dot(to_middle, reference.direction) / dot(end.direction, reference.direction);
        return to_middle - end.direction * along;
    }
    void find_ends(const Vec2f& film, std::vector<DeltaEnd>& ends) {
        ++trees_;
        ends.clear();
        EndCollector collector{ends};
        const Ray ray = world_.camera().generate_ray(on_film(whole_, film), Vec2f(0.5f, 0.5f), 0.5f);
        DeltaBranch branch = branch_along(world_, whole_, ray, {whole_.seed, 0}, nullptr);
        branch.path.throughput = Rgb(kSmallestContribution / kLeastThroughput);
        follow_deltas(world_, branch, EndCollector::NoState{}, kMostEdges, collector);
    }
    [[nodiscard]] static const DeltaEnd* find(const std::vector<DeltaEnd>& ends, std::uint32_t way) {
        const auto found = std::ranges::find(ends, way, &DeltaEnd::way);
        return found != ends.end() ? &*found : nullptr;
    }
    [[nodiscard]] bool shows_light(const LampImages& images) const {
        std::vector<LampSeen> seen;
        PathWords none;
        for (std::uint32_t i = 0; i < kLooks && seen.empty(); ++i) {
            const SampleKey key{whole_.seed, i};
            const Vec2f film = images.point(images.pixels().front(), sample_2d(whole_.sequence, key, kFilmDimension));
            look_for_lamps(world_, branch_through(world_, whole_, film, key, nullptr), {.max_depth = kMostEdges}, none,
                           seen);
        }
        return !seen.empty();
    }

    const World& world_;
    const TileJob& whole_;
    const std::vector<LampSphere>& lamps_;
    std::vector<DeltaEnd> ends_, ends_right_, ends_below_;
    std::vector<FilmCell> cells_;  ///< of a row of blocks
    std::size_t trees_ = 0;        ///< that were followed for it
    // Of `find_ways`.
    std::vector<Vec2f> points_, film_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<std::uint32_t> ways_;
};

}  // namespace

void LampImages::add(const Vec2i& pixel, std::span<const FilmCell> cells) {
    float area = 0.0f;
    for (const FilmCell& cell : cells) area += cell.area();
    pixels_.push_back(
        {pixel, static_cast<std::uint32_t>(cells_.size()), static_cast<std::uint32_t>(cells.size()), area});
    cells_.insert(cells_.end(), cells.begin(), cells.end());
}

void LampImages::add(const LampImages& others) {
    for (const LampPixel& pixel : others.pixels_) add(pixel.pixel, others.cells_of(pixel));
}

std::span<const LampPixel> LampImages::rows(int top, int bottom) const {
    const auto row = [](const LampPixel& pixel) { return pixel.pixel.y; };
    const auto first = std::ranges::lower_bound(pixels_, top, {}, row);
    const auto last = std::ranges::lower_bound(pixels_, bottom, {}, row);
    return first < last ? std::span(first, last) : std::span<const LampPixel>();
}

bool LampImages::contain(const Vec2f& film) const {
    const Vec2i pixel = pixel_of(film);
    const std::span<const LampPixel> row = rows(pixel.y, pixel.y + 1);
    const auto found = std::ranges::lower_bound(row, pixel.x, {}, [](const LampPixel& p) { return p.pixel.x; });
    return found != row.end() && found->pixel.x == pixel.x &&
           std::ranges::any_of(cells_of(*found), [&](const FilmCell& cell) { return cell.contains(film); });
}

Vec2f LampImages::point(const LampPixel& pixel, Vec2f u) const {
    const std::span<const FilmCell> cells = cells_of(pixel);
    float left = u.x * pixel.area;
    std::size_t i = 0;
    for (; i + 1 < cells.size() && left >= cells[i].area(); ++i) left -= cells[i].area();
    const float x = std::min(left / cells[i].area(), std::nextafter(1.0f, 0.0f));
    return cells[i].corner + Vec2f(x, u.y) * cells[i].size;
}

LampImages find_lamp_images(const World& world, const TileJob& whole, const ThreadPool& threads) {
    LampImages images;
    if (!world.traits().has_specular_surfaces || !world.traits().has_emitting_surfaces) return images;
    const std::vector<LampSphere> lamps = lamp_spheres(world);
    if (lamps.empty()) return images;
    std::vector<LampImages> rows(static_cast<std::size_t>((whole.full_height + kBlockSide - 1) / kBlockSide));
    threads.parallel_for(rows.size(), [&](std::size_t row, int) {
        ImageFinder finder(world, whole, lamps);
        finder.look_at_blocks(static_cast<int>(row) * kBlockSide, rows[row]);
    });
    for (const LampImages& row : rows) images.add(row);
    return images;
}

DeltaBranch branch_through(const World& world, const TileJob& job, const Vec2f& film, SampleKey key,
                           SampleTracer* tracer) {
    const SampleNumbers numbers{job.sequence, key};
    const Vec2f lens = world.traits().has_lens ? numbers.pair(kLensDimension) : Vec2f(0.0f);
    const float time =
        world.traits().has_motion ? SampleNumbers{job.sequence, shared_key(job, key)}.pair(kTimeDimension).x : 0.0f;
    Ray ray = world.camera().generate_ray(on_film(job, film), lens, time);
    ray.alpha_key = numbers.bits(kCameraAlphaDimension);
    return branch_along(world, job, ray, key, tracer);
}

namespace {

/// Holds what a branch has passed.
struct WayPassed {
    WordRange words;
    Vec3f first_position{0.0f};
    bool has_first = false;
};

/// Collects the lamps that branches meet.
struct LampCollector {
    const World& world;
    const PathLengths& lengths;
    PathWords& words;
    std::vector<LampSeen>& seen;
    std::vector<ExpressionShare> shares{};

    void visit(const DeltaBranch& branch, const WayPassed& way, const Vertex& vertex) {
        const EyePath& path = branch.path;
        if (path.edges < std::max(lengths.min_depth, 2) || vertex.surface.material == nullptr ||
            !vertex.surface.material->emits)
            return;
        const Rgb light = path.throughput * world.materials().emission(vertex.surface, vertex.wo);
        if (is_black(light) || !is_finite(light)) return;
        shares.clear();
        if (words.are_followed()) words.end_at_light(way.words, words.surface_source(vertex.surface), shares);
        Rgb left = Rgb(1.0f);
        for (const ExpressionShare& share : shares) {
            seen.push_back({light * share.share, share.expressions, way.first_position});
            left -= share.share;
        }
        if (shares.empty() || max_component(left) > 1e-4f) seen.push_back({light * left, 0, way.first_position});
    }
    [[nodiscard]] WayPassed after(WayPassed way, const Vertex& vertex, const BsdfSample& delta) const {
        if (!way.has_first) way.first_position = vertex.position;
        way.has_first = true;
        if (!words.are_followed() || (vertex.surface.material->is_pane && delta.is_transmission)) return way;
        way.words = words.scatter_from_eye(way.words,
                                           surface_event(vertex.scattering(), delta.wi, true, TransportMode::Radiance,
                                                         words.label(world, vertex.surface)));
        return way;
    }
};

/// Traces and counts the rays of samples of images.
class ImageTracer final : public SampleTracer {
  public:
    ImageTracer(const World& world, const TileJob& job, RenderCounters& counters)
        : world_(world), job_(job), counters_(counters) {}

    [[nodiscard]] Hit nearest_hit(const Ray& ray, int /*number*/) override {
        return intersect_one(world_, job_, RayKind::LampImage, ray, counters_);
    }
    [[nodiscard]] std::uint8_t occluded(const Ray& ray) override {
        return occluded_one(world_, job_, RayKind::LampImage, ray, counters_);
    }
    [[nodiscard]] bool finds_emission(const Hit&) const override { return false; }

  private:
    const World& world_;
    const TileJob& job_;
    RenderCounters& counters_;
};

}  // namespace

void look_for_lamps(const World& world, const DeltaBranch& branch, const PathLengths& lengths, PathWords& words,
                    std::vector<LampSeen>& seen) {
    const std::size_t words_before = words.size();
    LampCollector collector{world, lengths, words, seen};
    WayPassed start;
    if (words.are_followed()) start.words = words.begin_at_eye();
    follow_deltas(world, branch, start, lengths.max_depth, collector);
    words.shrink_to(words_before);
}

void LampImageSampler::start(const World& world, const TileJob& job, const PathLengths& lengths) {
    world_ = &world;
    job_ = &job;
    lengths_ = lengths;
    images_ = job.lamp_images != nullptr && !job.lamp_images->empty() ? job.lamp_images : nullptr;
    words_.reset(job.aovs);
}

void LampImageSampler::sample(std::uint32_t first, std::uint32_t end, const HasSample& has_sample, const Add& add,
                              RenderCounters& counters) {
    ImageTracer tracer(*world_, *job_, counters);
    const PixelFilter& filter = *job_->filter;
    const float radius = filter.radius();
    const int beyond = static_cast<int>(std::ceil(radius + 0.5f));
    const PixelRect& rect = job_->rect;
    for (const LampPixel& image : images_->rows(rect.y0 - beyond, rect.y1 + beyond)) {
        if (image.pixel.x < rect.x0 - beyond || image.pixel.x >= rect.x1 + beyond) continue;
        const std::uint32_t seed = hash_u32(make_pixel_seed(job_->seed, static_cast<std::uint32_t>(image.pixel.x),
                                                            static_cast<std::uint32_t>(image.pixel.y)));
        for (std::uint32_t index = first; index < end; ++index)
            for (std::uint32_t round = 0; round < image.samples(); ++round) {
                const SampleKey key{seed, index * image.samples() + round};
                const Vec2f film = images_->point(image, sample_2d(job_->sequence, key, kFilmDimension));
                const PixelRect around{static_cast<int>(std::ceil(film.x - radius - 0.5f)),
                                       static_cast<int>(std::ceil(film.y - radius - 0.5f)),
                                       static_cast<int>(std::floor(film.x + radius - 0.5f)) + 1,
                                       static_cast<int>(std::floor(film.y + radius - 0.5f)) + 1};
                const PixelRect pixels = intersection(around, rect);
                if (pixels.empty()) continue;
                seen_.clear();
                look_for_lamps(*world_, branch_through(*world_, *job_, film, key, &tracer), lengths_, words_, seen_);
                if (seen_.empty()) continue;
                const float share = image.area / static_cast<float>(image.samples());
                for (int y = pixels.y0; y < pixels.y1; ++y)
                    for (int x = pixels.x0; x < pixels.x1; ++x) {
                        if (!has_sample({x, y}, index)) continue;
                        const float scale = share * filter.evaluate(film.x - (static_cast<float>(x) + 0.5f)) *
                                            filter.evaluate(film.y - (static_cast<float>(y) + 0.5f));
                        if (scale == 0.0f) continue;
                        for (const LampSeen& seen : seen_) add({x, y}, index, seen, seen.light * scale);
                    }
            }
    }
}

}  // namespace etendue
