#include "world/embree_scene.h"

#include "core/error.h"
#include "world/embree_query.h"
#include "world/embree_shape.h"
#include "world/stochastic_opacity.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>

namespace etendue {

namespace {

// Of all BVHs; docs/optimisation.md has what the others were measured to cost.
constexpr RTCBuildQuality kBuildQuality = RTC_BUILD_QUALITY_MEDIUM;
constexpr RTCSceneFlags kSceneFlags = RTC_SCENE_FLAG_ROBUST;

const QueryContext& context_of(const RTCFilterFunctionNArguments& args) {
    return *reinterpret_cast<const QueryContext*>(args.context);
}

/// The surface that ray `i` of a packet may hit.
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

/// The cosine, of any length, between ray `i` of a packet and the normal on the front of what it may hit. Both are
/// those of the mesh where it is an instance, and its front is there what it is in the file.
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

/// Lets shadow rays pass panes.
template <bool Hidden, bool Culled, bool ByOpacity>
void pass_panes(const RTCFilterFunctionNArguments* args) {
    let_pass<Hidden, Culled, ByOpacity>(args);
    for (unsigned int i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        args->valid[i] = 0;
        context_of(*args).passed[RTCRayN_id(args->ray, args->N, i)] = kPassesPanes;
    }
}

/// Holds the filter functions of a geometry; null where it needs none.
struct FilterFunctions {
    RTCFilterFunctionN intersect = nullptr;
    RTCFilterFunctionN occluded = nullptr;
};

/// Returns the filter functions of a geometry with these properties.
template <bool Hidden, bool Culled, bool ByOpacity>
FilterFunctions let_through(bool passes_shadows) {
    FilterFunctions functions;
    if (Hidden || Culled || ByOpacity) functions.intersect = functions.occluded = let_pass<Hidden, Culled, ByOpacity>;
    if (passes_shadows) functions.occluded = pass_panes<Hidden, Culled, ByOpacity>;
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

using NearVisitor = std::function<bool(std::uint32_t, std::uint32_t, std::uint32_t)>;
struct NearQuery {
    const EmbreeEntries* entries;
    const NearVisitor* visit;
    bool is_over = false;
};

bool visit_near(RTCPointQueryFunctionArguments* args) {
    NearQuery& query = *static_cast<NearQuery*>(args->userPtr);
    if (query.is_over) return false;
    const bool is_instance = args->context->instStackSize > 0;
    const auto entry =
        query.entries->resolve(is_instance ? args->context->instID[0] : args->geomID, args->geomID, is_instance);
    query.is_over = !(*query.visit)(entry.instance, entry.geometry, args->primID);
    if (query.is_over) args->query->radius = 0.0f;
    return query.is_over;  // whether the radius has changed
}

std::atomic<std::size_t>& memory_counter(void* pointer) {
    return *static_cast<std::atomic<std::size_t>*>(pointer);
}

bool count_memory(void* counter, ssize_t bytes, bool /*post*/) {
    memory_counter(counter).fetch_add(static_cast<std::size_t>(bytes), std::memory_order_relaxed);
    return true;
}

/// Makes Embree's geometries of ours.
struct GeometryMaker {
    RTCDevice device;
    std::span<const Geometry> geometries;
    std::span<const HitFilter> filters;  ///< filters of the geometries
    bool collects;                       ///< for `EmbreeScene::collect`
    std::deque<std::vector<std::array<std::uint32_t, 3>>>& collected_indices;
    std::vector<std::unique_ptr<const EmbreeShape>>& shapes;

    /// Returns an empty scene.
    [[nodiscard]] RTCScene new_scene() const {
        RTCScene scene = rtcNewScene(device);
        rtcSetSceneBuildQuality(scene, kBuildQuality);
        rtcSetSceneFlags(scene, kSceneFlags);
        return scene;
    }

    /// Adds geometry `index` to `scene`, or those of its triangles that `collected` names, if it is not null.
    void add_geometry(RTCScene scene, std::uint32_t index, const CollectedSlot* collected) const {
        const Geometry& geometry = geometries[index];
        if (geometry.shape) return add_shape(scene, *geometry.shape, filters[index]);
        RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto set_vertices = [&](unsigned int slot, const std::vector<Vec3f>& positions) {
            rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, slot, RTC_FORMAT_FLOAT3, positions.data(), 0,
                                       sizeof(Vec3f), positions.size());
        };
        if (geometry.motion.empty()) {
            set_vertices(0, geometry.positions);
        } else {
            rtcSetGeometryTimeStepCount(mesh, static_cast<unsigned int>(geometry.motion.size()));
            for (std::size_t i = 0; i < geometry.motion.size(); ++i)
                set_vertices(static_cast<unsigned int>(i), geometry.motion[i].positions);
        }
        const std::vector<std::array<std::uint32_t, 3>>* triangles = &geometry.triangles;
        if (collected != nullptr && !collected->is_whole) {
            auto& indices = collected_indices.emplace_back();
            for (const std::uint32_t triangle : collected->triangles) indices.push_back(geometry.triangles[triangle]);
            triangles = &indices;
        }
        rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles->data(), 0,
                                   sizeof(std::array<std::uint32_t, 3>), triangles->size());
        const FilterFunctions functions = filter_functions(filters[index]);
        if (functions.intersect != nullptr) rtcSetGeometryIntersectFilterFunction(mesh, functions.intersect);
        if (functions.occluded != nullptr) rtcSetGeometryOccludedFilterFunction(mesh, functions.occluded);
        attach(scene, mesh);
    }

    void add_shape(RTCScene scene, const ExactShape& shape, const HitFilter& filter) const {
        const FilterFunctions functions = filter_functions(filter);
        shapes.push_back(
            std::make_unique<const EmbreeShape>(EmbreeShape{shape, functions.intersect, functions.occluded}));
        RTCGeometry placed = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        set_shape(placed, *shapes.back());
        attach(scene, placed);
    }

    static void attach(RTCScene scene, RTCGeometry geometry) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }

    /// Returns what Embree has to ask about hits as `filter` says.
    [[nodiscard]] FilterFunctions filter_functions(const HitFilter& filter) const {
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

    /// Returns a scene of the mesh that `instance` shares with others.
    [[nodiscard]] RTCScene build_shared_scene(const Instance& instance) const {
        RTCScene scene = new_scene();
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
            add_geometry(scene, instance.first_geometry + g, nullptr);
        rtcCommitScene(scene);
        return scene;
    }

    /// Places `shared` in `scene` as `instance` stands there.
    void add_instance(RTCScene scene, RTCScene shared, const Instance& instance,
                      std::span<const TransformMotion> motions) const {
        RTCGeometry placed = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(placed, shared);
        const std::span<const Mat4f> here(&instance.to_world, 1);
        const std::span<const Mat4f> steps = instance.motion == kNone ? here : std::span(motions[instance.motion]);
        rtcSetGeometryTimeStepCount(placed, static_cast<unsigned int>(steps.size()));
        // Matrices and not quaternions: Embree's quaternions are approximate, and differ between packets.
        for (std::size_t i = 0; i < steps.size(); ++i)
            rtcSetGeometryTransform(placed, static_cast<unsigned int>(i), RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                                    steps[i].getValue());
        attach(scene, placed);
    }
};

}  // namespace

EmbreeScene::EmbreeScene(std::span<const Geometry> geometries, std::span<const Instance> instances,
                         std::span<const TransformMotion> motions, std::span<const HitFilter> filters,
                         const ThreadPool& threads, std::vector<CollectedSlot> collected)
    : collects_(!collected.empty()),
      collected_(std::move(collected)),
      has_panes_(!collects_ && std::ranges::any_of(filters, &HitFilter::passes_shadows)) {
    has_motion_ =
        !motions.empty() || std::ranges::any_of(geometries, [](const Geometry& g) { return !g.motion.empty(); });
    std::atomic<std::size_t> memory{0};
    const auto start = std::chrono::steady_clock::now();
    threads.execute([&] {
        // Embree's own threads would come on top of the pool's; with start_threads=0 it uses the arena it is called
        // from.
        device_ = rtcNewDevice("start_threads=0,set_affinity=0");
        if (!device_) throw IoError("Embree could not be started");
        rtcSetDeviceMemoryMonitorFunction(device_, count_memory, &memory);
        const GeometryMaker maker{device_, geometries, filters, collects_, collected_indices_, shapes_};
        top_ = maker.new_scene();
        std::unordered_map<std::uint32_t, RTCScene> scene_of_mesh;
        for (std::size_t i = 0; i < instances.size(); ++i) {
            const Instance& instance = instances[i];
            const auto index = static_cast<std::uint32_t>(i);
            const auto is_taken = [&](std::uint32_t g) {
                if (!collects_) return true;
                const CollectedSlot& slot = collected_[instance.first_light_slot + g];
                return slot.is_whole || !slot.triangles.empty();
            };
            // A mesh without geometry shares its first index with the next one, so it must not claim a scene under it.
            if (instance.baked || instance.geometry_count == 0) {
                for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
                    if (!is_taken(g)) continue;
                    const std::uint32_t geometry = instance.first_geometry + g;
                    const CollectedSlot* slot = collects_ ? &collected_[instance.first_light_slot + g] : nullptr;
                    maker.add_geometry(top_, geometry, slot);
                    entries_.add({index, geometry}, slot);
                }
                continue;
            }
            bool is_any_taken = false;
            for (std::uint32_t g = 0; g < instance.geometry_count; ++g) is_any_taken = is_any_taken || is_taken(g);
            if (!is_any_taken) continue;
            RTCScene& shared = scene_of_mesh[instance.first_geometry];
            if (!shared) shared = shared_.emplace_back(maker.build_shared_scene(instance));
            maker.add_instance(top_, shared, instance, motions);
            entries_.add({index, instance.first_geometry}, nullptr);
        }
        rtcCommitScene(top_);
    });
    rtcSetDeviceMemoryMonitorFunction(device_, nullptr, nullptr);
    bytes_ = memory.load();
    build_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const RTCError error = rtcGetDeviceError(device_);
    if (error != RTC_ERROR_NONE)
        throw IoError("Embree could not build the scene (error " + std::to_string(static_cast<int>(error)) +
                      (error == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory)" : ")"));
}

EmbreeScene::~EmbreeScene() {
    for (RTCScene scene : shared_) rtcReleaseScene(scene);
    if (top_) rtcReleaseScene(top_);
    if (device_) rtcReleaseDevice(device_);
}

void EmbreeScene::set_opacity(OpacityFunction function, const void* world) {
    opacity_ = function;
    world_ = world;
}

template <typename Batch>
void EmbreeScene::intersect_batch(const Batch& rays, std::span<Hit> hits, Coherence coherence, QueryForm form,
                                  RayEnds ends) const {
    switch (form) {
        case QueryForm::Single:
            intersect_single(rays, hits, ends);
            break;
        case QueryForm::Packet8:
            intersect_packets<8>(rays, hits, takes_as_coherent(coherence), ends);
            break;
        case QueryForm::Best:
        case QueryForm::Packet16:
            intersect_packets<16>(rays, hits, takes_as_coherent(coherence), ends);
            break;
    }
}

void EmbreeScene::intersect(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence, QueryForm form,
                            RayEnds ends) const {
    intersect_batch(rays, hits, coherence, form, ends);
}

void EmbreeScene::intersect(const RayColumns& rays, std::span<Hit> hits, Coherence coherence, QueryForm form,
                            RayEnds ends) const {
    intersect_batch(rays, hits, coherence, form, ends);
}

template <typename Batch>
void EmbreeScene::occluded_batch(const Batch& rays, std::span<std::uint8_t> occluded, QueryForm form,
                                 RayEnds ends) const {
    switch (form) {
        case QueryForm::Single:
            occluded_single(rays, occluded, ends);
            break;
        case QueryForm::Packet8:
            occluded_packets<8>(rays, occluded, ends);
            break;
        case QueryForm::Best:
        case QueryForm::Packet16:
            occluded_packets<16>(rays, occluded, ends);
            break;
    }
}

void EmbreeScene::occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, QueryForm form,
                           RayEnds ends) const {
    occluded_batch(rays, occluded, form, ends);
}

void EmbreeScene::occluded(const RayColumns& rays, std::span<std::uint8_t> occluded, QueryForm form,
                           RayEnds ends) const {
    occluded_batch(rays, occluded, form, ends);
}

std::size_t EmbreeScene::collect(const Ray& ray, float t_min, std::span<Hit> hits) const {
    QueryContext context(*this, std::span(&ray, 1), false);
    CollectedHits collected{hits};
    context.collected = &collected;
    RTCRayHit query = make_ray_hit(ray, 0);
    query.ray.tnear = t_min;
    embree::intersect1(top_, context.base, query);
    return collected.count;
}

void EmbreeScene::for_each_near(const Vec3f& point, float radius, const NearVisitor& visit) const {
    constexpr float kMiddle = 0.5f;
    RTCPointQuery query{point.x, point.y, point.z, kMiddle, radius};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    NearQuery near{&entries_, &visit};
    rtcPointQuery(top_, &query, &context, visit_near, &near);
}

bool EmbreeScene::takes_as_coherent(Coherence coherence) const {
    return coherence == Coherence::Coherent && shared_.empty() && !has_motion_;
}

template <typename Batch>
void EmbreeScene::intersect_single(const Batch& rays, std::span<Hit> hits, RayEnds ends) const {
    QueryContext context(*this, rays, false);
    context.ends = ends;
    RTCRayHit query;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        query = make_ray_hit(rays[i], static_cast<unsigned int>(i));
        embree::intersect1(top_, context.base, query);
        hits[i] = entries_.make_hit(query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID, query.hit.geomID,
                                    query.hit.instID[0], query.ray.time);
    }
}

template <std::size_t Width, typename Batch>
void EmbreeScene::intersect_packets(const Batch& rays, std::span<Hit> hits, bool coherent, RayEnds ends) const {
    QueryContext context(*this, rays, coherent);
    context.ends = ends;
    for_each_packet<Width, typename Packet<Width>::RayHits>(
        rays, [&](const PacketMask<Width>& mask, auto& packet, std::size_t first, std::size_t count) {
            embree::intersect(mask.valid, top_, context.base, coherent, packet);
            for (std::size_t lane = 0; lane < count; ++lane)
                hits[first + lane] = entries_.make_hit(packet.ray.tfar[lane], packet.hit.u[lane], packet.hit.v[lane],
                                                       packet.hit.primID[lane], packet.hit.geomID[lane],
                                                       packet.hit.instID[0][lane], packet.ray.time[lane]);
        });
}

// Embree marks occluded rays with tfar = -inf; filter functions mark those that pass panes.

template <typename Batch>
void EmbreeScene::occluded_single(const Batch& rays, std::span<std::uint8_t> occluded, RayEnds ends) const {
    QueryContext context(*this, rays, false);
    context.ends = ends;
    context.passed = occluded.data();
    if (has_panes_) std::ranges::fill(occluded, kFree);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        RTCRay query = make_ray(rays[i], static_cast<unsigned int>(i));
        embree::occluded1(top_, context.base, query);
        occluded[i] = query.tfar < 0.0f ? kOccluded : has_panes_ ? occluded[i] : kFree;
    }
}

template <std::size_t Width, typename Batch>
void EmbreeScene::occluded_packets(const Batch& rays, std::span<std::uint8_t> occluded, RayEnds ends) const {
    QueryContext context(*this, rays, false);
    context.ends = ends;
    context.passed = occluded.data();
    if (has_panes_) std::ranges::fill(occluded, kFree);
    for_each_packet<Width, typename Packet<Width>::Rays>(
        rays, [&](const PacketMask<Width>& mask, auto& packet, std::size_t first, std::size_t count) {
            embree::occluded(mask.valid, top_, context.base, packet);
            if (has_panes_) {
                for (std::size_t lane = 0; lane < count; ++lane)
                    if (packet.tfar[lane] < 0.0f) occluded[first + lane] = kOccluded;
            } else {
                for (std::size_t lane = 0; lane < count; ++lane)
                    occluded[first + lane] = packet.tfar[lane] < 0.0f ? kOccluded : kFree;
            }
        });
}

std::string EmbreeScene::instruction_set() const {
    const auto supports = [&](RTCDeviceProperty property) { return rtcGetDeviceProperty(device_, property) != 0; };
    if (supports(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return "AVX-512";
    return supports(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? "AVX/AVX2" : "SSE";
}

std::string bvh_quality() {
    constexpr std::string_view kQuality = kBuildQuality == RTC_BUILD_QUALITY_HIGH     ? "high"
                                          : kBuildQuality == RTC_BUILD_QUALITY_MEDIUM ? "medium"
                                                                                      : "low";
    std::string quality(kQuality);
    if ((kSceneFlags & RTC_SCENE_FLAG_ROBUST) != 0) quality += ", robust";
    if ((kSceneFlags & RTC_SCENE_FLAG_COMPACT) != 0) quality += ", compact";
    return quality;
}

std::string ray_tracer_version() {
    return RTC_VERSION_STRING;
}

}  // namespace etendue
