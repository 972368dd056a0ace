// The tree of all ways on which mirrors and smooth refractions lead a sample from the eye, with no choice between them
// (Whitted, "An Improved Illumination Model for Shaded Display", 1980).
#pragma once

#include "transport/walk.h"

#include <cstdint>
#include <optional>

namespace etendue {

/// Holds a branch of the tree of one sample. All branches have random numbers of their own, whose seed names the
/// branch among those of the sample.
struct DeltaBranch {
    EyePath path;
    SampleNumbers numbers;
};

/// Returns the branch that goes on from `branch` straight through `vertex`.
[[nodiscard]] DeltaBranch go_straight_on(const DeltaBranch& branch, const Vertex& vertex);
/// Returns child number `child` of `branch`, which leaves `vertex` by `delta`.
[[nodiscard]] DeltaBranch grow_along(const World& world, const DeltaBranch& branch, const Vertex& vertex,
                                     const BsdfSample& delta, std::uint32_t child);
/// Returns what a branch of little light stands for, which is followed as rarely; nothing if it is not.
[[nodiscard]] std::optional<DeltaBranch> survivor(DeltaBranch branch);
/// Follows the branch's ray to where it leads. What media scatter on the way is lost like what they absorb.
[[nodiscard]] Vertex next_vertex(const World& world, DeltaBranch& branch);

/// Follows `branch` and all that grows from it, through at most `max_depth` edges. Calls `visitor.visit(branch, state,
/// vertex)` wherever a branch leads; a branch that leaves by `delta` has the state that `visitor.after(state, vertex,
/// delta)` returns. Branches end at surfaces in whose place the camera sees something else.
template <typename State, typename Visitor>
void follow_deltas(const World& world, DeltaBranch branch, const State& state, int max_depth, Visitor& visitor) {
    const auto follow_survivor = [&](const DeltaBranch& next, const State& its_state) {
        if (const std::optional<DeltaBranch> followed = survivor(next))
            follow_deltas(world, *followed, its_state, max_depth, visitor);
    };
    const Vertex vertex = next_vertex(world, branch);
    visitor.visit(branch, state, vertex);
    if (vertex.kind == Vertex::Kind::Boundary) follow_survivor(go_straight_on(branch, vertex), state);
    if (vertex.kind != Vertex::Kind::Surface || is_replaced(branch.path, vertex)) return;
    std::uint32_t child = 0;
    for (const BsdfSample& delta : vertex.scattering().deltas()) {
        // What goes straight through a clear surface has no vertex there.
        const bool passes = goes_straight_on(*vertex.surface.material, delta);
        if (branch.path.edges >= max_depth && !passes) continue;
        DeltaBranch next = grow_along(world, branch, vertex, delta, child++);
        next.path.edges += passes ? 0 : 1;
        follow_survivor(next, visitor.after(state, vertex, delta));
    }
}

}  // namespace etendue
