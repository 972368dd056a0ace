// Connections that wait for their rays: contributions that count if nothing is in the way.
#pragma once

#include "core/ray.h"
#include "film/splat_film.h"
#include "integrator/camera_wave.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

class Connections {
  public:
    /// `kind` is that of their rays.
    explicit Connections(RayKind kind) : kind_(kind) {}

    /// To the light of sample `slot`. `shares` are those of expressions.
    void to_sample(const Ray& ray, std::uint32_t slot, const Rgb& contribution, LightKind kind,
                   std::span<const ExpressionShare> shares);
    /// To the place on the film that `splat` says, by the light path of sample `slot`.
    void to_film(const Ray& ray, std::uint32_t slot, const Splat& splat, LightKind kind,
                 std::span<const ExpressionShare> shares);

    /// Traces all rays and adds what arrives, in the order of the calls above.
    void resolve(const World& world, const TileJob& job, std::span<const CameraSample> samples, SampleLight& light,
                 TileBuffer& tile, RenderCounters& counters);
    [[nodiscard]] std::size_t bytes() const { return vector_bytes(rays_, pending_, shares_, occluded_); }
    /// True once there are enough to fill a batch.
    [[nodiscard]] bool is_full() const { return rays_.size() >= kBatch; }

  private:
    /// Rays traced together: enough for full packets, and their 36 bytes each stay in a cache of 1 MiB.
    static constexpr std::size_t kBatch = 8192;

    struct Pending {
        Rgb value;
        Vec2f position{0.0f, 0.0f};  ///< on the film, if it is a splat
        float depth = 0.0f;          ///< of that
        std::uint32_t slot = 0;
        std::uint32_t end_of_shares = 0;  ///< its shares are those from where the one before has ended
        bool is_splat = false;
        LightKind kind = LightKind::Direct;
    };
    /// One more, to be filled in where it lies: a copy of what was just written, number by number, would wait until all
    /// of that is in the cache.
    Pending& push(const Ray& ray, std::span<const ExpressionShare> shares);

    RayKind kind_;
    std::vector<Ray> rays_;
    std::vector<Pending> pending_;
    std::vector<ExpressionShare> shares_;
    std::vector<std::uint8_t> occluded_;
};

}  // namespace etendue
