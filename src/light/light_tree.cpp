#include "light/light_tree.h"

#include "core/vector_bytes.h"
#include "core/wide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace etendue {

namespace {

/// Of choices among lamps that are uniform.
constexpr double kAny = 0.03;
constexpr double kLeastOfASide = 0.1;
/// Of the cosine: what bounds and rounding exclude keeps this share of its importance.
constexpr float kFloor = 1e-3f;
/// Of what a matte surface receives: this share by the bound, the rest by the mean.
constexpr float kByBound = 0.1f;
/// Of wo, where a lobe grows without bound as it grazes.
constexpr float kLeastCosine = 0.1f;
/// m², whose power of 3/2 floats still hold.
constexpr float kLeastSoftened = 1e-20f;
/// 1/m², where no child has more.
constexpr float kLeastImportance = 1e-30f;

/// The digits of both numbers, one after the other.
double joined(Vec2f u) {
    constexpr double kDigits = 1.0 / 16777216.0;  // of a float in [0, 1)
    return static_cast<double>(u.x) + static_cast<double>(u.y) * kDigits;
}

constexpr double kBelowOne = 1.0 - 0x1p-53;

/// Decides with `u`, of which it leaves what may decide again.
bool takes_first(double& u, double share) {
    const bool first = u < share;
    u = std::min(first ? u / share : (u - share) / (1.0 - share), kBelowOne);
    return first;
}

/// What is known of several children.
struct Shapes {
    Imath::Vec3<Wide> low, high, axis;
    Wide squared_spacing, cos_o, sin_o, cos_e, two_sided;
};

/// Children as a point sees them. May be no numbers where floats overflow.
struct Sight {
    Wide by_distance;           ///< 1/m², of the nearest and the farthest point of each box
    Wide squared;               ///< to the middle of the box, m²
    Wide squared_radius;        ///< of the sphere around it, m²
    Wide inverse_distance;      ///< to the middle, 1/m
    Wide cos_b, squared_sin_b;  ///< of half the angle that the sphere is seen under
    WideMask is_inside;         ///< the point lies in the sphere
    Wide emitted;               ///< the cosine at the lamps, at most
};

/// `along(axis)` is the distance of the point from the middle of the box, along that axis.
template <typename Along>
Sight look_at(const Shapes& shapes, const Vec3f& point, const Along& along) {
    constexpr float kLeastSquare = 1e-30f;
    Wide nearest(0.0f);
    Wide farthest(0.0f);
    Wide squared(0.0f);
    Wide squared_radius(0.0f);
    Wide along_axis(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        const Wide below = shapes.low[axis] - point[axis];
        const Wide above = point[axis] - shapes.high[axis];
        const Wide outside = max(max(below, above), 0.0f);
        const Wide across = max(-below, -above);
        nearest = nearest + outside * outside;
        farthest = farthest + across * across;
        const Wide to_point = along(axis);
        const Wide size = shapes.high[axis] - shapes.low[axis];
        squared = squared + to_point * to_point;
        squared_radius = squared_radius + size * size * 0.25f;
        along_axis = along_axis + shapes.axis[axis] * to_point;
    }
    nearest = max(max(nearest, shapes.squared_spacing), kLeastSquare);
    farthest = max(farthest, nearest);
    const Wide inverse_distance = 1.0f / sqrt(squared);
    // Less theta_o, and then less theta_b.
    const Wide cos_between = along_axis * inverse_distance;
    const Wide cos_w = max(min(select(shapes.two_sided > 0.0f, abs(cos_between), cos_between), 1.0f), -1.0f);
    const Wide sin_w = sqrt(1.0f - cos_w * cos_w);
    const Wide cos_x = cos_w * shapes.cos_o + sin_w * shapes.sin_o;
    const Wide sin_x = sin_w * shapes.cos_o - cos_w * shapes.sin_o;
    const Wide squared_sin_b = min(squared_radius / squared, 1.0f);
    const Wide cos_b = sqrt(1.0f - squared_sin_b);
    const Wide cos_least = cos_x * cos_b + sin_x * sqrt(squared_sin_b);
    // Inside of the sphere, or where light leaves every way.
    const WideMask is_inside = squared <= squared_radius;
    const auto is_anywhere = shapes.cos_o <= -1.0f || is_inside;
    const auto is_within = cos_w >= shapes.cos_o || cos_x >= cos_b;
    const Wide cosine = select(cos_least < shapes.cos_e, kFloor, max(cos_least, kFloor));
    return {.by_distance = 1.0f / (sqrt(nearest) * sqrt(farthest)),
            .squared = squared,
            .squared_radius = squared_radius,
            .inverse_distance = inverse_distance,
            .cos_b = cos_b,
            .squared_sin_b = squared_sin_b,
            .is_inside = is_inside,
            .emitted = select(is_anywhere || is_within, 1.0f, cosine)};
}

/// Importances for an intensity of one, 1/m².
Wide falloff(const Shapes& shapes, const LightReceiver& receiver) {
    const auto along = [&](int axis) {
        return receiver.position[axis] - (shapes.low[axis] + shapes.high[axis]) * 0.5f;
    };
    const Sight sight = look_at(shapes, receiver.position, along);
    if (!receiver.has_normal()) return sight.by_distance * sight.emitted;

    const auto towards = [&](const Vec3f& direction) {
        return -(along(0) * direction.x + along(1) * direction.y + along(2) * direction.z);
    };
    const Wide height = towards(receiver.normal);
    const Wide cos_i = clamp(height * sight.inverse_distance, -1.0f, 1.0f);
    const Wide cos_most = cos_i * sight.cos_b + sqrt(1.0f - cos_i * cos_i) * sqrt(sight.squared_sin_b);
    const Wide cosine = select(sight.is_inside || cos_i >= sight.cos_b, 1.0f, max(cos_most, kFloor));
    const Wide softened = max(sight.squared + sight.squared_radius * (1.0f / 3.0f), kLeastSoftened);
    const Wide mean = max(height, 0.0f) / (softened * sqrt(softened));
    const Wide matte = mean * (1.0f - kByBound) + sight.by_distance * cosine * kByBound;
    if (receiver.glossy == 0.0f) return sight.emitted * matte;

    const float cos_o = dot(receiver.normal, receiver.wo);
    const Wide cos_both = cos_i + cos_o;
    const Wide cos_between = clamp(towards(receiver.wo) * sight.inverse_distance, -1.0f, 1.0f);
    const Wide squared_cos_h = min(cos_both * cos_both / max(2.0f + 2.0f * cos_between, 1e-6f), 1.0f);
    const Wide squared_alpha = min(receiver.alpha * receiver.alpha + sight.squared_sin_b * 0.25f, 1.0f);
    const Wide spread = squared_cos_h * (squared_alpha - 1.0f) + 1.0f;
    const Wide lobe = squared_alpha / (spread * spread) * (0.25f / std::max(cos_o, kLeastCosine));
    const Wide mirrored = sight.by_distance * select(cosine > kFloor, max(lobe, kFloor), kFloor);
    return sight.emitted * (matte * (1.0f - receiver.glossy) + mirrored * receiver.glossy);
}

}  // namespace

LightTree::Importances LightTree::weigh(const Node& node, const LightReceiver& receiver) {
    static_assert(kChildren % Wide::kWidth == 0 && alignof(PerChild) >= Wide::kAlignment);
    Importances importances;
    for (std::size_t first = 0; first < kChildren; first += Wide::kWidth) {
        const auto load = [first](const PerChild& column) { return Wide::load(&column[first]); };
        const auto load_vector = [&](const std::array<PerChild, 3>& columns) {
            return Imath::Vec3<Wide>(load(columns[0]), load(columns[1]), load(columns[2]));
        };
        const Shapes shapes{.low = load_vector(node.low),
                            .high = load_vector(node.high),
                            .axis = load_vector(node.axis),
                            .squared_spacing = load(node.squared_spacing),
                            .cos_o = load(node.cos_o),
                            .sin_o = load(node.sin_o),
                            .cos_e = load(node.cos_e),
                            .two_sided = load(node.two_sided)};
        const Wide importance = load(node.intensity) * falloff(shapes, receiver);
        const Wide valid = select(importance > 0.0f, importance, 0.0f);
        valid.store(&importances.each[first]);
    }
    const auto add = [&importances] {
        double sum = 0.0;
        for (std::size_t child = 0; child < kChildren; ++child)
            importances.ends[child] = sum += static_cast<double>(importances.each[child]);
    };
    add();
    if (importances.sum() > 0.0) return importances;
    // Where floats do not tell them apart, all are as good, and as little.
    for (std::size_t child = 0; child < kChildren; ++child)
        importances.each[child] = node.next[child] != kNone ? kLeastImportance : 0.0f;
    add();
    return importances;
}

double LightTree::far_share(const Importances& near) const {
    if (far_.empty()) return 0.0;
    const double share = far_irradiance_ / (far_irradiance_ + root_intensity_ * near.sum());
    return std::clamp(share, kLeastOfASide, 1.0 - kLeastOfASide);
}

float LightTree::near_probability(double far_share, double by_tree) const {
    // Lamps beyond what floats hold have no probability, as they have none to emit: their samples are dropped and
    // counted.
    if (!std::isfinite(root_intensity_)) return std::numeric_limits<float>::quiet_NaN();
    if (near_.size() == 1) return static_cast<float>(1.0 - far_share);
    const double any = kAny / static_cast<double>(near_.size());
    return static_cast<float>((1.0 - far_share) * ((1.0 - kAny) * by_tree + any));
}

double LightTree::share(const Importances& importances, std::size_t child) {
    return static_cast<double>(importances.each[child]) / importances.sum();
}

LightTree::Choice LightTree::far_choice(double share, double u) const {
    const auto end = std::upper_bound(far_ends_.begin(), far_ends_.end(), u);
    const auto index = static_cast<std::size_t>(end - far_ends_.begin());
    return {far_[index], far_probability(share, index)};
}

float LightTree::far_probability(double share, std::size_t index) const {
    const double begin = index > 0 ? far_ends_[index - 1] : 0.0;
    return static_cast<float>(share * (far_ends_[index] - begin));
}

bool LightTree::begin(Walk& walk, const LightReceiver& receiver, Vec2f u) const {
    walk.rest = joined(u);
    if (near_.empty()) return walk.end_at(far_choice(1.0, walk.rest));
    const Importances importances = weigh(nodes_.front(), receiver);
    walk.far = far_share(importances);
    if (takes_first(walk.rest, walk.far)) return walk.end_at(far_choice(walk.far, walk.rest));
    if (near_.size() > 1 && takes_first(walk.rest, kAny)) {
        const auto place = static_cast<std::size_t>(walk.rest * static_cast<double>(near_.size()));
        const std::uint32_t light = near_[std::min(place, near_.size() - 1)];
        return walk.end_at({light, probability(receiver, light)});
    }
    return descend(walk, nodes_.front(), importances);
}

bool LightTree::descend(Walk& walk, const Node& node, const Importances& importances) const {
    // Less than the sum, which is the last of the ends.
    const double wanted = walk.rest * importances.sum();
    std::size_t child = 0;
    for (const double end : importances.ends) child += end <= wanted ? 1 : 0;
    const double below = child > 0 ? importances.ends[child - 1] : 0.0;
    walk.rest = std::min((wanted - below) / static_cast<double>(importances.each[child]), kBelowOne);
    walk.by_tree *= share(importances, child);
    const std::uint32_t next = node.next[child];
    if ((next & kLeaf) != 0) return walk.end_at({next & ~kLeaf, near_probability(walk.far, walk.by_tree)});
    walk.node = next;
    return false;
}

LightTree::Choice LightTree::sample(const LightReceiver& receiver, Vec2f u) const {
    if (single_ != kNone) return {single_, 1.0f};
    Walk walk;
    for (bool ended = begin(walk, receiver, u); !ended;)
        ended = descend(walk, nodes_[walk.node], weigh(nodes_[walk.node], receiver));
    return walk.choice;
}

void LightTree::sample(std::span<const LightReceiver> receivers, std::span<const Vec2f> u,
                       std::span<Choice> choices) const {
    if (single_ != kNone) {
        std::ranges::fill(choices, Choice{single_, 1.0f});
        return;
    }
    // As many as have nodes under way in the first-level cache.
    constexpr std::size_t kTogether = 16;
    for (std::size_t first = 0; first < receivers.size(); first += kTogether) {
        const std::size_t count = std::min(kTogether, receivers.size() - first);
        std::array<Walk, kTogether> walks;
        std::array<std::uint8_t, kTogether> under_way;
        std::size_t left = 0;
        const auto take = [&](std::size_t i, bool ended) {
            if (ended) {
                choices[first + i] = walks[i].choice;
            } else {
                fetch(nodes_[walks[i].node]);
                under_way[left++] = static_cast<std::uint8_t>(i);
            }
        };
        for (std::size_t i = 0; i < count; ++i) take(i, begin(walks[i], receivers[first + i], u[first + i]));
        while (left > 0) {
            const std::size_t before = std::exchange(left, 0);
            for (std::size_t w = 0; w < before; ++w) {
                const std::size_t i = under_way[w];
                const Node& node = nodes_[walks[i].node];
                take(i, descend(walks[i], node, weigh(node, receivers[first + i])));
            }
        }
    }
}

void LightTree::fetch(const Node& node) {
    constexpr std::size_t kLine = 64;
    const auto* bytes = reinterpret_cast<const std::byte*>(&node);
    for (std::size_t at = 0; at < sizeof(Node); at += kLine) __builtin_prefetch(bytes + at);
}

float LightTree::probability(const LightReceiver& receiver, std::size_t light) const {
    const Place& place = places_[light];
    if (place.index == kNone) return 0.0f;
    if (single_ != kNone) return 1.0f;
    if (near_.empty()) return far_probability(1.0, place.index);
    Importances importances = weigh(nodes_.front(), receiver);
    const double far = far_share(importances);
    if (place.is_far) return far_probability(far, place.index);
    double by_tree = 1.0;
    std::uint64_t trail = place.trail;
    for (const Node* node = &nodes_.front();; trail >>= kBitsOfALevel) {
        const std::size_t child = trail % kChildren;
        by_tree *= share(importances, child);
        const std::uint32_t next = node->next[child];
        if ((next & kLeaf) != 0) return near_probability(far, by_tree);
        node = &nodes_[next];
        importances = weigh(*node, receiver);
    }
}

std::size_t LightTree::bytes() const {
    return vector_bytes(nodes_, places_, near_, far_, far_ends_);
}

}  // namespace etendue
