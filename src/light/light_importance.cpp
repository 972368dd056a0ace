#include "light/light_importance.h"

#include "core/wide_rows.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace etendue {

namespace {

/// Is the least value of a cosine: what bounds and rounding exclude keeps this share of its importance.
constexpr float kFloor = 1e-3f;
/// Is the share of what a diffuse surface receives that goes by the bound; the rest goes by the mean.
constexpr float kByBound = 0.1f;
/// Is the least cosine of wo, where a lobe grows without bound as it grazes.
constexpr float kLeastCosine = 0.1f;
/// m², whose power of 3/2 floats still hold.
constexpr float kLeastSoftened = 1e-20f;

Imath::Vec3<Wide> in_all_lanes(const Vec3f& v) {
    return {Wide(v.x), Wide(v.y), Wide(v.z)};
}

/// Nodes as points see them. May be no numbers where floats overflow.
struct Sight {
    Wide by_distance;           ///< 1/m², of the nearest and the farthest point of each box
    Imath::Vec3<Wide> to_node;  ///< to the middle of the box, metres
    Wide squared;               ///< squared length of `to_node`, m²
    Wide inverse_distance;      ///< one over the length of `to_node`, 1/m
    Wide squared_radius;        ///< squared radius of the sphere around the box, m²
    Wide cos_b, squared_sin_b;  ///< cosine and squared sine of half the angle that this sphere is seen under
    WideMask is_inside;         ///< the point lies in the sphere
    Wide emitted;               ///< the cosine at the lamps, at most
};

Sight look_at(const LightNodeLanes& nodes, const Imath::Vec3<Wide>& point) {
    constexpr float kLeastSquare = 1e-30f;
    Wide nearest(0.0f);
    Wide farthest(0.0f);
    Wide squared(0.0f);
    Wide squared_radius(0.0f);
    Wide along_axis(0.0f);
    Imath::Vec3<Wide> to_node;
    for (int axis = 0; axis < 3; ++axis) {
        const Wide below = nodes.low[axis] - point[axis];
        const Wide above = point[axis] - nodes.high[axis];
        const Wide outside = max(max(below, above), 0.0f);
        const Wide across = max(-below, -above);
        nearest = nearest + outside * outside;
        farthest = farthest + across * across;
        to_node[axis] = (nodes.low[axis] + nodes.high[axis]) * 0.5f - point[axis];
        const Wide size = nodes.high[axis] - nodes.low[axis];
        squared = squared + to_node[axis] * to_node[axis];
        squared_radius = squared_radius + size * size * 0.25f;
        along_axis = along_axis - nodes.axis[axis] * to_node[axis];
    }
    nearest = max(max(nearest, nodes.squared_spacing), kLeastSquare);
    farthest = max(farthest, nearest);
    const Wide inverse_distance = 1.0f / sqrt(squared);
    // Less theta_o, and then less theta_b.
    const Wide cos_between = along_axis * inverse_distance;
    const Wide cos_w = max(min(select(nodes.two_sided > 0.0f, abs(cos_between), cos_between), 1.0f), -1.0f);
    const Wide sin_w = sqrt(1.0f - cos_w * cos_w);
    const Wide cos_x = cos_w * nodes.cos_o + sin_w * nodes.sin_o;
    const Wide sin_x = sin_w * nodes.cos_o - cos_w * nodes.sin_o;
    const Wide squared_sin_b = min(squared_radius / squared, 1.0f);
    const Wide cos_b = sqrt(1.0f - squared_sin_b);
    const Wide cos_least = cos_x * cos_b + sin_x * sqrt(squared_sin_b);
    // Inside of the sphere, or where light leaves every way.
    const WideMask is_inside = squared <= squared_radius;
    const auto is_anywhere = nodes.cos_o <= -1.0f || is_inside;
    const auto is_within = cos_w >= nodes.cos_o || cos_x >= cos_b;
    const Wide cosine = select(cos_least < nodes.cos_e, kFloor, max(cos_least, kFloor));
    return {.by_distance = 1.0f / (sqrt(nearest) * sqrt(farthest)),
            .to_node = to_node,
            .squared = squared,
            .inverse_distance = inverse_distance,
            .squared_radius = squared_radius,
            .cos_b = cos_b,
            .squared_sin_b = squared_sin_b,
            .is_inside = is_inside,
            .emitted = select(is_anywhere || is_within, 1.0f, cosine)};
}

/// 1/m². What is left out where no lane asks for it is no term of a sum that follows: nothing is contracted in two
/// ways.
Wide received(const Sight& sight, const LightReceiverLanes& receivers) {
    if (!receivers.any_normal) return sight.by_distance;

    const Wide height = dot(receivers.normal, sight.to_node);
    const Wide cos_i = clamp(height * sight.inverse_distance, -1.0f, 1.0f);
    const Wide cos_most = cos_i * sight.cos_b + sqrt(1.0f - cos_i * cos_i) * sqrt(sight.squared_sin_b);
    const Wide cosine = select(sight.is_inside || cos_i >= sight.cos_b, 1.0f, max(cos_most, kFloor));
    const Wide softened = max(sight.squared + sight.squared_radius * (1.0f / 3.0f), kLeastSoftened);
    const Wide mean = max(height, 0.0f) / (softened * sqrt(softened));
    const Wide diffuse = mean * (1.0f - kByBound) + sight.by_distance * cosine * kByBound;
    Wide by_surface = diffuse;
    if (receivers.any_glossy) {
        const Wide cos_o = dot(receivers.normal, receivers.wo);
        const Wide cos_both = cos_i + cos_o;
        const Wide cos_between = clamp(dot(receivers.wo, sight.to_node) * sight.inverse_distance, -1.0f, 1.0f);
        const Wide squared_cos_h = min(cos_both * cos_both / max(2.0f + 2.0f * cos_between, 1e-6f), 1.0f);
        const Wide squared_alpha = min(receivers.alpha * receivers.alpha + sight.squared_sin_b * 0.25f, 1.0f);
        const Wide spread = squared_cos_h * (squared_alpha - 1.0f) + 1.0f;
        const Wide lobe = squared_alpha / (spread * spread) * (0.25f / max(cos_o, kLeastCosine));
        const Wide mirrored = sight.by_distance * select(cosine > kFloor, max(lobe, kFloor), kFloor);
        by_surface =
            select(receivers.glossy > 0.0f, diffuse * (1.0f - receivers.glossy) + mirrored * receivers.glossy, diffuse);
    }
    const WideMask has_normal = dot(receivers.normal, receivers.normal) > 0.0f;
    return select(has_normal, by_surface, sight.by_distance);
}

/// Calls `take` with every number of `node`, which may be lanes.
template <typename Node, typename Take>
void take_each(Node& node, const Take& take) {
    for (auto* const vector : {&node.low, &node.high, &node.axis})
        for (int axis = 0; axis < 3; ++axis) take((*vector)[axis]);
    take(node.squared_spacing);
    take(node.intensity);
    take(node.cos_o);
    take(node.sin_o);
    take(node.cos_e);
    take(node.two_sided);
}

}  // namespace

LightNodeLanes::LightNodeLanes(const LightNode& node) {
    std::array<float, sizeof(LightNode) / sizeof(float)> numbers;
    auto* to = numbers.begin();
    take_each(node, [&to](float number) { *to++ = number; });
    const auto* from = numbers.begin();
    take_each(*this, [&from](Wide& lanes) { lanes = *from++; });
}

void LightNodeColumns::set(std::size_t index, const LightNode& node) {
    auto* to = numbers_.begin();
    take_each(node, [&to, index](float number) { (to++)->set(index, number); });
}

LightNodeLanes LightNodeColumns::load(std::size_t first) const {
    LightNodeLanes nodes;
    const auto* from = numbers_.begin();
    take_each(nodes, [&from, first](Wide& lanes) { lanes = (from++)->load(first); });
    return nodes;
}

LightReceiverLanes::LightReceiverLanes(const LightReceiver& receiver)
    : position(in_all_lanes(receiver.position)),
      normal(in_all_lanes(receiver.normal)),
      wo(in_all_lanes(receiver.wo)),
      glossy(receiver.glossy),
      alpha(receiver.alpha),
      any_normal(receiver.has_normal()),
      any_glossy(receiver.glossy != 0.0f) {}

static_assert(sizeof(LightReceiver) == kRowFloats * sizeof(float) &&
              offsetof(LightReceiver, alpha) == 10 * sizeof(float));

LightReceiverLanes::LightReceiverLanes(std::span<const LightReceiver> receivers) {
    std::array<const float*, Wide::kWidth> rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const LightReceiver& receiver = receivers[std::min(i, receivers.size() - 1)];
        rows[i] = &receiver.position.x;
        any_normal |= receiver.has_normal();
        any_glossy |= receiver.glossy != 0.0f;
    }
    const WideRow row = load_rows(rows);
    position = {row[0], row[1], row[2]};
    normal = {row[3], row[4], row[5]};
    wo = {row[6], row[7], row[8]};
    glossy = row[9];
    alpha = row[10];
}

Wide light_importance(const LightNodeLanes& nodes, const LightReceiverLanes& receivers) {
    const Sight sight = look_at(nodes, receivers.position);
    const Wide importance = nodes.intensity * (sight.emitted * received(sight, receivers));
    return select(importance > 0.0f, importance, 0.0f);
}

}  // namespace etendue
