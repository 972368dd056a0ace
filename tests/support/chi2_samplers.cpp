// The part of the harness that cuts a domain into cells, fills them and integrates over them.
#include "support/chi2.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

namespace etendue::test {

namespace {

constexpr double kPiDouble = std::numbers::pi;

/// A binary tree of splits; leaves are cells, numbered from left to right.
class Partition {
  public:
    Partition(const Rect& domain, std::vector<Point> pilot, std::optional<double> first_split_y, int depth)
        : first_split_y_(first_split_y) {
        split(domain, pilot, 0, depth);
    }

    [[nodiscard]] const std::vector<Rect>& cells() const { return cells_; }

    [[nodiscard]] std::size_t find(const Point& p) const {
        std::size_t node = 0;
        while (nodes_[node].axis >= 0) {
            const double coordinate = nodes_[node].axis == 0 ? p.x : p.y;
            node = coordinate < nodes_[node].position ? node + 1 : nodes_[node].right;
        }
        return nodes_[node].right;
    }

  private:
    struct Node {
        int axis = -1;  ///< 0 or 1; -1 for a leaf
        double position = 0.0;
        std::size_t right = 0;  ///< right child (the left one follows its parent); of a leaf, its cell
    };

    void split(const Rect& rect, std::span<Point> points, int level, int depth) {
        const std::size_t node = nodes_.size();
        nodes_.emplace_back();
        const int axis = (level + 1) % 2;
        const double low = axis == 0 ? rect.x0 : rect.y0;
        const double high = axis == 0 ? rect.x1 : rect.y1;
        double position = 0.5 * (low + high);
        const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
        if (level == 0 && first_split_y_) {
            position = *first_split_y_;
        } else if (points.size() >= 8) {
            const auto coordinate = [axis](const Point& p) { return axis == 0 ? p.x : p.y; };
            std::nth_element(points.begin(), middle, points.end(),
                             [&](const Point& a, const Point& b) { return coordinate(a) < coordinate(b); });
            position = coordinate(*middle);
        }
        if (level == depth || !(position > low && position < high)) {
            nodes_[node].right = cells_.size();
            cells_.push_back(rect);
            return;
        }
        Rect left = rect;
        Rect right = rect;
        (axis == 0 ? left.x1 : left.y1) = position;
        (axis == 0 ? right.x0 : right.y0) = position;
        const auto border = std::partition(points.begin(), points.end(),
                                           [&](const Point& p) { return (axis == 0 ? p.x : p.y) < position; });
        const auto left_count = static_cast<std::size_t>(border - points.begin());
        nodes_[node].axis = axis;
        nodes_[node].position = position;
        split(left, points.subspan(0, left_count), level + 1, depth);
        nodes_[node].right = nodes_.size();
        split(right, points.subspan(left_count), level + 1, depth);
    }

    std::optional<double> first_split_y_;
    std::vector<Node> nodes_;
    std::vector<Rect> cells_;
};

std::vector<Point> draw(const PointSampler& sampler, std::size_t count, std::uint32_t seed) {
    Random random(seed);
    std::vector<Point> points;
    points.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        if (const std::optional<Point> p = sampler(random)) points.push_back(*p);
    return points;
}

constexpr std::size_t kFewPoints = 16;
constexpr int kMaxLevels = 60;

double along(int axis, const Point& p) {
    return axis == 0 ? p.x : p.y;
}

/// The axis along which the nodes of a quadrature over `rect` miss the peak: where all of them, on the line through the
/// pilot point of the largest density, see less than half of it. A peak that holds some probability has points on it.
std::optional<int> unresolved_axis(const PointDensity& density, const Rect& rect, std::span<const Point> points) {
    double peak = 0.0;
    Point at;
    for (const Point& p : points) {
        const double value = density(p.x, p.y);
        if (value <= peak) continue;
        peak = value;
        at = p;
    }
    double seen_x = 0.0;
    double seen_y = 0.0;
    for (const double node : kGaussNodes) {
        seen_x = std::max(seen_x, density(rect.x0 + (rect.x1 - rect.x0) * node, at.y));
        seen_y = std::max(seen_y, density(at.x, rect.y0 + (rect.y1 - rect.y0) * node));
    }
    if (2.0 * std::min(seen_x, seen_y) >= peak) return std::nullopt;
    return seen_x < seen_y ? 0 : 1;
}

/// The integral over `rect`, cut at medians of the pilot points in it while they are many, then halved until the
/// quadrature resolves the density at the points.
double integrate_guided(const PointDensity& density, const Rect& rect, std::span<Point> points,
                        const SamplerOptions& options, int level = 0) {
    const auto whole = [&] {
        constexpr int kMostLevels = 10;
        return integrate(density, rect, options.tolerance, kMostLevels, options.least_levels);
    };
    if (points.empty() || level >= kMaxLevels) return whole();
    int axis = level % 2;
    std::optional<double> median;
    if (points.size() >= kFewPoints) {
        const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
        std::nth_element(points.begin(), middle, points.end(),
                         [axis](const Point& a, const Point& b) { return along(axis, a) < along(axis, b); });
        median = along(axis, *middle);
    } else {
        const std::optional<int> unresolved = unresolved_axis(density, rect, points);
        if (!unresolved) return whole();
        axis = *unresolved;
    }
    Rect left = rect;
    Rect right = rect;
    double& end = axis == 0 ? left.x1 : left.y1;
    double& begin = axis == 0 ? right.x0 : right.y0;
    const double position = median.value_or(0.5 * (begin + end));
    begin = end = position;
    const auto border =
        std::partition(points.begin(), points.end(), [=](const Point& p) { return along(axis, p) < position; });
    return integrate_guided(density, left, {points.begin(), border}, options, level + 1) +
           integrate_guided(density, right, {border, points.end()}, options, level + 1);
}

/// Points sorted by the cell in which they lie.
std::vector<std::vector<Point>> group(const Partition& partition, std::span<const Point> points) {
    std::vector<std::vector<Point>> groups(partition.cells().size());
    for (const Point& p : points) groups[partition.find(p)].push_back(p);
    return groups;
}

constexpr std::uint32_t kPilotSeed = 0x9e3779b9u;

SamplerCheck check(const Rect& domain, std::optional<double> first_split_y, const PointSampler& sampler,
                   const PointDensity& density, const SamplerOptions& options) {
    const std::vector<Point> pilot = draw(sampler, options.pilot_samples, options.seed ^ kPilotSeed);
    const Partition partition(domain, pilot, first_split_y, options.cells_log2);
    std::vector<std::vector<Point>> guides = group(partition, pilot);

    const auto count = static_cast<double>(options.samples);
    const std::size_t cells = partition.cells().size();
    std::vector<double> expected(cells + 1);
    std::vector<std::string> labels(cells + 1, "rejected or delta");
    SamplerCheck result;
    for (std::size_t i = 0; i < cells; ++i) {
        const Rect& cell = partition.cells()[i];
        const double mass = integrate_guided(density, cell, guides[i], options);
        result.pdf_integral += mass;
        expected[i] = mass * count;
        labels[i] = fmt::format("[{:.4f}, {:.4f}] x [{:.4f}, {:.4f}]", cell.x0, cell.x1, cell.y0, cell.y1);
    }
    // What remains is what the quadrature cannot tell from nothing: less than its error is nothing.
    const double rest = 1.0 - result.pdf_integral;
    expected[cells] = rest > options.tolerance * static_cast<double>(cells) ? rest * count : 0.0;

    const std::vector<Point> points = draw(sampler, options.samples, options.seed);
    std::vector<double> observed(cells + 1);
    for (const Point& p : points) observed[partition.find(p)] += 1.0;
    observed[cells] = count - static_cast<double>(points.size());

    result.hit_share = static_cast<double>(points.size()) / count;
    result.hit_error = std::sqrt(result.hit_share * (1.0 - result.hit_share) / count);
    result.chi2 = chi2_counts(observed, expected, labels);
    return result;
}

constexpr Rect kSphere{-1.0, 1.0, -kPiDouble, kPiDouble};

PointSampler on_sphere(const DirectionSampler& sampler) {
    return [&sampler](Random& random) -> std::optional<Point> {
        const std::optional<Vec3f> w = sampler(random);
        if (!w) return std::nullopt;
        return Point{static_cast<double>(w->y), std::atan2(static_cast<double>(w->z), static_cast<double>(w->x))};
    };
}

PointDensity on_sphere(const DirectionDensity& density) {
    return [&density](double cosine, double azimuth) {
        const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        return density({static_cast<float>(sine * std::cos(azimuth)), static_cast<float>(cosine),
                        static_cast<float>(sine * std::sin(azimuth))});
    };
}

}  // namespace

SamplerCheck check_rect_sampler(const Rect& domain, const PointSampler& sampler, const PointDensity& density,
                                const SamplerOptions& options) {
    return check(domain, std::nullopt, sampler, density, options);
}

SamplerCheck check_sphere_sampler(const DirectionSampler& sampler, const DirectionDensity& density,
                                  const SamplerOptions& options) {
    return check(kSphere, 0.0, on_sphere(sampler), on_sphere(density), options);
}

double integrate_sphere(const DirectionSampler& guide, const DirectionDensity& f, const SamplerOptions& options) {
    std::vector<Point> points = draw(on_sphere(guide), options.pilot_samples, options.seed ^ kPilotSeed);
    const auto border = std::partition(points.begin(), points.end(), [](const Point& p) { return p.y < 0.0; });
    const std::span<Point> below(points.begin(), border);
    const std::span<Point> above(border, points.end());
    const Rect lower{kSphere.x0, kSphere.x1, kSphere.y0, 0.0};
    const Rect upper{kSphere.x0, kSphere.x1, 0.0, kSphere.y1};
    return integrate_guided(on_sphere(f), lower, below, options) +
           integrate_guided(on_sphere(f), upper, above, options);
}

}  // namespace etendue::test
