// Builds the BVHs, finds surfaces that lie within rounding of each other, and moves thin sheets apart.
#include "core/position_error.h"
#include "world/compile_parts.h"
#include "world/contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace etendue {

namespace {

/// A triangle of an instance in world space, in the middle of the shutter.
struct PlacedTriangle {
    std::array<Vec3d, 3> p;
    Vec3d normal;  ///< unit, on the front
    double area = 0.0;
    double clearance = 0.0;

    [[nodiscard]] bool is_degenerate() const { return !(area > 0.0); }
};

struct Slot {
    std::uint32_t index = 0;
    std::uint32_t instance = 0;
    std::uint32_t geometry = 0;
};

/// How surfaces of two slots touch.
struct Touch {
    double distance = 0.0;  ///< metres within which they count as one, the largest of their triangles
    int alike = 0;          ///< pairs of triangles whose fronts are on one side, less those that face each other
};
/// By the slots, of which the first is the lower, or the same.
using Touches = std::map<std::pair<std::uint32_t, std::uint32_t>, Touch>;

Vec3d to_double(const Vec3f& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

PlacedTriangle place(const WorldData& data, std::uint32_t instance_index, std::uint32_t geometry_index,
                     std::uint32_t triangle_index) {
    const Instance& instance = data.instances[instance_index];
    const Geometry& geometry = data.geometries[geometry_index];
    PlacedTriangle placed;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3f& p = geometry.positions[geometry.triangles[triangle_index][i]];
        placed.p[i] = to_double(instance.baked ? p : transform_point(instance.to_world, p));
    }
    const Vec3d across = (placed.p[1] - placed.p[0]).cross(placed.p[2] - placed.p[0]);
    placed.area = 0.5 * across.length();
    if (placed.is_degenerate()) return placed;
    placed.normal = across / (2.0 * placed.area) * (instance.mirrors ? -1.0 : 1.0);
    placed.clearance =
        static_cast<double>(triangle_plane(data, instance_index, geometry_index, triangle_index).clearance);
    return placed;
}

/// The part of a convex polygon on the side of `edge_normal` of a point.
void clip(std::vector<Vec3d>& polygon, const Vec3d& on_edge, const Vec3d& edge_normal) {
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d& here = polygon[i];
        const Vec3d& next = polygon[(i + 1) % polygon.size()];
        const double d0 = edge_normal.dot(here - on_edge);
        const double d1 = edge_normal.dot(next - on_edge);
        if (d0 >= 0.0) kept.push_back(here);
        if ((d0 > 0.0 && d1 < 0.0) || (d0 < 0.0 && d1 > 0.0)) kept.push_back(here + (next - here) * (d0 / (d0 - d1)));
    }
    polygon = std::move(kept);
}

/// True if the triangles, seen along the normal of the first, overlap by more than rounding, and come within `distance`
/// of each other there.
bool touch(const PlacedTriangle& a, const PlacedTriangle& b, double distance) {
    constexpr double kParallel = 0.9;
    constexpr double kLeastShare = 1e-4;  // of the smaller one: neighbours in a mesh share an edge
    if (std::abs(a.normal.dot(b.normal)) < kParallel) return false;
    std::vector<Vec3d> overlap(b.p.begin(), b.p.end());
    for (std::size_t i = 0; i < 3 && !overlap.empty(); ++i) {
        const Vec3d edge = a.p[(i + 1) % 3] - a.p[i];
        Vec3d inwards = a.normal.cross(edge);
        if (inwards.dot(a.p[(i + 2) % 3] - a.p[i]) < 0.0) inwards = -inwards;
        clip(overlap, a.p[i], inwards);
    }
    Vec3d across(0.0);
    for (std::size_t i = 2; i < overlap.size(); ++i)
        across += (overlap[i - 1] - overlap[0]).cross(overlap[i] - overlap[0]);
    if (!(0.5 * std::abs(across.dot(a.normal)) > kLeastShare * std::min(a.area, b.area))) return false;
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const Vec3d& p : overlap) {
        const double height = a.normal.dot(p - a.p[0]);
        least = std::min(least, height);
        most = std::max(most, height);
    }
    return least <= distance && most >= -distance;
}

/// True if `point` is within `distance` of the triangle.
bool is_near(const PlacedTriangle& triangle, const Vec3d& point, double distance) {
    if (std::abs(triangle.normal.dot(point - triangle.p[0])) > distance) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d edge = triangle.p[(i + 1) % 3] - triangle.p[i];
        Vec3d inwards = triangle.normal.cross(edge).normalized();
        if (inwards.dot(triangle.p[(i + 2) % 3] - triangle.p[i]) < 0.0) inwards = -inwards;
        if (inwards.dot(point - triangle.p[i]) < -distance) return false;
    }
    return true;
}

/// Where a light is that shines from a point.
std::optional<Vec3f> point_of(const Light& light) {
    if (const auto* point = std::get_if<PointLight>(&light)) return point->position;
    if (const auto* spot = std::get_if<SpotLight>(&light)) return spot->position;
    if (const auto* profile = std::get_if<ProfileLight>(&light))
        return std::visit([](const auto& lamp) { return lamp.position; }, profile->lamp);
    return std::nullopt;
}

/// Vertices that two triangles of a mesh have in common.
int shared_vertices(const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b) {
    return static_cast<int>(std::ranges::count_if(a, [&](std::uint32_t v) { return std::ranges::count(b, v) > 0; }));
}

class ContactFinder {
  public:
    explicit ContactFinder(const WorldData& data) : data_(data) {}

    [[nodiscard]] Touches find(const ThreadPool& threads) {
        std::vector<std::pair<Slot, std::uint32_t>> triangles;  // those of surfaces for which it matters
        for (std::uint32_t i = 0; i < data_.instances.size(); ++i) {
            const Instance& instance = data_.instances[i];
            for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
                const Slot slot{instance.first_light_slot + g, i, instance.first_geometry + g};
                const Geometry& geometry = data_.geometries[slot.geometry];
                const Material& material = data_.materials[geometry.material];
                if (stops_light(material) && !material.emits) continue;
                for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) triangles.emplace_back(slot, t);
            }
        }
        constexpr std::size_t kChunk = 256;
        threads.parallel_for((triangles.size() + kChunk - 1) / kChunk, [&](std::size_t chunk, int) {
            for (std::size_t i = chunk * kChunk; i < std::min(triangles.size(), (chunk + 1) * kChunk); ++i)
                look_around(triangles[i].first, triangles[i].second);
        });
        return found_;
    }

  private:
    void look_around(const Slot& slot, std::uint32_t triangle) {
        const PlacedTriangle here = place(data_, slot.instance, slot.geometry, triangle);
        if (here.is_degenerate()) return;
        const Vec3d center = (here.p[0] + here.p[1] + here.p[2]) / 3.0;
        double radius = 0.0;
        for (const Vec3d& p : here.p) radius = std::max(radius, (p - center).length());
        const auto indices = [&](const Slot& of, std::uint32_t t) {
            return data_.geometries[of.geometry].triangles[t];
        };
        data_.bvh->for_each_near(
            Vec3f(center), static_cast<float>(radius * 1.001 + 8.0 * here.clearance),
            [&](std::uint32_t other_instance, std::uint32_t other_geometry, std::uint32_t other_triangle) {
                const Instance& instance = data_.instances[other_instance];
                const Slot other{instance.first_light_slot + other_geometry - instance.first_geometry, other_instance,
                                 other_geometry};
                if (other.index == slot.index) {
                    if (other_triangle == triangle) return;
                    // Neighbours, unless they are the two sides of one triangle.
                    const int shared = shared_vertices(indices(slot, triangle), indices(other, other_triangle));
                    if (shared == 1 || shared == 2) return;
                }
                const PlacedTriangle there = place(data_, other_instance, other_geometry, other_triangle);
                if (there.is_degenerate()) return;
                const double distance = contact_distance(here.clearance, there.clearance);
                for (int axis = 0; axis < 3; ++axis) {
                    const auto [low, high] = std::minmax({here.p[0][axis], here.p[1][axis], here.p[2][axis]});
                    if (std::min({there.p[0][axis], there.p[1][axis], there.p[2][axis]}) > high + distance) return;
                    if (std::max({there.p[0][axis], there.p[1][axis], there.p[2][axis]}) < low - distance) return;
                }
                if (touch(here, there, distance))
                    add(std::minmax(slot.index, other.index), distance, here.normal.dot(there.normal) > 0.0);
            });
    }

    void add(std::pair<std::uint32_t, std::uint32_t> slots, double distance, bool alike) {
        const std::lock_guard lock(mutex_);
        Touch& found = found_[slots];
        found.distance = std::max(found.distance, distance);
        found.alike += alike ? 1 : -1;
    }

    const WorldData& data_;
    std::mutex mutex_;
    Touches found_;
};

/// Unit normals of the vertices of a mesh; those in one place that face one way have one, so that moving along it tears
/// nothing.
std::vector<Vec3f> vertex_normals(const Geometry& geometry) {
    std::vector<Vec3f> of_index(geometry.positions.size(), Vec3f(0.0f));
    for (const auto& [a, b, c] : geometry.triangles) {
        const Vec3f& p = geometry.positions[a];
        const Vec3f across = cross(geometry.positions[b] - p, geometry.positions[c] - p);
        for (const std::uint32_t vertex : {a, b, c}) of_index[vertex] += across;
    }
    std::map<std::array<float, 3>, std::vector<std::size_t>> by_place;
    for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
        const Vec3f& p = geometry.positions[v];
        by_place[{p.x, p.y, p.z}].push_back(v);
    }
    std::vector<Vec3f> normals(of_index.size(), Vec3f(0.0f));
    for (const auto& [place, vertices] : by_place)
        for (const std::size_t v : vertices) {
            for (const std::size_t other : vertices)
                if (dot(of_index[v], of_index[other]) > 0.0f) normals[v] += of_index[other];
            const float size = length(normals[v]);
            if (size > 0.0f) normals[v] *= 1.0f / size;
        }
    return normals;
}

void shift(Mat4f& to_world, const Vec3f& by) {
    for (int i = 0; i < 3; ++i) to_world[3][i] += by[i];
}

/// Moves the surface of a slot by `distance` metres along its normals; what is instanced goes as a whole.
void move_along_normals(const Slot& slot, float distance, WorldData& data) {
    Instance& instance = data.instances[slot.instance];
    Geometry& geometry = data.geometries[slot.geometry];
    if (instance.baked) {
        const std::vector<Vec3f> normals = vertex_normals(geometry);
        for (std::size_t v = 0; v < normals.size(); ++v) {
            geometry.positions[v] += normals[v] * distance;
            for (VertexStep& step : geometry.motion) step.positions[v] += normals[v] * distance;
        }
        return;
    }
    Vec3d sum(0.0);
    for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
        const PlacedTriangle triangle = place(data, slot.instance, slot.geometry, t);
        if (!triangle.is_degenerate()) sum += triangle.normal * triangle.area;
    }
    if (!(sum.length() > 0.0)) return;
    const Vec3f by(sum / sum.length() * static_cast<double>(distance));
    shift(instance.to_world, by);
    instance.to_local = instance.to_world.inverse();
    if (instance.motion != kNone)
        for (Mat4f& step : data.motions[instance.motion]) shift(step, by);
}

std::vector<Slot> all_slots(const WorldData& data) {
    std::vector<Slot> slots(data.light_of_slot.size());
    for (std::uint32_t i = 0; i < data.instances.size(); ++i)
        for (std::uint32_t g = 0; g < data.instances[i].geometry_count; ++g) {
            const std::uint32_t index = data.instances[i].first_light_slot + g;
            slots[index] = {index, i, data.instances[i].first_geometry + g};
        }
    return slots;
}

/// Moves thin sheets that touch something by a few times what rounding may: in front of what stops light, out of
/// bodies, behind lamps, and one before the other. True if any was moved.
bool move_sheets_apart(const Touches& touches, WorldData& data) {
    const std::vector<Slot> slots = all_slots(data);
    const auto material = [&](std::uint32_t slot) -> const Material& {
        return data.materials[data.geometries[slots[slot].geometry].material];
    };
    std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, Touch>>> partners;  // of sheets
    double distance = 0.0;
    for (const auto& [pair, touch] : touches)
        for (const auto& [sheet, other] : {pair, std::pair(pair.second, pair.first)}) {
            if (!is_sheet(material(sheet))) continue;
            partners[sheet].emplace_back(other, touch);
            distance = std::max(distance, touch.distance);
        }
    std::map<std::uint32_t, int> steps;  // along their normals
    for (const auto& [sheet, touching] : partners) {
        int way = 1;
        std::set<int> taken;
        for (const auto& [other, touch] : touching) {
            const int alike = touch.alike >= 0 ? 1 : -1;
            if (other == sheet) {
                if (alike < 0) taken.insert(0);  // its two sides part
            } else if (!is_sheet(material(other))) {
                taken.insert(0);
                way = material(other).emits && !material(other).emits_both_sides ? -alike : alike;
            } else if (const auto placed = steps.find(other); placed != steps.end()) {
                taken.insert(placed->second * alike);
            }
        }
        int step = 0;
        while (taken.contains(step)) step += way;
        steps[sheet] = step;
    }
    bool any = false;
    for (const auto& [sheet, step] : steps) {
        if (step == 0) continue;
        move_along_normals(slots[sheet], static_cast<float>(2.0 * distance * step), data);
        any = true;
    }
    return any;
}

}  // namespace

void build_bvh(const ThreadPool& threads, WorldData& data) {
    std::vector<HitFilter> filters;
    filters.reserve(data.geometries.size());
    for (const Geometry& geometry : data.geometries) {
        const Material& material = data.materials[geometry.material];
        filters.push_back({material.alpha_test != AlphaTest::Opaque, material.is_pane});
    }
    data.bvh = std::make_unique<EmbreeScene>(data.geometries, data.instances, data.motions, filters, threads);
    Touches touches = ContactFinder(data).find(threads);
    if (move_sheets_apart(touches, data)) {
        data.bvh = std::make_unique<EmbreeScene>(data.geometries, data.instances, data.motions, filters, threads);
        touches = ContactFinder(data).find(threads);
    }
    const std::vector<Slot> slots = all_slots(data);
    std::vector<std::uint8_t> panes(slots.size());
    std::ranges::transform(slots, panes.begin(), [&](const Slot& slot) -> std::uint8_t {
        return data.materials[data.geometries[slot.geometry].material].is_pane ? 1 : 0;
    });
    if (std::ranges::count(panes, 1) > 0)
        data.panes =
            std::make_unique<EmbreeScene>(data.geometries, data.instances, data.motions, filters, threads, panes);
    if (touches.empty()) return;
    const auto emits = [&](std::uint32_t slot) {
        return data.materials[data.geometries[slots[slot].geometry].material].emits;
    };
    std::vector<float> reach(slots.size(), 0.0f);
    data.shares_place_of_slot.assign(slots.size(), 0);
    for (const auto& [pair, touch] : touches)
        for (const std::uint32_t slot : {pair.first, pair.second}) {
            reach[slot] = std::max(reach[slot], static_cast<float>(touch.distance));
            if (emits(pair.first) && emits(pair.second)) data.shares_place_of_slot[slot] = 1;
        }
    data.contacts = std::make_unique<Contacts>(data, std::move(reach), filters, threads);
}

void find_planes_of_lamps(WorldData& data) {
    constexpr double kAlike = 0.99;
    for (std::size_t light = 0; light < data.lights.size(); ++light) {
        const std::optional<Vec3f> lamp = point_of(data.lights[light]);
        if (!lamp) continue;
        const Vec3f error = position_error(abs_components(*lamp));
        const Vec3f extent = max_components(abs_components(data.bounds.min), abs_components(data.bounds.max));
        const float radius =
            8.0f * clearance({1.0f, 1.0f, 1.0f}, position_error(max_components(extent, abs_components(*lamp))));
        std::vector<Vec3f> planes;
        data.bvh->for_each_near(*lamp, radius, [&](std::uint32_t instance, std::uint32_t geometry, std::uint32_t t) {
            const PlacedTriangle triangle = place(data, instance, geometry, t);
            if (triangle.is_degenerate()) return;
            const Vec3f normal(triangle.normal);
            const double distance = contact_distance(triangle.clearance, static_cast<double>(clearance(normal, error)));
            if (!is_near(triangle, to_double(*lamp), distance)) return;
            const Vec3f plane(triangle.normal * distance);
            const auto same = std::ranges::find_if(planes, [&](const Vec3f& other) {
                return std::abs(triangle.normal.dot(to_double(other))) > kAlike * to_double(other).length();
            });
            if (same == planes.end())
                planes.push_back(plane);
            else if (length(*same) < length(plane))
                *same = plane;
        });
        if (planes.empty()) continue;
        data.planes_of_light.resize(data.lights.size());
        data.planes_of_light[light] = std::move(planes);
    }
}

}  // namespace etendue
