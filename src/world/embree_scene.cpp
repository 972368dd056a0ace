#include "world/embree_scene.h"

#include "core/error.h"
#include "core/process_time.h"
#include "world/embree_geometry_maker.h"
#include "world/embree_query.h"
#include "world/embree_shape.h"
#include "world/motion.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <unordered_map>

namespace etendue {

namespace {

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

}  // namespace

EmbreeScene::~EmbreeScene() = default;

EmbreeScene::EmbreeScene(std::span<const Geometry> geometries, std::span<const Instance> instances,
                         std::span<const TransformMotion> motions, std::span<const HitFilter> filters,
                         const ThreadPool& threads, std::vector<CollectedSlot> collected)
    : collects_(!collected.empty()),
      collected_(std::move(collected)),
      has_clear_surfaces_(!collects_ && std::ranges::any_of(filters, &HitFilter::passes_shadows)) {
    has_motion_ =
        !motions.empty() || std::ranges::any_of(geometries, [](const Geometry& g) { return !g.motion.empty(); });
    const auto start = std::chrono::steady_clock::now();
    threads.execute([&] {
        // Embree's own threads would come on top of the pool's; with start_threads=0 it uses the arena it is called
        // from.
        device_.reset(rtcNewDevice("start_threads=0,set_affinity=0"));
        if (!device_) throw IoError("Embree could not be started");
        rtcSetDeviceMemoryMonitorFunction(device_.get(), count_memory, &bytes_);
        const EmbreeGeometryMaker maker{device_.get(), geometries, filters, collects_, collected_indices_, shapes_};
        top_.reset(maker.new_scene());
        add_instances(maker, instances, motions);
        rtcCommitScene(top_.get());
    });
    rtcSetDeviceMemoryMonitorFunction(device_.get(), nullptr, nullptr);
    build_seconds_ = seconds_since(start);
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error != RTC_ERROR_NONE)
        throw IoError("Embree could not build the scene (error " + std::to_string(static_cast<int>(error)) +
                      (error == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory)" : ")"));
}

void EmbreeScene::add_instances(const EmbreeGeometryMaker& maker, std::span<const Instance> instances,
                                std::span<const TransformMotion> motions) {
    std::unordered_map<std::uint32_t, RTCScene> scene_of_mesh;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const Instance& instance = instances[i];
        const auto index = static_cast<std::uint32_t>(i);
        // A mesh without geometry shares its first index with the next one, so it must not claim a scene under it.
        if (instance.baked || instance.geometry_count == 0) {
            for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
                if (!is_taken(instance, g)) continue;
                const std::uint32_t geometry = instance.first_geometry + g;
                const CollectedSlot* slot = collects_ ? &collected_[instance.first_light_slot + g] : nullptr;
                maker.add_geometry(top_.get(), geometry, slot);
                entries_.add({index, geometry}, slot);
            }
            continue;
        }
        bool is_any_taken = false;
        for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
            is_any_taken = is_any_taken || is_taken(instance, g);
        if (!is_any_taken) continue;
        RTCScene& shared = scene_of_mesh[instance.first_geometry];
        if (!shared) shared = shared_.emplace_back(maker.build_shared_scene(instance)).get();
        maker.add_instance(top_.get(), shared, instance, motions);
        entries_.add({index, instance.first_geometry}, nullptr);
    }
}

bool EmbreeScene::is_taken(const Instance& instance, std::uint32_t geometry) const {
    if (!collects_) return true;
    const CollectedSlot& slot = collected_[instance.first_light_slot + geometry];
    return slot.is_whole || !slot.triangles.empty();
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
    embree::intersect1(top_.get(), context.base, query);
    return collected.count;
}

void EmbreeScene::for_each_near(const Vec3f& point, float radius, const NearVisitor& visit) const {
    RTCPointQuery query{point.x, point.y, point.z, kMidShutter, radius};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    NearQuery near{&entries_, &visit};
    rtcPointQuery(top_.get(), &query, &context, visit_near, &near);
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
        embree::intersect1(top_.get(), context.base, query);
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
            embree::intersect(mask.valid, top_.get(), context.base, coherent, packet);
            for (std::size_t lane = 0; lane < count; ++lane)
                hits[first + lane] = entries_.make_hit(packet.ray.tfar[lane], packet.hit.u[lane], packet.hit.v[lane],
                                                       packet.hit.primID[lane], packet.hit.geomID[lane],
                                                       packet.hit.instID[0][lane], packet.ray.time[lane]);
        });
}

// Embree marks occluded rays with tfar = -inf; filter functions mark those that pass clear surfaces.

template <typename Batch>
void EmbreeScene::occluded_single(const Batch& rays, std::span<std::uint8_t> occluded, RayEnds ends) const {
    QueryContext context(*this, rays, false);
    context.ends = ends;
    context.passed = occluded.data();
    if (has_clear_surfaces_) std::ranges::fill(occluded, kFree);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        RTCRay query = make_ray(rays[i], static_cast<unsigned int>(i));
        embree::occluded1(top_.get(), context.base, query);
        occluded[i] = query.tfar < 0.0f ? kOccluded : has_clear_surfaces_ ? occluded[i] : kFree;
    }
}

template <std::size_t Width, typename Batch>
void EmbreeScene::occluded_packets(const Batch& rays, std::span<std::uint8_t> occluded, RayEnds ends) const {
    QueryContext context(*this, rays, false);
    context.ends = ends;
    context.passed = occluded.data();
    if (has_clear_surfaces_) std::ranges::fill(occluded, kFree);
    for_each_packet<Width, typename Packet<Width>::Rays>(
        rays, [&](const PacketMask<Width>& mask, auto& packet, std::size_t first, std::size_t count) {
            embree::occluded(mask.valid, top_.get(), context.base, packet);
            if (has_clear_surfaces_) {
                for (std::size_t lane = 0; lane < count; ++lane)
                    if (packet.tfar[lane] < 0.0f) occluded[first + lane] = kOccluded;
            } else {
                for (std::size_t lane = 0; lane < count; ++lane)
                    occluded[first + lane] = packet.tfar[lane] < 0.0f ? kOccluded : kFree;
            }
        });
}

std::string EmbreeScene::instruction_set() const {
    const auto supports = [&](RTCDeviceProperty property) {
        return rtcGetDeviceProperty(device_.get(), property) != 0;
    };
    if (supports(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return "AVX-512";
    return supports(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? "AVX/AVX2" : "SSE";
}

std::string ray_tracer_version() {
    return RTC_VERSION_STRING;
}

}  // namespace etendue
