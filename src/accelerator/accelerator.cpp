#include "accelerator/accelerator.h"

#include "accelerator/brute_force.h"
#include "accelerator/bvh.h"
#include "accelerator/kd_tree.h"
#include "accelerator/ray_search.h"
#include "accelerator/uniform_grid.h"
#include "core/process_time.h"

#include <cassert>
#include <chrono>

namespace etendue {

namespace {

std::unique_ptr<Accelerator> make_accelerator(AcceleratorKind kind) {
    switch (kind) {
        case AcceleratorKind::Embree:
            break;
        case AcceleratorKind::Bvh:
            return std::make_unique<Bvh>(BvhSplit::SurfaceArea);
        case AcceleratorKind::BvhMiddle:
            return std::make_unique<Bvh>(BvhSplit::Middle);
        case AcceleratorKind::BvhCounts:
            return std::make_unique<Bvh>(BvhSplit::EqualCounts);
        case AcceleratorKind::KdTree:
            return std::make_unique<KdTree>();
        case AcceleratorKind::Grid:
            return std::make_unique<UniformGrid>();
        case AcceleratorKind::BruteForce:
            return std::make_unique<BruteForce>();
    }
    assert(false && "Embree is not built here");
    return nullptr;
}

}  // namespace

void Accelerator::build(std::span<const Triangle> triangles) {
    const auto start = std::chrono::steady_clock::now();
    make(triangles);
    build_seconds_ = seconds_since(start);
}

AcceleratorStatistics Accelerator::statistics() const {
    AcceleratorStatistics statistics = measure();
    statistics.build_seconds = build_seconds_;
    return statistics;
}

TriangleHit Accelerator::closest_hit(const Ray& ray, TriangleFilter* filter, RayWork& work) const {
    RaySearch search(ray, false, filter, work);
    trace(search);
    return search.nearest();
}

bool Accelerator::any_hit(const Ray& ray, TriangleFilter* filter, RayWork& work) const {
    RaySearch search(ray, true, filter, work);
    trace(search);
    return search.nearest().valid();
}

std::unique_ptr<const Accelerator> build_accelerator(AcceleratorKind kind, std::span<const Triangle> triangles) {
    std::unique_ptr<Accelerator> accelerator = make_accelerator(kind);
    accelerator->build(triangles);
    return accelerator;
}

}  // namespace etendue
