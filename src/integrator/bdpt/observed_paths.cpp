#include "integrator/bdpt/observed_paths.h"

#include <algorithm>
#include <vector>

namespace etendue {

namespace {

/// Appends to `path` the vertices of the subpath that ends in `last`, the last one first.
void append_subpath(SubpathVertices& vertices, const PathVertex* last, std::vector<const PathVertex*>& path) {
    for (const PathVertex* v = last; v != nullptr;
         v = v->previous != PathVertex::kNoVertex ? &vertices.whole(v->previous) : nullptr)
        path.push_back(v);
}

}  // namespace

void ObservedPaths::show(const SubpathJob& job, std::size_t s, float weight, const PathLightEnd& end,
                         std::uint32_t eye) {
    const PathVertex& last = eye_.vertices().whole(eye);
    show(job, s, weight, end, nullptr, &last, camera_of(job, last));
}

void ObservedPaths::show_to_camera(const SubpathJob& job, const ConnectibleVertex& light, float weight,
                                   const CameraConnection& camera) {
    show(job, static_cast<std::size_t>(light.index) + 1, weight, light_end(light.slot), &light_.vertices().whole(light),
         nullptr, camera);
}

void ObservedPaths::show_between(const SubpathJob& job, const ConnectibleVertex& eye, const ConnectibleVertex& light,
                                 float weight) {
    const PathVertex& last = eye_.vertices().whole(eye);
    show(job, static_cast<std::size_t>(light.index) + 1, weight, light_end(light.slot), &light_.vertices().whole(light),
         &last, camera_of(job, last));
}

void ObservedPaths::show(const SubpathJob& job, std::size_t s, float weight, const PathLightEnd& end,
                         const PathVertex* light, const PathVertex* eye, const CameraConnection& camera) const {
    std::vector<const PathVertex*> path;
    append_subpath(light_.vertices(), light, path);
    std::reverse(path.begin(), path.end());
    append_subpath(eye_.vertices(), eye, path);
    observer_->on_weight(job, {end, path, s, camera}, static_cast<double>(weight));
}

PathLightEnd ObservedPaths::light_end(std::uint32_t slot) const {
    const Emission& emission = light_.emissions()[slot];
    return {.light = emission.light,
            .triangle = emission.sample.triangle,
            .position = emission.sample.position,
            .direction = emission.sample.direction,
            .cos_light = emission.sample.cos_theta};
}

CameraConnection ObservedPaths::camera_of(const SubpathJob& job, const PathVertex& eye) const {
    const PathVertex* first = &eye;
    while (first->previous != PathVertex::kNoVertex) first = &eye_.vertices().all()[first->previous];
    return job.world().camera().connect(first->position, job.samples[eye.slot].lens, job.camera_rays[eye.slot].time);
}

}  // namespace etendue
