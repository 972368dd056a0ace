#include "loader/gltf/gltf_posed_nodes.h"

#include "loader/gltf/gltf_value.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace etendue {

namespace {

Mat4d local_transform(const tinygltf::Node& node, const NodePose& pose, const SourceLocation& where,
                      ProblemList& problems) {
    if (node.matrix.size() == 16) {
        const std::optional<Mat4d> matrix = affine_matrix(node.matrix);
        if (!matrix) problems.error(where, "the matrix is not affine: its fourth row must be 0, 0, 0, 1");
        if (pose.translation || pose.rotation || pose.scale)
            problems.warning(where, "the node has a matrix and cannot be animated: its animation is ignored");
        return matrix.value_or(Mat4d());
    }
    // What is animated, or else what the node has.
    const auto numbers = [](const auto& animated, const std::vector<double>& own) {
        return animated ? std::vector<double>(animated->begin(), animated->end()) : own;
    };
    const std::vector<double> scale = numbers(pose.scale, node.scale);
    const std::vector<double> rotation = numbers(pose.rotation, node.rotation);
    const std::vector<double> translation = numbers(pose.translation, node.translation);
    Mat4d result;
    if (scale.size() == 3) result.setScale(Imath::V3d(scale[0], scale[1], scale[2]));
    if (rotation.size() == 4) {
        const std::optional<Mat4d> matrix = rotation_matrix({rotation[0], rotation[1], rotation[2], rotation[3]});
        if (!matrix) problems.warning(where, "the rotation is a zero quaternion and is ignored");
        result *= matrix.value_or(Mat4d());
    }
    if (translation.size() == 3) {
        for (int i = 0; i < 3; ++i) result[3][i] = translation[static_cast<std::size_t>(i)];
    }
    return result;
}

/// The corners of a box at one step of a motion.
using Corners = std::array<Vec3d, 8>;

Corners moved_corners(const Mat4d& m, const Bounds& bounds) {
    Corners corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d corner{static_cast<double>((i & 1) != 0 ? bounds.max.x : bounds.min.x),
                           static_cast<double>((i & 2) != 0 ? bounds.max.y : bounds.min.y),
                           static_cast<double>((i & 4) != 0 ? bounds.max.z : bounds.min.z)};
        m.multVecMatrix(corner, corners[i]);
    }
    return corners;
}

/// Limits the error of a node's axes that linear interpolation between steps makes, as a share of their length.
constexpr double kAxisTolerance = 1e-3;

Vec3d axis_of(const Mat4d& m, int axis) {
    return {m[axis][0], m[axis][1], m[axis][2]};
}

/// Returns the largest distance between an axis of `a` and the same axis of `b`, as a share of its length in `lengths`.
double axis_error(const Mat4d& a, const Mat4d& b, const Vec3d& lengths) {
    double largest = 0.0;
    for (int i = 0; i < 3; ++i)
        if (lengths[i] > 0.0) largest = std::max(largest, (axis_of(a, i) - axis_of(b, i)).length() / lengths[i]);
    return largest;
}

/// Every how many steps straight lines between them are enough for the box.
std::size_t stride_for_box(std::span<const Mat4d> steps, const Bounds& bounds) {
    std::vector<Corners> corners;
    corners.reserve(steps.size());
    Bounds swept;
    Vec3d longest(0.0);  // of each axis over all steps, since an axis may grow from nothing
    for (const Mat4d& step : steps) {
        for (int i = 0; i < 3; ++i) longest[i] = std::max(longest[i], axis_of(step, i).length());
        corners.push_back(moved_corners(step, bounds));
        for (const Vec3d& corner : corners.back()) swept.extend(Vec3f(corner));
    }
    const double tolerance = kMotionTolerance * static_cast<double>(length(swept.size()));
    const auto distance = [&](std::size_t a, std::size_t b, double t, std::size_t c) {
        // Lamps are sampled as rigid bodies (world/light_pose.h), but linear interpolation shrinks bodies that turn.
        double largest =
            tolerance / kAxisTolerance * axis_error(steps[a] * (1.0 - t) + steps[b] * t, steps[c], longest);
        for (std::size_t i = 0; i < corners[a].size(); ++i) {
            const Vec3d straight = corners[a][i] * (1.0 - t) + corners[b][i] * t;
            largest = std::max(largest, (straight - corners[c][i]).length());
        }
        return largest;
    };
    return coarsest_stride(steps.size() - 1, tolerance, distance);
}

std::size_t bytes_of(const NodePoses& poses) {
    std::size_t bytes = poses.size() * sizeof(NodePoses::value_type);
    for (const auto& [node, pose] : poses) bytes += pose.weights.size() * sizeof(double);
    return bytes;
}

/// A box as large as what a node without a mesh may carry.
Bounds unit_box() {
    Bounds bounds;
    bounds.extend(Vec3f(-1.0f));
    bounds.extend(Vec3f(1.0f));
    return bounds;
}

bool is_visible(const tinygltf::Node& node) {
    const tinygltf::Value* extension = find_extension(node.extensions, "KHR_node_visibility");
    return extension == nullptr || !extension->Has("visible") || extension->Get("visible").Get<bool>();
}

}  // namespace

std::vector<Mat4f> thin_out(std::span<const Mat4d> steps, const Bounds& bounds) {
    const std::size_t stride = stride_for_box(steps, bounds.empty() ? unit_box() : bounds);
    std::vector<Mat4f> kept;
    for (std::size_t i = 0; i < steps.size(); i += stride) kept.push_back(to_float(steps[i]));
    return kept;
}

std::vector<Mat4f> thin_out_poses(std::span<const Mat4f> steps) {
    constexpr double kTolerance = 1e-4;
    const auto row = [](const Mat4f& m, int r) { return Vec3f(m[r][0], m[r][1], m[r][2]); };
    float way = 0.0f;
    for (std::size_t i = 1; i < steps.size(); ++i) way += length(row(steps[i], 3) - row(steps[i - 1], 3));
    const auto distance = [&](std::size_t a, std::size_t b, double t, std::size_t c) {
        const Mat4f between = steps[a] * static_cast<float>(1.0 - t) + steps[b] * static_cast<float>(t);
        float worst = 0.0f;
        for (int axis = 0; axis < 3; ++axis) worst = std::max(worst, length(row(between, axis) - row(steps[c], axis)));
        if (way > 0.0f) worst = std::max(worst, length(row(between, 3) - row(steps[c], 3)) / way);
        return static_cast<double>(worst);
    };
    const std::size_t stride = coarsest_stride(steps.size() - 1, kTolerance, distance);
    std::vector<Mat4f> kept;
    for (std::size_t i = 0; i < steps.size(); i += stride) kept.push_back(steps[i]);
    return kept;
}

PosedNodes::PosedNodes(const GltfDocument& document, std::span<const int> roots, std::span<const int> parents,
                       const AnimationSampler* animation, const RenderSettings& settings, AccessorReader& accessors,
                       ProblemList& problems)
    : document_(document), to_world_(document.model.nodes.size()), motion_of_(document.model.nodes.size(), -1) {
    const bool is_animated = animation != nullptr && settings.shown_time();
    const double seconds = settings.shown_time().value_or(0.0);
    const Shutter& shutter = settings.shutter;
    if (is_animated) poses_ = animation->poses(seconds + shutter.middle());
    std::vector<PlacedNode> starts;
    for (const int root : roots) starts.push_back({root, Mat4d()});
    placed_ = walk(starts, poses_, problems);
    for (const PlacedNode& placed : placed_) to_world_[static_cast<std::size_t>(placed.node)] = placed.to_world;
    if (is_animated && shutter.is_open())
        pose_steps(animated_roots(parents), *animation, seconds + shutter.open, seconds + shutter.close, accessors);
}

void PosedNodes::move_origin(const Vec3d& origin) {
    const auto move = [&](Mat4d& m) {
        for (int axis = 0; axis < 3; ++axis) m[3][axis] -= origin[axis];
    };
    for (PlacedNode& placed : placed_) move(placed.to_world);
    for (std::optional<Mat4d>& to_world : to_world_)
        if (to_world) move(*to_world);
    for (std::vector<Mat4d>& steps : motion_) std::ranges::for_each(steps, move);
}

const NodePose& PosedNodes::pose_of(const NodePoses& poses, int node) {
    static const NodePose kAtRest;
    const auto found = poses.find(node);
    return found == poses.end() ? kAtRest : found->second;
}

std::span<const Mat4d> PosedNodes::motion(int node) const {
    const int index = motion_of_[static_cast<std::size_t>(node)];
    return index < 0 ? std::span<const Mat4d>() : motion_[static_cast<std::size_t>(index)];
}

bool PosedNodes::weights_change(int node) const {
    return std::ranges::any_of(step_poses_, [&](const NodePoses& poses) {
        return pose_of(poses, node).weights != pose_of(step_poses_.front(), node).weights;
    });
}

/// Depth first over the forest, with a stack of its own: hierarchies may be as deep as the file likes.
std::vector<PlacedNode> PosedNodes::walk(std::span<const PlacedNode> starts, const NodePoses& poses,
                                         ProblemList& problems) const {
    std::vector<PlacedNode> placed;
    std::vector<PlacedNode> stack(starts.rbegin(), starts.rend());  // with the transforms of their parents
    while (!stack.empty()) {
        PlacedNode visit = stack.back();
        stack.pop_back();
        const tinygltf::Node& node = document_.model.nodes[static_cast<std::size_t>(visit.node)];
        const SourceLocation where = document_.at(fmt::format("/nodes/{}", visit.node));
        visit.to_world = local_transform(node, pose_of(poses, visit.node), where, problems) * visit.to_world;
        visit.visible = visit.visible && is_visible(node);
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            stack.push_back({*child, visit.to_world, visit.visible});
        placed.push_back(visit);
    }
    return placed;
}

std::vector<PlacedNode> PosedNodes::animated_roots(std::span<const int> parents) const {
    std::vector<PlacedNode> starts;
    std::vector<bool> is_below(to_world_.size(), false);  // an animated node, itself included
    for (const PlacedNode& placed : placed_) {
        const auto node = static_cast<std::size_t>(placed.node);
        const int parent = parents[node];
        const bool parent_is_below = parent >= 0 && is_below[static_cast<std::size_t>(parent)];
        is_below[node] = parent_is_below || poses_.contains(placed.node);
        if (is_below[node] && !parent_is_below)
            starts.push_back({placed.node, parent >= 0 ? *to_world(parent) : Mat4d()});
    }
    return starts;
}

void PosedNodes::pose_steps(std::span<const PlacedNode> starts, const AnimationSampler& animation, double open,
                            double close, AccessorReader& accessors) {
    constexpr std::size_t kFirstSegments = 16;
    ProblemList said;  // what is wrong has been said of the pose of the image itself
    for (std::size_t segments = kFirstSegments;; segments *= 2) {
        step_poses_.clear();
        motion_.clear();
        std::vector<PlacedNode> at_step;
        for (std::size_t s = 0; s <= segments; ++s) {
            const double t = static_cast<double>(s) / static_cast<double>(segments);
            step_poses_.push_back(animation.poses(open + (close - open) * t));
            at_step = walk(starts, step_poses_.back(), said);
            // Of the poses themselves only weights are asked for later.
            std::erase_if(step_poses_.back(), [](const auto& pose) { return pose.second.weights.empty(); });
            const SourceLocation where = document_.at("/animations");
            if (!accessors.allocate(at_step.size(), sizeof(Mat4d), where) ||
                !accessors.allocate(bytes_of(step_poses_.back()), 1, where)) {
                step_poses_.clear();
                std::ranges::fill(motion_of_, -1);
                return;
            }
            motion_.resize(at_step.size());
            for (std::size_t i = 0; i < at_step.size(); ++i) motion_[i].push_back(at_step[i].to_world);
        }
        bool is_fine = true;
        for (std::size_t i = 0; i < at_step.size(); ++i) {
            const std::vector<Mat4d>& steps = motion_[i];
            const bool moves = std::ranges::any_of(steps, [&](const Mat4d& m) { return m != steps.front(); });
            motion_of_[static_cast<std::size_t>(at_step[i].node)] = moves ? static_cast<int>(i) : -1;
            is_fine = is_fine && (!moves || stride_for_box(steps, unit_box()) > 1);
        }
        if (is_fine || segments >= kMaxSegments) return;
    }
}

}  // namespace etendue
