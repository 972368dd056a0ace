#include "integrator/pilot.h"

#include "film/pixel_filter.h"
#include "transport/scattered_cone.h"
#include "wave/camera_wave.h"
#include "wave/tile_job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace etendue {

namespace {

/// Bounds the pixels of the pilot's image.
constexpr double kMostPilotPixels = 4096.0;
/// Gives the pixels of the pilot's image in those of the render's, where that is small.
constexpr double kPilotShare = 1.0 / 16.0;
/// Counts the samples of each of its pixels.
constexpr std::uint32_t kPilotSamples = 4;
/// Counts the samples per pixel of the render that integrators are compared for: what one cannot find is an error that
/// more samples do not mend.
constexpr double kRenderSamples = 64.0;
/// Bounds the radiance, squared, that errors are relative to from below, as for relMSE.
constexpr double kLeastSquared = 0.01;
/// Gives the processor time that parts of a sample take, in those of a ray of an eye path with its shading.
constexpr double kLightSampleCost = 0.5;
constexpr double kLightRayCost = 2.0;
constexpr double kConnectionCost = 0.45;
constexpr double kPhotonCost = 1.0;
constexpr double kMergeCost = 0.1;
constexpr double kSampleCost = 1.0;

/// Holds the film of a pilot.
class PilotFilm {
  public:
    PilotFilm(int width, int height)
        : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

    /// Returns the pixel at `film`; nothing if that is beside the image.
    [[nodiscard]] std::optional<std::size_t> pixel_at(const Vec2f& film) const {
        const bool is_inside = film.x >= 0.0f && film.x < 1.0f && film.y >= 0.0f && film.y < 1.0f;
        if (!is_inside) return {};
        const auto place = [](float along, int count) {
            return std::min(static_cast<int>(along * static_cast<float>(count)), count - 1);
        };
        return static_cast<std::size_t>(place(film.y, height_)) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(place(film.x, width_));
    }
    /// Adds the light of a pixel's own sample of index `index`.
    void add_sample(std::size_t pixel, const ComparedLight& light, std::uint32_t index) {
        pixels_[pixel].sum.add(light);
        pixels_[pixel].of_samples[index % 2] += light.light;
        pixels_[pixel].of_all[index % 2] += light.light;
    }
    /// Adds light that a light subpath of index `index` brings to a pixel.
    void add_from_light(std::size_t pixel, const ComparedLight& light, std::uint32_t index) {
        pixels_[pixel].sum.add(light);
        pixels_[pixel].of_all[index % 2] += light.light;
    }

    /// Puts the mean squared relative error of an image with one sample per pixel into `findings`, for `samples` of
    /// each pixel here.
    void find_errors(double samples, PilotFindings& findings) const {
        const double of_half = 0.5 * samples;
        PerIntegrator<VarianceSum> sums{};
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                const Pixel& pixel = pixels_[index(x, y)];
                const double light = light_around(x, y) / samples;
                const double scale = 1.0 / (light * light + kLeastSquared);
                for (std::size_t i = 0; i < kComparedCount; ++i) {
                    const double missed = pixel.sum.missed[i] / samples;
                    // All light of path tracing comes by its own samples; what light subpaths bring to the others is
                    // rare in each pixel.
                    const auto& halves = i == 0 ? pixel.of_all : pixel.of_samples;
                    const double squared_mean = (halves[0] / of_half) * (halves[1] / of_half);
                    sums[i].add(scale *
                                (pixel.sum.moments[i] / samples - squared_mean + kRenderSamples * missed * missed));
                }
            }
        for (std::size_t i = 0; i < kComparedCount; ++i) {
            findings.errors[i] = sums[i].mean(static_cast<double>(pixels_.size()));
            findings.is_told[i] = sums[i].is_told();
        }
    }

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    /// Returns the mean of the pixel and its neighbours: one pixel alone has few samples.
    [[nodiscard]] double light_around(int x, int y) const {
        double sum = 0.0;
        double count = 0.0;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); ++v)
            for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); ++u) {
                sum += pixels_[index(u, v)].sum.light;
                count += 1.0;
            }
        return sum / count;
    }

    /// Holds the sums of a pixel; the light of samples with even and with odd indices apart, whose product is the
    /// square of the mean without bias.
    struct Pixel {
        ComparedLight sum;
        std::array<double, 2> of_samples{};
        std::array<double, 2> of_all{};
    };

    int width_ = 0;
    int height_ = 0;
    std::vector<Pixel> pixels_;
};

/// Holds what the samples of a row of pixels have found on the film.
struct RowFindings {
    std::vector<ComparedLight> of_samples;
    std::vector<std::pair<std::size_t, ComparedLight>> from_lights;  ///< with the pixel
    SampleWork work;
};

/// Takes the sample of index `index` of every pixel of `job.rect`, the whole image.
SampleWork take_samples(const World& world, const IntegratorSettings& settings, TileJob job, std::uint32_t index,
                        const ThreadPool& threads, PilotFilm& film) {
    job.first_sample = index;
    job.merging =
        make_merging(world, job.full_width, job.full_height, static_cast<double>(job.rect.area()), index,
                     {.at = MergeAt::SeenByDeltas, .radius = settings.merging.radius, .alpha = settings.merging.alpha});
    std::vector<CameraSample> samples(job.rect.area());
    std::vector<Ray> rays(samples.size());
    generate_camera_rays(world, job, 0, samples, rays);
    const auto compared = [&](std::size_t i) {
        const EyeSample eye{.ray = rays[i],
                            .cone = camera_cone(world, job.full_width, job.full_height, rays[i]),
                            .numbers = {job.sequence, samples[i].key},
                            .lens = samples[i].lens};
        return ComparedSample(world, eye, settings,
                              {.merging = job.merging, .shared = shared_key(job, samples[i].key)});
    };
    const auto width = static_cast<std::size_t>(job.full_width);
    const std::size_t height = samples.size() / width;
    const auto for_each_row = [&](const std::function<void(std::size_t row, std::size_t sample)>& take) {
        threads.parallel_for(height, [&](std::size_t row, int) {
            for (std::size_t i = row * width; i < (row + 1) * width; ++i) take(row, i);
        });
    };
    // Subpaths are followed twice rather than kept: those in media are long.
    ComparedSample::Photons photons;
    if (job.merging.merges()) {
        std::vector<ComparedSample::Photons> of_rows(height);
        for_each_row([&](std::size_t row, std::size_t i) { compared(i).append_photons(of_rows[row]); });
        for (const ComparedSample::Photons& of_row : of_rows) photons.append(of_row);
    }
    std::vector<std::vector<Photon>> lists(1, photons.all);
    const PhotonMap map(std::move(lists), job.merging.radius, threads);
    std::vector<RowFindings> rows(height);
    for_each_row([&](std::size_t row, std::size_t i) {
        rows[row].of_samples.push_back(
            compared(i).compare(map, photons, rows[row].work, [&](const ComparedLight& light, const Vec2f& place) {
                if (const auto pixel = film.pixel_at(place)) rows[row].from_lights.emplace_back(*pixel, light);
            }));
    });
    SampleWork work;
    std::size_t taken = 0;
    for (const RowFindings& row : rows) {
        for (const ComparedLight& light : row.of_samples) film.add_sample(samples[taken++].pixel, light, index);
        for (const auto& [pixel, light] : row.from_lights) film.add_from_light(pixel, light, index);
        work.add(row.work);
    }
    return work;
}

}  // namespace

PilotFindings run_pilot(const World& world, const IntegratorSettings& settings, int width, int height,
                        const ThreadPool& threads) {
    const double pixels = static_cast<double>(width) * static_cast<double>(height);
    const double side = std::sqrt(std::min(kMostPilotPixels / pixels, kPilotShare));
    const auto scaled = [&](int of) {
        return std::max(1, static_cast<int>(std::lround(side * static_cast<double>(of))));
    };
    const PixelFilter filter{FilterShape::Box};
    TileJob job;
    job.full_width = scaled(width);
    job.full_height = scaled(height);
    job.rect = {0, 0, job.full_width, job.full_height};
    job.window = job.rect;
    job.filter = &filter;
    PilotFilm film(job.full_width, job.full_height);
    SampleWork work;
    for (std::uint32_t index = 0; index < kPilotSamples; ++index)
        work.add(take_samples(world, settings, job, index, threads, film));
    const double count = static_cast<double>(job.rect.area()) * kPilotSamples;
    PilotFindings findings{.work = work};
    film.find_errors(kPilotSamples, findings);
    const auto mean = [&](double sum) { return sum / count; };
    const double path = kSampleCost + mean(work.eye_rays) + kLightSampleCost * mean(work.light_samples);
    const double bdpt = path + kLightRayCost * mean(work.light_rays) + kConnectionCost * mean(work.connections);
    const bool merges = make_merging(world, job.full_width, job.full_height, count, 0, {}).merges();
    const double vcm = bdpt + (merges ? kPhotonCost * mean(work.light_rays) : 0.0) + kMergeCost * mean(work.merges);
    findings.costs = {path, bdpt, vcm};
    return findings;
}

}  // namespace etendue
