#include "agreement/room_comparison.h"

#include "core/parallel.h"
#include "integrator/agreement_cases.h"
#include "integrator/agreement_render.h"
#include "integrator/failure_images.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace etendue::test {

namespace {

constexpr std::uint32_t kSeeds = 4;
constexpr std::uint32_t kTrialSeeds = 2;

constexpr std::uint32_t kFewestSamples = 16;  ///< of a pixel, with one seed

/// How well an integrator's images shall be known.
struct Precision {
    double mean_error;    ///< relative standard error of an image's mean
    double rate;          ///< the power of the number of samples with which that falls
    double most_samples;  ///< of a pixel, with one seed
};

/// 1% is four standard errors of a difference. Eye paths of a pixel are well distributed; light paths that meet it come
/// from anywhere, so they take more samples, and are known less well.
constexpr Precision kEyePaths{0.0012, 0.6, 2048};
constexpr Precision kLightPaths{0.002, 0.5, 2048};

/// By a small render, which is not used for anything else: its noise must not choose the image that is compared.
std::uint32_t samples_per_pixel(const World& world, const std::string& integrator, AgreementCase agreement,
                                std::uint32_t first_seed, const ThreadPool& threads) {
    agreement.spp = kFewestSamples;
    const ImageEstimate trial =
        estimate(world, integrator, agreement, {.seeds = kTrialSeeds, .first_seed = first_seed}, threads);
    const double error = mean_error(trial) * std::sqrt(double{kTrialSeeds} / double{kSeeds});
    const Precision& wanted = integrator == "light" ? kLightPaths : kEyePaths;
    const double samples = kFewestSamples * std::pow(error / wanted.mean_error, 1.0 / wanted.rate);
    return static_cast<std::uint32_t>(std::clamp(std::ceil(samples), double{kFewestSamples}, wanted.most_samples));
}

}  // namespace

bool RoomComparison::agrees() const {
    return std::all_of(pairs.begin(), pairs.end(), [](const PairComparison& pair) { return pair.agreement.agree(); });
}

RoomComparison compare_in_room(const RoomTraits& room, std::size_t index, const RoomImages& images,
                               const ComparisonOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    const ThreadPool this_thread(1);
    AgreementCase agreement = make_case(room, images);
    const World world = agreement_world(agreement);
    std::vector<ImageEstimate> estimates;
    const std::vector<std::string>& integrators = agreement.integrators;
    // One integrator alone has nobody to agree with.
    for (std::size_t i = 0; i < integrators.size() && integrators.size() > 1; ++i) {
        const auto image = static_cast<std::uint32_t>(index * matrix_integrators().size() + i);
        const std::uint32_t first_seed = 2 * kSeeds * image;
        agreement.spp =
            options.samples * samples_per_pixel(world, integrators[i], agreement, first_seed + kSeeds, this_thread);
        estimates.push_back(
            estimate(world, integrators[i], agreement, {.seeds = kSeeds, .first_seed = first_seed}, this_thread));
    }
    RoomComparison result;
    result.room = room;
    std::vector<Disagreement> disagreements;
    for (std::size_t a = 0; a < estimates.size(); ++a)
        for (std::size_t b = a + 1; b < estimates.size(); ++b) {
            result.pairs.push_back(
                {integrators[a], integrators[b],
                 test_agreement(estimates[a], estimates[b], {.block_size = 16, .significance = options.significance})});
            if (!result.pairs.back().agreement.agree())
                disagreements.push_back({{integrators[a], &estimates[a].mean}, {integrators[b], &estimates[b].mean}});
        }
    if (!options.failures.empty() && !disagreements.empty())
        write_failure_images(options.failures, agreement, world, disagreements);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace etendue::test
