#include "light/light_tree.h"

#include "core/vector_bytes.h"
#include "core/wide.h"
#include "light/light_importance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace etendue {

namespace {

/// Is the share of choices among lamps that is uniform.
constexpr double kAny = 0.03;
constexpr double kLeastOfASide = 0.1;
/// 1/m², of all children of a node where floats do not tell them apart: all are as good, and as little.
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

}  // namespace

struct LightTree::NodeImportances {
    alignas(Wide::kAlignment) std::array<float, kChildren> each;
    std::array<double, kChildren> ends;  ///< sums from the first on

    [[nodiscard]] static constexpr std::size_t children() { return kChildren; }
    [[nodiscard]] double of(std::size_t child) const { return static_cast<double>(each[child]); }
    /// Returns the sum of the importances of the children up to this one.
    [[nodiscard]] double end(std::size_t child) const { return ends[child]; }
    [[nodiscard]] double sum() const { return ends.back(); }  ///< more than zero
};

/// Holds the importances of the root's children, which all receivers look at: child after child, receivers side by
/// side.
struct LightTree::RootImportances {
    alignas(Wide::kAlignment) std::array<std::array<float, kTogether>, kChildren> each;
    std::array<std::array<double, kTogether>, kChildren> ends;
    std::size_t count;  ///< how many children

    /// Shows the importances for one receiver as `NodeImportances` does.
    struct OfReceiver {
        const RootImportances& all;
        std::size_t receiver;

        [[nodiscard]] std::size_t children() const { return all.count; }
        [[nodiscard]] double of(std::size_t child) const { return static_cast<double>(all.each[child][receiver]); }
        [[nodiscard]] double end(std::size_t child) const { return all.ends[child][receiver]; }
        [[nodiscard]] double sum() const { return end(children() - 1); }
    };
};

LightTree::NodeImportances LightTree::weigh(const Node& node, const LightReceiverLanes& receiver) {
    NodeImportances importances;
    for (std::size_t first = 0; first < kChildren; first += Wide::kWidth)
        light_importance(node.children.load(first), receiver).store(&importances.each[first]);
    const auto add = [&importances] {
        double sum = 0.0;
        for (std::size_t child = 0; child < kChildren; ++child)
            importances.ends[child] = sum += static_cast<double>(importances.each[child]);
    };
    add();
    if (importances.sum() > 0.0) return importances;
    for (std::size_t child = 0; child < kChildren; ++child)
        importances.each[child] = node.next[child] != kNone ? kLeastImportance : 0.0f;
    add();
    return importances;
}

void LightTree::weigh_root(std::span<const LightReceiver> receivers, RootImportances& importances) const {
    importances.count = at_root_.size();
    static_assert(kTogether % Wide::kWidth == 0);
    for (std::size_t first = 0; first < kTogether; first += Wide::kWidth) {
        // Where none is left, the last once more.
        const LightReceiverLanes lanes(receivers.subspan(std::min(first, receivers.size() - 1)));
        for (std::size_t child = 0; child < at_root_.size(); ++child)
            light_importance(LightNodeLanes(at_root_[child]), lanes).store(&importances.each[child][first]);
    }
    std::array<double, kTogether> sums{};
    for (std::size_t child = 0; child < at_root_.size(); ++child)
        for (std::size_t i = 0; i < kTogether; ++i)
            importances.ends[child][i] = sums[i] += static_cast<double>(importances.each[child][i]);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (sums[i] > 0.0) continue;
        for (std::size_t child = 0; child < at_root_.size(); ++child) {
            importances.each[child][i] = kLeastImportance;
            importances.ends[child][i] = static_cast<double>(kLeastImportance) * static_cast<double>(child + 1);
        }
    }
}

double LightTree::far_share(double near) const {
    if (far_.empty()) return 0.0;
    const double share = far_irradiance_ / (far_irradiance_ + root_intensity_ * near);
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

template <typename Importances>
double LightTree::share(const Importances& importances, std::size_t child) {
    return importances.of(child) / importances.sum();
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

template <typename Importances>
bool LightTree::begin(Walk& walk, const LightReceiver& receiver, Vec2f u, const Importances& importances) const {
    walk.rest = joined(u);
    if (!far_.empty()) {
        walk.far = far_share(importances.sum());
        if (takes_first(walk.rest, walk.far)) return walk.end_at(far_choice(walk.far, walk.rest));
    }
    if (near_.size() > 1 && takes_first(walk.rest, kAny)) {
        const auto place = static_cast<std::size_t>(walk.rest * static_cast<double>(near_.size()));
        const std::uint32_t light = near_[std::min(place, near_.size() - 1)];
        return walk.end_at({light, probability(receiver, light)});
    }
    return descend(walk, nodes_.front(), importances);
}

template <typename Importances>
bool LightTree::descend(Walk& walk, const Node& node, const Importances& importances) const {
    // Less than the sum, which is the last of the ends.
    const double wanted = walk.rest * importances.sum();
    std::size_t child = 0;
    for (std::size_t c = 0; c < importances.children(); ++c) child += importances.end(c) <= wanted ? 1 : 0;
    walk.by_tree *= share(importances, child);
    const std::uint32_t next = node.next[child];
    if ((next & kLeaf) != 0) return walk.end_at({next & ~kLeaf, near_probability(walk.far, walk.by_tree)});
    const double below = child > 0 ? importances.end(child - 1) : 0.0;
    walk.rest = std::min((wanted - below) / importances.of(child), kBelowOne);
    walk.node = next;
    return false;
}

LightTree::Choice LightTree::sample(const LightReceiver& receiver, Vec2f u) const {
    if (single_ != kNone) return {single_, 1.0f};
    if (near_.empty()) return far_choice(1.0, joined(u));
    const LightReceiverLanes lanes(receiver);
    Walk walk;
    for (bool ended = begin(walk, receiver, u, weigh(nodes_.front(), lanes)); !ended;)
        ended = descend(walk, nodes_[walk.node], weigh(nodes_[walk.node], lanes));
    return walk.choice;
}

void LightTree::sample(std::span<const LightReceiver> receivers, std::span<const Vec2f> u,
                       std::span<Choice> choices) const {
    if (single_ != kNone) {
        std::ranges::fill(choices, Choice{single_, 1.0f});
        return;
    }
    if (near_.empty()) {
        std::ranges::transform(u, choices.begin(), [this](Vec2f each) { return far_choice(1.0, joined(each)); });
        return;
    }
    RootImportances root;
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
        const std::span<const LightReceiver> group = receivers.subspan(first, count);
        const auto begin_all = [&](const auto& importances_of) {
            for (std::size_t i = 0; i < count; ++i) take(i, begin(walks[i], group[i], u[first + i], importances_of(i)));
        };
        if (count > at_root_.size()) {
            weigh_root(group, root);
            begin_all([&](std::size_t i) { return RootImportances::OfReceiver{root, i}; });
        } else {
            begin_all([&](std::size_t i) { return weigh(nodes_.front(), LightReceiverLanes(group[i])); });
        }
        while (left > 0) {
            const std::size_t before = std::exchange(left, 0);
            for (std::size_t w = 0; w < before; ++w) {
                const std::size_t i = under_way[w];
                const Node& node = nodes_[walks[i].node];
                take(i, descend(walks[i], node, weigh(node, LightReceiverLanes(group[i]))));
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
    const LightReceiverLanes lanes(receiver);
    NodeImportances importances = weigh(nodes_.front(), lanes);
    const double far = far_share(importances.sum());
    if (place.is_far) return far_probability(far, place.index);
    double by_tree = 1.0;
    std::uint64_t trail = place.trail;
    for (const Node* node = &nodes_.front();; trail >>= kBitsOfALevel) {
        const std::size_t child = trail % kChildren;
        by_tree *= share(importances, child);
        const std::uint32_t next = node->next[child];
        if ((next & kLeaf) != 0) return near_probability(far, by_tree);
        node = &nodes_[next];
        importances = weigh(*node, lanes);
    }
}

std::size_t LightTree::bytes() const {
    return vector_bytes(nodes_, at_root_, places_, near_, far_, far_ends_);
}

}  // namespace etendue
