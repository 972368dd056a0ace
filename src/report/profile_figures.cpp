#include "report/profile_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace etendue {

double median(std::vector<double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double rate(double a, double b) {
    const bool known = std::isfinite(a) && std::isfinite(b) && b > 0.0;
    return known ? a / b : std::numeric_limits<double>::quiet_NaN();
}

double rays_per_second(const ProfileRun& run) {
    return rate(static_cast<double>(run.rays), median(run.seconds));
}

double samples_per_second(const ProfileRun& run) {
    return rate(static_cast<double>(run.samples), median(run.seconds));
}

double rays_per_second(const RayKindReport& kind) {
    return rate(static_cast<double>(kind.rays), kind.seconds);
}

double tracing_share(const ProfileRun& run) {
    const double tracing = std::accumulate(run.kinds.begin(), run.kinds.end(), 0.0,
                                           [](double sum, const RayKindReport& kind) { return sum + kind.seconds; });
    return rate(tracing, sum_of(run.stages));
}

double sum_of(const std::vector<NamedValue>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0,
                           [](double sum, const NamedValue& value) { return sum + value.value; });
}

std::vector<TileCost> most_expensive_tiles(const ProfileRun& run, std::size_t count) {
    struct Passes {
        std::vector<double> per_sample;
        double samples = 0.0;
    };
    std::map<std::array<int, 4>, Passes> places;
    for (const TileReport& tile : run.tiles) {
        Passes& passes = places[{tile.rect.y0, tile.rect.x0, tile.rect.y1, tile.rect.x1}];
        const auto samples = static_cast<double>(tile.samples);
        passes.per_sample.push_back(rate(tile.cpu_seconds, samples));
        passes.samples += samples;
    }
    std::vector<TileCost> tiles;
    double sum = 0.0;
    for (const auto& [place, passes] : places) {
        const double per_sample = median(passes.per_sample);
        tiles.push_back({{place[1], place[0], place[3], place[2]}, per_sample, per_sample * passes.samples});
        sum += tiles.back().cpu_seconds;
    }
    for (TileCost& tile : tiles) tile.share = rate(tile.cpu_seconds, sum);
    // Stable: of equal ones the first in the image.
    std::ranges::stable_sort(tiles, std::ranges::greater{}, &TileCost::cpu_seconds);
    tiles.resize(std::min(tiles.size(), count));
    return tiles;
}

double cpu_seconds_per_sample(const ProfileRun& run) {
    return rate(median(run.cpu_seconds), static_cast<double>(run.samples));
}

std::string heat_map_key(const ProfileRun& run) {
    return fmt::format("heat/{}-{}", run.integrator, run.threads);
}

}  // namespace etendue
