#include "world/embree_filters.h"

#include "world/embree_query.h"
#include "world/stochastic_opacity.h"

#include <type_traits>

namespace etendue {

namespace {

const QueryContext& context_of(const RTCFilterFunctionNArguments& args) {
    return *reinterpret_cast<const QueryContext*>(args.context);
}

/// Returns the surface that ray `i` of a packet may hit.
Hit hit_of(const RTCFilterFunctionNArguments& args, unsigned int i) {
    const EmbreeEntries& entries = context_of(args).scene->entries();
    return entries.make_hit(RTCRayN_tfar(args.ray, args.N, i), RTCHitN_u(args.hit, args.N, i),
                            RTCHitN_v(args.hit, args.N, i), RTCHitN_primID(args.hit, args.N, i),
                            RTCHitN_geomID(args.hit, args.N, i), RTCHitN_instID(args.hit, args.N, i, 0),
                            RTCRayN_time(args.ray, args.N, i));
}

/// Returns true if a partly transparent surface stops ray `i` of a packet.
bool stops(const RTCFilterFunctionNArguments& args, unsigned int i, const Hit& hit) {
    const QueryContext& context = context_of(args);
    const float opacity = context.scene->opacity(hit.geometry, hit.triangle, {hit.u, hit.v});
    return stops_ray(context.alpha_key(RTCRayN_id(args.ray, args.N, i)), hit, opacity);
}

/// Returns the cosine, times any length, between ray `i` of a packet and the normal on the front of what it may hit.
/// Both are those of the mesh where it is an instance, and its front is there what it is in the file.
float cosine_to_front(const RTCFilterFunctionNArguments& args, unsigned int i) {
    return RTCRayN_dir_x(args.ray, args.N, i) * RTCHitN_Ng_x(args.hit, args.N, i) +
           RTCRayN_dir_y(args.ray, args.N, i) * RTCHitN_Ng_y(args.hit, args.N, i) +
           RTCRayN_dir_z(args.ray, args.N, i) * RTCHitN_Ng_z(args.hit, args.N, i);
}

/// Lets rays pass where a surface does not stop them: all that have an end at the camera if `Hidden`, those that come
/// from behind if `Culled`, others by its opacity if `ByOpacity`.
template <bool Hidden, bool Culled, bool ByOpacity>
void let_pass(const RTCFilterFunctionNArguments* args) {
    const RayEnds ends = context_of(*args).ends;
    const bool is_hidden = Hidden && has_end_at_camera(ends);
    for (unsigned int i = 0; i < args->N; ++i)
        if (args->valid[i] == -1 && (is_hidden || (Culled && passes_culled(ends, cosine_to_front(*args, i))) ||
                                     (ByOpacity && !stops(*args, i, hit_of(*args, i)))))
            args->valid[i] = 0;
}

/// Lets shadow rays pass clear surfaces.
template <bool Hidden, bool Culled, bool ByOpacity>
void let_shadows_pass(const RTCFilterFunctionNArguments* args) {
    let_pass<Hidden, Culled, ByOpacity>(args);
    for (unsigned int i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        args->valid[i] = 0;
        context_of(*args).passed[RTCRayN_id(args->ray, args->N, i)] = kPassesClear;
    }
}

/// Returns the filter functions of a geometry with these properties.
template <bool Hidden, bool Culled, bool ByOpacity>
FilterFunctions let_through(bool passes_shadows) {
    FilterFunctions functions;
    if (Hidden || Culled || ByOpacity) functions.intersect = functions.occluded = let_pass<Hidden, Culled, ByOpacity>;
    if (passes_shadows) functions.occluded = let_shadows_pass<Hidden, Culled, ByOpacity>;
    return functions;
}

/// Calls `use` with `value` as a constant.
template <typename Use>
void with_constant(bool value, const Use& use) {
    if (value)
        use(std::true_type());
    else
        use(std::false_type());
}

/// Notes what the ray meets and lets it pass.
template <bool ByOpacity>
void collect_hits(const RTCFilterFunctionNArguments* args) {
    CollectedHits& collected = *context_of(*args).collected;
    for (unsigned int i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        args->valid[i] = 0;
        Hit hit = hit_of(*args, i);
        const unsigned int instance = RTCHitN_instID(args->hit, args->N, i, 0);
        const bool is_instance = instance != RTC_INVALID_GEOMETRY_ID;
        hit.triangle = context_of(*args).scene->entries().collected_triangle(
            is_instance ? instance : RTCHitN_geomID(args->hit, args->N, i), hit.triangle);
        if (ByOpacity && !stops(*args, i, hit)) continue;
        if (collected.count < collected.hits.size()) collected.hits[collected.count++] = hit;
    }
}

}  // namespace

FilterFunctions filter_functions(const HitFilter& filter, bool collects) {
    if (collects) return {filter.by_opacity ? collect_hits<true> : collect_hits<false>, nullptr};
    FilterFunctions functions;
    with_constant(filter.is_hidden, [&](auto hidden) {
        with_constant(filter.culls_back, [&](auto culled) {
            with_constant(filter.by_opacity, [&](auto by_opacity) {
                functions = let_through<hidden(), culled(), by_opacity()>(filter.passes_shadows);
            });
        });
    });
    return functions;
}

}  // namespace etendue
