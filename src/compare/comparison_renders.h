// Rendering variants with several seeds each, and keeping what their images were on the way.
#pragma once

#include "compare/comparison_variants.h"
#include "compare/image_store.h"
#include "core/parallel.h"
#include "session/render_watcher.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace etendue {

/// Sets what each render takes: one of the two is set.
struct RenderBudget {
    std::optional<double> seconds{};  ///< on the clock, or of all threads together
    std::optional<std::uint32_t> spp{};
    bool by_wall = false;  ///< the seconds are those on the clock
};

/// An image on the way.
struct Snapshot {
    std::uint32_t spp = 0;
    double seconds = 0.0;  ///< seconds of rendering alone
    double cpu_seconds = 0.0;
    std::size_t image = 0;  ///< in the store
};

/// One render with one seed.
struct SeedRender {
    std::uint32_t seed = 0;
    std::vector<Snapshot> checkpoints{};  ///< the last is the finished image
    RenderCounters counters{};
};

struct VariantRenders {
    std::vector<SeedRender> seeds;
};

struct RendersRequest {
    RenderBudget budget{};
    int seeds = 1;
    std::uint32_t first_seed = 0;
    bool quiet = false;
    RenderWatcher* watcher = nullptr;  ///< gets images between passes, and outlives the renders; null for nobody
};

/// The seed of a variant's render with number `render`, of `variants` that are rendered: no two renders have the same,
/// so that all images are independent. Counts on from `first` by rounds of one render of each variant; what would be
/// the number after the last seed there is, is 0.
[[nodiscard]] std::uint32_t render_seed(std::uint32_t first, std::size_t render, std::size_t variant,
                                        std::size_t variants);

/// Returns how many of the `wanted` samples, each of which takes `sample_seconds`, come nearest to taking `seconds`.
[[nodiscard]] std::uint32_t fit_samples(std::uint32_t wanted, double seconds, double sample_seconds);

/// Holds how long a render takes for one sample of every pixel.
struct SampleCost {
    double first = 0.0;  ///< seconds of the first sample, with the work that is done once
    double next = 0.0;   ///< seconds of each later one
};

/// Returns how many samples a render can take in `seconds`, at least one: the median over the
/// `costs` of several renders.
[[nodiscard]] std::uint32_t calibrated_samples(double seconds, std::span<const SampleCost> costs);

/// Returns the samples that take the time `asked`, at least one, if `samples` took more than a fifth more or less; else
/// `samples`.
[[nodiscard]] std::uint32_t corrected_samples(std::uint32_t samples, double taken, double asked);

/// Returns how many seconds on the clock the renders of so many variants take at least; 0 if no time is asked for.
[[nodiscard]] double least_seconds(std::size_t variants, const RendersRequest& request, int threads);

/// Renders every variant `seeds` times, each time with a seed of its own, one variant after the other, so that what
/// else the machine does falls on all alike. All renders of a variant take as many samples. If times are equal, that
/// number comes from three renders of each variant before, each for a fifth of the time, and a first render that misses
/// the time is made again with samples that take it. With one seed, each variant renders one sample before, and then
/// until the time is spent. Images are kept after 1, 2, 3, 4, 6, 8, ... samples, a factor of sqrt(2) apart. Once an
/// interrupt is requested, the renders are returned that all variants have.
[[nodiscard]] std::vector<VariantRenders> render_variants(std::span<const Variant> variants,
                                                          const RendersRequest& request, ImageStore& store,
                                                          const ThreadPool& threads);

/// Holds renders of as many samples that are a reference together, each with a seed of its own.
struct ReferenceRenders {
    std::vector<ImageF> images{};  ///< R, G and B
    std::uint32_t spp = 0;         ///< samples of each
    double seconds = 0.0;          ///< seconds of all
    double cpu_seconds = 0.0;
};

/// The renders of a reference: a few, so that their differences tell its noise.
inline constexpr std::uint32_t kReferenceRenders = 4;

/// Renders `variant` with seeds from `first_seed` on; the seconds of `budget` are for all renders. Returns nothing if
/// it is interrupted.
[[nodiscard]] std::optional<ReferenceRenders> render_reference(const Variant& variant, const RenderBudget& budget,
                                                               std::uint32_t first_seed, const ThreadPool& threads,
                                                               bool quiet);

}  // namespace etendue
