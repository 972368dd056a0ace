#include "denoise/halves.h"

#include <algorithm>
#include <utility>

namespace etendue {

namespace {

bool is_black(const Planes& planes) {
    for (int plane = 0; plane < planes.count(); ++plane)
        for (int y = 0; y < planes.height(); ++y)
            if (!std::all_of(planes.row(plane, y), planes.row(plane, y) + planes.width(),
                             [](float value) { return value == 0.0f; }))
                return false;
    return true;
}

}  // namespace

Halves make_halves(const Planes& whole, Planes one_half, float share) {
    Halves halves;
    halves.share = share;
    halves.a = std::move(one_half);
    halves.a.extend();
    halves.b = combined(whole, halves.a, [share](float v, float a) { return (v - share * a) / (1.0f - share); });
    halves.variance = estimated_variance(halves.a, halves.b, share);
    return halves;
}

bool is_black(const Halves& halves) {
    return is_black(halves.a) && is_black(halves.b);
}

Planes mean_of_all(const Planes& a, const Planes& b, float share) {
    return combined(a, b, [share](float u, float v) { return share * u + (1.0f - share) * v; });
}

Planes estimated_variance(const Planes& a, const Planes& b, float share) {
    const Planes squares =
        combined(a, b, [share](float u, float v) { return (u - v) * (u - v) * share * (1.0f - share); });
    return box_filtered(squares, kVarianceRadius);
}

Planes box_filtered(const Planes& planes, int radius) {
    const auto side = static_cast<float>(2 * radius + 1);
    const Planes rows = make_planes(planes.width(), planes.height(), planes.count(), [&](int plane, int x, int y) {
        const float* row = planes.row(plane, y);
        float sum = 0.0f;
        for (int i = -radius; i <= radius; ++i) sum += row[x + i];
        return sum / side;
    });
    return make_planes(planes.width(), planes.height(), planes.count(), [&](int plane, int x, int y) {
        float sum = 0.0f;
        for (int i = -radius; i <= radius; ++i) sum += rows.row(plane, y + i)[x];
        return sum / side;
    });
}

}  // namespace etendue
