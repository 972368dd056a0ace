// Contributions that come one by one and many at a time, among each other: what arrives is what was queued, in its
// order.
#include "wave/shadow_ray_queue.h"

#include "support/random.h"
#include "world/test_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace etendue::test {

namespace {

constexpr std::uint32_t kSlots = 40;

/// One connection, as the test remembers it.
struct Queued {
    Ray ray;
    std::uint32_t slot = 0;
    Rgb value;
    SplatPlace place;
    std::vector<ExpressionShare> shares;
    bool is_direct = false;
};

/// A wall stops the rays on one side.
World half_a_wall() {
    SceneDesc scene = empty_scene();
    add_object(scene, quad({5, 0, -1}, {5, 0, 0}, {0, 5, 0}), add_material(scene, diffuse(Rgb(0.5f))));
    return compile(std::move(scene));
}

bool arrives(const Queued& queued) {
    return queued.ray.origin.x < 0.0f || queued.ray.t_max < 1.0f;
}

class ConnectionsTest : public testing::Test {
  protected:
    Queued next(bool with_shares) {
        Queued queued;
        queued.ray.origin = {random_.next() < 0.5f ? -1.0f - random_.next() : 1.0f + random_.next(), random_.next(), 0};
        queued.ray.direction = {0, 0, -1};
        queued.ray.t_max = random_.next() < 0.5f ? 0.5f : 2.0f;
        queued.slot = static_cast<std::uint32_t>(random_.next() * kSlots);
        queued.value = {random_.next(), random_.next(), 1.0f + random_.next()};
        queued.place = {random_.next_2d(), random_.next()};
        queued.is_direct = random_.next() < 0.5f;
        if (with_shares)
            for (std::size_t count = static_cast<std::size_t>(random_.next() * 3.0f); count > 0; --count)
                queued.shares.push_back({1u << count, Rgb(random_.next())});
        return queued;
    }
    /// Queues some, singly or as lanes of which some are asked for; those are added to `queued_`.
    void queue(bool to_film) {
        if (random_.next() < 0.7f) {
            const Queued one = next(job_.aovs != nullptr && !to_film);
            const LightKind kind = one.is_direct ? LightKind::Direct : LightKind::Indirect;
            if (to_film)
                connections_.to_film(one.ray, one.slot,
                                     {.position = one.place.position, .value = one.value, .depth = one.place.depth},
                                     kind, one.shares);
            else
                connections_.to_sample(one.ray, one.slot, one.value, kind, one.shares);
            queued_.push_back(one);
            return;
        }
        std::array<Queued, Wide::kWidth> lanes;
        Imath::Vec3<Wide> origin(Wide(0.0f));
        Imath::Vec3<Wide> direction(Wide(0.0f));
        BasicRgb<Wide> value;
        Wide t_max(0.0f);
        std::array<std::uint32_t, Wide::kWidth> slots;
        Wide is_direct(0.0f);
        Wide is_asked_for(0.0f);
        const float share = random_.next() * 1.4f - 0.2f;  // all and none, too
        for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
            const Queued one = lanes[lane] = next(false);
            origin.x.set(lane, one.ray.origin.x);
            origin.y.set(lane, one.ray.origin.y);
            origin.z.set(lane, one.ray.origin.z);
            direction.x.set(lane, one.ray.direction.x);
            direction.y.set(lane, one.ray.direction.y);
            direction.z.set(lane, one.ray.direction.z);
            t_max.set(lane, one.ray.t_max);
            value.r.set(lane, one.value.r);
            value.g.set(lane, one.value.g);
            value.b.set(lane, one.value.b);
            slots[lane] = one.slot;
            is_direct.set(lane, one.is_direct ? 1.0f : 0.0f);
            if (random_.next() < share) {
                is_asked_for.set(lane, 1.0f);
                queued_.push_back(one);
            }
        }
        const WideShadowRays wide{.origin = origin,
                                  .direction = direction,
                                  .t_max = t_max,
                                  .time = 0.0f,
                                  .alpha_key = 0u,
                                  .slot = WideBits::load(slots.data()),
                                  .contribution = value,
                                  .is_direct = is_direct != Wide(0.0f)};
        const WideMask which = is_asked_for != Wide(0.0f);
        if (to_film)
            connections_.to_film(wide, which, [&](std::size_t lane) { return lanes[lane].place; });
        else
            connections_.to_sample(wide, which);
    }
    void resolve() {
        samples_.resize(kSlots);
        tile_.reset(job_.rect);
        light_.reset(kSlots, job_, 1e30f);
        connections_.resolve(world_, job_, samples_, light_, tile_, counters_);
    }

    Random random_{11};
    World world_ = half_a_wall();
    PixelFilter filter_{FilterShape::Box};
    AovSet aovs_{.layout = {.light = 4}};
    TileJob job_{{0, 0, 8, 8}, {0, 0, 8, 8}, 8, 8, 0, 1, 1, SampleSequence::Sobol, &filter_, &aovs_};
    std::vector<CameraSample> samples_;
    SampleLight light_;
    TileBuffer tile_;
    RenderCounters counters_;
    ShadowRayQueue connections_{RayKind::Shadow};
    std::vector<Queued> queued_;
};

TEST_F(ConnectionsTest, BringToSamplesWhatNothingStops) {
    for (const int operations : {0, 1, 15, 40, 3000, 70}) {
        queued_.clear();
        for (int i = 0; i < operations; ++i) queue(false);
        resolve();
        std::vector<Rgb> radiance(kSlots);
        std::vector<Rgb> layers(kSlots * aovs_.layout.light);
        for (const Queued& one : queued_) {
            if (!arrives(one)) continue;
            radiance[one.slot] += one.value;
            for (const ExpressionShare& part : one.shares)
                for (std::size_t layer = 0; layer < aovs_.layout.light; ++layer)
                    if ((part.expressions >> layer & 1u) != 0)
                        layers[one.slot * aovs_.layout.light + layer] += one.value * part.share;
        }
        for (std::size_t slot = 0; slot < kSlots; ++slot) {
            ASSERT_EQ(light_.radiance(slot), radiance[slot]) << operations;
            for (std::size_t layer = 0; layer < aovs_.layout.light; ++layer) {
                // To roundings: the compiler may contract product and sum.
                const Rgb& expected = layers[slot * aovs_.layout.light + layer];
                const Rgb& found = light_.layers(slot)[layer];
                ASSERT_FLOAT_EQ(found.r, expected.r) << operations;
                ASSERT_FLOAT_EQ(found.g, expected.g) << operations;
                ASSERT_FLOAT_EQ(found.b, expected.b) << operations;
            }
        }
    }
}

TEST_F(ConnectionsTest, BringToTheFilmWhatNothingStops) {
    for (const int operations : {1, 15, 40, 3000, 70}) {
        queued_.clear();
        for (int i = 0; i < operations; ++i) queue(true);
        resolve();
        std::size_t next = 0;
        for (const Queued& one : queued_) {
            if (!arrives(one)) continue;
            ASSERT_LT(next, tile_.splats().size());
            const Splat& splat = tile_.splats()[next++];
            ASSERT_EQ(splat.position, one.place.position);
            ASSERT_EQ(splat.value, one.value);
            ASSERT_EQ(splat.depth, one.place.depth);
        }
        EXPECT_EQ(next, tile_.splats().size());
    }
}

// A limit tells direct light from other.
TEST_F(ConnectionsTest, KeepKindsOfLight) {
    job_.aovs = nullptr;
    job_.clamp_indirect = 0.5f;
    for (std::size_t i = 0; i < 400; ++i) queue(false);
    resolve();
    std::vector<Rgb> radiance(kSlots);
    for (const Queued& one : queued_)
        if (arrives(one))
            radiance[one.slot] += one.is_direct ? one.value : one.value * (0.5f / max_component(one.value));
    for (std::size_t slot = 0; slot < kSlots; ++slot) ASSERT_EQ(light_.radiance(slot), radiance[slot]);
}

TEST_F(ConnectionsTest, AreFullWhenTheyFillABatch) {
    std::size_t count = 0;
    for (; !connections_.is_full(); ++count) {
        const Queued one = next(false);
        connections_.to_sample(one.ray, one.slot, one.value, LightKind::Direct, {});
    }
    EXPECT_EQ(count, 8192u);
    resolve();
    EXPECT_FALSE(connections_.is_full());
    EXPECT_EQ(counters_.rays[RayKind::Shadow], count);
}

}  // namespace

}  // namespace etendue::test
