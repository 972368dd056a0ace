// The choice of a light for a point: by power, distance and orientation, in a time that grows with the logarithm of
// their number. Lights not at infinity are the leaves of a tree; on the way down, a child is chosen in proportion to
//
//   importance = power / measure × max(cos theta', floor) × received
//   theta' = max(0, theta - theta_o - theta_b),    only the floor if theta' > theta_e
//
// with the half angle theta_o of the cone around normals and light leaving up to theta_e from one (Conty Estevez and
// Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", HPG 2018); docs/derivations.md, equations
// 15 to 18, has the rest. Lights are split where, of 12 bins along each axis, the cost is least (ibid., equation 2),
// below eight levels in halves: 64 bits hold the way to any, four a level. Nodes between would say less certain things
// than 16 children, which are looked at together, as many as a register holds. At the root, where every choice begins
// and which is all there is with few lamps, receivers are looked at together, for one child after the other, if they
// are more than the children. Memory: 1 KiB a node, usually some 100 bytes a light and at most 540 where there are
// many, and 20 more. Built by one thread, so that every build of the same lights is the same.
#pragma once

#include "core/wide.h"
#include "light/light.h"
#include "light/light_bounds.h"
#include "light/light_importance.h"
#include "light/light_receiver.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

class LightTree {
  public:
    LightTree() = default;
    /// `scene_radius` in metres, for the power of lights at infinity. n log n steps.
    LightTree(std::span<const Light> lights, float scene_radius);
    /// Builds the tree with given bounds for each light, which must contain its `light_bounds`: a light that moves
    /// needs larger ones.
    LightTree(std::span<const Light> lights, std::span<const std::optional<LightBounds>> bounds, float scene_radius);

    struct Choice {
        std::uint32_t light;
        float probability;
    };
    /// Chooses a light for `receiver` with `u` in [0, 1)², both of whose numbers are used as the digits of one. The
    /// tree must not be empty.
    [[nodiscard]] Choice sample(const LightReceiver& receiver, Vec2f u) const;
    /// Chooses a light for each of many receivers, each to the bit as by itself; nodes are fetched ahead, so that walks
    /// need not wait for memory.
    void sample(std::span<const LightReceiver> receivers, std::span<const Vec2f> u, std::span<Choice> choices) const;
    /// Returns the probability with which `sample` chooses the light of this index; to the bit what `sample` says.
    [[nodiscard]] float probability(const LightReceiver& receiver, std::size_t light) const;
    /// False if there is but one light that the tree can choose, whatever the numbers are.
    [[nodiscard]] bool has_choice() const { return single_ == kNone; }
    /// False if every receiver has the same probabilities.
    [[nodiscard]] bool depends_on_receiver() const { return single_ == kNone && !near_.empty(); }
    /// True if there is nothing to choose from.
    [[nodiscard]] bool empty() const { return near_.empty() && far_.empty(); }
    [[nodiscard]] std::size_t bytes() const;

  private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    static constexpr std::uint32_t kLeaf = 0x80000000u;

    static constexpr std::size_t kChildren = 16;
    static constexpr int kBitsOfALevel = 4;
    static_assert(kChildren == 1u << kBitsOfALevel);
    struct alignas(64) Node {
        /// Holds the node's children, of which the strongest has an intensity of one.
        LightNodeColumns children{};
        std::array<std::uint32_t, kChildren> next{};  ///< a node, a light with `kLeaf`, or kNone
    };
    static_assert(kChildren == LightNodeColumns::kSize && sizeof(Node) == 1024);
    /// Says where a light is found.
    struct Place {
        std::uint64_t trail = 0;      ///< from the lowest bits on: which child the way from the root takes
        std::uint32_t index = kNone;  ///< in `far_`, if it is at infinity; kNone if it has no power
        bool is_far = false;
    };

    /// A choice on its way through the tree.
    struct Walk {
        double rest = 0.0;       ///< rest of the random number, [0, 1)
        double far = 0.0;        ///< probability of the lights at infinity
        double by_tree = 1.0;    ///< probability of the children so far
        std::uint32_t node = 0;  ///< where it is
        Choice choice{};         ///< where it has ended

        /// Ends the walk at `chosen`, and returns true.
        bool end_at(const Choice& chosen) {
            choice = chosen;
            return true;
        }
    };

    struct Leaf;
    struct NodeImportances;
    struct RootImportances;
    /// Walks that go on together: as many as have nodes under way in the first-level cache.
    static constexpr std::size_t kTogether = 16;

    /// Reorders lights so that those of the first part come first; says how many they are.
    static std::size_t split_by_cost(std::span<Leaf> leaves);
    /// Which of a node's parts to split next; their number, if all are single lights.
    static std::size_t next_to_split(std::span<const std::span<Leaf>> parts);
    /// Makes the node of these lights at this level from the root, in `nodes_[node]`. Returns the intensity of its
    /// strongest child, W/sr.
    double build(std::uint32_t node, std::span<Leaf> leaves, std::uint64_t trail, int level);
    /// Takes the first step of a walk, and returns true if that is the last.
    template <typename Importances>
    bool begin(Walk& walk, const LightReceiver& receiver, Vec2f u, const Importances& importances) const;
    /// Takes the next step of a walk down from `node`, and returns true if that is the last.
    template <typename Importances>
    bool descend(Walk& walk, const Node& node, const Importances& importances) const;
    static void fetch(const Node& node);
    /// Returns what each child of `node` may bring to `receiver` (in all lanes), in units of the node's strongest.
    [[nodiscard]] static NodeImportances weigh(const Node& node, const LightReceiverLanes& receiver);
    /// Computes what each child of the root may bring to each of one receiver to `kTogether`, in units of the root's
    /// strongest.
    void weigh_root(std::span<const LightReceiver> receivers, RootImportances& importances) const;
    /// Returns the probability of taking a light at infinity, where there are others; 0 if there are none. `near` is
    /// the sum of what the root's children may bring.
    [[nodiscard]] double far_share(double near) const;
    /// Chooses a light at infinity by a number in [0, 1), and returns its probability, where that of any at infinity is
    /// `share`.
    [[nodiscard]] Choice far_choice(double share, double u) const;
    [[nodiscard]] float far_probability(double share, std::size_t index) const;
    /// Returns the probability of a child.
    template <typename Importances>
    [[nodiscard]] static double share(const Importances& importances, std::size_t child);
    /// Returns the probability of a near light, where that of the walk to it is `by_tree`.
    [[nodiscard]] float near_probability(double far_share, double by_tree) const;

    std::vector<Node> nodes_;          ///< the first is the root
    std::vector<LightNode> at_root_;   ///< its children once more, one by one
    double root_intensity_ = 0.0;      ///< intensity of the root's strongest child, W/sr
    std::vector<Place> places_;        ///< where each light is found
    std::vector<std::uint32_t> near_;  ///< lights with power that are in the tree
    std::vector<std::uint32_t> far_;   ///< and those at infinity
    std::vector<double> far_ends_;     ///< sums of the probabilities of `far_`
    double far_irradiance_ = 0.0;      ///< W/m²
    std::uint32_t single_ = kNone;     ///< the one light that has any power, if there is no other
};

}  // namespace etendue
