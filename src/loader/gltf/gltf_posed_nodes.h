// Where the nodes of the shown scene are: at the moment of the image, and all through the time its shutter is open.
#pragma once

#include "core/bounds.h"
#include "loader/gltf/gltf_animation.h"
#include "loader/gltf/gltf_document.h"
#include "loader/gltf/gltf_transform.h"
#include "scene/render_settings.h"

#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// A node of the scene, where it is.
struct PlacedNode {
    int node;
    Mat4d to_world;
    bool visible = true;  ///< KHR_node_visibility: it and all nodes above it are
};

/// Limits how far a straight piece of a motion may be from the motion, as a part of the diagonal of the box that the
/// motion sweeps.
inline constexpr double kMotionTolerance = 1e-3;

class PosedNodes {
  public:
    /// Most pieces of a motion between shutter open and close; Embree takes 128.
    static constexpr std::size_t kMaxSegments = 128;

    /// Poses the nodes below `roots`, a forest with these `parents` (-1 for none), as `animation` (none for the nodes'
    /// own pose) has them. While the shutter is open, the motion is cut into as many pieces as it takes for what is
    /// straight in each of them to be the motion, within a thousandth of what it sweeps, up to kMaxSegments. Errors for
    /// transforms that are not affine, and for motions that are more than may be decoded from the file.
    PosedNodes(const GltfDocument& document, std::span<const int> roots, std::span<const int> parents,
               const AnimationSampler* animation, const RenderSettings& settings, AccessorReader& accessors,
               ProblemList& problems);

    /// Takes all places from `origin` instead of the world's.
    void move_origin(const Vec3d& origin);

    /// Depth first.
    [[nodiscard]] std::span<const PlacedNode> placed() const { return placed_; }
    /// Nothing for nodes that the scene does not show.
    [[nodiscard]] const std::optional<Mat4d>& to_world(int node) const {
        return to_world_[static_cast<std::size_t>(node)];
    }
    [[nodiscard]] const NodePose& pose(int node) const { return pose_of(poses_, node); }

    /// Pieces of all motions: a power of two, or 0 if nothing moves.
    [[nodiscard]] std::size_t segments() const { return step_poses_.empty() ? 0 : step_poses_.size() - 1; }
    /// The node's transforms at segments() + 1 equally spaced times; empty if it stays where it is.
    [[nodiscard]] std::span<const Mat4d> motion(int node) const;
    /// Where a node of the scene is at one of these times, whether or not it moves.
    [[nodiscard]] const Mat4d& to_world_at(int node, std::size_t step) const {
        const std::span<const Mat4d> steps = motion(node);
        return steps.empty() ? *to_world(node) : steps[step];
    }
    /// Returns the weights of morph targets that the animation gives `node` at the time `step`; empty if the animation
    /// gives none.
    [[nodiscard]] const std::vector<double>& weights_at(int node, std::size_t step) const {
        return (step_poses_.empty() ? pose(node) : pose_of(step_poses_[step], node)).weights;
    }
    /// True if the node's weights of morph targets change while the shutter is open.
    [[nodiscard]] bool weights_change(int node) const;

  private:
    [[nodiscard]] static const NodePose& pose_of(const NodePoses& poses, int node);
    /// Every node below `starts`, which come with the transforms of their parents, in its pose.
    [[nodiscard]] std::vector<PlacedNode> walk(std::span<const PlacedNode> starts, const NodePoses& poses,
                                               ProblemList& problems) const;
    /// The topmost animated nodes, with the transforms of their parents: what moves is below them.
    [[nodiscard]] std::vector<PlacedNode> animated_roots(std::span<const int> parents) const;
    void pose_steps(std::span<const PlacedNode> starts, const AnimationSampler& animation, double open, double close,
                    AccessorReader& accessors);

    const GltfDocument& document_;
    std::vector<PlacedNode> placed_;
    std::vector<std::optional<Mat4d>> to_world_;  ///< by node
    NodePoses poses_;
    std::vector<NodePoses> step_poses_;       ///< poses of the nodes with weights
    std::vector<std::vector<Mat4d>> motion_;  ///< transforms of the nodes that move
    std::vector<int> motion_of_;              ///< by node: index into motion_, -1 for those that do not
};

/// `steps`, equally spaced and 2^n + 1 of them, thinned out to the fewest from which straight lines lead to all of them
/// within `tolerance`; `distance(a, b, t, c)` is how far the point `t` of the way from step a to step b is from step c.
/// Returns every how many steps are needed: 2^n if the ends are enough.
template <typename Distance>
[[nodiscard]] std::size_t coarsest_stride(std::size_t segments, double tolerance, const Distance& distance) {
    const auto is_enough = [&](std::size_t stride) {
        for (std::size_t first = 0; first < segments; first += stride)
            for (std::size_t i = 1; i < stride; ++i)
                if (distance(first, first + stride, static_cast<double>(i) / static_cast<double>(stride), first + i) >
                    tolerance)
                    return false;
        return true;
    };
    std::size_t stride = segments;
    while (stride > 1 && !is_enough(stride)) stride /= 2;
    return stride;
}

/// Returns the fewest of `steps` (2^n + 1, equally spaced) that suffice for linear interpolation. It moves no point of
/// the box `bounds` by more than a thousandth of the diagonal of all that the box sweeps, and no axis by more than a
/// thousandth of its length.
[[nodiscard]] std::vector<Mat4f> thin_out(std::span<const Mat4d> steps, const Bounds& bounds);

/// Returns the fewest of `steps`, the rigid poses of a camera or a lamp, that suffice for interpolation. It turns no
/// axis by more than a ten-thousandth of a radian, since what a camera sees or a lamp lights may be far away, and moves
/// the place by no more than a ten-thousandth of its way.
[[nodiscard]] std::vector<Mat4f> thin_out_poses(std::span<const Mat4f> steps);

}  // namespace etendue
