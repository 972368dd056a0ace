// Bare Embree on given rays: nothing but its calls is timed.
#include "core/process_time.h"
#include "world/embree_query.h"
#include "world/embree_scene.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

namespace etendue {

namespace {

/// Seconds that `call` takes for all of `queries`.
template <typename Queries, typename Call>
double timed(Queries& queries, const Call& call) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < queries.size(); ++i) call(i, queries[i]);
    return seconds_since(start);
}

template <std::size_t Width>
double replay_packets(RTCScene top, std::span<const Ray> rays, QueryContext& context, bool occlusion, bool coherent) {
    const std::size_t count = (rays.size() + Width - 1) / Width;
    std::vector<PacketMask<Width>> masks(count);
    std::vector<typename Packet<Width>::RayHits> packets(count);
    for (std::size_t i = 0; i < count; ++i) fill_packet<Width>(rays, i * Width, packets[i], masks[i]);
    if (occlusion)
        return timed(packets, [&](std::size_t i, typename Packet<Width>::RayHits& packet) {
            embree::occluded(masks[i].valid, top, context.base, packet.ray);
        });
    return timed(packets, [&](std::size_t i, typename Packet<Width>::RayHits& packet) {
        embree::intersect(masks[i].valid, top, context.base, coherent, packet);
    });
}

double replay_single(RTCScene top, std::span<const Ray> rays, QueryContext& context, bool occlusion) {
    std::vector<RTCRayHit> queries(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) queries[i] = make_ray_hit(rays[i], static_cast<unsigned int>(i));
    if (occlusion)
        return timed(queries, [&](std::size_t, RTCRayHit& query) { embree::occluded1(top, context.base, query.ray); });
    return timed(queries, [&](std::size_t, RTCRayHit& query) { embree::intersect1(top, context.base, query); });
}

}  // namespace

double EmbreeScene::replay(std::span<const Ray> rays, bool occlusion, Coherence coherence, QueryForm form) const {
    const bool coherent = !occlusion && takes_as_coherent(coherence) && form != QueryForm::Single;
    QueryContext context(*this, rays, coherent);
    std::vector<std::uint8_t> passed(rays.size());  // where filter functions say which shadow rays pass clear surfaces
    context.passed = passed.data();
    switch (form) {
        case QueryForm::Single:
            return replay_single(top_.get(), rays, context, occlusion);
        case QueryForm::Packet8:
            return replay_packets<8>(top_.get(), rays, context, occlusion, coherent);
        case QueryForm::Best:
        case QueryForm::Packet16:
            break;
    }
    return replay_packets<16>(top_.get(), rays, context, occlusion, coherent);
}

}  // namespace etendue
