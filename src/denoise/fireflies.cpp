#include "denoise/fireflies.h"

#include <utility>

namespace etendue {

namespace {

/// Adds this share of the image's mean to a pixel's surroundings, so that in the dark not every glimmer is a firefly.
constexpr float kFloor = 0.5f;

float sum_of(const Planes& planes, int x, int y) {
    float sum = 0.0f;
    for (int plane = 0; plane < planes.count(); ++plane) sum += planes.row(plane, y)[x];
    return sum;
}

double total_of(const Planes& planes) {
    double total = 0.0;
    for (int y = 0; y < planes.height(); ++y)
        for (int x = 0; x < planes.width(); ++x) total += double(sum_of(planes, x, y));
    return total;
}

/// `suspect` without its fireflies, judged by `witness`. Adds the light that they had.
Planes without_fireflies(const Planes& suspect, const Planes& witness, std::size_t& count, double& light) {
    const Planes surroundings = box_filtered(witness, kFireflyRadius);
    const Planes substitute = box_filtered(witness, 1);
    const double pixels = double(witness.width()) * double(witness.height());
    const float floor = kFloor * static_cast<float>(total_of(witness) / pixels);
    Planes cleaned = suspect;
    for (int y = 0; y < suspect.height(); ++y) {
        for (int x = 0; x < suspect.width(); ++x) {
            const float value = sum_of(suspect, x, y);
            if (!(value > 0.0f && value > kFireflyFactor * (sum_of(surroundings, x, y) + floor))) continue;
            ++count;
            light += double(value) - double(sum_of(substitute, x, y));
            for (int plane = 0; plane < suspect.count(); ++plane)
                cleaned.row(plane, y)[x] = substitute.row(plane, y)[x];
        }
    }
    cleaned.extend();
    return cleaned;
}

}  // namespace

Fireflies remove_fireflies(Halves& light) {
    Fireflies found;
    double lost_a = 0.0;
    double lost_b = 0.0;
    const double total = total_of(mean_of_all(light.a, light.b, light.share));
    Planes a = without_fireflies(light.a, light.b, found.count, lost_a);
    Planes b = without_fireflies(light.b, light.a, found.count, lost_b);
    light.a = std::move(a);
    light.b = std::move(b);
    light.variance = estimated_variance(light.a, light.b, light.share);
    const double share = double(light.share);
    if (total > 0.0) found.light_share = (share * lost_a + (1.0 - share) * lost_b) / total;
    return found;
}

}  // namespace etendue
