// Embree 3 (Debian 12) and Embree 4 (Debian 13) behind one set of names. Every difference between them is in this file.
//
// Shadow rays are never flagged as coherent: rtcOccluded16 of Embree 3.13.5 with AVX-512 does not return from some
// packets that are, in scenes with instances (tests/world/embree_scene_test.cpp has them).
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace etendue::embree {

#if RTC_VERSION_MAJOR >= 4

using Context = RTCRayQueryContext;

inline RTCIntersectArguments intersect_arguments(Context& context, bool coherent) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    return arguments;
}
inline RTCOccludedArguments occluded_arguments(Context& context) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    arguments.flags = RTC_RAY_QUERY_FLAG_INCOHERENT;
    return arguments;
}

inline void init_context(Context& context, bool /*coherent*/) {
    rtcInitRayQueryContext(&context);
}
inline void intersect1(RTCScene scene, Context& context, RTCRayHit& ray) {
    RTCIntersectArguments arguments = intersect_arguments(context, false);
    rtcIntersect1(scene, &ray, &arguments);
}
inline void intersect(const int* valid, RTCScene scene, Context& context, bool coherent, RTCRayHit8& rays) {
    RTCIntersectArguments arguments = intersect_arguments(context, coherent);
    rtcIntersect8(valid, scene, &rays, &arguments);
}
inline void intersect(const int* valid, RTCScene scene, Context& context, bool coherent, RTCRayHit16& rays) {
    RTCIntersectArguments arguments = intersect_arguments(context, coherent);
    rtcIntersect16(valid, scene, &rays, &arguments);
}
inline void occluded1(RTCScene scene, Context& context, RTCRay& ray) {
    RTCOccludedArguments arguments = occluded_arguments(context);
    rtcOccluded1(scene, &ray, &arguments);
}
inline void occluded(const int* valid, RTCScene scene, Context& context, RTCRay8& rays) {
    RTCOccludedArguments arguments = occluded_arguments(context);
    rtcOccluded8(valid, scene, &rays, &arguments);
}
inline void occluded(const int* valid, RTCScene scene, Context& context, RTCRay16& rays) {
    RTCOccludedArguments arguments = occluded_arguments(context);
    rtcOccluded16(valid, scene, &rays, &arguments);
}

#else

using Context = RTCIntersectContext;

inline void init_context(Context& context, bool coherent) {
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
}
inline void intersect1(RTCScene scene, Context& context, RTCRayHit& ray) {
    rtcIntersect1(scene, &context, &ray);
}
inline void intersect(const int* valid, RTCScene scene, Context& context, bool /*coherent*/, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &context, &rays);
}
inline void intersect(const int* valid, RTCScene scene, Context& context, bool /*coherent*/, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &context, &rays);
}
inline void occluded1(RTCScene scene, Context& context, RTCRay& ray) {
    rtcOccluded1(scene, &context, &ray);
}
inline void occluded(const int* valid, RTCScene scene, Context& context, RTCRay8& rays) {
    rtcOccluded8(valid, scene, &context, &rays);
}
inline void occluded(const int* valid, RTCScene scene, Context& context, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &context, &rays);
}

#endif

}  // namespace etendue::embree
