#include "integrator/scalar_integrator.h"

#include "integrator/trace_in_waves.h"
#include "transport/scattered_cone.h"
#include "wave/aov/first_hits.h"
#include "wave/lamps_in_view.h"
#include "wave/one_kind_tracer.h"

namespace etendue {

namespace {

/// Traces the rays of one camera sample, but for the first, and counts them.
class CountingTracer final : public OneKindTracer {
  public:
    CountingTracer(const World& world, const TileJob& job, const LampsInView& lamps, SampleLight& light,
                   RenderCounters& counters)
        : OneKindTracer(world, job, RayKind::Bounce, counters), lamps_(lamps), light_(light) {}

    /// Goes on to the sample in `slot`, whose camera ray has met `hit`.
    void start(std::uint32_t slot, const Hit& hit) {
        slot_ = slot;
        first_ = hit;
        light_.count_ray(slot);
    }
    [[nodiscard]] Hit nearest_hit(const Ray& ray, int number, RayEnds ends) override {
        if (number == 1 && ends == RayEnds::InScene) return first_;
        light_.count_ray(slot_);
        return OneKindTracer::nearest_hit(ray, number, ends);
    }
    [[nodiscard]] std::uint8_t occluded(const Ray& ray) override {
        light_.count_ray(slot_);
        return OneKindTracer::occluded(ray);
    }
    [[nodiscard]] bool finds_emission(const Hit& hit) const override { return lamps_.finds_emission(hit); }

  private:
    const LampsInView& lamps_;
    SampleLight& light_;
    std::uint32_t slot_ = 0;
    Hit first_;
};

class ScalarWave final : public IntegratorScratch {
  public:
    static constexpr std::size_t kCapacity = 1024;

    [[nodiscard]] std::size_t bytes() const override {
        return sizeof *this + vector_bytes(samples_, rays_, hits_, alpha_) + found_.bytes() + lamps_.bytes();
    }
    [[nodiscard]] LampsInView& lamps() { return lamps_; }

    void trace(const World& world, const TileJob& job, const ScalarIntegrator& integrator, std::size_t first,
               std::size_t count, TileBuffer& tile, RenderCounters& counters) {
        samples_.resize(count);
        rays_.resize(count);
        hits_.resize(count);
        alpha_.resize(count);
        generate_camera_rays(world, job, first, samples_, rays_);
        intersect_batch(world, job, RayKind::Primary, rays_, hits_, counters);
        hide_unseen_hits(world, rays_, hits_);
        find_first_hits(world, job, samples_, rays_, hits_, tile);
        lamps_.note(samples_, rays_, hits_, counters);
        found_.reset(count, job, counters.brightest.threshold());
        CountingTracer tracer(world, job, lamps_, found_, counters);
        for (std::uint32_t i = 0; i < count; ++i) {
            tracer.start(i, hits_[i]);
            const EyeLight light = integrator.li(world,
                                                 {.ray = rays_[i],
                                                  .cone = camera_cone(world, job.full_width, job.full_height, rays_[i]),
                                                  .numbers = {job.sequence, samples_[i].key},
                                                  .lens = samples_[i].lens,
                                                  .tracer = &tracer},
                                                 hits_[i]);
            found_.add(i, light.seen, LightKind::Seen);
            found_.add(i, light.scattered, LightKind::Direct);
            alpha_[i] = light.alpha;
        }
        lamps_.note_radiance(samples_, found_);
        accumulate(job, samples_, found_, alpha_, tile, counters);
    }

  private:
    std::vector<CameraSample> samples_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<float> alpha_;
    SampleLight found_;
    LampsInView lamps_;
};

}  // namespace

std::unique_ptr<IntegratorScratch> ScalarIntegrator::make_scratch() const {
    return std::make_unique<ScalarWave>();
}

void ScalarIntegrator::render_tile(const World& world, const TileJob& job, IntegratorScratch& scratch, TileBuffer& tile,
                                   RenderCounters& counters) const {
    LampsInView& lamps = static_cast<ScalarWave&>(scratch).lamps();
    if (shows_ == Shows::Light) lamps.start(world, job, settings_.lengths, true);
    trace_in_waves<ScalarWave>(world, job, *this, scratch, tile, counters);
    if (shows_ == Shows::Light) lamps.finish(tile, counters);
}

}  // namespace etendue
