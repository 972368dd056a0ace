// Rays as columns.
#pragma once

#include "core/ray.h"

#include <cstddef>
#include <cstdint>

namespace etendue {

/// Rays as columns that belong to somebody else. Each can be read for a whole packet from any ray on, beyond the last
/// one too.
struct RayColumns {
    static constexpr std::size_t kPacket = 16;

    const float* origin_x = nullptr;
    const float* origin_y = nullptr;
    const float* origin_z = nullptr;
    const float* direction_x = nullptr;
    const float* direction_y = nullptr;
    const float* direction_z = nullptr;
    const float* t_max = nullptr;  ///< null if all reach as far as there is anything
    const float* time = nullptr;
    const std::uint32_t* alpha_key = nullptr;
    std::size_t count = 0;

    [[nodiscard]] std::size_t size() const { return count; }
    /// Ray `i`, of those that there are and of those behind them.
    [[nodiscard]] Ray operator[](std::size_t i) const {
        Ray ray;
        ray.origin = {origin_x[i], origin_y[i], origin_z[i]};
        ray.direction = {direction_x[i], direction_y[i], direction_z[i]};
        if (t_max != nullptr) ray.t_max = t_max[i];
        ray.time = time[i];
        ray.alpha_key = alpha_key[i];
        return ray;
    }
};

}  // namespace etendue
