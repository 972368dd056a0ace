#include "light/light_tree.h"

#include "core/vector_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace etendue {

namespace {

/// Of choices that are uniform.
constexpr double kAny = 0.1;
constexpr double kLeastOfASide = 0.1;
/// Of the cosine: what bounds and rounding exclude keeps this share of its importance.
constexpr float kFloor = 1e-3f;
/// Of the squared diagonal of a box over the number of its lamps: how near the nearest is taken to be.
constexpr float kNear = 0.02f;
constexpr int kBins = 12;
/// Nodes below are split in halves.
constexpr int kDeepestBinned = 32;

/// Conty Estevez and Kulla's equation 1, with the square of the diagonal for the area of the box: lamps in a row have
/// none.
double cost(const LightBounds& bounds) {
    return bounds.power * bounds.cone.measure() * Vec3d(bounds.box.size()).length2();
}

/// The digits of both numbers, one after the other.
double joined(Vec2f u) {
    constexpr double kDigits = 1.0 / 16777216.0;  // of a float in [0, 1)
    return static_cast<double>(u.x) + static_cast<double>(u.y) * kDigits;
}

/// Decides with `u`, of which it leaves what may decide again.
bool takes_first(double& u, double share) {
    constexpr double kBelowOne = 1.0 - 0x1p-53;
    const bool first = u < share;
    u = std::min(first ? u / share : (u - share) / (1.0 - share), kBelowOne);
    return first;
}

/// Turns bounds around single lights into those of all.
LightBounds united(const LightBounds& all, const LightBounds& one, bool is_first) {
    return is_first ? one : all.united(one);
}

}  // namespace

struct LightTree::Leaf {
    LightBounds bounds;
    Vec3f center;
    std::uint32_t light = 0;
};

LightTree::LightTree(std::span<const Light> lights, float scene_radius) : places_(lights.size()) {
    std::vector<float> powers;
    for (const Light& light : lights) powers.push_back(light_power(light, scene_radius));
    const bool none_shines = std::all_of(powers.begin(), powers.end(), [](float power) { return !(power > 0.0f); });
    std::vector<Leaf> leaves;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        // Without any power, all are as good.
        if (none_shines) powers[i] = 1.0f;
        if (!(powers[i] > 0.0f)) continue;
        const auto index = static_cast<std::uint32_t>(i);
        if (std::optional<LightBounds> bounds = light_bounds(lights[i])) {
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
        end += (1.0 - kAny) * by_power + kAny / static_cast<double>(far_.size());
        far_ends_.push_back(end);
    }
    if (!far_ends_.empty()) far_ends_.back() = 1.0;
    const auto radius = static_cast<double>(scene_radius);
    far_irradiance_ = far_power / (std::numbers::pi * radius * radius);
    if (leaves.empty() && far_.size() == 1) single_ = far_.front();
    if (leaves.empty()) return;
    nodes_.reserve(2 * leaves.size() - 1);
    nodes_.emplace_back();
    build(0, leaves, 0, 0);
    if (far_.empty() && near_.size() == 1 && std::isfinite(nodes_.front().intensity)) single_ = near_.front();
}

LightTree::Node LightTree::make_node(const LightBounds& bounds) {
    const EmissionCone& cone = bounds.cone;
    Node node{};
    node.low = bounds.box.min;
    node.high = bounds.box.max;
    node.axis = cone.axis;
    node.squared_spacing = kNear * length_squared(bounds.box.size()) / static_cast<float>(bounds.count);
    node.intensity = static_cast<float>(bounds.power / cone.measure());
    node.cos_o = cone.theta_o < std::numbers::pi ? static_cast<float>(std::cos(cone.theta_o)) : -1.0f;
    node.sin_o = static_cast<float>(std::sin(cone.theta_o));
    node.cos_e = static_cast<float>(std::cos(cone.theta_e));
    node.two_sided = cone.two_sided;
    return node;
}

void LightTree::build(std::uint32_t node, std::span<Leaf> leaves, std::uint64_t trail, int depth) {
    LightBounds all = leaves.front().bounds;
    Bounds centers;
    centers.extend(leaves.front().center);
    for (const Leaf& leaf : leaves.subspan(1)) {
        all = all.united(leaf.bounds);
        centers.extend(leaf.center);
    }
    nodes_[node] = make_node(all);
    if (leaves.size() == 1) {
        nodes_[node].is_leaf = true;
        nodes_[node].next = leaves.front().light;
        places_[leaves.front().light].trail = trail;
        return;
    }

    const Vec3f size = centers.size();
    const float longest = std::max({size.x, size.y, size.z});
    double least = std::numeric_limits<double>::infinity();
    int best_axis = 0;
    int best_bin = 0;
    const auto bin_of = [&](const Leaf& leaf, int axis) {
        const float place = (leaf.center[axis] - centers.min[axis]) / size[axis];
        return std::clamp(static_cast<int>(place * static_cast<float>(kBins)), 0, kBins - 1);
    };
    for (int axis = 0; axis < 3 && depth < kDeepestBinned; ++axis) {
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
            const double split = slimness * (below[b - 1] + cost(sum.bounds));
            if (split < least) {
                least = split;
                best_axis = axis;
                best_bin = static_cast<int>(b);
            }
        }
    }
    std::size_t count = leaves.size() / 2;
    if (std::isfinite(least)) {
        const auto middle = std::stable_partition(leaves.begin(), leaves.end(),
                                                  [&](const Leaf& leaf) { return bin_of(leaf, best_axis) < best_bin; });
        count = static_cast<std::size_t>(middle - leaves.begin());
    }
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].next = first;
    nodes_.resize(nodes_.size() + 2);
    build(first, leaves.first(count), trail, depth + 1);
    build(first + 1, leaves.subspan(count), trail | std::uint64_t{1} << depth, depth + 1);
}

double LightTree::Node::importance(const Vec3f& point) const {
    constexpr float kLeastSquare = 1e-30f;
    float nearest = 0.0f;
    float farthest = 0.0f;
    for (int axis_index = 0; axis_index < 3; ++axis_index) {
        const float below = low[axis_index] - point[axis_index];
        const float above = point[axis_index] - high[axis_index];
        const float outside = std::max({below, above, 0.0f});
        const float across = std::max(-below, -above);
        nearest += outside * outside;
        farthest += across * across;
    }
    nearest = std::max({nearest, squared_spacing, kLeastSquare});
    farthest = std::max(farthest, nearest);
    const float mean = std::sqrt(nearest) * std::sqrt(farthest);
    const double by_distance = static_cast<double>(intensity) / static_cast<double>(mean);
    const Vec3f to_point = point - (low + high) * 0.5f;
    const float squared = length_squared(to_point);
    const float squared_radius = 0.25f * length_squared(high - low);
    // Inside of the sphere, or where light leaves every way.
    if (cos_o <= -1.0f || squared <= squared_radius) return by_distance;
    const float cos_between = dot(axis, to_point) / std::sqrt(squared);
    const float cos_w = std::clamp(two_sided ? std::abs(cos_between) : cos_between, -1.0f, 1.0f);
    const float sin_w = std::sqrt(1.0f - cos_w * cos_w);
    if (cos_w >= cos_o) return by_distance;
    const float cos_x = cos_w * cos_o + sin_w * sin_o;
    const float sin_x = sin_w * cos_o - cos_w * sin_o;
    const float sin_b = std::sqrt(squared_radius / squared);
    const float cos_b = std::sqrt(std::max(0.0f, 1.0f - squared_radius / squared));
    if (cos_x >= cos_b) return by_distance;
    const float cos_least = cos_x * cos_b + sin_x * sin_b;
    return by_distance * static_cast<double>(cos_least < cos_e ? kFloor : std::max(cos_least, kFloor));
}

double LightTree::first_share(const Node& node, const Vec3f& point) const {
    const double first = nodes_[node.next].importance(point);
    const double sum = first + nodes_[node.next + 1].importance(point);
    return sum > 0.0 ? first / sum : 0.5;
}

double LightTree::far_share(const Vec3f& point) const {
    if (far_.empty()) return 0.0;
    if (near_.empty()) return 1.0;
    const double share = far_irradiance_ / (far_irradiance_ + nodes_.front().importance(point));
    return std::clamp(share, kLeastOfASide, 1.0 - kLeastOfASide);
}

float LightTree::near_probability(double far_share, double by_tree) const {
    // Lamps beyond what floats hold have no probability, as they have none to emit: their samples are dropped and
    // counted.
    if (!std::isfinite(nodes_.front().intensity)) return std::numeric_limits<float>::quiet_NaN();
    if (near_.size() == 1) return static_cast<float>(1.0 - far_share);
    const double any = kAny / static_cast<double>(near_.size());
    return static_cast<float>((1.0 - far_share) * ((1.0 - kAny) * by_tree + any));
}

LightTree::Choice LightTree::sample(const Vec3f& point, Vec2f u) const {
    if (single_ != kNone) return {single_, 1.0f};
    double rest = joined(u);
    const double far = far_share(point);
    if (takes_first(rest, far)) {
        const auto end = std::upper_bound(far_ends_.begin(), far_ends_.end(), rest);
        const std::uint32_t light = far_[static_cast<std::size_t>(end - far_ends_.begin())];
        return {light, probability(point, light)};
    }
    if (near_.size() > 1 && takes_first(rest, kAny)) {
        const auto place = static_cast<std::size_t>(rest * static_cast<double>(near_.size()));
        const std::uint32_t light = near_[std::min(place, near_.size() - 1)];
        return {light, probability(point, light)};
    }
    const Node* node = &nodes_.front();
    double by_tree = 1.0;
    while (!node->is_leaf) {
        const double share = first_share(*node, point);
        const bool first = takes_first(rest, share);
        by_tree *= first ? share : 1.0 - share;
        node = &nodes_[node->next + (first ? 0 : 1)];
    }
    return {node->next, near_probability(far, by_tree)};
}

float LightTree::probability(const Vec3f& point, std::size_t light) const {
    const Place& place = places_[light];
    if (place.index == kNone) return 0.0f;
    if (single_ != kNone) return 1.0f;
    const double far = far_share(point);
    if (place.is_far) {
        const double begin = place.index > 0 ? far_ends_[place.index - 1] : 0.0;
        return static_cast<float>(far * (far_ends_[place.index] - begin));
    }
    const Node* node = &nodes_.front();
    double by_tree = 1.0;
    for (std::uint64_t trail = place.trail; !node->is_leaf; trail >>= 1) {
        const double share = first_share(*node, point);
        const bool first = (trail & 1) == 0;
        by_tree *= first ? share : 1.0 - share;
        node = &nodes_[node->next + (first ? 0 : 1)];
    }
    return near_probability(far, by_tree);
}

std::size_t LightTree::bytes() const {
    return vector_bytes(nodes_, places_, near_, far_, far_ends_);
}

}  // namespace etendue
