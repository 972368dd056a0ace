#include "world/contact_finder.h"

#include "world/contacts.h"
#include "world/embree_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>

namespace etendue {

namespace {

/// Vertices that two triangles of a mesh have in common.
int shared_vertices(const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b) {
    return static_cast<int>(std::ranges::count_if(a, [&](std::uint32_t v) { return std::ranges::count(b, v) > 0; }));
}

/// A surface, as far as looking for those that touch it goes.
struct PlacedSurface {
    Slot slot;
    Bounds bounds;  ///< in world space, with what rounding may be
    bool matters = false;
    std::uint32_t triangles = 0;
};

class TouchFinder {
  public:
    TouchFinder(const WorldData& data, std::size_t most_work) : data_(data), most_work_(most_work) {}

    [[nodiscard]] Touches find(const ThreadPool& threads) {
        if (!list_surfaces()) return {};
        list_queries_between();
        threads.parallel_for(surfaces_.size(), [&](std::size_t c, int) {
            if (surfaces_[c].matters) look_within(surfaces_[c].slot);
        });
        std::sort(queries_.begin(), queries_.end());
        queries_.erase(std::unique(queries_.begin(), queries_.end()), queries_.end());
        const std::vector<Query>& queries = queries_;
        // Once the work limit is passed, what the threads have found depends on their order, so it is discarded.
        const Touches certain = found_;
        const std::size_t chunk_size = std::clamp<std::size_t>(queries.size() / 256, 1, 64);
        threads.parallel_for((queries.size() + chunk_size - 1) / chunk_size, [&](std::size_t chunk, int) {
            for (std::size_t i = chunk * chunk_size; i < std::min(queries.size(), (chunk + 1) * chunk_size); ++i)
                look_around(queries[i]);
        });
        const bool is_complete = work_ < most_work_;
        if (!is_complete) found_ = certain;
        found_.is_complete = is_complete;
        return std::move(found_);
    }

  private:
    struct BoundedTriangle {
        std::uint32_t triangle = 0;
        Bounds bounds;
    };
    /// A triangle all around which is looked.
    struct Query {
        Slot slot;
        std::uint32_t triangle = 0;

        bool operator<(const Query& other) const {
            return std::tie(slot.index, triangle) < std::tie(other.slot.index, other.triangle);
        }
        bool operator==(const Query& other) const {
            return slot.index == other.slot.index && triangle == other.triangle;
        }
    };

    [[nodiscard]] bool matters(const Slot& slot) const {
        const Material& material = data_.materials[data_.geometries[slot.geometry].material];
        return !stops_light(material) || material.emits;
    }

    [[nodiscard]] Vec3f placed(const Instance& instance, const Vec3f& p) const {
        return instance.baked ? p : transform_point(instance.to_world, p);
    }

    /// False if there are none that matter.
    bool list_surfaces() {
        bool any = false;
        for (std::uint32_t i = 0; i < data_.instances.size(); ++i)
            for (std::uint32_t g = 0; g < data_.instances[i].geometry_count; ++g) {
                const Instance& instance = data_.instances[i];
                const Slot slot{instance.first_light_slot + g, i, instance.first_geometry + g};
                const std::uint32_t count = touching_triangles(data_.geometries[slot.geometry]);
                if (count == 0) continue;
                surfaces_.push_back({slot, {}, matters(slot), count});
                any = any || surfaces_.back().matters;
                all_triangles_ += count;
            }
        if (!any) return false;
        for (PlacedSurface& surface : surfaces_) {
            const Instance& instance = data_.instances[surface.slot.instance];
            for (const Vec3f& p : data_.geometries[surface.slot.geometry].positions)
                surface.bounds.extend(placed(instance, p));
            grow(surface.bounds, surface.slot);
        }
        return true;
    }

    /// Grows a box around a part of the surface `slot` by a few times what rounding may move a point of it.
    void grow(Bounds& bounds, const Slot& slot) const {
        const Vec3f extent = max_components(abs_components(bounds.min), abs_components(bounds.max));
        const float size = data_.size_of_slot[slot.index];
        const float most = 16.0f * clearance(Vec3f(1.0f), position_error(extent)) + 4.0f * kPositionError * size;
        bounds = {bounds.min - Vec3f(most), bounds.max + Vec3f(most)};
    }

    /// The triangles of one of two surfaces whose bounds overlap, of that around whose there is less.
    void list_queries_between() {
        // Beyond that many pairs of surfaces, what is near one is asked of the BVH.
        constexpr std::size_t kMostPairs = std::size_t{1} << 22;
        const auto relevant = static_cast<std::size_t>(std::ranges::count_if(surfaces_, &PlacedSurface::matters));
        const bool is_crowd = relevant * surfaces_.size() > kMostPairs;
        for (const PlacedSurface& a : surfaces_) {
            if (!a.matters) continue;
            if (is_crowd) {
                // Each triangle costs at least one visit.
                if (queries_.size() + a.triangles > most_work_) {
                    work_ = most_work_;
                    queries_.clear();
                    return;
                }
                if (is_met(a))
                    for (std::uint32_t t = 0; t < a.triangles; ++t) queries_.push_back({a.slot, t});
                continue;
            }
            for (const PlacedSurface& b : surfaces_) {
                const bool is_listed = b.matters && b.slot.index < a.slot.index;
                if (a.slot.index == b.slot.index || is_listed || !overlap(a.bounds, b.bounds)) continue;
                hold_against_each_other(a, b);
            }
        }
    }

    /// Triangles of two surfaces whose bounds overlap: each against each if they are few, or else those around which
    /// there is less to look at.
    void hold_against_each_other(const PlacedSurface& a, const PlacedSurface& b) {
        constexpr std::size_t kMostPairs = std::size_t{1} << 23;
        if (work_ >= most_work_) return;
        std::vector<BoundedTriangle> of_a;
        std::vector<BoundedTriangle> of_b;
        const double around_a = list_within(a, b.bounds, of_a);
        const double around_b = list_within(b, a.bounds, of_b);
        // Rejecting a triangle by its bounds costs an eighth of a visit.
        work_ += (a.triangles + b.triangles) / 8 + 1;
        if (of_a.size() * of_b.size() > kMostPairs) {
            const bool a_is_less = around_a <= around_b;
            for (const BoundedTriangle& t : a_is_less ? of_a : of_b)
                queries_.push_back({a_is_less ? a.slot : b.slot, t.triangle});
            return;
        }
        for (const BoundedTriangle& one : of_a) {
            if (work_ >= most_work_) return;
            const PlacedTriangle here = place(data_, a.slot.instance, a.slot.geometry, one.triangle);
            std::size_t held = 0;
            for (const BoundedTriangle& other : of_b)
                if (overlap(one.bounds, other.bounds)) {
                    hold_against(a.slot, here, b.slot, other.triangle);
                    ++held;
                }
            work_ += of_b.size() / 8 + held;
        }
    }

    /// True if triangles of other surfaces are within the bounds of this one.
    [[nodiscard]] bool is_met(const PlacedSurface& surface) {
        bool any = work_ >= most_work_;
        if (any) return true;
        std::size_t visits = 0;
        data_.bvh->for_each_near(
            surface.bounds.center(), 0.5f * length(surface.bounds.size()),
            [&](std::uint32_t instance_index, std::uint32_t geometry_index, std::uint32_t triangle) {
                ++visits;
                const bool is_itself =
                    instance_index == surface.slot.instance && geometry_index == surface.slot.geometry;
                any = !is_itself &&
                      overlap(surface.bounds, bounds_of(data_.instances[instance_index], geometry_index, triangle));
                return !any;
            });
        work_ += visits / 8;
        return any;
    }

    [[nodiscard]] Bounds bounds_of(const Instance& instance, std::uint32_t geometry_index,
                                   std::uint32_t triangle) const {
        const Geometry& geometry = data_.geometries[geometry_index];
        Bounds bounds;  // empty of shapes that are not flat, whose contacts are not looked for
        if (geometry.shape) {
            if (touching_triangles(geometry) > 0)
                for (const Vec3d& p : disk_triangle(geometry, instance).p) bounds.extend(Vec3f(p));
            return bounds;
        }
        for (const std::uint32_t vertex : geometry.triangles[triangle])
            bounds.extend(placed(instance, geometry.positions[vertex]));
        return bounds;
    }

    /// Triangles of a surface within `bounds`; about how many others are visited to look around all of them.
    double list_within(const PlacedSurface& surface, const Bounds& bounds, std::vector<BoundedTriangle>& found) const {
        constexpr double kOfAnyQuery = 64.0;  // what it takes however small the triangle is
        const double scene = static_cast<double>(length_squared(data_.bounds.size()));
        double visits = 0.0;
        for (std::uint32_t t = 0; t < surface.triangles; ++t) {
            Bounds triangle = bounds_of(data_.instances[surface.slot.instance], surface.slot.geometry, t);
            grow(triangle, surface.slot);
            if (!overlap(triangle, bounds)) continue;
            found.push_back({t, triangle});
            visits += kOfAnyQuery + static_cast<double>(all_triangles_) *
                                        std::min(1.0, static_cast<double>(length_squared(triangle.size())) / scene);
        }
        return visits;
    }

    /// Looks for triangles of one mesh that lie in one plane.
    void look_within(const Slot& slot) {
        const Geometry& geometry = data_.geometries[slot.geometry];
        Bounds bounds;
        for (const Vec3f& p : geometry.positions) bounds.extend(p);
        const Vec3d center = (Vec3d(bounds.min) + Vec3d(bounds.max)) * 0.5;
        const double size = std::max(static_cast<double>(length(bounds.size())), 1e-30);
        // Triangles with the same vertices have the same plane to the bit; others are as good as never in different
        // cells.
        constexpr double kNormalCells = 512.0, kOffsetCells = 8192.0, kShift = 0.37;
        const auto cell = [](double value, double cells) {
            return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value * cells + kShift))) & 0xffffu;
        };
        std::vector<std::pair<std::uint64_t, std::uint32_t>> planes;  // cell and triangle
        planes.reserve(geometry.triangles.size());
        for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
            const auto& [a, b, c] = geometry.triangles[t];
            const Vec3d p(geometry.positions[a]);
            Vec3d normal = (Vec3d(geometry.positions[b]) - p).cross(Vec3d(geometry.positions[c]) - p);
            const double area = normal.length();
            if (!(area > 0.0)) continue;
            normal /= area;
            const double leading = std::abs(normal.x) > 0.5 ? normal.x : std::abs(normal.y) > 0.5 ? normal.y : normal.z;
            if (leading < 0.0) normal = -normal;
            planes.emplace_back(cell(normal.x, kNormalCells) << 48 | cell(normal.y, kNormalCells) << 32 |
                                    cell(normal.z, kNormalCells) << 16 |
                                    cell(normal.dot(p - center) / size, kOffsetCells),
                                t);
        }
        std::sort(planes.begin(), planes.end());
        for (std::size_t first = 0, end = 0; first < planes.size(); first = end) {
            while (end < planes.size() && planes[end].first == planes[first].first) ++end;
            look_in_plane(slot, std::span(planes).subspan(first, end - first));
        }
    }

    template <typename Planes>
    void look_in_plane(const Slot& slot, const Planes& planes) {
        constexpr std::size_t kFew = 16;
        if (planes.size() > kFew) {
            const std::lock_guard lock(mutex_);
            for (const auto& [key, triangle] : planes) queries_.push_back({slot, triangle});
            return;
        }
        for (std::size_t a = 0; a < planes.size(); ++a)
            for (std::size_t b = a + 1; b < planes.size(); ++b) {
                const std::uint32_t here = planes[a].second;
                const std::uint32_t there = planes[b].second;
                if (are_neighbours(slot, here, there)) continue;
                hold_against(slot, place(data_, slot.instance, slot.geometry, here), slot, there);
            }
    }

    /// Triangles of one mesh, unless they are the two sides of one.
    [[nodiscard]] bool are_neighbours(const Slot& slot, std::uint32_t a, std::uint32_t b) const {
        const auto& triangles = data_.geometries[slot.geometry].triangles;
        const int shared = shared_vertices(triangles[a], triangles[b]);
        return shared == 1 || shared == 2;
    }

    void look_around(const Query& query) {
        const Slot& slot = query.slot;
        if (work_ >= most_work_) return;
        const PlacedTriangle here = place(data_, slot.instance, slot.geometry, query.triangle);
        if (here.is_degenerate()) return;
        std::size_t visits = 0;
        Bounds bounds;
        for (const Vec3d& p : here.p) bounds.extend(Vec3f(p));
        grow(bounds, slot);
        const bool here_matters = matters(slot);
        data_.bvh->for_each_near(
            bounds.center(), 0.5f * length(bounds.size()),
            [&](std::uint32_t instance_index, std::uint32_t geometry_index, std::uint32_t triangle) {
                ++visits;
                const Instance& instance = data_.instances[instance_index];
                const Slot other{instance.first_light_slot + geometry_index - instance.first_geometry, instance_index,
                                 geometry_index};
                const bool is_same = other.index == slot.index;
                if (is_same && (triangle == query.triangle || are_neighbours(slot, triangle, query.triangle)))
                    return true;
                if (!here_matters && !matters(other)) return true;
                if (overlap(bounds, bounds_of(instance, geometry_index, triangle)))
                    hold_against(slot, here, other, triangle);
                return work_ + visits < most_work_;
            });
        work_ += visits;
    }

    void hold_against(const Slot& slot, const PlacedTriangle& here, const Slot& other, std::uint32_t triangle) {
        const PlacedTriangle there = place(data_, other.instance, other.geometry, triangle);
        if (here.is_degenerate() || there.is_degenerate()) return;
        const double distance = contact_distance(here, there);
        const std::optional<Bounds> where = touch(here, there, distance);
        if (!where) return;
        const std::lock_guard lock(mutex_);
        Touch& found = found_.pairs[std::minmax(slot.index, other.index)];
        found.distance = std::max(found.distance, distance);
        found.alike += here.normal.dot(there.normal) > 0.0 ? 1 : -1;
        // Beyond the most, all that comes is in the last one.
        if (found.places.size() <= Touch::kMostPlaces)
            found.places.push_back(*where);
        else
            found.places.back().extend(*where);
    }

    const WorldData& data_;
    std::size_t most_work_;
    std::vector<PlacedSurface> surfaces_;
    std::size_t all_triangles_ = 0;
    std::atomic<std::size_t> work_ = 0;
    std::mutex mutex_;
    std::vector<Query> queries_;
    Touches found_;
};

}  // namespace

std::uint32_t touching_triangles(const Geometry& geometry) {
    if (geometry.shape) return geometry.shape->kind() == ShapeKind::Disk ? 1 : 0;
    return static_cast<std::uint32_t>(geometry.triangles.size());
}

Touches find_touches(const WorldData& data, const ThreadPool& threads, std::size_t most_work) {
    Touches touches = TouchFinder(data, most_work).find(threads);
    // In an order that threads have no part in.
    for (auto& [slots, touch] : touches.pairs) {
        if (touch.places.size() > Touch::kMostPlaces) {
            Bounds all;
            for (const Bounds& place : touch.places) all.extend(place);
            touch.places = {all};
        }
        std::ranges::sort(touch.places, {}, [](const Bounds& b) {
            return std::tuple(b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z);
        });
    }
    return touches;
}

}  // namespace etendue
