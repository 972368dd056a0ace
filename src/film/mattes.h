// Whose surfaces the samples of a pixel have met, and with how much of its weight: what Cryptomatte ranks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

/// An id and its share of a pixel.
struct MatteShare {
    std::uint32_t id = 0;
    double weight = 0.0;  ///< sum of the filter weights of its samples, or that over the sum of all
};

/// For some pixels and each of some mattes (of objects, of materials …) a bounded list of ids with the sums of their
/// filter weights. Where a pixel has more ids than the list has slots, the one with the least weight falls out for a
/// heavier one; if it comes again, it begins at nothing. The weights of ids that never fell out are whole. 12 bytes a
/// pixel, matte and slot.
class MatteBuffer {
  public:
    /// Starts with nothing; memory is kept.
    void reset(std::size_t mattes, std::size_t slots, std::size_t pixels) {
        mattes_ = mattes;
        slots_ = slots;
        ids_.assign(pixels * mattes * slots, kNoId);
        weights_.assign(pixels * mattes * slots, 0.0);
    }
    /// Stands for samples that met nothing; they are not kept.
    static constexpr std::uint32_t kNoId = 0;

    /// Adds `weight`, which may be negative, to that of `id`.
    void add(std::size_t pixel, std::size_t matte, std::uint32_t id, double weight);
    /// Adds pixel `other_pixel` of `other`, which has the same mattes and slots.
    void add(std::size_t pixel, const MatteBuffer& other, std::size_t other_pixel);

    /// The ids of a pixel with weight, the heaviest first, of equally heavy ones the smaller first. Negative weights,
    /// which filters with negative parts leave around edges, are left out.
    [[nodiscard]] std::vector<MatteShare> ranked(std::size_t pixel, std::size_t matte) const;

    /// All lists, pixel by pixel, and how to put them back.
    [[nodiscard]] std::span<const std::uint32_t> all_ids() const { return ids_; }
    [[nodiscard]] std::span<const double> all_weights() const { return weights_; }
    [[nodiscard]] std::span<std::uint32_t> all_ids() { return ids_; }
    [[nodiscard]] std::span<double> all_weights() { return weights_; }

  private:
    [[nodiscard]] std::size_t first_slot(std::size_t pixel, std::size_t matte) const {
        return (pixel * mattes_ + matte) * slots_;
    }

    std::size_t mattes_ = 0;
    std::size_t slots_ = 0;
    std::vector<std::uint32_t> ids_;
    std::vector<double> weights_;
};

}  // namespace etendue
