// The vertices of a wave that can be connected, with random numbers for the connections of all of them.
#pragma once

#include "wave/number_pairs.h"
#include "wave/subpath/subpath_wave.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace etendue {

/// `Kinds` are the numbers that the connections need.
template <SubpathDimension... Kinds>
class ConnectibleVertices {
  public:
    /// Collects the connectible vertices of `wave`, whose subpaths are from `end`, in their order, and draws their
    /// numbers.
    void collect(const SubpathJob& job, SubpathEnd end, const SubpathWave& wave) {
        vertices_ = wave.vertices().connectible();
        keys_.clear();
        for (const ConnectibleVertex& vertex : vertices_) keys_.push_back(job.samples[vertex.slot].key);
        for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
            if (job.needs(end, kKinds[kind]))
                numbers_[kind].resize(vertices_.size());
            else
                numbers_[kind].draw_none(vertices_.size());
        }
        // Vertices come bounce by bounce: long runs of them have one index, and with it one dimension.
        for (std::size_t first = 0, next = 0; first < vertices_.size(); first = next) {
            const int index = vertices_[first].index;
            while (next < vertices_.size() && vertices_[next].index == index) ++next;
            for (std::size_t kind = 0; kind < kKinds.size(); ++kind)
                if (job.needs(end, kKinds[kind]))
                    numbers_[kind].draw(job.job.sequence, keys_, subpath_dimension(end, index, kKinds[kind]), first,
                                        next);
        }
    }

    [[nodiscard]] std::size_t size() const { return vertices_.size(); }
    [[nodiscard]] const ConnectibleVertex& operator[](std::size_t i) const { return vertices_[i]; }
    /// Returns the numbers of vertex `i`, in the order of `Kinds`.
    [[nodiscard]] std::array<Vec2f, sizeof...(Kinds)> numbers(std::size_t i) const {
        std::array<Vec2f, sizeof...(Kinds)> pairs;
        for (std::size_t kind = 0; kind < pairs.size(); ++kind) pairs[kind] = numbers_[kind][i];
        return pairs;
    }
    [[nodiscard]] std::size_t bytes() const {
        std::size_t bytes = keys_.bytes();
        for (const NumberPairs& pairs : numbers_) bytes += pairs.bytes();
        return bytes;
    }

  private:
    static constexpr std::array kKinds{Kinds...};

    std::span<const ConnectibleVertex> vertices_;
    SampleKeys keys_;
    std::array<NumberPairs, sizeof...(Kinds)> numbers_;
};

/// Holds vertices to be connected to a point on the lens.
using VerticesToCamera = ConnectibleVertices<SubpathDimension::LightChoice>;
/// Holds vertices to be connected to a point on a light.
using VerticesToLight = ConnectibleVertices<SubpathDimension::LightChoice, SubpathDimension::LightTriangle,
                                            SubpathDimension::LightDirection>;

}  // namespace etendue
