// A medium that is the same everywhere: absorbs and scatters light with coefficients per channel.
//
// Distances are sampled by the extinction of a channel that is drawn by its throughput; the density is that of all
// channels together, so that no throughput exceeds the sum of what there was (Chiang, Kutz and Burley, "Practical and
// Controllable Subsurface Scattering for Production Path Tracing", SIGGRAPH 2016 talk).
#pragma once

#include "core/rgb.h"
#include "core/vec.h"
#include "medium/henyey_greenstein.h"

namespace etendue {

/// Where light goes in a medium.
struct MediumSample {
    float distance = 0.0f;  ///< metres to the point of scattering
    bool scatters = false;  ///< false: it reaches the end of its way
    Rgb weight;             ///< transmittance, times the scattering coefficient if it scatters, over the density
};

struct HomogeneousMedium {
    Rgb extinction{};             ///< absorbed and scattered, 1/m, >= 0
    Rgb single_scatter_albedo{};  ///< the scattered share of it, [0, 1]
    HenyeyGreenstein phase{};
    /// Light scatters so often on its way through that connections between two points of it do not pay.
    bool is_dense = false;

    [[nodiscard]] bool is_empty() const { return is_black(extinction); }
    [[nodiscard]] bool scatters() const { return !is_black(extinction * single_scatter_albedo); }

    /// Share of light that passes `distance` metres, which may be infinite.
    [[nodiscard]] Rgb transmittance(float distance) const;

    /// How far light with `throughput` gets on a way of `distance` metres. `u.x` draws the distance, `u.y` the channel,
    /// both in [0, 1).
    [[nodiscard]] MediumSample sample(const Rgb& throughput, float distance, Vec2f u) const;

    /// Single-scattering albedo, per channel, with which a large body of such a medium reflects `multiscatter_color` in
    /// diffuse light, by a fit of Kulla and Conty ("Revisiting Physically Based Shading at Imageworks", SIGGRAPH 2017
    /// course), corrected for anisotropy `g` by the similarity relation.
    [[nodiscard]] static Rgb albedo_from_multiscatter(const Rgb& multiscatter_color, float g);
};

}  // namespace etendue
