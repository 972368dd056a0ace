// How the tree of light_tree.h is built.
#include "light/light_bounds.h"
#include "light/light_tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace etendue {

namespace {

/// Is the share of choices among lights at infinity that is uniform.
constexpr double kAnyFar = 0.1;
/// Is the share of a box's squared diagonal over the number of its lamps that is taken for the square of how near the
/// nearest is.
constexpr float kNear = 0.02f;
constexpr int kBins = 12;
/// Below so many levels lights are split in halves: as many levels more hold all that have an index.
constexpr int kBinnedLevels = 8;

/// Conty Estevez and Kulla's equation 1, with the square of the diagonal for the area of the box: lamps in a row have
/// none.
double cost(const LightBounds& bounds) {
    return bounds.power * bounds.cone.measure() * Vec3d(bounds.box.size()).length2();
}

/// Turns bounds around single lights into those of all.
LightBounds united(const LightBounds& all, const LightBounds& one, bool is_first) {
    return is_first ? one : all.united(one);
}

std::vector<std::optional<LightBounds>> bounds_of_each(std::span<const Light> lights) {
    std::vector<std::optional<LightBounds>> bounds;
    for (const Light& light : lights) bounds.push_back(light_bounds(light));
    return bounds;
}

double intensity(const LightBounds& bounds) {
    return bounds.power / bounds.cone.measure();
}

/// Returns what importances need of the lights within `bounds`, with the intensity in units of `unit`.
LightNode light_node(const LightBounds& bounds, double unit) {
    const EmissionCone& cone = bounds.cone;
    return {.low = bounds.box.min,
            .high = bounds.box.max,
            .axis = cone.axis,
            .squared_spacing = kNear * length_squared(bounds.box.size()) / static_cast<float>(bounds.count),
            .intensity = static_cast<float>(intensity(bounds) / unit),
            .cos_o = cone.theta_o < std::numbers::pi ? static_cast<float>(std::cos(cone.theta_o)) : -1.0f,
            .sin_o = static_cast<float>(std::sin(cone.theta_o)),
            .cos_e = static_cast<float>(std::cos(cone.theta_e)),
            .two_sided = cone.two_sided ? 1.0f : 0.0f};
}

}  // namespace

struct LightTree::Leaf {
    LightBounds bounds;
    Vec3f center;
    std::uint32_t light = 0;
};

LightTree::LightTree(std::span<const Light> lights, float scene_radius)
    : LightTree(lights, bounds_of_each(lights), scene_radius) {}

LightTree::LightTree(std::span<const Light> lights, std::span<const std::optional<LightBounds>> bounds_of_light,
                     float scene_radius)
    : places_(lights.size()) {
    assert(lights.size() < kLeaf);
    const bool none_shines = std::all_of(
        lights.begin(), lights.end(), [&](const Light& light) { return !(light_power(light, scene_radius) > 0.0f); });
    std::vector<float> powers;
    for (const Light& light : lights) powers.push_back(compensated_power(light, scene_radius));
    std::vector<Leaf> leaves;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        // Without any power, all are as good.
        if (none_shines) powers[i] = 1.0f;
        if (!(powers[i] > 0.0f)) continue;
        const auto index = static_cast<std::uint32_t>(i);
        if (std::optional<LightBounds> bounds = bounds_of_light[i]) {
            bounds->power = static_cast<double>(powers[i]);
            places_[i].index = static_cast<std::uint32_t>(near_.size());
            near_.push_back(index);
            leaves.push_back({*bounds, bounds->box.center(), index});
        } else {
            places_[i] = {.index = static_cast<std::uint32_t>(far_.size()), .is_far = true};
            far_.push_back(index);
        }
    }
    double far_power = 0.0;
    for (const std::uint32_t light : far_) far_power += static_cast<double>(powers[light]);
    double end = 0.0;
    for (const std::uint32_t light : far_) {
        const double by_power = static_cast<double>(powers[light]) / far_power;
        end += (1.0 - kAnyFar) * by_power + kAnyFar / static_cast<double>(far_.size());
        far_ends_.push_back(end);
    }
    if (!far_ends_.empty()) far_ends_.back() = 1.0;
    const auto radius = static_cast<double>(scene_radius);
    far_irradiance_ = far_power / (std::numbers::pi * radius * radius);
    if (leaves.empty() && far_.size() == 1) single_ = far_.front();
    if (leaves.empty()) return;
    nodes_.emplace_back();
    root_intensity_ = build(0, leaves, 0, 0);
    nodes_.shrink_to_fit();
    if (far_.empty() && near_.size() == 1 && std::isfinite(root_intensity_)) single_ = near_.front();
}

std::size_t LightTree::split_by_cost(std::span<Leaf> leaves) {
    Bounds centers;
    for (const Leaf& leaf : leaves) centers.extend(leaf.center);
    const Vec3f size = centers.size();
    const float longest = std::max({size.x, size.y, size.z});
    double least = std::numeric_limits<double>::infinity();
    int best_axis = 0;
    int best_bin = 0;
    const auto bin_of = [&](const Leaf& leaf, int axis) {
        const float place = (leaf.center[axis] - centers.min[axis]) / size[axis];
        return std::clamp(static_cast<int>(place * static_cast<float>(kBins)), 0, kBins - 1);
    };
    for (int axis = 0; axis < 3; ++axis) {
        if (!(size[axis] > 0.0f)) continue;
        struct Bin {
            LightBounds bounds;
            std::size_t count = 0;
        };
        std::array<Bin, kBins> bins;
        for (const Leaf& leaf : leaves) {
            Bin& bin = bins[static_cast<std::size_t>(bin_of(leaf, axis))];
            bin.bounds = united(bin.bounds, leaf.bounds, bin.count == 0);
            ++bin.count;
        }
        std::array<double, kBins> below{};
        Bin sum;
        const auto add = [&](const Bin& bin) {
            if (bin.count == 0) return;
            sum.bounds = united(sum.bounds, bin.bounds, sum.count == 0);
            sum.count += bin.count;
        };
        for (std::size_t b = 0; b + 1 < kBins; ++b) {
            add(bins[b]);
            below[b] = sum.count > 0 ? cost(sum.bounds) : std::numeric_limits<double>::infinity();
        }
        sum = {};
        // Thin slices of long nodes cost more than they seem to (ibid., equation 2, K_r).
        const auto slimness = static_cast<double>(longest / size[axis]);
        for (std::size_t b = kBins - 1; b > 0; --b) {
            add(bins[b]);
            if (sum.count == 0) continue;
            const double both = slimness * (below[b - 1] + cost(sum.bounds));
            if (both < least) {
                least = both;
                best_axis = axis;
                best_bin = static_cast<int>(b);
            }
        }
    }
    // Those in one place are all the same.
    if (!std::isfinite(least)) return leaves.size() / 2;
    const auto middle = std::stable_partition(leaves.begin(), leaves.end(),
                                              [&](const Leaf& leaf) { return bin_of(leaf, best_axis) < best_bin; });
    return static_cast<std::size_t>(middle - leaves.begin());
}

std::size_t LightTree::next_to_split(std::span<const std::span<Leaf>> parts) {
    const auto fewer = [](std::span<Leaf> a, std::span<Leaf> b) { return a.size() < b.size(); };
    const auto largest = std::max_element(parts.begin(), parts.end(), fewer);
    if (largest->size() > kChildren) return static_cast<std::size_t>(largest - parts.begin());
    // All could be nodes of their own: what is split now until it is single lights needs none.
    std::size_t smallest = parts.size();
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i].size() > 1 && (smallest == parts.size() || fewer(parts[i], parts[smallest]))) smallest = i;
    return smallest;
}

double LightTree::build(std::uint32_t node, std::span<Leaf> leaves, std::uint64_t trail, int level) {
    assert(level < 64 / kBitsOfALevel);
    // Neighbours stay side by side.
    std::vector<std::span<Leaf>> parts{leaves};
    while (parts.size() < kChildren) {
        const std::size_t part = next_to_split(parts);
        if (part == parts.size()) break;
        const std::span<Leaf> whole = parts[part];
        const std::size_t count = level < kBinnedLevels ? split_by_cost(whole) : whole.size() / 2;
        parts[part] = whole.first(count);
        parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(part) + 1, whole.subspan(count));
    }
    std::array<LightBounds, kChildren> bounds;
    double strongest = 0.0;
    for (std::size_t child = 0; child < parts.size(); ++child) {
        bounds[child] = parts[child].front().bounds;
        for (const Leaf& leaf : parts[child].subspan(1)) bounds[child] = bounds[child].united(leaf.bounds);
        strongest = std::max(strongest, intensity(bounds[child]));
    }
    nodes_[node].next.fill(kNone);
    for (std::size_t child = 0; child < parts.size(); ++child) {
        const std::span<Leaf> part = parts[child];
        const LightNode as_node = light_node(bounds[child], strongest);
        nodes_[node].children.set(child, as_node);
        if (level == 0) at_root_.push_back(as_node);
        const std::uint64_t way = trail | std::uint64_t{child} << (kBitsOfALevel * level);
        if (part.size() == 1) {
            nodes_[node].next[child] = part.front().light | kLeaf;
            places_[part.front().light].trail = way;
        } else {
            const auto next = static_cast<std::uint32_t>(nodes_.size());
            nodes_[node].next[child] = next;
            nodes_.emplace_back();
            build(next, part, way, level + 1);
        }
    }
    return strongest;
}

}  // namespace etendue
