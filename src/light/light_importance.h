// What nodes of the light tree may bring to receivers (docs/derivations.md, equations 15 to 17), in lanes: many nodes
// for one receiver, or one node for many.
#pragma once

#include "core/columns.h"
#include "core/vec.h"
#include "core/wide.h"
#include "light/light_receiver.h"

#include <array>
#include <cstddef>
#include <span>

namespace etendue {

/// Where the lights of a node are and which way they shine.
template <typename T>
struct BasicLightNode {
    Imath::Vec3<T> low{T(0.0f)}, high{T(0.0f)};  ///< corners of the node's box, metres
    Imath::Vec3<T> axis{T(0.0f)};                ///< unit, of the cone around their normals
    T squared_spacing = 0.0f;                    ///< m², how near the nearest light is at least
    T intensity = 0.0f;                          ///< along the axis, in any unit; 0 where there is no node
    T cos_o = 0.0f, sin_o = 0.0f, cos_e = 0.0f;  ///< cosines and sine of the angles theta_o and theta_e (light_tree.h)
    T two_sided = 0.0f;                          ///< 1, or 0
};

using LightNode = BasicLightNode<float>;

struct LightNodeLanes : BasicLightNode<Wide> {
    /// Leaves every lane without a node.
    LightNodeLanes() = default;
    /// Puts `node` into all lanes.
    explicit LightNodeLanes(const LightNode& node);
};

/// Nodes side by side in memory, a column for each of their numbers, however many lanes look at them at once.
class LightNodeColumns {
  public:
    static constexpr std::size_t kSize = 16;

    void set(std::size_t index, const LightNode& node);
    /// Loads `Wide::kWidth` nodes from `first` on, a multiple of that width.
    [[nodiscard]] LightNodeLanes load(std::size_t first) const;

  private:
    std::array<BasicColumn<kSize>, sizeof(LightNode) / sizeof(float)> numbers_;
};

struct LightReceiverLanes {
    Imath::Vec3<Wide> position, normal, wo;
    Wide glossy, alpha;
    bool any_normal = false;
    bool any_glossy = false;

    /// Puts `receiver` into all lanes.
    explicit LightReceiverLanes(const LightReceiver& receiver);
    /// Puts a receiver into each lane, of at least one of `receivers`; lanes that are left over are the same as the
    /// last.
    explicit LightReceiverLanes(std::span<const LightReceiver> receivers);
};

/// Intensity times `emitted` times `received`, and 0 where that is no number, since floats overflow. What is in a lane
/// has no say in another, down to the bit: this is compiled once, for all callers.
[[nodiscard, gnu::noinline]] Wide light_importance(const LightNodeLanes& nodes, const LightReceiverLanes& receivers);

}  // namespace etendue
