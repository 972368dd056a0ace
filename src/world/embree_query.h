// Our rays as Embree takes them, one by one and in packets.
#pragma once

#include "core/ray.h"
#include "core/ray_columns.h"
#include "world/embree.h"
#include "world/hit.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

namespace etendue {

class EmbreeScene;

/// Where a query leaves all that its ray meets.
struct CollectedHits {
    std::span<Hit> hits;
    std::size_t count = 0;
};

/// Holds what a filter function needs beside the hit: the scene, and the alpha keys of the batch, in its rays or their
/// column.
struct QueryContext {
    embree::Context base;  // first, so that Embree's pointer to it is a pointer to this
    const EmbreeScene* scene;
    const Ray* rays;  ///< or null
    const std::uint32_t* alpha_keys;
    RayEnds ends = RayEnds::InScene;
    CollectedHits* collected = nullptr;  ///< only for `EmbreeScene::collect`
    std::uint8_t* passed =
        nullptr;  ///< by ray, set to kPassesClear where one does; only where there are clear surfaces

    QueryContext(const EmbreeScene& owner, std::span<const Ray> batch, bool coherent)
        : scene(&owner), rays(batch.data()), alpha_keys(nullptr) {
        embree::init_context(base, coherent);
    }
    QueryContext(const EmbreeScene& owner, const RayColumns& batch, bool coherent)
        : scene(&owner), rays(nullptr), alpha_keys(batch.alpha_key) {
        embree::init_context(base, coherent);
    }

    /// Returns the alpha key of the ray with the index `id` in its batch.
    [[nodiscard]] std::uint32_t alpha_key(unsigned int id) const {
        return rays != nullptr ? rays[id].alpha_key : alpha_keys[id];
    }
};
static_assert(std::is_standard_layout_v<QueryContext>);

/// Makes Embree's ray; `id` is the ray's index in its batch.
[[nodiscard]] inline RTCRay make_ray(const Ray& ray, unsigned int id) {
    RTCRay r{};
    r.org_x = ray.origin.x;
    r.org_y = ray.origin.y;
    r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x;
    r.dir_y = ray.direction.y;
    r.dir_z = ray.direction.z;
    r.tfar = ray.t_max;
    r.time = ray.time;
    r.mask = 0xffffffffu;
    r.id = id;
    return r;
}

/// Makes Embree's ray with a hit that is none yet; `id` is the ray's index in its batch.
[[nodiscard]] inline RTCRayHit make_ray_hit(const Ray& ray, unsigned int id) {
    RTCRayHit query;
    query.ray = make_ray(ray, id);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return query;
}

/// Embree's types of packets.
template <std::size_t Width>
struct Packet;
template <>
struct Packet<8> {
    using Rays = RTCRay8;
    using RayHits = RTCRayHit8;
};
template <>
struct Packet<16> {
    using Rays = RTCRay16;
    using RayHits = RTCRayHit16;
};

/// Which lanes have rays.
template <std::size_t Width>
struct PacketMask {
    alignas(64) int valid[Width];
};

/// Copies into a packet what it takes from rays `first` … of a batch, `count` of which are in it.
template <std::size_t Width>
void fill_rays(std::span<const Ray> rays, std::size_t first, std::size_t count, typename Packet<Width>::Rays& packet) {
    for (std::size_t lane = 0; lane < Width; ++lane) {
        const Ray& ray = rays[first + std::min(lane, count - 1)];
        packet.org_x[lane] = ray.origin.x;
        packet.org_y[lane] = ray.origin.y;
        packet.org_z[lane] = ray.origin.z;
        packet.dir_x[lane] = ray.direction.x;
        packet.dir_y[lane] = ray.direction.y;
        packet.dir_z[lane] = ray.direction.z;
        packet.time[lane] = ray.time;
        packet.tfar[lane] = ray.t_max;
    }
}
template <std::size_t Width>
void fill_rays(const RayColumns& rays, std::size_t first, std::size_t /*count*/, typename Packet<Width>::Rays& packet) {
    static_assert(Width <= RayColumns::kPacket);
    std::copy_n(rays.origin_x + first, Width, packet.org_x);
    std::copy_n(rays.origin_y + first, Width, packet.org_y);
    std::copy_n(rays.origin_z + first, Width, packet.org_z);
    std::copy_n(rays.direction_x + first, Width, packet.dir_x);
    std::copy_n(rays.direction_y + first, Width, packet.dir_y);
    std::copy_n(rays.direction_z + first, Width, packet.dir_z);
    std::copy_n(rays.time + first, Width, packet.time);
    if (rays.t_max != nullptr)
        std::copy_n(rays.t_max + first, Width, packet.tfar);
    else
        std::fill_n(packet.tfar, Width, std::numeric_limits<float>::infinity());
}

/// Rays `first` … of the batch, of which there is at least one, as a packet; lanes beyond the end are invalid.
template <std::size_t Width, typename Batch>
void fill_packet(const Batch& rays, std::size_t first, typename Packet<Width>::Rays& packet, PacketMask<Width>& mask) {
    const std::size_t count = std::min(Width, rays.size() - first);
    fill_rays<Width>(rays, first, count, packet);
    // What does not come from the rays, in loops of its own, which are vectorised.
    for (std::size_t lane = 0; lane < Width; ++lane) {
        mask.valid[lane] = lane < count ? -1 : 0;
        packet.tnear[lane] = 0.0f;
        packet.mask[lane] = 0xffffffffu;
        packet.id[lane] = static_cast<unsigned int>(first + lane);
        packet.flags[lane] = 0;
    }
}

/// Makes rays `first` … of the batch, of which there is at least one, a packet with hits that are none yet; lanes
/// beyond the end are invalid.
template <std::size_t Width, typename Batch>
void fill_packet(const Batch& rays, std::size_t first, typename Packet<Width>::RayHits& packet,
                 PacketMask<Width>& mask) {
    fill_packet<Width>(rays, first, packet.ray, mask);
    std::fill_n(packet.hit.geomID, Width, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(packet.hit.instID[0], Width, RTC_INVALID_GEOMETRY_ID);
}

/// Calls `trace(mask, packet, first, count)` for packets of type `Rays` of all rays, `count` of which, from `first` on,
/// are in that packet.
template <std::size_t Width, typename Rays, typename Batch, typename Trace>
void for_each_packet(const Batch& rays, const Trace& trace) {
    if (rays.size() == 0) return;
    // The next packet is filled before this one is traced: Embree would wait for what was just stored piece by piece.
    std::array<PacketMask<Width>, 2> masks;
    std::array<Rays, 2> packets;
    fill_packet<Width>(rays, 0, packets[0], masks[0]);
    for (std::size_t first = 0, now = 0; first < rays.size(); first += Width, now = 1 - now) {
        if (first + Width < rays.size()) fill_packet<Width>(rays, first + Width, packets[1 - now], masks[1 - now]);
        trace(masks[now], packets[now], first, std::min(Width, rays.size() - first));
    }
}

}  // namespace etendue
