// Connections of a block that are computed many at once.
#pragma once

#include "core/columns.h"
#include "integrator/bdpt/matte_connections.h"
#include "integrator/light_front_columns.h"

#include <cstddef>

namespace etendue {

/// What a connection brings if nothing is in the way, and its weight, which that includes.
struct Brought {
    Rgb light;
    float weight;
};

struct ConnectionColumns {
    RgbColumns contribution;
    Column weight;
    Vec3Columns direction;
    Column t_max;

    [[nodiscard]] Brought brought(std::size_t lane) const { return {contribution[lane], weight[lane]}; }
    /// From `origin`, that of the end.
    [[nodiscard]] Ray ray(std::size_t lane, const Vec3f& origin) const {
        Ray ray;
        ray.origin = origin;
        ray.direction = direction[lane];
        ray.t_max = t_max[lane];
        return ray;
    }
    void store(std::size_t first, const MatteConnection<Wide>& connection) {
        contribution.store(first, connection.contribution);
        weight.store(first, connection.weight);
        direction.store(first, connection.ray.direction);
        t_max.store(first, connection.ray.t_max);
    }
};

// Each computes lanes [0, count), rounded up, from what the caller has set.

/// Of two subpaths; about 3 KiB. Ends stay where they are until rays are asked for.
struct BetweenLanes : ConnectionColumns {
    MatteEndsOfBlock eye, light;
    Column scale;  ///< how many connections one stands for

    void connect(std::size_t count, const WeightRule& rule);
};

/// To samples of even mesh lights; about 10 KiB.
struct ToLightLanes : ConnectionColumns {
    MatteEndsOfBlock eye;
    LightFrontColumns front;
    Vec2Columns u;  ///< for the point on the triangle
    RgbColumns radiance;
    Column probability;   ///< of the choice of the light
    Column choice_ratio;  ///< of light and triangle being chosen for an emission, over that for a sample

    // The sample.
    Vec3Columns wi;
    Column distance, cos_light;

    void connect(std::size_t count, const WeightRule& rule);
};

/// To the camera; about 4 KiB.
struct ToCameraLanes : ConnectionColumns {
    MatteEndsOfBlock light;
    Vec3Columns lens, w;  ///< the point there, and the unit vector to it
    Column importance;    ///< CameraConnection::importance_area

    void connect(std::size_t count, const WeightRule& rule, float samples_per_path);
};

}  // namespace etendue
