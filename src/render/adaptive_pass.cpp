#include "render/adaptive_pass.h"

#include "render/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace etendue {

namespace {

constexpr int kBoxRadius = 2;
constexpr int kDilation = 1;
static_assert(kDilation <= kBoxRadius, "a pixel lies in every box that it looks at");

/// Pixels of [0, size) that are no further than kBoxRadius from `at`.
struct Reach {
    int begin;
    int end;

    Reach(int at, int size) : begin(std::max(0, at - kBoxRadius)), end(std::min(size, at + kBoxRadius + 1)) {}
    [[nodiscard]] int count() const { return end - begin; }
};

/// Sums over the box around every pixel.
std::vector<double> box_sums(std::span<const float> values, int width, int height, const ThreadPool& threads) {
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    };
    std::vector<double> along_x(values.size(), 0.0);
    std::vector<double> sums(values.size(), 0.0);
    threads.parallel_for(static_cast<std::size_t>(height), [&](std::size_t row, int) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const Reach reach(x, width);
            for (int i = reach.begin; i < reach.end; ++i) along_x[at(x, y)] += static_cast<double>(values[at(i, y)]);
        }
    });
    threads.parallel_for(static_cast<std::size_t>(height), [&](std::size_t row, int) {
        const int y = static_cast<int>(row);
        const Reach reach(y, height);
        for (int i = reach.begin; i < reach.end; ++i)
            for (int x = 0; x < width; ++x) sums[at(x, y)] += along_x[at(x, i)];
    });
    return sums;
}

/// Goals as a function of the one number that scales them.
class Goals {
  public:
    explicit Goals(const Allocation& allocation)
        : a_(allocation), variance_(allocation.variance.begin(), allocation.variance.end()) {
        // Without noise of the eye's samples any distribution is as good; so it is where no pixel has a neighbour that
        // would know of it.
        if (std::ranges::all_of(variance_, [](float v) { return v == 0.0f; })) std::ranges::fill(variance_, 1.0f);
        double sum = 0.0;
        double predicted = 0.0;
        weights_.reserve(variance_.size());
        for (std::size_t p = 0; p < a_.samples.size(); ++p) {
            weights_.push_back(std::sqrt(variance_[p]));
            sum += static_cast<double>(weights_[p]);
            predicted += static_cast<double>(variance_[p]) / static_cast<double>(a_.samples[p]);
        }
        mean_weight_ = sum / static_cast<double>(weights_.size());
        const auto least = static_cast<float>(kLeastShare * mean_weight_);
        for (float& weight : weights_) weight = std::max(weight, least);
        // The neighbourhood says how variances compare, what was measured how large they are.
        eye_scale_ = predicted > 0.0 ? a_.eye_error / predicted : 0.0;
        light_ = a_.light_error * std::accumulate(a_.samples.begin(), a_.samples.end(), 0.0);
    }

    [[nodiscard]] double of(std::size_t pixel, double scale) const {
        const auto taken = static_cast<double>(a_.samples[pixel]);
        return std::max(taken, std::min(scale * static_cast<double>(weights_[pixel]), static_cast<double>(a_.most)));
    }
    /// The error that these goals are expected to leave.
    [[nodiscard]] double error(double scale) const {
        double eye = 0.0;
        double samples = 0.0;
        for (std::size_t p = 0; p < weights_.size(); ++p) {
            const double goal = of(p, scale);
            eye += static_cast<double>(variance_[p]) / goal;
            samples += goal;
        }
        return eye * eye_scale_ + light_ / samples;
    }
    /// The least scale that comes to the target, or one that gives all pixels as many samples as they may have.
    [[nodiscard]] double solve() const {
        const double largest = static_cast<double>(a_.most) / (kLeastShare * mean_weight_);
        double enough = std::accumulate(a_.samples.begin(), a_.samples.end(), 0.0) /
                        static_cast<double>(a_.samples.size()) / mean_weight_;
        while (enough < largest && error(enough) > a_.target) enough *= 2.0;
        if (enough >= largest) return largest;
        constexpr double kSmallest = 1e-9;
        while (enough > kSmallest && error(0.5 * enough) <= a_.target) enough *= 0.5;
        double step = std::sqrt(0.5);
        for (int i = 0; i < 6; ++i, step = std::sqrt(step))
            if (error(enough * step) <= a_.target) enough *= step;
        return enough;
    }

  private:
    const Allocation& a_;
    std::vector<float> variance_;
    std::vector<float> weights_;
    double mean_weight_ = 0.0;
    double eye_scale_ = 0.0;
    double light_ = 0.0;  ///< the error that one light path would leave
};

/// Makes those pixels active that `is_wanted`.
template <typename Predicate>
void activate(AdaptivePass& pass, std::size_t pixels, const Predicate& is_wanted) {
    pass.is_active.resize(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
        pass.is_active[p] = is_wanted(p) ? 1 : 0;
        pass.active += pass.is_active[p];
    }
}

}  // namespace

std::vector<float> variance_around(std::span<const float> variance, int width, int height, const ThreadPool& threads) {
    const std::vector<double> sums = box_sums(variance, width, height, threads);
    std::vector<float> around(variance.size());
    threads.parallel_for(static_cast<std::size_t>(height), [&](std::size_t row, int) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const std::size_t pixel = row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            const auto own = static_cast<double>(variance[pixel]);
            double largest = 0.0;
            for (int j = std::max(0, y - kDilation); j < std::min(height, y + kDilation + 1); ++j)
                for (int i = std::max(0, x - kDilation); i < std::min(width, x + kDilation + 1); ++i) {
                    const int others = Reach(i, width).count() * Reach(j, height).count() - 1;
                    const double sum = sums[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) +
                                            static_cast<std::size_t>(i)] -
                                       own;
                    if (others > 0) largest = std::max(largest, sum / others);
                }
            around[pixel] = static_cast<float>(largest);
        }
    });
    return around;
}

std::vector<float> sample_goals(const Allocation& allocation) {
    const Goals goals(allocation);
    const double scale = goals.solve();
    std::vector<float> samples;
    samples.reserve(allocation.samples.size());
    for (std::size_t p = 0; p < allocation.samples.size(); ++p)
        samples.push_back(static_cast<float>(goals.of(p, scale)));
    return samples;
}

AdaptivePass plan_adaptive_pass(const RenderState& state, const ErrorEstimate& errors, double relative_error,
                                std::uint32_t most, const ThreadPool& threads) {
    const PixelRect& window = state.film.window();
    std::vector<std::uint32_t> samples = state.adaptive.samples;
    if (samples.empty()) samples.assign(window.area(), state.spp_done);
    std::vector<float> variance = errors.eye;
    for (std::size_t p = 0; p < variance.size(); ++p) variance[p] *= static_cast<float>(samples[p]);
    variance = variance_around(variance, window.width(), window.height(), threads);
    const std::vector<float> goals = sample_goals({.variance = variance,
                                                   .samples = samples,
                                                   .eye_error = errors.eye_mean,
                                                   .light_error = errors.light,
                                                   .target = relative_error * relative_error,
                                                   .most = most});
    const auto missing = [&](std::size_t p) { return goals[p] - static_cast<float>(samples[p]); };
    const auto has_room = [&](std::size_t p, std::uint32_t count) { return samples[p] + count <= most; };
    // Passes grow with the samples taken, so that there are few of them and what is decided between them costs little.
    const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
    constexpr double kPasses = 16.0;
    AdaptivePass pass;
    pass.count = kLargestPass * std::max(1u, static_cast<std::uint32_t>(mean / (kPasses * kLargestPass)));
    activate(pass, samples.size(), [&](std::size_t p) {
        return has_room(p, pass.count) && missing(p) >= 0.5f * static_cast<float>(pass.count);
    });
    if (pass.active > 0) return pass;
    // All are nearly there, or have nearly as many as they may have.
    std::uint32_t least_room = std::numeric_limits<std::uint32_t>::max();
    for (std::size_t p = 0; p < samples.size(); ++p)
        if (missing(p) > 0.0f && has_room(p, 1)) least_room = std::min(least_room, most - samples[p]);
    pass.count = std::min(pass.count, least_room);
    activate(pass, samples.size(), [&](std::size_t p) { return missing(p) > 0.0f && has_room(p, pass.count); });
    if (pass.active == 0) pass.is_active.clear();
    return pass;
}

AdaptivePass pass_up_to(const AdaptiveState& state, std::uint32_t least) {
    AdaptivePass pass;
    std::uint32_t most = 0;
    for (const std::uint32_t samples : state.samples)
        if (samples < least) most = std::max(most, samples);
    pass.count = least - most;
    activate(pass, state.samples.size(), [&](std::size_t p) { return state.samples[p] < least; });
    return pass;
}

}  // namespace etendue
