#include "sampling/distribution.h"

#include "core/wide.h"
#include "sampling/warp.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace etendue {

namespace {

/// So many intervals share an entry of the guide, or up to half as many.
constexpr std::size_t kIntervalsPerStart = 4;

/// The interval that holds `x`. In double precision the product is exact, so that no x belongs to a neighbour.
std::size_t cell(float x, std::size_t count) {
    const double scaled = static_cast<double>(std::clamp(x, 0.0f, kOneMinusEpsilon)) * static_cast<double>(count);
    return std::min(static_cast<std::size_t>(scaled), count - 1);
}

}  // namespace

Distribution1D::Distribution1D(std::span<const float> weights)
    : cdf_(weights.size() + 1 + Wide::kMostLanes, 1.0f), size_(weights.size()) {
    double sum = 0.0;
    for (const float weight : weights) sum += static_cast<double>(weight);
    const auto count = static_cast<double>(weights.size());
    integral_ = sum / count;
    double running = 0.0;
    cdf_[0] = 0.0f;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        running += sum > 0.0 ? static_cast<double>(weights[i]) / sum : 1.0 / count;
        cdf_[i + 1] = static_cast<float>(std::min(running, 1.0));
    }
    cdf_[size_] = 1.0f;

    const std::size_t starts = std::max<std::size_t>(1, std::bit_ceil(weights.size()) / kIntervalsPerStart);
    guide_.reserve(starts + 1);
    std::size_t index = 0;
    for (std::size_t i = 0; i <= starts; ++i) {
        const float u = static_cast<float>(i) / static_cast<float>(starts);
        while (index + 1 < weights.size() && cdf_[index + 1] <= u) ++index;
        guide_.push_back(static_cast<std::uint32_t>(index));
    }
}

std::size_t Distribution1D::start_of(float u) const {
    // Exact, since the number of starts is a power of two.
    return cell(u, guide_.size() - 1);
}

void Distribution1D::fetch_guide(float u) const {
    __builtin_prefetch(&guide_[start_of(u)]);
}

void Distribution1D::fetch_interval(float u) const {
    __builtin_prefetch(&cdf_[guide_[start_of(u)]]);
}

std::size_t Distribution1D::find(float u) const {
    const std::size_t start = start_of(u);
    const std::size_t low = guide_[start];
    const std::size_t high = guide_[start + 1];
    const float* const ends = &cdf_[1];
    // Of the few there mostly are all at once, as no processor foretells which one it is.
    if (high - low <= Wide::kWidth)
        return low + count(Wide::load_unaligned(ends + low) <= Wide(u) && WideMask::first(high - low));
    return static_cast<std::size_t>(std::upper_bound(ends + low, ends + high, u) - ends);
}

Distribution1D::Sample Distribution1D::sample(float u) const {
    // The first value above u ends the interval; intervals of zero width are never chosen.
    const std::size_t index = find(u);
    const float mass = cdf_[index + 1] - cdf_[index];
    const float within = mass > 0.0f ? std::clamp((u - cdf_[index]) / mass, 0.0f, kOneMinusEpsilon) : 0.5f;
    const auto count = static_cast<float>(size());
    float x = std::min((static_cast<float>(index) + within) / count, kOneMinusEpsilon);
    // Rounding may step over a border, to an interval of another density or of none.
    if (const std::size_t rounded = cell(x, size()); rounded != index)
        x = std::nextafter(x, rounded > index ? 0.0f : 1.0f);
    return {x, mass * count, index};
}

float Distribution1D::pdf(float x) const {
    const std::size_t index = cell(x, size());
    return (cdf_[index + 1] - cdf_[index]) * static_cast<float>(size());
}

void Distribution1D::fetch_pdf(float x) const {
    __builtin_prefetch(&cdf_[cell(x, size())]);
}

Distribution2D::Distribution2D(std::span<const float> weights, int width, int height) {
    const auto row_size = static_cast<std::size_t>(width);
    std::vector<float> row_integrals;
    for (int y = 0; y < height; ++y) {
        rows_.emplace_back(weights.subspan(static_cast<std::size_t>(y) * row_size, row_size));
        row_integrals.push_back(static_cast<float>(rows_.back().integral()));
    }
    marginal_ = Distribution1D(row_integrals);
}

const Distribution1D& Distribution2D::row(float y) const {
    return rows_[cell(y, rows_.size())];
}

Distribution2D::Sample Distribution2D::sample(Vec2f u) const {
    const Distribution1D::Sample y = marginal_.sample(u.y);
    const Distribution1D::Sample x = rows_[y.index].sample(u.x);
    return {{x.x, y.x}, x.pdf * y.pdf};
}

void Distribution2D::sample(std::span<const Vec2f> u, std::span<Sample> samples) const {
    constexpr std::size_t kAtOnce = 64;
    std::array<const Distribution1D*, kAtOnce> rows;
    for (std::size_t first = 0; first < samples.size(); first += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, samples.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            const Distribution1D::Sample y = marginal_.sample(u[first + i].y);
            samples[first + i] = {{0.0f, y.x}, y.pdf};
            rows[i] = &rows_[y.index];
            rows[i]->fetch_guide(u[first + i].x);
        }
        for (std::size_t i = 0; i < count; ++i) rows[i]->fetch_interval(u[first + i].x);
        for (std::size_t i = 0; i < count; ++i) {
            const Distribution1D::Sample x = rows[i]->sample(u[first + i].x);
            samples[first + i].position.x = x.x;
            samples[first + i].pdf *= x.pdf;
        }
    }
}

float Distribution2D::pdf(Vec2f position) const {
    return marginal_.pdf(position.y) * row(position.y).pdf(position.x);
}

std::size_t Distribution2D::bytes() const {
    return rows_.empty() ? 0 : rows_.size() * rows_.front().bytes() + marginal_.bytes();
}

}  // namespace etendue
