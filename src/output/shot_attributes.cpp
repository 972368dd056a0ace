#include "output/shot_attributes.h"

#include "core/source_date.h"

#include <cmath>
#include <cstdint>
#include <ctime>

namespace etendue {

namespace {

/// A number below 100 as two digits of four bits each.
std::uint32_t two_digits(std::int64_t number) {
    return static_cast<std::uint32_t>(number / 10 * 16 + number % 10);
}

}  // namespace

std::optional<ImageRational> frames_per_second(double fps) {
    constexpr double kMost = 1e6;
    if (!(fps >= 1e-3 && fps <= kMost)) return std::nullopt;
    const double whole = std::round(fps);
    if (fps == whole) return ImageRational{static_cast<int>(whole), 1};
    constexpr double kTolerance = 1e-3;  // 23.976 is meant for 24000/1001
    if (whole >= 1.0 && std::abs(whole / 1.001 - fps) < kTolerance)
        return ImageRational{static_cast<int>(whole) * 1000, 1001};
    return ImageRational{static_cast<int>(std::lround(fps * 1000.0)), 1000};
}

std::optional<ImageTimeCode> time_code(int frame, double fps) {
    constexpr std::int64_t kMostFrames = 30;
    constexpr std::int64_t kSecondsOfDay = 24 * 60 * 60;
    const std::int64_t in_second = std::llround(fps);
    if (frame < 0 || in_second < 1 || in_second > kMostFrames) return std::nullopt;
    const std::int64_t seconds = frame / in_second;
    if (seconds >= kSecondsOfDay) return std::nullopt;
    return ImageTimeCode{two_digits(frame % in_second) | two_digits(seconds % 60) << 8 |
                         two_digits(seconds / 60 % 60) << 16 | two_digits(seconds / 3600) << 24};
}

float utc_offset() {
    if (source_date()) return 0.0f;  // whose date is written in universal time
    const std::time_t now = creation_time();
    std::tm local{};
    localtime_r(&now, &local);
    return -static_cast<float>(local.tm_gmtoff);
}

}  // namespace etendue
