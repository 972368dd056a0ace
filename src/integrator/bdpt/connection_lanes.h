// Connections of a block that are computed many at once.
#pragma once

#include "core/columns.h"
#include "integrator/bdpt/diffuse_connections.h"
#include "wave/light_front_columns.h"
#include "wave/shadow_ray_queue.h"

#include <cstddef>

namespace etendue {

struct ConnectionColumns {
    BitColumn slot;       ///< sample that gets the light
    BitColumn is_direct;  ///< 1 where that is direct light, else 0

    RgbColumns contribution;
    Vec3Columns origin, direction;
    Column t_max;

    void set_sample(std::size_t lane, std::uint32_t slot_of_lane, bool is_direct_light) {
        slot.set(lane, slot_of_lane);
        is_direct.set(lane, is_direct_light ? 1u : 0u);
    }
    [[nodiscard]] Ray ray(std::size_t lane) const {
        Ray ray;
        ray.origin = origin[lane];
        ray.direction = direction[lane];
        ray.t_max = t_max[lane];
        return ray;
    }
    /// Calls `queue(connections, which, first)` for all of the `count` that bring anything, where rays have no time and
    /// nothing is partly transparent.
    template <typename Queue>
    void for_each_wide(std::size_t count, const Queue& queue) const {
        for (std::size_t first = 0; first < count; first += Wide::kWidth) {
            const BasicRgb<Wide> light = contribution.load(first);
            queue(WideShadowRays{.origin = origin.load(first),
                                 .direction = direction.load(first),
                                 .t_max = t_max.load(first),
                                 .time = 0.0f,
                                 .alpha_key = 0u,
                                 .slot = slot.load(first),
                                 .contribution = light,
                                 .is_direct = is_direct.load(first) != WideBits(0u)},
                  WideMask::first(count - first) && !is_black(light), first);
        }
    }
    void store(std::size_t first, const Imath::Vec3<Wide>& from, const DiffuseConnection<Wide>& connection) {
        origin.store(first, from);
        contribution.store(first, connection.contribution);
        direction.store(first, connection.ray.direction);
        t_max.store(first, connection.ray.t_max);
    }
};

// Each computes lanes [0, count), rounded up, from what the caller has set.

/// Connects vertices of two subpaths; about 5 KiB. Ends stay where they are until rays are asked for.
struct BetweenLanes : ConnectionColumns {
    DiffuseEndsOfBlock eye, light;
    Column merged;  ///< SubpathDensities::merged of the eye's end, or 0 if the light has come by no delta
    Column scale;   ///< how many connections one stands for

    void connect(std::size_t count, const WeightRule& rule);
};

/// Connects eye vertices to samples of even mesh lights; about 8 KiB.
struct ToLightLanes : ConnectionColumns {
    DiffuseEndsOfBlock eye;
    LightFrontColumns front;
    Vec2Columns u;  ///< for the point on the triangle
    RgbColumns radiance;
    Column probability;   ///< probability of choosing the light for a sample
    Column choice_ratio;  ///< probability of choosing light and triangle for an emission, over that for a sample

    Vec3Columns wi;  ///< to the sample

    void connect(std::size_t count, const WeightRule& rule, const LightAim& aim);
};

/// Connects light vertices to the camera; about 5 KiB.
struct ToCameraLanes : ConnectionColumns {
    DiffuseEndsOfBlock light;
    Vec3Columns lens, w;  ///< the point there, and the unit vector to it
    Column importance;    ///< CameraConnection::importance_area

    void connect(std::size_t count, const WeightRule& rule, float samples_per_path);
};

}  // namespace etendue
