// One step of a path, from vertex to vertex.
#pragma once

#include "core/ray.h"
#include "core/ray_cone.h"
#include "core/rgb.h"
#include "light/light_receiver.h"
#include "scene/integrator_settings.h"
#include "transport/dimensions.h"
#include "transport/vertex.h"
#include "world/world.h"

#include <cstdint>

namespace etendue {

/// Traces the rays of one sample from the eye, one by one. A renderer implements this class to trace and count the rays
/// of a scalar algorithm.
class SampleTracer {
  public:
    virtual ~SampleTracer() = default;
    /// Returns the first hit of `ray`, which has `ends` and is ray `number` of its path; ray 1 comes from the camera.
    [[nodiscard]] virtual Hit nearest_hit(const Ray& ray, int number, RayEnds ends) = 0;
    /// Returns what `SceneGeometry::occluded` says of `ray`.
    [[nodiscard]] virtual std::uint8_t occluded(const Ray& ray) = 0;
    /// Returns true if another estimate finds the emission of `hit`, which the ray from the camera has met.
    [[nodiscard]] virtual bool finds_emission(const Hit& /*hit*/) const { return false; }
};

/// Holds a sample of a pixel: its ray from the camera, with the cone of the pixel around it, and its random numbers.
struct EyeSample {
    Ray ray;
    RayCone cone;
    SampleNumbers numbers;
    Vec2f lens{0.0f, 0.0f};          ///< chose the point on the lens, in [0, 1)²
    SampleTracer* tracer = nullptr;  ///< traces the sample's rays; null if the World does
};

/// Holds the light that a sample finds, W/(m² sr).
struct EyeLight {
    Rgb seen{};          ///< from what the eye sees directly, which is as bright in every sample
    Rgb scattered{};     ///< all other light
    float alpha = 1.0f;  ///< 0 if the eye sees through the scene

    [[nodiscard]] Rgb radiance() const { return seen + scattered; }
};

/// Holds what the weight of light that a path meets by chance depends on: the path's last vertex, and the light samples
/// that were taken there.
struct LightSampleContext {
    LightReceiver receiver;
    std::uint32_t samples = 0;     ///< light samples at the vertex; 0 if none of them can find what the ray meets
    float pdf_solid_angle = 0.0f;  ///< 1/sr, of the ray's direction; not meaningful if there are no `samples`
    float passed = 0.0f;           ///< metres from the vertex to where the ray starts, over 0 behind clear surfaces
};

/// Holds a path from the eye between two of its vertices: the ray to the next one, and the share of light that comes
/// back along it.
struct EyePath {
    Ray ray;
    RayCone cone;                 ///< around the ray
    Interior interior;            ///< the bodies that the ray is in
    Rgb throughput{1.0f};         ///< the share of its light that arrives at the eye, over the density of the path
    float roulette_scale = 1.0f;  ///< eta² over all refractions: what radiance takes from the throughput, unlike power
    float wavelength_nm = 0.0f;   ///< nanometres once a dispersive body has refracted it, 0 for all wavelengths
    int rays = 1;                 ///< traced, this one included
    int edges = 1;                ///< rays traced without those to media, clear surfaces and hidden boundaries
    bool only_deltas = true;  ///< every vertex so far was a delta, or there is none: the eye sees what the ray meets
    LightSampleContext last{};
    SampleTracer* tracer = nullptr;  ///< traces the path's rays; null if the World does

    /// Returns true if the eye sees what the ray meets, through clear surfaces at most.
    [[nodiscard]] bool is_seen() const { return edges == 1 && only_deltas; }
};

/// Holds the random numbers of one vertex, but for those of light samples.
struct VertexNumbers {
    Vec2f medium;  ///< x: how far, y: by which channel
    float wavelength;
    float lobe;
    Vec2f direction;
    float roulette;
    std::uint32_t alpha_key;  ///< alpha key of the ray that goes on

    VertexNumbers(const SampleNumbers& numbers, int rays);
};

/// Returns the path of `sample` that has come nowhere yet.
[[nodiscard]] EyePath begin_at_eye(const World& world, const EyeSample& sample);

/// Returns the nearest surface along `ray`.
[[nodiscard]] Hit nearest_hit(const World& world, const Ray& ray, RayEnds ends = RayEnds::InScene);
/// Returns the nearest surface along the path's ray, if the camera shows it where the eye sees along the ray.
[[nodiscard]] Hit nearest_hit(const World& world, const EyePath& path);
/// Returns whether the camera sees a shadow or a hole in the place of `vertex`, where the path has arrived.
[[nodiscard]] inline bool is_replaced(const EyePath& path, const Vertex& vertex) {
    return path.is_seen() && vertex.kind == Vertex::Kind::Surface &&
           vertex.surface.material->seen_as != SeenAs::Surface;
}
/// Returns the share of light, [0, 1], that passes what lies within the length of `ray`; `tracer` may be null.
[[nodiscard]] Rgb visibility(const World& world, const Ray& ray, SampleTracer* tracer = nullptr,
                             RayEnds ends = RayEnds::InScene);

/// Follows the path's ray to where it leads. Multiplies the throughput by the transmittance of a medium on the way,
/// times its scattering coefficient where it scatters, over the density.
[[nodiscard]] Vertex next_vertex(const World& world, EyePath& path, const VertexNumbers& u);

/// Extends the path from `vertex`, at which it took `light_samples`, in a direction sampled as `settings` say. Returns
/// false if the path ends there: light is absorbed, or the path would be too long.
[[nodiscard]] bool scatter(const World& world, EyePath& path, const Vertex& vertex, const VertexNumbers& u,
                           std::uint32_t light_samples, const IntegratorSettings& settings);

/// Sends the path straight on from `vertex`, which is none to the path: a boundary that another body hides, or a clear
/// surface.
void pass(EyePath& path, const Vertex& vertex, std::uint32_t alpha_key);

/// Ends the path at random if little light comes along it, and divides the throughput of survivors by their chance;
/// false if it ends.
[[nodiscard]] bool survives_roulette(const World& world, EyePath& path, float u, int roulette_depth);

/// Points the path's ray along `sample` from `vertex` and sets its cone, its bodies and eta²; leaves the throughput and
/// the edges to the caller.
void leave(const World& world, EyePath& path, const Vertex& vertex, const BsdfSample& sample, std::uint32_t alpha_key);

}  // namespace etendue
