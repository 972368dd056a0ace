#include "wave/lamp_images.h"

#include "sampling/hash.h"
#include "transport/scattered_cone.h"
#include "wave/ray_batch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace etendue {

namespace {

/// Bounds the lamps that images are looked for; of more, those of the most power.
constexpr std::size_t kMostLamps = 64;
/// Bounds the edges of the paths that are looked along: light of longer ones is dim.
constexpr int kMostEdges = 8;
/// Bounds the width of an image, pixels, of which a pixel's own samples that take a likely way meet too little.
constexpr float kMostWidth = 0.5f;
/// Bounds the throughput of likely ways from below.
constexpr float kLikely = 0.5f;
/// Divides the sides of pixels at the edges of mirrors.
constexpr int kEdgeParts = 4;
/// Bounds the size of cells from below, pixels.
constexpr float kLeastCell = 1.0f / 64.0f;
/// Pixels between the rays whose difference is the derivative, in sizes of the cell.
constexpr float kDifference = 0.02f;
/// Multiplies how far the derivative says that the way moves within a cell, as the way to the lamp is curved.
constexpr float kMargin = 1.5f;
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
    for (std::uint32_t light = 0; light < world.light_count(); ++light) {
        if (!world.can_be_hit(light)) continue;
        const std::optional<LightBounds> bounds = world.bounds_of_light(light);
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
                            max_component(branch.path.throughput)});
    }
    [[nodiscard]] static NoState after(NoState state, const Vertex&, const BsdfSample&) { return state; }
};

/// Looks for images of lamps in one pixel after the other.
class ImageFinder {
  public:
    ImageFinder(const World& world, const TileJob& whole, int max_depth, const std::vector<LampSphere>& lamps)
        : world_(world), whole_(whole), max_depth_(std::min(max_depth, kMostEdges)), lamps_(lamps) {}

    /// Adds to `images` the pixels of a row that show some.
    void look_at_row(int y, LampImages& images) {
        points_.clear();
        for (int x = 0; x <= whole_.full_width; ++x)
            for (const Vec2f& of_pixel : {Vec2f(0.0f, 0.0f), Vec2f(0.0f, 1.0f), Vec2f(0.5f, 0.5f)})
                points_.push_back(Vec2f(static_cast<float>(x), static_cast<float>(y)) + of_pixel);
        ways_.resize(points_.size());
        find_mirrors();
        for (std::size_t i = 0; i < points_.size(); ++i) ways_[i] = is_mirror_[i] != 0 ? ways_through(points_[i]) : 0;
        for (int x = 0; x < whole_.full_width; ++x) {
            // Those of the pixel's corners to the left, its middle, and its corners to the right.
            const std::span<const std::uint32_t> ways = std::span(ways_).subspan(3 * static_cast<std::size_t>(x), 5);
            const bool is_even = std::ranges::all_of(ways, [&](std::uint32_t way) { return way == ways[0]; });
            if (!is_even || ways[0] != 0) look_at({x, y}, is_even, images);
        }
    }

  private:
    /// Finds out through which points the eye sees what mirrors or refracts.
    void find_mirrors() {
        const std::size_t count = points_.size();
        film_.resize(count);
        for (std::size_t i = 0; i < count; ++i) film_[i] = on_film(whole_, points_[i]);
        rays_.resize(count);
        hits_.assign(count, {});
        world_.generate_rays(film_, std::vector(count, Vec2f(0.5f)), std::vector(count, 0.5f), rays_);
        world_.intersect(rays_, hits_, Coherence::Coherent);
        is_mirror_.resize(count);
        for (std::size_t i = 0; i < count; ++i)
            is_mirror_[i] = hits_[i].valid() && is_specular(*world_.material(hits_[i])) ? 1 : 0;
    }
    /// Names the ways of the ray through `film`; 0 if there are none.
    [[nodiscard]] std::uint32_t ways_through(const Vec2f& film) {
        find_ends(film, ends_);
        std::uint32_t name = 0;
        for (const DeltaEnd& end : ends_) name = hash_combine(name, end.way);
        return name;
    }
    /// Adds `pixel` if it shows some. At an edge of a mirror it `is_even` no more, and its middle says little of it.
    void look_at(const Vec2i& pixel, bool is_even, LampImages& images) {
        const Vec2f corner(static_cast<float>(pixel.x), static_cast<float>(pixel.y));
        cells_.clear();
        const int parts = is_even ? 1 : kEdgeParts;
        const float size = 1.0f / static_cast<float>(parts);
        for (int part = 0; part < parts * parts; ++part)
            divide({corner + Vec2f(static_cast<float>(part % parts), static_cast<float>(part / parts)) * size, size});
        if (cells_.empty()) return;
        LampImages found;
        found.add(pixel, cells_);
        if (shows_light(found)) images.add(found);
    }

    /// Says what is known of a part of the film.
    enum class Shows { Nothing, Parts, Lamp };

    /// Puts the parts of `cell` that may show a lamp into the list, each about as wide as that.
    void divide(const FilmCell& cell) {
        const Shows shows = look_through(cell);
        if (shows == Shows::Nothing) return;
        if (shows == Shows::Lamp) return cells_.push_back(cell);
        const float half = 0.5f * cell.size;
        for (const Vec2f& part : {Vec2f(0.0f, 0.0f), Vec2f(half, 0.0f), Vec2f(0.0f, half), Vec2f(half, half)})
            divide({cell.corner + part, half});
    }
    [[nodiscard]] Shows look_through(const FilmCell& cell) {
        const Vec2f middle = cell.middle();
        const float difference = kDifference * cell.size;
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
                const Vec3f miss = missed_by(end, end, lamp);
                if (!(dot(lamp.middle - end.origin, end.direction) > 0.0f)) continue;
                const float dx = length(missed_by(*right, end, lamp) - miss);
                const float dy = length(missed_by(*below, end, lamp) - miss);
                const float sweep = std::hypot(dx, dy) / difference;  // metres per pixel
                const float within = kMargin * sweep * cell.size * std::numbers::sqrt2_v<float> / 2.0f;
                const bool is_found_by_pixels = lamp.radius > kMostWidth * sweep && end.throughput > kLikely;
                if (!(length(miss) <= lamp.radius + within) || is_found_by_pixels) continue;
                if (cell.size > kLeastCell && within > kMargin * 0.5f * lamp.radius) return Shows::Parts;
                shows = Shows::Lamp;
            }
        }
        return shows;
    }
    /// Returns how far `end` passes the middle of `lamp`, metres across the way that `reference` takes.
    [[nodiscard]] static Vec3f missed_by(const DeltaEnd& end, const DeltaEnd& reference, const LampSphere& lamp) {
        const Vec3f to_middle = lamp.middle - end.origin;
        const float along = dot(to_middle, reference.direction) / dot(end.direction, reference.direction);
        return to_middle - end.direction * along;
    }
    void find_ends(const Vec2f& film, std::vector<DeltaEnd>& ends) const {
        ends.clear();
        EndCollector collector{ends};
        const Ray ray = world_.generate_ray(on_film(whole_, film), Vec2f(0.5f, 0.5f), 0.5f);
        follow_deltas(world_, branch_along(world_, whole_, ray, {whole_.seed, 0}, nullptr), EndCollector::NoState{},
                      max_depth_, collector);
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
            look_for_lamps(world_, branch_through(world_, whole_, film, key, nullptr), {.max_depth = max_depth_}, none,
                           seen);
        }
        return !seen.empty();
    }

    const World& world_;
    const TileJob& whole_;
    int max_depth_;
    const std::vector<LampSphere>& lamps_;
    std::vector<DeltaEnd> ends_, ends_right_, ends_below_;
    std::vector<FilmCell> cells_;
    // Of a row.
    std::vector<Vec2f> points_, film_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<std::uint8_t> is_mirror_;
    std::vector<std::uint32_t> ways_;
};

Vec2i pixel_of(const Vec2f& film) {
    return {static_cast<int>(std::floor(film.x)), static_cast<int>(std::floor(film.y))};
}

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

LampImages find_lamp_images(const World& world, const TileJob& whole, int max_depth, const ThreadPool& threads) {
    LampImages images;
    if (max_depth < 2 || !world.has_specular_surfaces() || !world.has_emitting_surfaces()) return images;
    const std::vector<LampSphere> lamps = lamp_spheres(world);
    if (lamps.empty()) return images;
    std::vector<LampImages> rows(static_cast<std::size_t>(whole.full_height));
    threads.parallel_for(rows.size(), [&](std::size_t row, int) {
        ImageFinder finder(world, whole, max_depth, lamps);
        finder.look_at_row(static_cast<int>(row), rows[row]);
    });
    for (const LampImages& row : rows) images.add(row);
    return images;
}

DeltaBranch branch_through(const World& world, const TileJob& job, const Vec2f& film, SampleKey key,
                           SampleTracer* tracer) {
    const SampleNumbers numbers{job.sequence, key};
    const Vec2f lens = world.has_lens() ? numbers.pair(kLensDimension) : Vec2f(0.0f);
    const float time =
        world.has_motion() ? SampleNumbers{job.sequence, shared_key(job, key)}.pair(kTimeDimension).x : 0.0f;
    Ray ray = world.generate_ray(on_film(job, film), lens, time);
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
        const Rgb light = path.throughput * world.emission(vertex.surface, vertex.wo);
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
        return intersect_one(world_, job_, RayKind::LampInView, ray, counters_);
    }
    [[nodiscard]] std::uint8_t occluded(const Ray& ray) override {
        return occluded_one(world_, job_, RayKind::LampInView, ray, counters_);
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
