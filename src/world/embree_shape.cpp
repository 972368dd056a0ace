#include "world/embree_shape.h"

#include <cstddef>
#include <limits>

namespace etendue {

namespace {

const EmbreeShape& shape_of(void* data) {
    return *static_cast<const EmbreeShape*>(data);
}

void bound_shape(const RTCBoundsFunctionArguments* args) {
    const Bounds bounds = shape_of(args->geometryUserPtr).shape.bounds();
    RTCBounds& out = *args->bounds_o;
    out.lower_x = bounds.min.x;
    out.lower_y = bounds.min.y;
    out.lower_z = bounds.min.z;
    out.upper_x = bounds.max.x;
    out.upper_y = bounds.max.y;
    out.upper_z = bounds.max.z;
}

/// Returns the hit of a crossing as Embree has those of triangles.
RTCHit embree_hit(const ShapeCrossing& crossing, unsigned int geometry, const embree::Context& context) {
    RTCHit hit;
    hit.Ng_x = crossing.normal.x;
    hit.Ng_y = crossing.normal.y;
    hit.Ng_z = crossing.normal.z;
    hit.u = crossing.place.at.x;
    hit.v = crossing.place.at.y;
    hit.primID = triangle_of_place(crossing.place, crossing.is_from_back);
    hit.geomID = geometry;
    hit.instID[0] = context.instID[0];
    return hit;
}

/// Calls `accept(hit, t)` for the nearest crossing of the ray within its part that `filter` does not let pass.
template <typename Accept>
void stop_ray(const EmbreeShape& shape, const RTCRay& from, unsigned int geometry, embree::Context& context,
              RTCFilterFunctionN filter, const Accept& accept) {
    const ShapeCrossings crossings =
        shape.shape.crossings({from.org_x, from.org_y, from.org_z}, {from.dir_x, from.dir_y, from.dir_z});
    for (std::size_t c = 0; c < crossings.count; ++c) {
        const auto t = static_cast<float>(crossings.all[c].t);
        if (!(t > from.tnear && t <= from.tfar)) continue;
        RTCHit hit = embree_hit(crossings.all[c], geometry, context);
        RTCRay ray = from;
        ray.tfar = t;  // as filter functions have it
        int valid = -1;
        if (filter != nullptr) {
            RTCFilterFunctionNArguments arguments{};
            arguments.valid = &valid;
            arguments.context = &context;
            arguments.ray = reinterpret_cast<RTCRayN*>(&ray);
            arguments.hit = reinterpret_cast<RTCHitN*>(&hit);
            arguments.N = 1;
            filter(&arguments);
        }
        if (valid == 0) continue;
        accept(hit, t);
        return;
    }
}

void intersect_shape(const RTCIntersectFunctionNArguments* args) {
    const EmbreeShape& shape = shape_of(args->geometryUserPtr);
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
    for (unsigned int i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        stop_ray(shape, rtcGetRayFromRayN(rays, args->N, i), args->geomID, *args->context, shape.intersect_filter,
                 [&](const RTCHit& hit, float t) {
                     RTCRayN_tfar(rays, args->N, i) = t;
                     rtcCopyHitToHitN(hits, &hit, args->N, i);
                 });
    }
}

void occlude_shape(const RTCOccludedFunctionNArguments* args) {
    const EmbreeShape& shape = shape_of(args->geometryUserPtr);
    for (unsigned int i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        stop_ray(shape, rtcGetRayFromRayN(args->ray, args->N, i), args->geomID, *args->context, shape.occluded_filter,
                 [&](const RTCHit&, float) {
                     RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
                 });
    }
}

}  // namespace

void set_shape(RTCGeometry geometry, const EmbreeShape& shape) {
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, const_cast<EmbreeShape*>(&shape));
    rtcSetGeometryBoundsFunction(geometry, bound_shape, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_shape);
    rtcSetGeometryOccludedFunction(geometry, occlude_shape);
}

}  // namespace etendue
