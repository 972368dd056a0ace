// The brightest single contributions of a render: where its fireflies come from.
#pragma once

#include "core/rgb.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

namespace etendue {

/// Holds one contribution to the image, before any limit, other than what the eye sees of a light itself. Which path
/// has brought it is found afterwards, by tracing its sample once more (render/brightest_paths.h).
struct BrightSample {
    static constexpr std::size_t kWordSize = 64;

    std::int32_t x = 0;  ///< pixel of the full image that it falls into
    std::int32_t y = 0;
    std::int32_t sample_x = 0;  ///< pixel whose sample has made it: another one if it is a splat
    std::int32_t sample_y = 0;
    std::uint32_t sample = 0;    ///< index within that pixel
    Rgb value{};                 ///< contribution, as a sample of the pixel has it
    std::uint16_t s = 0;         ///< vertices from the light, as in `Strategy`; both are 0 while it is not known
    std::uint16_t t = 0;         ///< vertices from the eye
    std::uint16_t edges = 0;     ///< edges of the path; media add none
    std::uint16_t is_splat = 0;  ///< 1 if it was connected to the camera
    std::array<char, kWordSize> word{};  ///< the path as an expression, from the eye to the light, zero-terminated

    [[nodiscard]] float brightness() const { return max_component(value); }
    [[nodiscard]] bool has_path() const { return t > 0; }
};
static_assert(std::is_trivially_copyable_v<BrightSample> && sizeof(BrightSample) == 104,
              "checkpoints hold it as it lies in memory");

/// True if `a` stands before `b` in the list: a strict order of all contributions that are not the same one.
[[nodiscard]] bool is_brighter(const BrightSample& a, const BrightSample& b);

/// The brightest contribution of each of the few pixels that have the brightest ones: many of one pixel would tell no
/// more than its first. What it holds depends on what was offered, in any order, and in any number of lists that are
/// added.
class BrightestSamples {
  public:
    static constexpr std::size_t kMost = 1024;

    /// Has the list keep `capacity` contributions; those less bright than `floor` need not be offered.
    void expect(std::size_t capacity, float floor) {
        capacity_ = capacity;
        floor_ = floor;
    }
    void offer(const BrightSample& sample);
    void add(const BrightestSamples& other);

    /// Returns the brightness below which nothing has a place in the list; infinity if nothing has one.
    [[nodiscard]] float threshold() const {
        if (capacity_ == 0) return std::numeric_limits<float>::infinity();
        return samples_.size() < capacity_ ? floor_ : samples_.back().brightness();
    }
    [[nodiscard]] std::size_t capacity() const { return capacity_; }
    /// Returns the contributions in the list, the brightest first.
    [[nodiscard]] std::span<const BrightSample> samples() const { return samples_; }
    [[nodiscard]] std::span<BrightSample> samples() { return samples_; }
    /// Puts back what `capacity` and `samples` have given.
    void restore(std::size_t capacity, std::vector<BrightSample> samples);

  private:
    std::size_t capacity_ = 0;
    float floor_ = 0.0f;
    std::vector<BrightSample> samples_;
};

}  // namespace etendue
