// Builds the BVHs, finds surfaces that lie within rounding of each other, and moves thin sheets apart.
#include "core/position_error.h"
#include "world/compile_parts.h"
#include "world/contact_finder.h"
#include "world/contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

namespace etendue {

namespace {

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
    if (instance.baked && geometry.shape) {
        const Vec3f by(place(data, slot.instance, slot.geometry, 0).normal * static_cast<double>(distance));
        Mat4f moved;
        shift(moved, by);
        geometry.shape = geometry.shape->placed(moved);
        for (Vec3f& corner : geometry.positions) corner += by;
        return;
    }
    if (instance.baked) {
        const std::vector<Vec3f> normals = vertex_normals(geometry);
        for (std::size_t v = 0; v < normals.size(); ++v) {
            geometry.positions[v] += normals[v] * distance;
            for (VertexStep& step : geometry.motion) step.positions[v] += normals[v] * distance;
        }
        return;
    }
    Vec3d sum(0.0);
    for (std::uint32_t t = 0; t < touching_triangles(geometry); ++t) {
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

bool moves(const WorldData& data, const Slot& slot) {
    return data.instances[slot.instance].motion != kNone || !data.geometries[slot.geometry].motion.empty();
}

/// Groups sheets that touch, each with the largest distance at which any of it touches something.
class SheetGroups {
  public:
    void join(std::uint32_t a, std::uint32_t b, double distance) {
        const std::uint32_t of_a = group(a);
        const std::uint32_t of_b = group(b);
        double& own = distances_[of_b];
        own = std::max({own, distances_[of_a], distance});
        parents_[of_a] = of_b;
    }
    [[nodiscard]] double distance(std::uint32_t sheet) { return distances_[group(sheet)]; }

  private:
    [[nodiscard]] std::uint32_t group(std::uint32_t sheet) {
        for (;;) {
            std::uint32_t& parent = parents_.try_emplace(sheet, sheet).first->second;
            if (parent == sheet) return sheet;
            parent = parents_.at(parent);  // so that the way is shorter next time
            sheet = parent;
        }
    }

    std::unordered_map<std::uint32_t, std::uint32_t> parents_;
    std::unordered_map<std::uint32_t, double> distances_;
};

/// Moves thin sheets that touch something by a few times what rounding may: in front of what stops light, out of
/// bodies, behind lamps, and one before the other. True if any was moved.
bool move_sheets_apart(const Touches& touches, WorldData& data) {
    const std::vector<Slot> slots = all_slots(data);
    const auto material = [&](std::uint32_t slot) -> const Material& {
        return data.materials[data.geometries[slots[slot].geometry].material];
    };
    std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, Touch>>> partners;  // of sheets
    for (const auto& [pair, touch] : touches.pairs)
        for (const auto& [sheet, other] : {pair, std::pair(pair.second, pair.first)})
            if (is_sheet(material(sheet))) partners[sheet].emplace_back(other, touch);
    // Sheets that touch share the largest distance in their group, since rounding grows with distance from the origin.
    SheetGroups groups;
    for (const auto& [sheet, touching] : partners)
        for (const auto& [other, touch] : touching)
            groups.join(sheet, partners.contains(other) ? other : sheet, touch.distance);
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
        move_along_normals(slots[sheet], static_cast<float>(2.0 * groups.distance(sheet) * step), data);
        any = true;
    }
    return any;
}

/// For each plane of surfaces that lie within rounding of `point` its normal, as long as it takes to be clear of it.
std::vector<Vec3f> planes_through(const WorldData& data, const Vec3f& point) {
    constexpr double kAlike = 0.99;
    const Vec3f error = position_error(abs_components(point));
    const Vec3f extent = max_components(abs_components(data.bounds.min), abs_components(data.bounds.max));
    const float radius =
        8.0f * clearance({1.0f, 1.0f, 1.0f}, position_error(max_components(extent, abs_components(point))));
    std::vector<Vec3f> planes;
    data.bvh->for_each_near(point, radius, [&](std::uint32_t instance, std::uint32_t geometry, std::uint32_t t) {
        if (t >= touching_triangles(data.geometries[geometry])) return true;
        const PlacedTriangle triangle = place(data, instance, geometry, t);
        if (triangle.is_degenerate()) return true;
        const Vec3f normal(triangle.normal);
        const double distance =
            point_contact_distance(triangle.clearance, static_cast<double>(clearance(normal, error)));
        if (!is_near(triangle, Vec3d(point), distance)) return true;
        const Vec3f plane(triangle.normal * distance);
        const auto same = std::ranges::find_if(planes, [&](const Vec3f& other) {
            return std::abs(triangle.normal.dot(Vec3d(other))) > kAlike * Vec3d(other).length();
        });
        if (same == planes.end())
            planes.push_back(plane);
        else if (length(*same) < length(plane))
            *same = plane;
        return true;
    });
    return planes;
}

}  // namespace

void build_bvh(const ThreadPool& threads, WorldData& data, ProblemList& problems) {
    std::vector<HitFilter> filters;
    filters.reserve(data.geometries.size());
    for (const Geometry& geometry : data.geometries) {
        const Material& material = data.materials[geometry.material];
        filters.push_back({.by_opacity = material.alpha_test != AlphaTest::Opaque,
                           .passes_shadows = material.is_clear,
                           .is_hidden = !material.visible_to_camera,
                           .culls_back = material.culls_back});
    }
    data.bvh = std::make_unique<EmbreeScene>(data.geometries, data.instances, data.motions, filters, threads);
    Touches touches = find_touches(data, threads);
    if (move_sheets_apart(touches, data)) {
        data.bvh.reset();  // memory need not hold both
        data.bvh = std::make_unique<EmbreeScene>(data.geometries, data.instances, data.motions, filters, threads);
        touches = find_touches(data, threads);
    }
    const std::vector<Slot> slots = all_slots(data);
    std::vector<CollectedSlot> clear_slots(slots.size());
    for (const Slot& slot : slots)
        clear_slots[slot.index].is_whole = data.materials[data.geometries[slot.geometry].material].is_clear;
    if (std::ranges::any_of(clear_slots, &CollectedSlot::is_whole))
        data.clear_surfaces = std::make_unique<EmbreeScene>(data.geometries, data.instances, data.motions, filters,
                                                            threads, std::move(clear_slots));
    if (touches.pairs.empty() && touches.is_complete) return;
    const auto emits = [&](std::uint32_t slot) {
        return data.materials[data.geometries[slots[slot].geometry].material].emits;
    };
    std::vector<ContactSlot> contacts(slots.size());
    data.shares_place_of_slot.assign(slots.size(), 0);
    for (const auto& [pair, touch] : touches.pairs)
        for (const std::uint32_t slot : {pair.first, pair.second}) {
            contacts[slot].reach = std::max(contacts[slot].reach, static_cast<float>(touch.distance));
            // If one of the two moves, they touch in different places at different times.
            if (moves(data, slots[pair.first]) || moves(data, slots[pair.second]))
                contacts[slot].is_anywhere = true;
            else
                for (const Bounds& place : touch.places) contacts[slot].add(place);
            if (emits(pair.first) && emits(pair.second)) data.shares_place_of_slot[slot] = 1;
        }
    if (!touches.is_complete) {
        problems.note({},
                      "so many surfaces overlap that not all could be looked at: rays ask everywhere for surfaces that "
                      "touch, which takes longer");
        for (const Slot& slot : slots) {
            contacts[slot.index].is_anywhere = true;
            if (emits(slot.index)) data.shares_place_of_slot[slot.index] = 1;  // it may
            for (std::uint32_t t = 0; t < touching_triangles(data.geometries[slot.geometry]); ++t) {
                const TrianglePlane plane = triangle_plane(data, slot.instance, slot.geometry, t);
                contacts[slot.index].reach = std::max(contacts[slot.index].reach, contact_distance(plane, plane));
            }
        }
    }
    data.contacts = std::make_unique<Contacts>(data, std::move(contacts), filters, threads);
}

void find_planes_of_lamps(WorldData& data) {
    for (std::size_t light = 0; light < data.lights.size(); ++light) {
        const std::optional<Vec3f> lamp = light_point(data.lights[light]);
        if (!lamp || data.motion_of(static_cast<std::uint32_t>(light)) != nullptr) continue;
        std::vector<Vec3f> planes = planes_through(data, *lamp);
        if (planes.empty()) continue;
        data.planes_of_light.resize(data.lights.size());
        data.planes_of_light[light] = std::move(planes);
    }
}

void move_camera_off_surfaces(WorldData& data) {
    if (!data.camera_motion.empty()) return;
    CameraPose pose = pose_of(data.camera);
    for (const Vec3f& plane : planes_through(data, pose.position))
        pose.position += dot(plane, pose.forward) >= 0.0f ? plane : -plane;
    data.camera = with_pose(data.camera, pose);
}

}  // namespace etendue
