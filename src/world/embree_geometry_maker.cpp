#include "world/embree_geometry_maker.h"

#include "world/embree_filters.h"

#include <string_view>

namespace etendue {

namespace {

// Of all BVHs; docs/optimisation.md has what the others were measured to cost.
constexpr RTCBuildQuality kBuildQuality = RTC_BUILD_QUALITY_MEDIUM;
constexpr RTCSceneFlags kSceneFlags = RTC_SCENE_FLAG_ROBUST;

void attach(RTCScene scene, RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

// Embree's own spheres and discs are not used: they are met in single precision, are never ellipsoids, and their hits
// have no u and v (both are 0). Front and back of a sphere also share one primitive, but rays pass them independently.
void add_shape(const EmbreeGeometryMaker& maker, RTCScene scene, const ExactShape& shape, const HitFilter& filter) {
    const FilterFunctions functions = filter_functions(filter, maker.collects);
    maker.shapes.push_back(
        std::make_unique<const EmbreeShape>(EmbreeShape{shape, functions.intersect, functions.occluded}));
    RTCGeometry placed = rtcNewGeometry(maker.device, RTC_GEOMETRY_TYPE_USER);
    set_shape(placed, *maker.shapes.back());
    attach(scene, placed);
}

/// Gives `mesh` the vertices of `geometry`, at all times.
void set_vertices(RTCGeometry mesh, const Geometry& geometry) {
    const auto set = [&](unsigned int slot, const std::vector<Vec3f>& positions) {
        rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, slot, RTC_FORMAT_FLOAT3, positions.data(), 0,
                                   sizeof(Vec3f), positions.size());
    };
    if (geometry.motion.empty()) {
        set(0, geometry.positions);
    } else {
        rtcSetGeometryTimeStepCount(mesh, static_cast<unsigned int>(geometry.motion.size()));
        for (std::size_t i = 0; i < geometry.motion.size(); ++i)
            set(static_cast<unsigned int>(i), geometry.motion[i].positions);
    }
}

}  // namespace

RTCScene EmbreeGeometryMaker::new_scene() const {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, kBuildQuality);
    rtcSetSceneFlags(scene, kSceneFlags);
    return scene;
}

void EmbreeGeometryMaker::add_geometry(RTCScene scene, std::uint32_t index, const CollectedSlot* collected) const {
    const Geometry& geometry = geometries[index];
    if (geometry.shape) return add_shape(*this, scene, *geometry.shape, filters[index]);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    set_vertices(mesh, geometry);
    const std::vector<std::array<std::uint32_t, 3>>* triangles = &geometry.triangles;
    if (collected != nullptr && !collected->is_whole) {
        auto& indices = collected_indices.emplace_back();
        for (const std::uint32_t triangle : collected->triangles) indices.push_back(geometry.triangles[triangle]);
        triangles = &indices;
    }
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles->data(), 0,
                               sizeof(std::array<std::uint32_t, 3>), triangles->size());
    const FilterFunctions functions = filter_functions(filters[index], collects);
    if (functions.intersect != nullptr) rtcSetGeometryIntersectFilterFunction(mesh, functions.intersect);
    if (functions.occluded != nullptr) rtcSetGeometryOccludedFilterFunction(mesh, functions.occluded);
    attach(scene, mesh);
}

RTCScene EmbreeGeometryMaker::build_shared_scene(const Instance& instance) const {
    RTCScene scene = new_scene();
    for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
        add_geometry(scene, instance.first_geometry + g, nullptr);
    rtcCommitScene(scene);
    return scene;
}

void EmbreeGeometryMaker::add_instance(RTCScene scene, RTCScene shared, const Instance& instance,
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

std::string bvh_quality() {
    constexpr std::string_view kQuality = kBuildQuality == RTC_BUILD_QUALITY_HIGH     ? "high"
                                          : kBuildQuality == RTC_BUILD_QUALITY_MEDIUM ? "medium"
                                                                                      : "low";
    std::string quality(kQuality);
    if ((kSceneFlags & RTC_SCENE_FLAG_ROBUST) != 0) quality += ", robust";
    if ((kSceneFlags & RTC_SCENE_FLAG_COMPACT) != 0) quality += ", compact";
    return quality;
}

}  // namespace etendue
