// The light vertices of a wave, as eye vertices look for them.
#pragma once

#include "core/vector_bytes.h"
#include "integrator/bdpt/bdpt_job.h"

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace etendue {

/// Brings the light vertices that can be connected into an order in which those of a sample are side by side, and into
/// the cache, if settings ask for one.
class LightVertices {
  public:
    /// Holds a light vertex, and whether it is in the cache.
    struct Candidate {
        ConnectibleVertex vertex;
        bool is_shared;
    };

    /// Takes the vertices of a wave, which come bounce by bounce.
    void collect(const BdptJob& job, std::span<const ConnectibleVertex> vertices) {
        cache_.clear();
        // The number of each slot's, then where those end; as they are written, backwards, where they begin.
        own_begin_.assign(job.samples.size() + 1, 0);
        for (const ConnectibleVertex& vertex : vertices) ++own_begin_[vertex.slot];
        std::inclusive_scan(own_begin_.begin(), own_begin_.end(), own_begin_.begin());
        own_.resize(own_begin_.back());
        // Bounce by bounce, so that the last vertex of a slot comes first there.
        for (const ConnectibleVertex& vertex : vertices) {
            const Candidate candidate{vertex, job.is_shared(vertex)};
            own_[--own_begin_[vertex.slot]] = candidate;
            if (candidate.is_shared) cache_.push_back(candidate);
        }
    }

    /// Returns all vertices of the light subpath of the sample in `slot`, the last first.
    [[nodiscard]] std::span<const Candidate> own(std::uint32_t slot) const {
        return std::span(own_).subspan(own_begin_[slot], own_begin_[slot + 1] - own_begin_[slot]);
    }
    /// Returns the vertices that eye vertices of any sample may be connected to.
    [[nodiscard]] std::span<const Candidate> cache() const { return cache_; }
    [[nodiscard]] std::size_t bytes() const { return vector_bytes(own_, own_begin_, cache_); }

  private:
    std::vector<Candidate> own_;            ///< sample by sample
    std::vector<std::uint32_t> own_begin_;  ///< by slot, and the end of the last
    std::vector<Candidate> cache_;
};

}  // namespace etendue
