// What Embree's numbers stand for.
#pragma once

#include "world/embree.h"
#include "world/hit.h"

#include <cstdint>
#include <vector>

namespace etendue {

/// Says which triangles of a slot, one of (instance, geometry), a scene for `EmbreeScene::collect` holds.
struct CollectedSlot {
    bool is_whole = false;
    std::vector<std::uint32_t> triangles{};  ///< if it is not whole; none if there are none
};

/// Reads the numbers of Embree's top-level scene in ours.
class EmbreeEntries {
  public:
    /// Says what one top-level entry of Embree stands for.
    struct Entry {
        std::uint32_t instance;
        std::uint32_t geometry;  ///< number of the baked geometry, or of the first one of an instanced mesh
    };

    /// Appends the entry that Embree numbers next; `slot` may be null, and has to stay where it is.
    void add(Entry entry, const CollectedSlot* slot) {
        entries_.push_back(entry);
        slots_.push_back(slot);
    }

    /// Reads a place on entry `top`, in geometry `inner` of its scene if it is an instance, in our numbers.
    [[nodiscard]] Entry resolve(std::uint32_t top, std::uint32_t inner, bool is_instance) const {
        const Entry entry = entries_[top];
        return is_instance ? Entry{entry.instance, entry.geometry + inner} : entry;
    }
    /// Reads a hit of Embree's in our numbers.
    [[nodiscard]] Hit make_hit(float t, float u, float v, unsigned int triangle, unsigned int inner,
                               unsigned int instance, float time) const {
        if (inner == RTC_INVALID_GEOMETRY_ID) return {};
        const bool is_instance = instance != RTC_INVALID_GEOMETRY_ID;
        const Entry entry = resolve(is_instance ? instance : inner, inner, is_instance);
        return {t, u, v, triangle, entry.geometry & 0x7fffffffu, 0, entry.instance, time};
    }
    /// Returns the number in its mesh of triangle `triangle` of entry `top`, in a scene for `EmbreeScene::collect`.
    [[nodiscard]] std::uint32_t collected_triangle(std::uint32_t top, std::uint32_t triangle) const {
        const CollectedSlot* slot = slots_[top];
        return slot == nullptr || slot->is_whole ? triangle : slot->triangles[triangle];
    }

  private:
    std::vector<Entry> entries_;
    std::vector<const CollectedSlot*> slots_;  ///< null for instances
};

}  // namespace etendue
